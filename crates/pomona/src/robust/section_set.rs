//! Which of the cross-sections along an axis show something.

/// Numbers of cross-sections.
///
/// Those from 256 on are not kept: with the closest spacing, 2 mm, and the longest reach by default, 2.9 radii, they
/// belong to apples with a radius above 88 mm.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SectionSet([u64; 4]);

impl SectionSet {
    /// Adds a number.
    pub(crate) fn insert(&mut self, number: usize) {
        if let Some(word) = self.0.get_mut(number / 64) {
            *word |= 1 << (number % 64);
        }
    }

    /// Whether a number is there.
    pub(crate) fn contains(&self, number: usize) -> bool {
        let word = self.0.get(number / 64);
        word.is_some_and(|word| word & (1 << (number % 64)) != 0)
    }

    /// How many stretches of consecutive numbers there are, and how many numbers the longest has.
    pub(crate) fn stretches(&self) -> (usize, usize) {
        let (mut count, mut longest, mut own) = (0, 0, 0);
        for number in 0..64 * self.0.len() {
            if self.contains(number) {
                count += usize::from(own == 0);
                own += 1;
                longest = longest.max(own);
            } else {
                own = 0;
            }
        }
        (count, longest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_are_counted_and_measured() {
        let mut set = SectionSet::default();
        assert_eq!(set.stretches(), (0, 0));
        for number in [3, 4, 62, 63, 64, 65, 300] {
            set.insert(number);
        }
        assert!(set.contains(64) && !set.contains(61) && !set.contains(300));
        assert_eq!(set.stretches(), (2, 4));
    }
}
