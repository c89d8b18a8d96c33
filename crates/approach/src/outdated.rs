//! Settings that were once said another way.

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

const TRANSLATION: &str = "wrist_from_tool_translation_m";
const QUATERNION: &str = "wrist_from_tool_quaternion_xyzw";

/// What to write in place of `wrist_from_tool_*` of `[gripper]`; `None` where neither stands there.
///
/// That was the pose of the gripper's frame in the flange's; its inverse is where the flange is in a tool's
/// frame that approaches along +x.
pub(crate) fn in_place_of(settings: &toml::Table) -> Option<String> {
    let gripper = settings.get("gripper")?.as_table()?;
    let (place, turn) = (gripper.get(TRANSLATION), gripper.get(QUATERNION));
    if place.is_none() && turn.is_none() {
        return None;
    }
    let numbers = |value: Option<&toml::Value>, default: &[f64]| -> Option<Vec<f64>> {
        let Some(value) = value else {
            return Some(default.to_vec());
        };
        let number = |v: &toml::Value| v.as_float().or_else(|| v.as_integer().map(|i| i as f64));
        let numbers: Option<Vec<f64>> = value.as_array()?.iter().map(number).collect();
        numbers.filter(|n| n.len() == default.len() && n.iter().all(|x| x.is_finite()))
    };
    let form = || {
        let (place, turn) = (
            numbers(place, &[0.0; 3])?,
            numbers(turn, &[0.0, 0.0, 0.0, 1.0])?,
        );
        let rotation =
            UnitQuaternion::try_new(Quaternion::new(turn[3], turn[0], turn[1], turn[2]), 1e-9)?;
        let place = Translation3::new(place[0], place[1], place[2]);
        let inverse = Isometry3::from_parts(place, rotation).inverse();
        let list = |numbers: &[f64]| {
            // No sign on what rounds to 0.
            let texts = numbers
                .iter()
                .map(|x| format!("{:?}", (x * 1e9).round() / 1e9 + 0.0));
            texts.collect::<Vec<_>>().join(", ")
        };
        Some(format!(
            "tcp_from_flange_translation_m = [{}] and tcp_from_flange_quaternion_xyzw = [{}]",
            list(inverse.translation.vector.as_slice()),
            list(inverse.rotation.coords.as_slice()),
        ))
    };
    let otherwise = || {
        "tcp_from_flange_translation_m and tcp_from_flange_quaternion_xyzw, the pose of the flange in \
         the tool's frame"
            .to_owned()
    };
    Some(form().unwrap_or_else(otherwise))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ApproachConfig, ConfigError};
    use nalgebra::Vector3;

    #[test]
    fn the_old_mount_is_refused_with_the_new_one() {
        let folder = std::env::temp_dir().join(format!("pomona-outdated-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("robot.toml");
        let old = "[gripper]\nwrist_from_tool_translation_m = [0, 0.0, 0.2]\n\
                   wrist_from_tool_quaternion_xyzw = [0.0, -0.7071067811865476, 0.0, 0.7071067811865476]\n";
        std::fs::write(&path, old).unwrap();
        let refused = ApproachConfig::read(&path);
        let Err(ConfigError::Outdated { instead, .. }) = &refused else {
            panic!("{refused:?}");
        };
        let message = refused.as_ref().unwrap_err().to_string();
        assert!(message.contains("robot.toml") && message.contains(instead));

        // What is said instead puts the flange where the old settings put it.
        let new = format!("[gripper]\n{}\n", instead.replace(" and ", "\n"));
        std::fs::write(&path, new).unwrap();
        let config = ApproachConfig::read(&path).unwrap();
        let wrist = config.gripper.wrist_pose(&Isometry3::identity());
        assert!((wrist * Vector3::z() - Vector3::x()).norm() < 1e-6);
        assert!((wrist.translation.vector - Vector3::new(-0.2, 0.0, 0.0)).norm() < 1e-6);
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn what_is_no_pose_is_refused_too_and_the_rest_is_left_alone() {
        let table = |text: &str| text.parse::<toml::Table>().unwrap();
        for text in [
            "[gripper]\nwrist_from_tool_translation_m = 3",
            "[gripper]\nwrist_from_tool_translation_m = [nan, 0, 0]",
            "[gripper]\nwrist_from_tool_quaternion_xyzw = [0, 0, 0, 0]",
            "[gripper]\nwrist_from_tool_quaternion_xyzw = ['a']",
        ] {
            assert!(
                in_place_of(&table(text))
                    .unwrap()
                    .contains("tcp_from_flange")
            );
        }
        assert_eq!(in_place_of(&table("gripper = 3")), None);
        assert_eq!(in_place_of(&table("[gripper]\njaw_width_m = 0.1")), None);
    }
}
