//! What the columns of a table of samples hold, by their names: of this project, or as other programs call them.

use crate::rotation_form::{EulerAngles, RotationForm};
use crate::sample_options::SampleOptions;
use crate::units::{AngleUnit, LengthUnit};
use pomona_files::Malformed;

/// Names of what the robot tells, before the name of a number; a number without any is the robot's too.
const ROBOT: [&str; 9] = [
    "robot_from_flange_",
    "base_from_flange_",
    "base_from_gripper_",
    "flange_",
    "gripper_",
    "robot_",
    "tool_",
    "tcp_",
    "ee_",
];
/// Names of what the camera sees.
const CAMERA: [&str; 9] = [
    "camera_from_target_",
    "camera_from_board_",
    "camera_from_marker_",
    "target_",
    "board_",
    "marker_",
    "object_",
    "camera_",
    "t",
];

const REMEDY: &str = "give id, and for robot_from_flange and camera_from_target each x, y, z and the numbers of a rotation: qx qy qz qw, a b c (KUKA), roll pitch yaw, w p r (FANUC), or rx ry rz with --rotations";

/// One column.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Column {
    side: usize,
    part: Part,
    length: Option<LengthUnit>,
    angle: Option<AngleUnit>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Part {
    Position(usize),
    Rotation(Names, usize),
}

/// By which names the numbers of a rotation go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Names {
    Quaternion,
    Abc,
    RollPitchYaw,
    Wpr,
    Rxyz,
}

impl Names {
    const ALL: [(Self, &'static [&'static str]); 5] = [
        (Self::Quaternion, &["qx", "qy", "qz", "qw"]),
        (Self::Abc, &["a", "b", "c"]),
        (Self::RollPitchYaw, &["roll", "pitch", "yaw"]),
        (Self::Wpr, &["w", "p", "r"]),
        (Self::Rxyz, &["rx", "ry", "rz"]),
    ];

    fn count(self) -> usize {
        if self == Self::Quaternion { 4 } else { 3 }
    }

    /// The form that the names tell; `rx ry rz` are of several.
    fn form(self) -> Option<RotationForm> {
        match self {
            Self::Quaternion => Some(RotationForm::QuaternionXyzw),
            Self::Abc => Some(RotationForm::Euler(EulerAngles::KUKA)),
            Self::RollPitchYaw | Self::Wpr => {
                Some(RotationForm::Euler(EulerAngles::ROLL_PITCH_YAW))
            }
            Self::Rxyz => None,
        }
    }
}

/// Where the numbers of one side stand.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SideColumns {
    pub(super) position: [usize; 3],
    pub(super) length: Option<LengthUnit>,
    /// `None` for points.
    pub(super) rotation: Option<RotationColumns>,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct RotationColumns {
    pub(super) at: Vec<usize>,
    pub(super) form: RotationForm,
    pub(super) unit: Option<AngleUnit>,
}

/// Where the numbers of a sample stand: of the robot, and of the camera.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Columns {
    pub(super) id: Option<usize>,
    pub(super) sides: [SideColumns; 2],
}

fn column(name: &str) -> Option<Column> {
    let name = name.to_ascii_lowercase();
    let of_side = |prefixes: &[&str], side: usize| {
        let rests = prefixes.iter().filter_map(|p| name.strip_prefix(p));
        rests.into_iter().find_map(|rest| part(rest, side))
    };
    // The longest prefixes stand first; `t` and none are tried last.
    of_side(&ROBOT, 0)
        .or_else(|| of_side(&CAMERA, 1))
        .or_else(|| part(&name, 0))
}

fn part(name: &str, side: usize) -> Option<Column> {
    let units = [
        ("_mm", Some(LengthUnit::Millimetres), None),
        ("_m", Some(LengthUnit::Metres), None),
        ("_deg", None, Some(AngleUnit::Degrees)),
        ("_rad", None, Some(AngleUnit::Radians)),
    ];
    let with_unit = units
        .iter()
        .find_map(|&(suffix, length, angle)| Some((name.strip_suffix(suffix)?, length, angle)));
    let (bare, length, angle) = with_unit.unwrap_or((name, None, None));
    let position = ["x", "y", "z"].iter().position(|n| *n == bare);
    let part = match position {
        Some(axis) if angle.is_none() => Part::Position(axis),
        Some(_) => return None,
        None if length.is_some() => return None,
        None => Names::ALL.iter().find_map(|(names, list)| {
            let at = list.iter().position(|n| *n == bare)?;
            Some(Part::Rotation(*names, at))
        })?,
    };
    Some(Column {
        side,
        part,
        length,
        angle,
    })
}

impl Columns {
    /// Where the columns of a header stand; `None` where one of them is of no known name.
    pub(super) fn of<'a>(
        header: impl Iterator<Item = &'a str>,
        options: &SampleOptions,
    ) -> Result<Option<Self>, Malformed> {
        let mut id = None;
        let mut columns = Vec::new();
        for (at, name) in header.enumerate() {
            if ["id", "name", "sample"].contains(&&*name.to_ascii_lowercase()) && id.is_none() {
                id = Some(at);
            } else if let Some(column) = column(name) {
                columns.push((at, column));
            } else {
                return Ok(None);
            }
        }
        let sides = [side(&columns, 0, options)?, side(&columns, 1, options)?];
        if sides[0].rotation.is_some() != sides[1].rotation.is_some() {
            let problem = "one side has rotations and the other has none";
            return Err(Malformed::new("line 1", problem, REMEDY));
        }
        Ok(Some(Self { id, sides }))
    }
}

/// The columns of one side.
fn side(
    columns: &[(usize, Column)],
    side: usize,
    options: &SampleOptions,
) -> Result<SideColumns, Malformed> {
    let who = ["the robot", "the camera"][side];
    let fault = |problem: String| Malformed::new("line 1", problem, REMEDY);
    let own: Vec<_> = columns.iter().filter(|(_, c)| c.side == side).collect();
    let find = |part: Part| -> Result<usize, Malformed> {
        let mut found = own.iter().filter(|(_, c)| c.part == part);
        match (found.next(), found.next()) {
            (Some((at, _)), None) => Ok(*at),
            (None, _) => Err(fault(format!("a column of {who} is missing"))),
            (Some(_), Some(_)) => Err(fault(format!("two columns of {who} hold the same"))),
        }
    };
    let position = [
        find(Part::Position(0))?,
        find(Part::Position(1))?,
        find(Part::Position(2))?,
    ];
    let length = own.iter().find_map(|(_, c)| c.length);
    let unit = own.iter().find_map(|(_, c)| c.angle);
    if let (Some(named), Some(said)) = (length, options.lengths)
        && named != said
    {
        let problem = format!(
            "columns say {}, and the lengths are said to be {}",
            named.name(),
            said.name()
        );
        return Err(fault(problem));
    }
    if let (Some(named), Some(said)) = (unit, options.angles)
        && named != said
    {
        let problem = format!(
            "columns say {}, and the angles are said to be {}",
            named.name(),
            said.name()
        );
        return Err(fault(problem));
    }
    let mut kinds = own.iter().filter_map(|(_, c)| match c.part {
        Part::Rotation(names, _) => Some(names),
        Part::Position(_) => None,
    });
    let rotation = match kinds.next() {
        None => None,
        Some(names) if kinds.all(|other| other == names) => {
            let at: Vec<usize> = (0..names.count())
                .map(|i| find(Part::Rotation(names, i)))
                .collect::<Result<_, _>>()?;
            let form = options.rotations.or_else(|| names.form()).ok_or_else(|| {
                let remedy = "say by --rotations what they are: rotation-vector (Universal Robots, OpenCV), rpy, or the axes of \
                              three angles such as ZYX";
                let problem = "rx, ry, rz may be a rotation vector or three angles";
                Malformed::new("line 1", problem, remedy)
            })?;
            if form.count() != at.len() {
                let problem = format!(
                    "{} columns of a rotation, where --rotations takes {}",
                    at.len(),
                    form.count()
                );
                return Err(fault(problem));
            }
            Some(RotationColumns {
                at,
                form,
                unit: unit.or(options.angles),
            })
        }
        Some(_) => return Err(fault(format!("rotations of {who} in two forms"))),
    };
    Ok(SideColumns {
        position,
        length: length.or(options.lengths),
        rotation,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns(header: &str) -> Result<Option<Columns>, Malformed> {
        Columns::of(header.split(','), &SampleOptions::default())
    }

    #[test]
    fn names_of_other_programs_are_known() {
        for header in [
            "id,x,y,z,a,b,c,tx,ty,tz,ta,tb,tc",
            "id,flange_x_mm,flange_y_mm,flange_z_mm,flange_roll_deg,flange_pitch_deg,flange_yaw_deg,board_x_m,board_y_m,board_z_m,\
             board_qx,board_qy,board_qz,board_qw",
            "name,X,Y,Z,W,P,R,target_x,target_y,target_z,target_qx,target_qy,target_qz,target_qw",
        ] {
            let found = columns(header)
                .unwrap()
                .unwrap_or_else(|| panic!("{header}"));
            assert!(found.sides.iter().all(|side| side.rotation.is_some()));
        }
        let points = columns("id,robot_x,robot_y,robot_z,camera_x_mm,camera_y_mm,camera_z_mm")
            .unwrap()
            .unwrap();
        assert_eq!(points.sides[0].rotation, None);
        assert_eq!(points.sides[1].length, Some(LengthUnit::Millimetres));
        assert_eq!(columns("id,x,y,z,color").unwrap(), None);
    }

    #[test]
    fn what_is_ambiguous_or_incomplete_is_refused() {
        for (header, words) in [
            (
                "id,x,y,z,rx,ry,rz,tx,ty,tz,tqx,tqy,tqz,tqw",
                "rotation vector",
            ),
            ("id,x,y,z,a,b,c,tx,ty,tz", "no"),
            ("id,x,y,z,a,b,tx,ty,tz,ta,tb,tc", "missing"),
            ("id,x,x,y,z,a,b,c,tx,ty,tz,ta,tb,tc", "two columns"),
            ("id,x,y,z,a,b,c,roll,tx,ty,tz,ta,tb,tc", "two forms"),
        ] {
            let fault = columns(header).unwrap_err();
            assert!(fault.problem.contains(words), "{header}: {fault:?}");
        }
    }
}
