use crate::{
    classes::{Classes, Role},
    error::SegmentError,
};
use pomona_network::{
    ChannelOrder, Malformed, NetworkError, Padding, Preparation, TilingChoice, TilingOptions,
    description,
};
use serde::Deserialize;
use std::{collections::BTreeMap, path::Path};

/// Pixels that neighbouring tiles share where the description says nothing.
const DEFAULT_OVERLAP: usize = 64;

/// How a network's numbers become probabilities.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Activation {
    /// They are logits of classes that exclude one another.
    Softmax,
    /// They are logits, each of one class against the rest.
    Sigmoid,
    /// They are probabilities.
    None,
}

/// What a model's file does not say about it, from a small TOML beside it; everything is optional.
///
/// ```
/// # use pomona_segment::SegmentDescription;
/// let text = "
///     classes = ['background', 'trunk', 'branch', 'support']
///     roles = { support = 'post' }
///     activation = 'softmax'
///     channels = 'bgr'
///     tile = 512";
/// let description = SegmentDescription::parse(text, "branches.toml")?;
/// assert_eq!(description.classes.unwrap().len(), 4);
/// # Ok::<(), pomona_segment::SegmentError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct SegmentDescription {
    /// What the model is called.
    pub name: Option<String>,
    /// Under which licence it may be used.
    #[serde(alias = "license")]
    pub licence: Option<String>,
    /// Where it is from.
    pub source: Option<String>,
    /// Anything else.
    pub notes: Option<String>,
    /// Names of the classes, in the order of the output's channels. Where absent, a model of one channel has `wood`,
    /// and others must state it.
    pub classes: Option<Vec<String>>,
    /// The role of classes whose name does not tell it: `wood`, `peduncle`, `fruit`, `post` or `rest`.
    pub roles: Option<BTreeMap<String, Role>>,
    /// How the output's numbers become probabilities. Where absent, a grey image is run once: numbers that are
    /// probabilities are taken for such, others for logits.
    pub activation: Option<Activation>,
    /// Width and height of the input in pixels, where the model leaves them open.
    pub input_size: Option<[usize; 2]>,
    /// Order of the colours.
    pub channels: Option<ChannelOrder>,
    /// Factor on the colours 0 to 255, before mean and standard deviation; 1/255 where absent.
    pub scale: Option<f32>,
    /// Subtracted from each colour, in the order of the channels.
    pub mean: Option<[f32; 3]>,
    /// Divisor of each colour, in the order of the channels.
    pub std: Option<[f32; 3]>,
    /// Where a tile smaller than the input lies in it.
    pub padding: Option<Padding>,
    /// The grey, 0 to 255, around it.
    pub fill: Option<u8>,
    /// Longest side of a tile in pixels of the image; the input's longer side where absent, so that nothing is scaled.
    pub tile: Option<usize>,
    /// Pixels of the image that neighbouring tiles share at least; 64 where absent.
    pub tile_overlap: Option<usize>,
}

impl SegmentDescription {
    /// Reads the description beside a model; one that says nothing where there is no such file.
    ///
    /// # Errors
    ///
    /// [`NetworkError::Read`], [`NetworkError::Model`].
    pub fn beside(model: &Path) -> Result<Self, SegmentError> {
        match description::read_beside(model)? {
            Some((text, origin)) => Self::parse(&text, &origin),
            None => Ok(Self::default()),
        }
    }

    /// Reads a description's text; `origin` names it in messages.
    ///
    /// # Errors
    ///
    /// [`NetworkError::Model`] for what is not TOML, for a key that does not exist, and for a value that is none of
    /// those the key can have.
    pub fn parse(text: &str, origin: &str) -> Result<Self, SegmentError> {
        let remedy = "docs/segmentation.md lists the keys and their values";
        let description: Self = description::parse(text, origin, remedy)?;
        description
            .check()
            .map_err(|fault| NetworkError::model(origin, fault))?;
        Ok(description)
    }

    /// How images are prepared for the model.
    pub fn preparation(&self) -> Preparation {
        let mut preparation = Preparation::default();
        preparation.channels = self.channels.unwrap_or(preparation.channels);
        preparation.scale = self.scale.unwrap_or(preparation.scale);
        preparation.mean = self.mean.unwrap_or(preparation.mean);
        preparation.std = self.std.unwrap_or(preparation.std);
        preparation.padding = self.padding.unwrap_or(preparation.padding);
        preparation.fill = self.fill.unwrap_or(preparation.fill);
        preparation
    }

    /// How images are tiled for a model of this input, by this choice.
    pub fn tiling(&self, choice: TilingChoice, input: [usize; 2]) -> TilingOptions {
        let mut options = TilingOptions::default();
        options.choice = choice;
        options.tile = Some(self.tile.unwrap_or(input[0].max(input[1])));
        options.overlap = self.tile_overlap.unwrap_or(DEFAULT_OVERLAP);
        options.whole_pass = false;
        options
    }

    /// The classes of a model whose output has so many channels.
    pub(crate) fn classes(&self, channels: usize) -> Result<Classes, Malformed> {
        let fault = |problem: String, remedy: &str| Malformed::new("`classes`", problem, remedy);
        let mut names = match &self.classes {
            Some(names) if names.len() == channels => names.clone(),
            // One against the rest may be named alone or after it.
            Some(names) if channels == 1 && names.len() == 2 => names[1..].to_vec(),
            Some(names) => {
                let problem = format!("{} names for an output of {channels} channels", names.len());
                return Err(fault(
                    problem,
                    "name every class of the model, in its order",
                ));
            }
            None if channels == 1 => vec![Role::Wood.name().to_owned()],
            None => {
                let problem =
                    format!("an output of {channels} channels, and nobody says what they are");
                let remedy = "list `classes` in a TOML file beside the model, such as ['background', 'branch']";
                return Err(fault(problem, remedy));
            }
        };
        if channels == 1 {
            let rest = self.classes.as_ref().filter(|names| names.len() == 2);
            let rest = rest.map_or_else(|| Role::Rest.name().to_owned(), |names| names[0].clone());
            names.insert(0, rest);
        }
        let stated = self.roles.iter().flatten();
        if let Some((name, _)) = stated.clone().find(|(name, _)| !names.contains(name)) {
            let nearest = pomona_network::nearest(
                name,
                &names.iter().map(String::as_str).collect::<Vec<_>>(),
            );
            return Err(Malformed::new(
                format!("`roles`, `{name}`"),
                "none of the classes has this name",
                format!("the nearest are {nearest}"),
            ));
        }
        let role = |name: &str| {
            let of_name = || Role::of_name(name);
            stated
                .clone()
                .find(|(n, _)| *n == name)
                .map_or_else(of_name, |(_, role)| *role)
        };
        let classes = Classes::new(names.iter().map(|name| (name.clone(), role(name))));
        let classes = classes
            .map_err(|error| fault(error.to_string(), "give each class a name of its own"))?;
        if classes.of(Role::Wood).next().is_none() {
            let problem = format!("none of {:?} is wood", classes.names());
            return Err(fault(
                problem,
                "state which is by `roles = { NAME = \"wood\" }`",
            ));
        }
        Ok(classes)
    }

    /// Refuses values that make no sense for any model.
    fn check(&self) -> Result<(), Malformed> {
        let refused = [
            self.classes.as_deref().and_then(description::class_names),
            self.input_size.and_then(description::input_size),
            self.scale.and_then(description::scale),
            self.mean.and_then(description::mean),
            self.std.and_then(description::std),
            self.tile.and_then(description::tile),
            self.tile
                .zip(self.tile_overlap)
                .and_then(|(tile, overlap)| description::tile_overlap(tile, overlap)),
        ];
        refused.into_iter().flatten().next().map_or(Ok(()), Err)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<SegmentDescription, SegmentError> {
        SegmentDescription::parse(text, "m.toml")
    }

    #[test]
    fn every_key_is_read() {
        let text = "
            name = 'branches'\nlicence = 'MIT'\nsource = 'here'\nnotes = 'small'
            classes = ['leaf', 'branch']\nroles = { leaf = 'rest' }\nactivation = 'sigmoid'
            input_size = [416, 320]\nchannels = 'bgr'\nscale = 1\nmean = [1, 2, 3.5]\nstd = [1, 1, 2]
            padding = 'top-left'\nfill = 0\ntile = 400\ntile_overlap = 90";
        let description = parse(text).unwrap();
        assert_eq!(description.activation, Some(Activation::Sigmoid));
        let preparation = description.preparation();
        assert_eq!(
            (preparation.padding, preparation.fill),
            (Padding::TopLeft, 0)
        );
        let tiling = description.tiling(TilingChoice::Automatic, [416, 320]);
        assert_eq!(
            (tiling.tile, tiling.overlap, tiling.whole_pass),
            (Some(400), 90, false)
        );
        // Those are all keys, but for the other spelling of `licence`.
        let unknown = parse("zzz = 1").unwrap_err().to_string();
        let list = unknown.split_once("`: ").unwrap().1;
        let known = description::known_keys(list.split_once(';').unwrap().0);
        for key in known.iter().filter(|key| **key != "license") {
            assert!(text.contains(&format!("{key} = ")), "{key}");
        }
    }

    #[test]
    fn classes_are_what_is_stated_or_one_against_the_rest() {
        let roles = |text: &str, channels| {
            let classes = parse(text).unwrap().classes(channels).unwrap();
            (classes.names().to_vec(), classes.roles().to_vec())
        };
        let (names, binary) = roles("", 1);
        assert_eq!(
            (&names[..], &binary[..]),
            (
                &["rest".to_owned(), "wood".to_owned()][..],
                &[Role::Rest, Role::Wood][..]
            )
        );
        assert_eq!(roles("classes = ['leaf', 'twig']", 1).0, ["leaf", "twig"]);
        assert_eq!(roles("classes = ['branch']", 1).0, ["rest", "branch"]);
        let text = "classes = ['a', 'b', 'apple']\nroles = { b = 'wood' }";
        assert_eq!(roles(text, 3).1, [Role::Rest, Role::Wood, Role::Fruit]);
    }

    #[test]
    fn classes_that_do_not_fit_are_refused() {
        let fault = |text: &str, channels| {
            let fault = parse(text).unwrap().classes(channels).unwrap_err();
            format!("{}: {}; {}", fault.place, fault.problem, fault.remedy)
        };
        assert!(fault("", 2).contains("nobody says"));
        assert!(fault("classes = ['a', 'wood']", 3).contains("2 names for an output of 3"));
        assert!(fault("classes = ['a', 'b']", 2).contains("is wood"));
        let role = fault("classes = ['a', 'wood']\nroles = { wod = 'wood' }", 2);
        assert!(role.contains("`wod`") && role.contains("`wood`"), "{role}");
        assert!(fault("classes = ['rest']", 1).contains("a name of its own"));
    }

    #[test]
    fn values_that_make_no_sense_are_refused() {
        for (text, key) in [
            ("classes = []", "`classes`"),
            ("input_size = [0, 416]", "`input_size`"),
            ("scale = 0", "`scale`"),
            ("mean = [0, nan, 0]", "`mean`"),
            ("std = [1, 1, 0]", "`std`"),
            ("tile = 0", "`tile`"),
            ("tile = 100\ntile_overlap = 60", "`tile_overlap`"),
            ("activation = 'tanh'", "`activation`"),
            ("roles = { a = 'tree' }", "`roles`"),
        ] {
            let message = parse(text).unwrap_err().to_string();
            assert!(
                message.starts_with("m.toml: ") && message.contains(key),
                "{text}: {message}"
            );
        }
    }
}
