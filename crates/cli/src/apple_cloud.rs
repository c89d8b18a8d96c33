use anyhow::bail;
use nalgebra::{Point3, distance};
use pomona::{Evidence, Outcome, Pick, Status};
use pomona_cloud::{CloudError, Frame, PixelWindow, PointCloud};
use pomona_view::{CloudMark, colored_cloud};
use std::str::FromStr;

/// Radii about an apple's centre within which its cloud shows what is around it.
const REACH_RADII: f64 = 4.0;

/// Which apples get a cloud of their own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum CloudChoice {
    /// The picked apple with the most points on its surface.
    Best,
    /// Every apple with a sphere.
    All,
    /// None.
    None,
    /// Those of these numbers.
    Ids(Vec<usize>),
}

impl FromStr for CloudChoice {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text {
            "best" => Ok(Self::Best),
            "all" => Ok(Self::All),
            "none" => Ok(Self::None),
            ids => {
                let ids: Result<_, _> = ids.split(',').map(|id| id.trim().parse()).collect();
                ids.map(Self::Ids)
                    .map_err(|_| "neither best, all, none nor numbers such as 0,3")
            }
        }
    }
}

impl CloudChoice {
    /// The numbers of the apples chosen.
    pub(crate) fn of(&self, outcome: &Outcome) -> anyhow::Result<Vec<usize>> {
        let picks = &outcome.record.picks;
        let with_sphere = picks.iter().filter(|p| p.apple.is_some());
        let surface = |p: &&Pick| {
            (
                p.apple.as_ref().map_or(0, |a| a.inliers),
                std::cmp::Reverse(p.id),
            )
        };
        Ok(match self {
            Self::None => Vec::new(),
            Self::All => with_sphere.map(|p| p.id).collect(),
            Self::Best => {
                let picked = with_sphere.filter(|p| p.status == Status::Picked);
                picked
                    .max_by_key(surface)
                    .map(|p| p.id)
                    .into_iter()
                    .collect()
            }
            Self::Ids(ids) => {
                if let Some(id) = ids.iter().find(|&&id| id >= picks.len()) {
                    let frame = &outcome.record.frame.id;
                    bail!(
                        "--clouds {id}: frame '{frame}' has {} apples, numbered from 0",
                        picks.len()
                    );
                }
                ids.clone()
            }
        })
    }
}

/// The points of a frame, from which the clouds of its apples are cut.
pub(crate) struct AppleClouds {
    points: PointCloud,
    /// Pixel of each point, ascending.
    pixels: Vec<u32>,
}

impl AppleClouds {
    pub(crate) fn new(frame: &Frame) -> Result<Self, CloudError> {
        let window = PixelWindow::full(frame.depth.width, frame.depth.height);
        let points = frame.window(window)?;
        Ok(Self {
            points: PointCloud::from_points(&points, &frame.color),
            pixels: points.pixel,
        })
    }

    /// The surroundings of one apple: surface pink, branch green, direction red, the rest grey;
    /// `None` for an apple without a sphere.
    pub(crate) fn cut(&self, pick: &Pick, evidence: &Evidence) -> Option<PointCloud> {
        let apple = pick.apple.as_ref()?;
        let center = Point3::from(apple.center);
        let reach = REACH_RADII * apple.radius;
        let kept: Vec<usize> = (0..self.points.len())
            .filter(|&i| distance(&self.points.point(i), &center) <= reach)
            .collect();
        // Both ascend, so that the kept points can be searched by their pixel.
        let index_of = |pixel: &u32| {
            let at = kept.binary_search_by_key(pixel, |&i| self.pixels[i]).ok()?;
            u32::try_from(at).ok()
        };
        let surface: Vec<u32> = evidence.surface.iter().filter_map(index_of).collect();
        let branch: Vec<u32> = evidence.branch.iter().filter_map(index_of).collect();
        let mark = CloudMark {
            surface: &surface,
            branch: &branch,
            arrow: pick.foot.map(|foot| (center, Point3::from(foot))),
        };
        Some(colored_cloud(
            &self.points.select(kept.iter().copied()),
            &[mark],
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_read_back() {
        assert_eq!("best".parse(), Ok(CloudChoice::Best));
        assert_eq!("3, 7".parse(), Ok(CloudChoice::Ids(vec![3, 7])));
        assert!("3,".parse::<CloudChoice>().is_err());
        assert!("-1".parse::<CloudChoice>().is_err());
    }
}
