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
    pub(crate) class: usize,
    /// The score threshold.
    pub(crate) threshold: f64,
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
        classes::check(self.class, Some(count))
    }
}
