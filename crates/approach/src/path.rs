use crate::{MotionConfig, Quintic, Stage, State};
use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector1, Vector3};

/// Peak speed of a quintic from rest to rest, in lengths per duration.
const PEAK_SPEED: f64 = 1.875;
/// Its peak acceleration, in lengths per squared duration: 10/√3.
const PEAK_ACCELERATION: f64 = 5.773_502_691_896_258;
/// Shortest duration of a segment, seconds, also where the tool does not move.
const SHORTEST_S: f64 = 0.05;

/// A segment of a path: one polynomial of degree five for the tool's position.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PathSegment {
    /// The stage to which it belongs.
    pub stage: Stage,
    /// When it begins, seconds since the start of the path.
    pub start_s: f64,
    /// The position of the tool's origin in the base's frame, metres; its time is counted from
    /// `start_s`.
    pub curve: Quintic<3>,
}

/// Where the tool is at one time, in the base's frame; metres, radians, seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PathPoint {
    /// Time since the start of the path.
    pub time_s: f64,
    /// Place of the tool's origin.
    pub position: Point3<f64>,
    /// Its velocity.
    pub velocity: Vector3<f64>,
    /// Its acceleration.
    pub acceleration: Vector3<f64>,
    /// Orientation of the tool's axes.
    pub rotation: UnitQuaternion<f64>,
    /// How fast and about which axis they turn, in the base's frame.
    pub angular_velocity: Vector3<f64>,
}

impl PathPoint {
    /// The pose of the tool frame.
    pub fn pose(&self) -> Isometry3<f64> {
        Isometry3::from_parts(self.position.coords.into(), self.rotation)
    }
}

/// The motion of a tool from its start to the pre-grasp, to the apple and back.
///
/// Position, velocity and acceleration are continuous. The orientation rotates about one axis during the
/// transit, as a quintic in time from rest to rest, and is fixed from the pre-grasp on.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    pieces: Vec<PathSegment>,
    start_rotation: UnitQuaternion<f64>,
    /// Axis times angle of the turn from there to the grasp, in the start's axes.
    turn: Vector3<f64>,
    /// The share of the turn, 0 to 1 over the transit.
    share: Quintic<1>,
    pre_grasp_s: f64,
    grasp_s: f64,
}

/// The waypoints of a path.
pub(crate) struct Waypoints {
    pub(crate) start: Isometry3<f64>,
    /// Between start and pre-grasp.
    pub(crate) via: Vec<Point3<f64>>,
    pub(crate) pre_grasp: Point3<f64>,
    pub(crate) grasp: Point3<f64>,
    pub(crate) retreat: Point3<f64>,
    pub(crate) rotation: UnitQuaternion<f64>,
}

fn rest_to_rest_s(length: f64, speed: f64, acceleration: f64) -> f64 {
    let by_speed = PEAK_SPEED * length / speed;
    let by_acceleration = (PEAK_ACCELERATION * length / acceleration).sqrt();
    by_speed.max(by_acceleration).max(SHORTEST_S)
}

impl Path {
    /// The path through these places within the limits of `motion`; `None` where a number is not
    /// finite.
    pub(crate) fn through(waypoints: &Waypoints, motion: &MotionConfig) -> Option<Self> {
        let turn = (waypoints.start.rotation.inverse() * waypoints.rotation).scaled_axis();
        let mut places = vec![Point3::from(waypoints.start.translation.vector)];
        places.extend_from_slice(&waypoints.via);
        places.push(waypoints.pre_grasp);
        let straight = waypoints.grasp - waypoints.pre_grasp;
        let (legs, entry) = transit(&places, straight, turn.norm(), motion)?;

        let mut pieces = Vec::with_capacity(legs.len() + 2);
        let mut time = 0.0;
        let mut push = |stage, curve: Quintic<3>| {
            pieces.push(PathSegment {
                stage,
                start_s: time,
                curve,
            });
            time += curve.duration_s;
            time
        };
        let mut pre_grasp_s = 0.0;
        for leg in legs {
            pre_grasp_s = push(Stage::Transit, leg);
        }
        let arrival = State::at_rest(waypoints.grasp.coords);
        // From an entry speed v to rest over L in 2 L / v: the speed falls all the way and never
        // turns back, v (1 − 3τ² + 2τ³).
        let length = straight.norm();
        let speed = entry.velocity.norm();
        let duration = if speed > 0.0 {
            2.0 * length / speed
        } else {
            rest_to_rest_s(
                length,
                motion.approach_speed_m_per_s,
                motion.acceleration_max_m_per_s2,
            )
        };
        let grasp_s = push(
            Stage::Approach,
            Quintic::between(&entry, &arrival, duration)?,
        );
        let back = (waypoints.retreat - waypoints.grasp).norm();
        let duration = rest_to_rest_s(
            back,
            PEAK_SPEED * motion.retreat_speed_m_per_s,
            motion.acceleration_max_m_per_s2,
        );
        let end = State::at_rest(waypoints.retreat.coords);
        push(Stage::Retreat, Quintic::between(&arrival, &end, duration)?);
        let (none, all) = (Vector1::new(0.0), Vector1::new(1.0));
        Some(Self {
            pieces,
            start_rotation: waypoints.start.rotation,
            turn,
            share: Quintic::between(&State::at_rest(none), &State::at_rest(all), pre_grasp_s)?,
            pre_grasp_s,
            grasp_s,
        })
    }

    /// Its parts in their order.
    pub fn pieces(&self) -> &[PathSegment] {
        &self.pieces
    }

    /// When the tool passes the pre-grasp, seconds since the start.
    pub fn pre_grasp_s(&self) -> f64 {
        self.pre_grasp_s
    }

    /// When it rests at the apple.
    pub fn grasp_s(&self) -> f64 {
        self.grasp_s
    }

    /// When it rests at the end of the retreat.
    pub fn duration_s(&self) -> f64 {
        self.pieces
            .last()
            .map_or(0.0, |piece| piece.start_s + piece.curve.duration_s)
    }

    /// Orientation of the tool at the start.
    pub fn start_rotation(&self) -> UnitQuaternion<f64> {
        self.start_rotation
    }

    /// The share of the turn from the start's orientation to the grasp's, 0 to 1 over the transit.
    pub fn turn_share(&self) -> &Quintic<1> {
        &self.share
    }

    /// Where the tool is at a time; before the start and after the end it rests there.
    pub fn sample(&self, time_s: f64) -> PathPoint {
        let time_s = time_s.clamp(0.0, self.duration_s());
        let later = self.pieces.partition_point(|piece| piece.start_s <= time_s);
        let piece = &self.pieces[later.saturating_sub(1)];
        let state = piece.curve.at(time_s - piece.start_s);
        let (share, rate) = if time_s < self.pre_grasp_s {
            let share = self.share.at(time_s);
            (share.position.x, share.velocity.x)
        } else {
            (1.0, 0.0)
        };
        PathPoint {
            time_s,
            position: state.position.into(),
            velocity: state.velocity,
            acceleration: state.acceleration,
            rotation: self.start_rotation * UnitQuaternion::from_scaled_axis(self.turn * share),
            angular_velocity: self.start_rotation * (self.turn * rate),
        }
    }

    /// Only the position at a time, as [`Path::sample`] gives it.
    pub(crate) fn place(&self, time_s: f64) -> Point3<f64> {
        let time_s = time_s.clamp(0.0, self.duration_s());
        let later = self.pieces.partition_point(|piece| piece.start_s <= time_s);
        let piece = &self.pieces[later.saturating_sub(1)];
        piece.curve.position(time_s - piece.start_s).into()
    }

    /// Only the pose at a time, as [`Path::sample`] gives it.
    pub(crate) fn pose(&self, time_s: f64) -> Isometry3<f64> {
        let share = if time_s < self.pre_grasp_s {
            self.share.position(time_s.max(0.0)).x
        } else {
            1.0
        };
        Isometry3::from_parts(
            self.place(time_s).into(),
            self.start_rotation * UnitQuaternion::from_scaled_axis(self.turn * share),
        )
    }

    /// `count` samples at equal steps from the start to the end; at least two.
    pub fn samples(&self, count: usize) -> Vec<PathPoint> {
        let count = count.max(2);
        let step = self.duration_s() / (count - 1) as f64;
        (0..count).map(|i| self.sample(i as f64 * step)).collect()
    }

    /// A bound on the speed of every point within `radius` of the tool's origin over an interval of
    /// one piece.
    pub(crate) fn point_speed_bound(
        &self,
        piece: &PathSegment,
        from_s: f64,
        to_s: f64,
        radius: f64,
    ) -> f64 {
        let place = piece
            .curve
            .speed_bound(from_s - piece.start_s, to_s - piece.start_s);
        if piece.stage == Stage::Transit {
            place + self.turn.norm() * radius * self.share.speed_bound(from_s, to_s)
        } else {
            place
        }
    }

    /// When the tool has `left_m` of the final straight before it.
    pub(crate) fn time_on_straight(&self, left_m: f64) -> f64 {
        let grasp = self.place(self.grasp_s);
        let (mut early, mut late) = (self.pre_grasp_s, self.grasp_s);
        for _ in 0..40 {
            let middle = 0.5 * (early + late);
            if (self.place(middle) - grasp).norm() > left_m {
                early = middle;
            } else {
                late = middle;
            }
        }
        late
    }
}

/// The curves through `places` that end along `straight`, and the state at their end.
fn transit(
    places: &[Point3<f64>],
    straight: Vector3<f64>,
    turn: f64,
    motion: &MotionConfig,
) -> Option<(Vec<Quintic<3>>, State<3>)> {
    let (speed, acceleration) = (motion.speed_max_m_per_s, motion.acceleration_max_m_per_s2);
    let lengths: Vec<f64> = places.windows(2).map(|w| (w[1] - w[0]).norm()).collect();
    let mut durations: Vec<f64> = lengths
        .iter()
        .map(|&length| rest_to_rest_s(length, speed, acceleration))
        .collect();
    let turning = PEAK_SPEED * turn / motion.turn_max_rad_per_s;
    let all: f64 = durations.iter().sum();
    if turning > all {
        for duration in &mut durations {
            *duration *= turning / all;
        }
    }
    let mut answer = None;
    for _ in 0..12 {
        let last = durations.len() - 1;
        // Faster than this for its length, the last leg would swing far out to come in straight.
        let entry_speed = motion
            .approach_speed_m_per_s
            .min(1.2 * lengths[last] / durations[last]);
        // Over 2 L / v the deceleration peaks at 3/4 v² / L.
        let entry_speed = entry_speed.min((acceleration * straight.norm() / 0.75).sqrt());
        let entry_speed = if entry_speed < 1e-3 { 0.0 } else { entry_speed };
        let states = states(places, &durations, straight.normalize() * entry_speed);
        let legs: Option<Vec<_>> = states
            .windows(2)
            .zip(&durations)
            .map(|(w, &duration)| Quintic::between(&w[0], &w[1], duration))
            .collect();
        let legs = legs?;
        let fastest = legs.iter().map(|l| l.largest_speed(16)).fold(0.0, f64::max);
        let hardest = legs.iter().map(hardest).fold(0.0, f64::max);
        let over = (fastest / speed).max((hardest / acceleration).sqrt());
        answer = Some((legs, states[states.len() - 1]));
        if over <= 1.0 {
            break;
        }
        for duration in &mut durations {
            *duration *= over * 1.01;
        }
    }
    answer
}

/// The largest acceleration of 33 samples.
fn hardest(leg: &Quintic<3>) -> f64 {
    (0..=32)
        .map(|i| {
            leg.at(leg.duration_s * f64::from(i) / 32.0)
                .acceleration
                .norm()
        })
        .fold(0.0, f64::max)
}

/// From rest, through each place with the velocity and acceleration of the parabola through it and
/// its neighbours, to the last with the entry velocity.
fn states(places: &[Point3<f64>], durations: &[f64], entry: Vector3<f64>) -> Vec<State<3>> {
    let last = places.len() - 1;
    (0..=last)
        .map(|i| {
            let position = places[i].coords;
            if i == 0 {
                return State::at_rest(position);
            }
            if i == last {
                return State {
                    velocity: entry,
                    ..State::at_rest(position)
                };
            }
            let (before, after) = (durations[i - 1], durations[i]);
            let slope_before = (places[i] - places[i - 1]) / before;
            let slope_after = (places[i + 1] - places[i]) / after;
            State {
                position,
                velocity: (slope_before * after + slope_after * before) / (before + after),
                acceleration: (slope_after - slope_before) * (2.0 / (before + after)),
            }
        })
        .collect()
}
