use crate::Scored;

/// Two hypotheses whose inliers have more than this share of their union in common are taken for one.
const SAME: f64 = 0.8;

/// How many runners-up are kept at most, whatever is asked for: each takes a bit for each datum.
pub(crate) const MAX_RUNNERS_UP: usize = 1000;

/// Which runners-up a search keeps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Keep {
    /// How many at most.
    pub(crate) models: usize,
    /// Share of the best score that each exceeds; `None` where any score will do.
    pub(crate) share: Option<f64>,
}

/// The best distinct hypotheses of a search but for the best, for a last refit of each.
///
/// Offered in the order of the iterations, so that what is kept depends on neither threads nor rounds.
#[derive(Debug)]
pub(crate) struct RunnersUp<M> {
    /// The highest score first; among equal ones the earliest.
    kept: Vec<RunnerUp<M>>,
    limit: usize,
    /// The lowest score that was kept when there was no room left, the highest such score in the course of the search.
    floor: f64,
    /// A bit for each datum and place; the last place is that of the best hypothesis.
    bits: Vec<u64>,
    /// Words of a place.
    words: usize,
    /// Places that no runner-up holds; one more than there are runners-up at most.
    free: Vec<usize>,
}

#[derive(Debug)]
struct RunnerUp<M> {
    scored: Scored<M>,
    /// Where in `bits` its inliers are.
    place: usize,
}

impl<M> Default for RunnersUp<M> {
    fn default() -> Self {
        Self {
            kept: Vec::new(),
            limit: 0,
            floor: f64::NEG_INFINITY,
            bits: Vec::new(),
            words: 0,
            free: Vec::new(),
        }
    }
}

impl<M> RunnersUp<M> {
    /// Readies the memory for `limit` hypotheses over `data` data.
    pub(crate) fn prepare(&mut self, limit: usize, data: usize) {
        let limit = limit.min(MAX_RUNNERS_UP);
        self.kept.clear();
        self.kept.reserve(limit);
        self.limit = limit;
        self.floor = f64::NEG_INFINITY;
        self.words = data.div_ceil(64);
        self.bits.clear();
        self.free.clear();
        if limit > 0 {
            self.bits.resize((limit + 2) * self.words, 0);
            self.free.extend(0..=limit);
        }
    }

    /// Whether a hypothesis of this score can be kept at all.
    pub(crate) fn wants(&self, score: f64) -> bool {
        self.limit > 0 && score > self.floor
    }

    /// No score up to this one will be kept any more: it never falls, so that models can be abandoned by it.
    pub(crate) fn floor(&self) -> f64 {
        self.floor
    }

    /// The inliers of the best hypothesis: no runner-up is much the same.
    pub(crate) fn best(&mut self, inliers: &[usize]) {
        if self.limit == 0 {
            return;
        }
        let place = self.limit + 1;
        self.mark(place, inliers);
        self.drop_same(place, 0);
    }

    /// Drops those from number `from` on that are much the same as the hypothesis of a place.
    fn drop_same(&mut self, place: usize, from: usize) {
        for k in (from..self.kept.len()).rev() {
            let other = self.kept[k].place;
            if self.same(other, place) {
                self.kept.remove(k);
                self.free.push(other);
            }
        }
    }

    /// Keeps a hypothesis unless a better one is much the same, in the place of worse ones that are.
    pub(crate) fn offer(&mut self, scored: Scored<M>, inliers: &[usize]) {
        if !self.wants(scored.score) {
            return;
        }
        // There is one place more than runners-up.
        let Some(place) = self.free.pop() else { return };
        self.mark(place, inliers);
        let better = self
            .kept
            .partition_point(|k| k.scored.score >= scored.score);
        let known = self.kept[..better]
            .iter()
            .any(|k| self.same(k.place, place));
        if known || self.same(self.limit + 1, place) {
            self.free.push(place);
            return;
        }
        self.drop_same(place, better);
        if self.kept.len() == self.limit {
            self.free.extend(self.kept.pop().map(|worst| worst.place));
        }
        self.kept.insert(better, RunnerUp { scored, place });
        if self.kept.len() == self.limit
            && let Some(worst) = self.kept.last()
        {
            self.floor = self.floor.max(worst.scored.score);
        }
    }

    /// Takes out those with a score above `bound`, the best first; the others are forgotten.
    pub(crate) fn drain(&mut self, bound: f64) -> impl Iterator<Item = Scored<M>> + '_ {
        let kept = self.kept.drain(..).map(|k| k.scored);
        kept.take_while(move |scored| scored.score > bound)
    }

    fn row(&self, place: usize) -> &[u64] {
        &self.bits[place * self.words..(place + 1) * self.words]
    }

    fn mark(&mut self, place: usize, inliers: &[usize]) {
        let row = &mut self.bits[place * self.words..(place + 1) * self.words];
        row.fill(0);
        for &i in inliers {
            row[i / 64] |= 1 << (i % 64);
        }
    }

    fn same(&self, one: usize, other: usize) -> bool {
        let (mut common, mut either) = (0, 0);
        for (a, b) in self.row(one).iter().zip(self.row(other)) {
            common += (a & b).count_ones();
            either += (a | b).count_ones();
        }
        f64::from(common) >= SAME * f64::from(either)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kept(limit: usize, offers: &[(f64, std::ops::Range<usize>)]) -> Vec<f64> {
        let mut runners_up = RunnersUp::default();
        // Memory of an earlier search with more data leaves no trace.
        runners_up.prepare(limit + 3, 1000);
        runners_up.offer(
            Scored {
                model: (),
                score: 9.0,
            },
            &[999],
        );
        runners_up.prepare(limit, 100);
        for (score, inliers) in offers {
            let inliers: Vec<usize> = inliers.clone().collect();
            let model = ();
            runners_up.offer(
                Scored {
                    model,
                    score: *score,
                },
                &inliers,
            );
        }
        runners_up.drain(0.5).map(|s| s.score).collect()
    }

    #[test]
    fn the_best_distinct_ones_are_kept_in_order() {
        let offers = [(1.0, 0..10), (3.0, 20..30), (2.0, 40..50), (0.4, 60..70)];
        assert_eq!(kept(4, &offers), [3.0, 2.0, 1.0]);
        assert_eq!(kept(2, &offers), [3.0, 2.0]);
        assert_eq!(kept(0, &offers), []);
    }

    #[test]
    fn of_those_alike_the_best_is_kept() {
        assert_eq!(kept(4, &[(1.0, 0..10), (2.0, 0..9)]), [2.0]);
        assert_eq!(kept(4, &[(2.0, 0..10), (1.0, 0..9)]), [2.0]);
        assert_eq!(kept(4, &[(2.0, 0..10), (2.0, 1..10)]), [2.0]);
        assert_eq!(kept(4, &[(2.0, 0..10), (1.0, 0..7)]), [2.0, 1.0]);
        // One that is like two others takes the place of both.
        let three = [(1.0, 0..90), (1.5, 18..100), (2.0, 9..95)];
        assert_eq!(kept(4, &three), [2.0]);
        assert_eq!(kept(1, &three), [2.0]);
    }
}
