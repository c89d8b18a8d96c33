use pomona_ransac::{Constraint, Estimator};

/// A constraint that refuses a refit which breaks it, and does not
/// [restore](Constraint::restore) it: the model before the refit stays, and the report counts the refusal.
///
/// For published methods, which know no refit under a constraint, and where a refit that leaves the
/// window says that the model is wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refusing<C>(pub C);

impl<E: Estimator, C: Constraint<E>> Constraint<E> for Refusing<C> {
    fn name(&self) -> &'static str {
        self.0.name()
    }

    fn allows_sample(&self, estimator: &E, sample: &[usize]) -> bool {
        self.0.allows_sample(estimator, sample)
    }

    fn allows_model(&self, estimator: &E, model: &E::Model) -> bool {
        self.0.allows_model(estimator, model)
    }
}
