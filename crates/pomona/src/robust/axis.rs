use super::spheroid::biweight;
use nalgebra::{Matrix3, Point3, Unit, Vector3};
use pomona_geometry::Line;

/// A curved axis: a line, and parabolas across it lateral in the image and in depth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BranchAxis {
    /// Point of the line from which lengths along it are measured.
    pub(crate) base: Point3<f64>,
    /// Unit direction of the line.
    along: Vector3<f64>,
    /// Unit vector across the line and the ray to its base.
    pub(crate) side: Vector3<f64>,
    /// Unit vector across the line, away from the camera.
    deep: Vector3<f64>,
    /// Coefficients of 1, s, s² of the way lateral.
    pub(crate) lateral: Vector3<f64>,
    /// Coefficients of 1, s, s² of the offset away from the camera.
    pub(crate) depth_offset: Vector3<f64>,
    /// Radius of the branch.
    pub(crate) radius: f64,
}

/// 1, s, s².
pub(crate) fn powers(s: f64) -> Vector3<f64> {
    Vector3::new(1.0, s, s * s)
}

impl BranchAxis {
    /// A straight axis about the foot of `center` on `line`; `None` where the line points at the camera.
    pub(crate) fn straight(line: &Line, center: &Point3<f64>, radius: f64) -> Option<Self> {
        let base = line.foot(center);
        let along = line.direction.into_inner();
        let side = along.cross(&base.coords).try_normalize(1e-4)?;
        let deep = side.cross(&along);
        let deep = if deep.dot(&base.coords) < 0.0 {
            -deep
        } else {
            deep
        };
        Some(Self {
            base,
            along,
            side,
            deep,
            lateral: Vector3::zeros(),
            depth_offset: Vector3::zeros(),
            radius,
        })
    }

    /// Place along the line, of its point nearest to `point`.
    pub(crate) fn along(&self, point: &Point3<f64>) -> f64 {
        (point - self.base).dot(&self.along)
    }

    pub(crate) fn at(&self, s: f64) -> Point3<f64> {
        let p = powers(s);
        self.base
            + self.along * s
            + self.side * self.lateral.dot(&p)
            + self.deep * self.depth_offset.dot(&p)
    }

    pub(crate) fn tangent(&self, s: f64) -> Unit<Vector3<f64>> {
        let slope = Vector3::new(0.0, 1.0, 2.0 * s);
        Unit::new_normalize(
            self.along
                + self.side * self.lateral.dot(&slope)
                + self.deep * self.depth_offset.dot(&slope),
        )
    }

    /// Where the axis is nearest to `point`, within `reach` of its base.
    pub(crate) fn nearest(&self, point: &Point3<f64>, reach: f64) -> f64 {
        let mut s = 0.0f64;
        for _ in 0..8 {
            s = (s + (point - self.at(s)).dot(&self.tangent(s))).clamp(-reach, reach);
        }
        s
    }
}

/// A value observed at a place along the axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Observation {
    pub(crate) s: f64,
    pub(crate) value: f64,
    pub(crate) weight: f64,
}

/// A parabola through samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parabola {
    /// Coefficients of 1, s, s².
    pub(crate) coefficients: Vector3<f64>,
    /// Covariance of the coefficients.
    covariance: Matrix3<f64>,
    /// Weighted root mean square of the residuals.
    pub(crate) rms: f64,
}

impl Parabola {
    /// Standard deviation of the parabola at `s`.
    pub(crate) fn sd_at(&self, s: f64) -> f64 {
        let p = powers(s);
        p.dot(&(self.covariance * p)).max(0.0).sqrt()
    }

    /// Fits samples of standard deviation `scale` by reweighted least squares, from their median on.
    ///
    /// `bend_sd` is the prior standard deviation of the coefficient of s², per metre; the priors of slope and offset are
    /// weak (0.7; 20 mm). `cuts` tells where the robust weight ends for each step, in scales. `None` for fewer than four
    /// samples or where no sample is left.
    pub(crate) fn fit(
        samples: &[Observation],
        bend_sd: f64,
        scale: f64,
        cuts: &[f64],
    ) -> Option<Self> {
        const OFFSET_SD_M: f64 = 0.02;
        const SLOPE_SD: f64 = 0.7;
        if samples.len() < 4 {
            return None;
        }
        let mut values: Vec<f64> = samples.iter().map(|d| d.value).collect();
        let middle = values.len() / 2;
        let (_, median, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
        let mut c = Vector3::new(*median, 0.0, 0.0);
        let mut last = None;
        for &cut in cuts {
            let mut normal = Matrix3::zeros();
            let mut right = Vector3::zeros();
            let (mut squares, mut weights) = (0.0, 0.0);
            for sample in samples {
                let row = powers(sample.s);
                let e = sample.value - row.dot(&c);
                let w = sample.weight * biweight(e / scale, cut);
                let weighted = row * w;
                normal += weighted * row.transpose();
                right += weighted * sample.value;
                squares += w * e * e;
                weights += w;
            }
            if weights <= 0.0 {
                return None;
            }
            let priors = [OFFSET_SD_M, SLOPE_SD, bend_sd];
            for (k, sd) in priors.into_iter().enumerate() {
                normal[(k, k)] += (scale / sd).powi(2);
            }
            let solved = normal.cholesky()?;
            c = solved.solve(&right);
            let rms = (squares / weights).sqrt();
            last = Some(Self {
                coefficients: c,
                covariance: solved.inverse() * (rms * rms),
                rms,
            });
        }
        last
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_among_outliers_is_found() {
        let samples: Vec<Observation> = (-40..=40)
            .map(|k| {
                let s = f64::from(k) * 0.002;
                let wild = if k % 7 == 0 { 0.015 } else { 0.0 };
                let value = 0.001 + 0.1 * s + 0.15 * s * s + wild;
                Observation {
                    s,
                    value,
                    weight: 1.0,
                }
            })
            .collect();
        let fit = Parabola::fit(&samples, 0.2, 0.0005, &[20.0, 8.0, 3.0, 3.0]).unwrap();
        assert!((fit.coefficients - Vector3::new(0.001, 0.1, 0.15)).amax() < 0.02);
        assert!((fit.coefficients[0] - 0.001).abs() < 2e-5 && fit.sd_at(0.0) < 1e-4);
        assert!(Parabola::fit(&samples[..3], 0.2, 0.0005, &[3.0]).is_none());
    }

    #[test]
    fn the_nearest_place_has_its_tangent_across() {
        let line = Line::new(Point3::new(0.05, 0.0, 0.9), Vector3::new(0.2, 1.0, 0.4)).unwrap();
        let center = Point3::new(0.0, 0.01, 0.9);
        let mut axis = BranchAxis::straight(&line, &center, 0.005).unwrap();
        axis.lateral[2] = 0.3;
        axis.depth_offset[1] = 0.1;
        let s = axis.nearest(&center, 0.1);
        assert!(
            (center - axis.at(s))
                .normalize()
                .dot(&axis.tangent(s))
                .abs()
                < 1e-6
        );
    }
}
