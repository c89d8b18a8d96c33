/// The models that one minimal sample gives: a buffer the engine owns and reuses.
///
/// It holds at most [`Estimator::MAX_MODELS`](crate::Estimator::MAX_MODELS)
/// models and never allocates once made.
#[derive(Debug)]
pub struct Candidates<M> {
    models: Vec<M>,
    limit: usize,
}

impl<M> Candidates<M> {
    /// An empty buffer for at most `limit` models.
    ///
    /// The engine makes its own; this one is for calling
    /// [`Estimator::fit`](crate::Estimator::fit) outside of it, as tests do.
    pub fn new(limit: usize) -> Self {
        Self {
            models: Vec::with_capacity(limit),
            limit,
        }
    }

    pub(crate) fn clear(&mut self) {
        self.models.clear();
    }

    /// Makes it a buffer for at most `limit` models.
    pub(crate) fn set_limit(&mut self, limit: usize) {
        self.models.clear();
        self.models.reserve(limit);
        self.limit = limit;
    }

    /// The model, where it holds one and no other; it then holds none.
    #[inline]
    pub(crate) fn take_only(&mut self) -> Option<M> {
        if self.models.len() == 1 {
            self.models.pop()
        } else {
            None
        }
    }

    pub(crate) fn drain(&mut self) -> impl Iterator<Item = M> + '_ {
        self.models.drain(..)
    }

    /// Adds a model; `false`, and nothing added, where the buffer is full.
    pub fn push(&mut self, model: M) -> bool {
        let fits = self.models.len() < self.limit;
        if fits {
            self.models.push(model);
        }
        fits
    }

    /// How many models it holds.
    pub fn len(&self) -> usize {
        self.models.len()
    }

    /// Whether it holds none.
    pub fn is_empty(&self) -> bool {
        self.models.is_empty()
    }
}

impl<M> AsRef<[M]> for Candidates<M> {
    fn as_ref(&self) -> &[M] {
        &self.models
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_buffer_takes_no_more() {
        let mut c = Candidates::new(2);
        assert!(c.is_empty());
        assert!(c.push('a') && c.push('b') && !c.push('c'));
        assert_eq!(c.as_ref(), ['a', 'b']);
        assert_eq!(c.take_only(), None);
        assert_eq!(c.drain().count(), 2);
        assert!(c.push('d') && c.take_only() == Some('d'));
        assert_eq!(c.len(), 0);
    }
}
