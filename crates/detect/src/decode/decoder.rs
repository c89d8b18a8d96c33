use super::table::rows_output;
use crate::{classes, family::Coordinates, family::Family};
use pomona_network::{Malformed, Port, Tensor};

/// What the reading of a network's outputs depends on.
#[derive(Clone, Debug)]
pub(crate) struct Decoder {
    pub(crate) family: Family,
    /// Whether the family was stated rather than recognised.
    pub(crate) stated: bool,
    /// Width and height of the input in pixels.
    pub(crate) input: [usize; 2],
    /// The classes that count; the boxes of all of them get the first one's number.
    pub(crate) wanted: Vec<usize>,
    /// Whether neither a choice nor a name says that it is these.
    pub(crate) class_is_guess: bool,
    /// The score threshold.
    pub(crate) threshold: f64,
    /// Numbers of a row behind those of the boxes and classes, for a mask or key points, where the model has names.
    pub(crate) has_more: bool,
    /// Number of classes, where they have names.
    pub(crate) classes: Option<usize>,
    pub(crate) strides: Option<Vec<usize>>,
    pub(crate) anchors: Option<Vec<[f32; 2]>>,
    pub(crate) coordinates: Option<Coordinates>,
    /// The outputs as the model declares them.
    pub(crate) ports: Vec<Port>,
}

impl Decoder {
    /// The output that holds rows of boxes.
    pub(super) fn rows<'a>(&self, outputs: &'a [Tensor]) -> Result<&'a Tensor, Malformed> {
        let at = rows_output(&self.ports).unwrap_or(0);
        outputs.get(at).ok_or_else(|| {
            let problem = format!("none, and {} is read from one", self.family);
            Malformed::new("outputs", problem, "export the model again")
        })
    }

    /// Refuses a number of classes that their names or the choice contradict.
    pub(super) fn check_classes(&self, place: &str, count: usize) -> Result<(), Malformed> {
        if let Some(named) = self.classes
            && named != count
        {
            return Err(Malformed::new(
                place,
                format!("{count} classes, of which {named} are named"),
                "name every class of the model in `classes`, in its order, or state its `family`",
            ));
        }
        self.wanted
            .iter()
            .try_for_each(|&class| classes::check(class, Some(count)))
    }

    /// The best score of the classes that count, by that of each.
    pub(super) fn best(&self, score: impl Fn(usize) -> f32) -> f32 {
        let scores = self.wanted.iter().map(|&class| score(class));
        scores.fold(f32::NEG_INFINITY, f32::max)
    }

    /// How many of so many numbers to a row are scores of classes: the rest behind them are of a mask or key points.
    pub(super) fn class_columns(&self, columns: usize, before: usize) -> usize {
        let all = columns.saturating_sub(before);
        match self.classes {
            Some(named) if self.has_more && named < all => named,
            _ => all,
        }
    }
}
