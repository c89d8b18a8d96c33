use crate::Kind;

/// A type that a setting may have.
pub trait Value {
    /// What it holds.
    const KIND: Kind;

    /// Its value in a file; `None` where it is left out.
    fn to_toml(&self) -> Option<toml::Value>;

    /// The numbers on which rules are checked; `None` where it holds none.
    fn numbers(&self) -> Option<Vec<f64>> {
        None
    }
}

impl Value for bool {
    const KIND: Kind = Kind::Flag;

    fn to_toml(&self) -> Option<toml::Value> {
        Some((*self).into())
    }
}

impl Value for u64 {
    const KIND: Kind = Kind::Count;

    fn to_toml(&self) -> Option<toml::Value> {
        i64::try_from(*self).ok().map(Into::into)
    }

    fn numbers(&self) -> Option<Vec<f64>> {
        Some(vec![*self as f64])
    }
}

impl Value for usize {
    const KIND: Kind = Kind::Count;

    fn to_toml(&self) -> Option<toml::Value> {
        (*self as u64).to_toml()
    }

    fn numbers(&self) -> Option<Vec<f64>> {
        Some(vec![*self as f64])
    }
}

impl Value for f64 {
    const KIND: Kind = Kind::Number;

    fn to_toml(&self) -> Option<toml::Value> {
        Some((*self).into())
    }

    fn numbers(&self) -> Option<Vec<f64>> {
        Some(vec![*self])
    }
}

impl<const N: usize> Value for [f64; N] {
    const KIND: Kind = Kind::Numbers(N);

    fn to_toml(&self) -> Option<toml::Value> {
        Some(self.to_vec().into())
    }

    fn numbers(&self) -> Option<Vec<f64>> {
        Some(self.to_vec())
    }
}

impl<T: Value> Value for Option<T> {
    const KIND: Kind = T::KIND;

    fn to_toml(&self) -> Option<toml::Value> {
        self.as_ref()?.to_toml()
    }

    fn numbers(&self) -> Option<Vec<f64>> {
        self.as_ref()?.numbers()
    }
}
