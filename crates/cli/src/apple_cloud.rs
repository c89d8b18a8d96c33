use anyhow::bail;
use nalgebra::distance;
use pomona::{AppleAnswer, CheckedFrame, FrameAnswer};
use pomona_cloud::PointCloud;
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
    pub(crate) fn of(&self, answer: &FrameAnswer) -> anyhow::Result<Vec<usize>> {
        let surface = |a: &AppleAnswer| {
            let inliers = a.apple.map_or(0, |apple| apple.inliers);
            (inliers, std::cmp::Reverse(a.id))
        };
        let apples = answer.apples.iter().filter(|a| a.apple.is_some());
        Ok(match self {
            Self::None => Vec::new(),
            Self::All => apples.map(|a| a.id).collect(),
            Self::Best => {
                let picked = apples.filter(|a| a.is_picked());
                let best = picked.max_by_key(|a| surface(a));
                best.map(|a| a.id).into_iter().collect()
            }
            Self::Ids(ids) => {
                let count = answer.apples.len();
                if let Some(id) = ids.iter().find(|&&id| id >= count) {
                    let frame = &answer.id;
                    bail!("--clouds {id}: frame '{frame}' has {count} apples, numbered from 0");
                }
                ids.clone()
            }
        })
    }
}

/// The points of a frame, from which the clouds of its apples are cut.
pub(crate) struct AppleClouds<'a> {
    points: PointCloud,
    /// Pixel of each point, ascending.
    pixels: &'a [u32],
}

impl<'a> AppleClouds<'a> {
    pub(crate) fn new(frame: &'a CheckedFrame<'_>) -> Self {
        let points = frame.points();
        Self {
            points: PointCloud::from_points(points, &frame.frame().color),
            pixels: &points.pixel,
        }
    }

    /// The surroundings of one apple: surface pink, branch green, direction red, the rest grey;
    /// `None` for an apple without a sphere.
    pub(crate) fn cut(&self, answer: &AppleAnswer) -> Option<PointCloud> {
        let apple = answer.apple?;
        let center = apple.center.point();
        let reach = REACH_RADII * apple.radius_m;
        let kept: Vec<usize> = (0..self.points.len())
            .filter(|&i| distance(&self.points.point(i), &center) <= reach)
            .collect();
        // Both ascend, so that the kept points can be searched by their pixel.
        let index_of = |pixel: &u32| {
            let at = kept.binary_search_by_key(pixel, |&i| self.pixels[i]).ok()?;
            u32::try_from(at).ok()
        };
        let surface: Vec<u32> = answer
            .evidence
            .surface
            .iter()
            .filter_map(index_of)
            .collect();
        let branch: Vec<u32> = answer.evidence.branch.iter().filter_map(index_of).collect();
        let mut mark = CloudMark::new(&surface, &branch);
        mark.arrow = answer.pick.map(|pick| (center, pick.foot.point()));
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
