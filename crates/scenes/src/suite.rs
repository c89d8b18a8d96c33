use crate::cameras::Make;
use crate::dense::Dense;
use crate::error::SceneError;
use crate::lab::{Lab, Orientation};
use crate::orchard::Orchard;
use crate::repeat::{Density, Repeat};
use crate::row::Row;
use crate::scene::Scene;
use crate::sensor::Sensor;
use crate::shot::Shot;

/// A named set of scenes, the same ones whoever asks.
///
/// Every suite goes on beyond its own length, with new seeds: see [`Suite::cases_to`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Suite {
    /// `lab15`: the paper's fifteen orientations, one noise draw each.
    Lab15,
    /// `lab150`: the same with ten noise draws each.
    Lab150,
    /// `repeat474` and the like: one apple with leaves at its stalk, 474 times; see [`Repeat`].
    Repeat(Density),
    /// `orchard`: 200 random pieces of an orchard before the paper's camera; see [`Orchard`].
    Orchard,
    /// `rivals`: the same where thicker branches pass near the target's own; see [`Orchard::with_rivals`].
    Rivals,
    /// `harsh` and the like: the same orchard as a real camera sees it
    /// outdoors; see [`Sensor::outdoors`].
    Harsh(Make),
    /// `dense`: 160 pieces of dense trees as a time-of-flight camera sees them; see [`Dense`] and
    /// [`Sensor::time_of_flight_outdoors`].
    Dense,
    /// `row`: ten whole trees with up to 40 apples each; see [`Row`].
    Row,
    /// `demo`: one frame of a fruiting tree, for pictures.
    Demo,
}

/// One scene of a suite, not yet generated.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Case {
    /// Name of the scene; its frame carries it too.
    pub name: String,
    /// Seed of the scene.
    pub seed: u64,
    suite: Suite,
    number: usize,
}

impl Suite {
    /// All suites, in the order in which they are listed to people.
    pub const ALL: &[Self] = &[
        Self::Lab15,
        Self::Lab150,
        Self::Repeat(Density::None),
        Self::Repeat(Density::Light),
        Self::Repeat(Density::Paper),
        Self::Repeat(Density::Dense),
        Self::Orchard,
        Self::Rivals,
        Self::Harsh(Make::Paper),
        Self::Harsh(Make::Kinect),
        Self::Harsh(Make::AzureKinect),
        Self::Harsh(Make::D400),
        Self::Dense,
        Self::Row,
        Self::Demo,
    ];

    /// The suite called `name`; `repeat474-paper` and `harsh-paper` are `repeat474` and `harsh`.
    ///
    /// # Errors
    ///
    /// [`SceneError::UnknownSuite`], which lists the names there are.
    pub fn named(name: &str) -> Result<Self, SceneError> {
        let name = match name {
            "repeat474-paper" => "repeat474",
            "harsh-paper" => "harsh",
            other => other,
        };
        let unknown = || SceneError::UnknownSuite {
            name: name.into(),
            known: Self::ALL.iter().map(Self::name).collect(),
        };
        Self::ALL
            .iter()
            .copied()
            .find(|suite| suite.name() == name)
            .ok_or_else(unknown)
    }

    /// The name.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Lab15 => "lab15",
            Self::Lab150 => "lab150",
            Self::Repeat(Density::None) => "repeat474-none",
            Self::Repeat(Density::Light) => "repeat474-light",
            Self::Repeat(Density::Paper) => "repeat474",
            Self::Repeat(Density::Dense) => "repeat474-dense",
            Self::Orchard => "orchard",
            Self::Rivals => "rivals",
            Self::Harsh(Make::Paper) => "harsh",
            Self::Harsh(Make::Kinect) => "harsh-kinect",
            Self::Harsh(Make::AzureKinect) => "harsh-azure-kinect",
            Self::Harsh(Make::D400) => "harsh-d400",
            Self::Dense => "dense",
            Self::Row => "row",
            Self::Demo => "demo",
        }
    }

    /// What it shows, in one line.
    pub fn summary(&self) -> &'static str {
        match self {
            Self::Lab15 => "the paper's 15 lab orientations",
            Self::Lab150 => "the 15 lab orientations, ten noise draws each",
            Self::Repeat(Density::None) => "474 repeats of one apple without leaves",
            Self::Repeat(Density::Light) => "474 repeats of one apple with three leaves",
            Self::Repeat(Density::Paper) => "474 repeats of one apple with leaves as in the paper",
            Self::Repeat(Density::Dense) => "474 repeats of one apple among many leaves",
            Self::Orchard => "200 random orchard scenes, the paper's camera",
            Self::Rivals => "200 orchard scenes with thicker branches near the right one",
            Self::Harsh(Make::Paper) => "the orchard scenes outdoors, the paper's camera",
            Self::Harsh(Make::Kinect) => "the orchard scenes outdoors, first Kinect",
            Self::Harsh(Make::AzureKinect) => "the orchard scenes outdoors, Azure Kinect",
            Self::Harsh(Make::D400) => "the orchard scenes outdoors, RealSense D400",
            Self::Dense => "160 pieces of dense trees, a time-of-flight camera outdoors",
            Self::Row => "ten whole trees with up to 40 apples each",
            Self::Demo => "one fruiting tree against the sky",
        }
    }

    /// How many scenes it has.
    pub fn len(&self) -> usize {
        match self {
            Self::Lab15 => 15,
            Self::Lab150 => 150,
            Self::Repeat(_) => 474,
            Self::Orchard | Self::Rivals | Self::Harsh(_) => 200,
            Self::Dense => 160,
            Self::Row => 10,
            Self::Demo => 1,
        }
    }

    /// Never: every suite has scenes.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Its cases, by which single scenes can be generated in any order.
    pub fn cases(self) -> impl ExactSizeIterator<Item = Case> {
        self.cases_to(self.len())
    }

    /// The first `count` cases, which may be fewer or more than its own.
    pub fn cases_to(self, count: usize) -> impl ExactSizeIterator<Item = Case> {
        (0..count).map(move |number| self.case(number))
    }

    /// Its scenes, each generated when it is asked for.
    pub fn scenes(self) -> impl ExactSizeIterator<Item = Scene> {
        self.cases().map(|case| case.scene())
    }

    fn case(self, number: usize) -> Case {
        let orientations = Orientation::PAPER.len();
        let (name, seed) = match self {
            Self::Lab15 | Self::Lab150 => {
                let seed = number / orientations;
                let orientation = Orientation::PAPER[number % orientations];
                (format!("lab-{}-s{seed}", orientation.name()), seed)
            }
            Self::Demo if number == 0 => ("orchard-demo".into(), 0),
            _ => (format!("{}-{number:03}", self.name()), number),
        };
        Case {
            name,
            seed: seed as u64,
            suite: self,
            number,
        }
    }
}

impl Case {
    /// The suite it belongs to.
    pub fn suite(&self) -> Suite {
        self.suite
    }

    /// Generates the scene.
    pub fn scene(&self) -> Scene {
        match self.suite {
            Suite::Lab15 | Suite::Lab150 => {
                let orientation = Orientation::PAPER[self.number % Orientation::PAPER.len()];
                let shot = Shot {
                    target: Some(0),
                    ..self.shot(Sensor::paper())
                };
                shot.take(&Lab::default().world(orientation))
            }
            Suite::Repeat(density) => Repeat::new(density).scene(self.name.clone(), self.seed),
            Suite::Orchard => self.orchard(Orchard::default(), Sensor::paper()),
            Suite::Rivals => self.orchard(Orchard::with_rivals(), Sensor::paper()),
            Suite::Harsh(make) => {
                self.orchard(Orchard::default(), make.sensor().outdoors(self.seed))
            }
            Suite::Dense => self.dense(Sensor::time_of_flight_outdoors()),
            Suite::Row => self
                .shot(Sensor::paper())
                .take(&Row::default().world(self.seed)),
            Suite::Demo => self.shot(Sensor::paper()).take(&crate::demo::world()),
        }
    }

    fn shot(&self, sensor: Sensor) -> Shot {
        Shot::new(self.name.clone(), Shot::paper_camera(), sensor, self.seed)
    }

    fn dense(&self, sensor: Sensor) -> Scene {
        let dense = Dense::default();
        let camera = Dense::camera(self.seed);
        let (world, cast) = dense.layout(&camera, self.seed);
        let shot = Shot {
            least_visible: dense.least_visible,
            box_margin_px: 1.0,
            box_sd_px: Dense::BOX_SD_PX,
            ..Shot::new(self.name.clone(), camera, sensor, self.seed)
        };
        shot.develop(&world, &cast)
    }

    fn orchard(&self, orchard: Orchard, sensor: Sensor) -> Scene {
        let shot = Shot {
            target: Some(0),
            ..self.shot(sensor)
        };
        let (world, cast) = orchard.layout(&shot.camera, self.seed);
        shot.develop(&world, &cast)
    }
}
