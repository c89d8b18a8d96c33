use crate::arguments::Arguments;
use pomona_cloud::PixelBox;
use pomona_evaluate::{
    AppleWoodTable, RealFrame, Subject, WoodSeen, read_calipers, read_real_frames,
};
use pomona_labels::{ImageStrokes, Stroke, StrokeClass, StrokePoint};
use pomona_scenes::{Scene, Truth};
use std::collections::BTreeMap;
use std::error::Error;

/// Wood farther behind the apples than this belongs to another row, metres.
const FAR_M: f64 = 0.6;

/// Frames that are measured together, as one column of the table.
pub(crate) struct Source {
    pub(crate) name: String,
    pub(crate) frames: Vec<RealFrame>,
    /// The truth of each frame, for scenes.
    pub(crate) truths: Vec<Truth>,
    /// Which apples' wood a person sees; by strokes near the box without.
    pub(crate) apples: Option<AppleWoodTable>,
    /// Radii by frame and box, metres.
    pub(crate) radii: BTreeMap<(String, String), f64>,
}

impl Source {
    pub(crate) fn of_suite(name: &str, count: Option<usize>) -> Result<Self, Box<dyn Error>> {
        let mut source = Self::named(name);
        for subject in Subject::named(name, count)? {
            source.add(subject.load()?);
        }
        Ok(source)
    }

    pub(crate) fn of_frames(arguments: &Arguments) -> Result<Self, Box<dyn Error>> {
        let mut source = Self::named("real frames");
        source.frames = read_real_frames(&arguments.real, arguments.strokes.as_deref())?;
        if let Some(path) = &arguments.apples {
            source.apples = Some(AppleWoodTable::read(path)?);
        }
        if let Some(path) = &arguments.calipers {
            for caliper in read_calipers(path)? {
                for frame in &source.frames {
                    let key = (frame.frame.id.clone(), caliper.box_name.clone());
                    source.radii.insert(key, 0.5 * caliper.diameter);
                }
            }
        }
        Ok(source)
    }

    fn named(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            frames: Vec::new(),
            truths: Vec::new(),
            apples: None,
            radii: BTreeMap::new(),
        }
    }

    fn add(&mut self, scene: Scene) {
        let id = scene.frame.id.clone();
        let depths = scene.truth.apples.iter().map(|apple| apple.center[2]);
        let near = depths.fold(f64::INFINITY, f64::min);
        let strokes = scene.wood.unwrap_or_default().into_iter().map(|wood| {
            let class = if wood.depth_m > near + FAR_M {
                StrokeClass::Far
            } else {
                StrokeClass::Wood
            };
            let point = |&[x, y, half_width]: &[f64; 3]| StrokePoint { x, y, half_width };
            Stroke::new(class, wood.points.iter().map(point).collect())
        });
        let strokes = ImageStrokes::new(id.clone(), strokes.collect());
        for apple in &scene.truth.apples {
            let key = (id.clone(), apple.bounds.name.clone());
            self.radii.insert(key, apple.radius);
        }
        self.frames.push(RealFrame::new(scene.frame, strokes));
        self.truths.push(scene.truth);
    }

    /// Apples that count: of real frames those of the table, which leaves out what is no apple.
    pub(crate) fn boxes<'a>(&'a self, frame: &'a RealFrame) -> impl Iterator<Item = &'a PixelBox> {
        frame.boxes().iter().filter(|bounds| {
            self.apples
                .as_ref()
                .is_none_or(|table| table.wood(&frame.frame.id, &bounds.name) != WoodSeen::Unlisted)
        })
    }
}
