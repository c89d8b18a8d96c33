use std::sync::{Mutex, PoisonError};

/// Workers that are not busy, for a network that many threads run at once.
///
/// Nobody waits: where all are busy the caller makes another one, which then stays. So there are as many as
/// ever ran at once.
pub(super) struct Idle<T> {
    workers: Mutex<Vec<T>>,
}

impl<T> Idle<T> {
    /// Begins with this one.
    pub(super) fn new(first: T) -> Self {
        Self {
            workers: Mutex::new(vec![first]),
        }
    }

    /// Does `work` with a worker that is not busy, or with a new one.
    ///
    /// A worker that fails is not used again.
    pub(super) fn with<R, E>(
        &self,
        make: impl FnOnce() -> Result<T, E>,
        work: impl FnOnce(&mut T) -> Result<R, E>,
    ) -> Result<R, E> {
        let idle = self.lock().pop();
        let mut worker = match idle {
            Some(worker) => worker,
            None => make()?,
        };
        let outcome = work(&mut worker)?;
        self.lock().push(worker);
        Ok(outcome)
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Vec<T>> {
        // The list is whole even if a thread died while it held it.
        self.workers.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_as_many_workers_as_ever_ran_at_once() {
        let idle = Idle::new(0);
        let make = || Ok::<_, ()>(1);
        let nested = idle.with(make, |&mut outer| {
            idle.with(make, |&mut inner| Ok((outer, inner)))
        });
        assert_eq!(nested, Ok((0, 1)));
        assert_eq!(idle.lock().len(), 2);
        assert_eq!(idle.with(make, |_| Err::<(), ()>(())), Err(()));
        assert_eq!(idle.lock().len(), 1);
    }
}
