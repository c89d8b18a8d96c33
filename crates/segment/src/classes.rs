use crate::error::{MOST_CLASSES, SegmentError};
use serde::{Deserialize, Serialize};

/// What a class is to a picking robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Role {
    /// Trunk, limb, branch, twig, spur.
    Wood,
    /// The stalk that joins a fruit to its spur.
    Peduncle,
    /// Fruit.
    Fruit,
    /// Whatever is man-made and long: stakes, posts, wires, pipes.
    Post,
    /// Leaves and everything else.
    Rest,
}

impl Role {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Wood,
        Self::Peduncle,
        Self::Fruit,
        Self::Post,
        Self::Rest,
    ];

    /// Its name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Wood => "wood",
            Self::Peduncle => "peduncle",
            Self::Fruit => "fruit",
            Self::Post => "post",
            Self::Rest => "rest",
        }
    }

    /// What a class of this name is, as data sets of orchards call them; the rest where the name tells nothing.
    pub fn of_name(name: &str) -> Self {
        let name = name.trim().to_lowercase();
        let stem = name.strip_suffix('s').unwrap_or(&name);
        match stem {
            "wood" | "branch" | "branche" | "trunk" | "limb" | "twig" | "spur" | "shoot"
            | "stem" | "leader" | "bark" => Self::Wood,
            "peduncle" | "stalk" | "pedicel" => Self::Peduncle,
            "fruit" | "apple" | "pear" | "peach" | "peache" | "cherry" | "citru" | "orange" => {
                Self::Fruit
            }
            "post" | "pole" | "wire" | "pipe" | "stake" | "support" | "trellis" => Self::Post,
            _ => Self::Rest,
        }
    }
}

/// The classes of a segmenter: their names, in the order of their numbers, and the role of each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Classes {
    names: Vec<String>,
    roles: Vec<Role>,
}

impl Classes {
    /// Classes whose roles their names tell, as [`Role::of_name`] reads them.
    ///
    /// # Errors
    ///
    /// [`SegmentError::Classes`] for none, too many, or two of one name.
    pub fn by_names<N: Into<String>>(
        names: impl IntoIterator<Item = N>,
    ) -> Result<Self, SegmentError> {
        let named = names.into_iter().map(|name| {
            let name = name.into();
            let role = Role::of_name(&name);
            (name, role)
        });
        Self::new(named)
    }

    /// Classes with a role each.
    ///
    /// # Errors
    ///
    /// [`SegmentError::Classes`] for none, too many, or two of one name.
    pub fn new<N: Into<String>>(
        classes: impl IntoIterator<Item = (N, Role)>,
    ) -> Result<Self, SegmentError> {
        let (names, roles): (Vec<String>, Vec<Role>) = classes
            .into_iter()
            .map(|(name, role)| (name.into(), role))
            .unzip();
        let twice = (1..names.len()).find(|&k| names[..k].contains(&names[k]));
        let problem = match (names.len(), twice) {
            (0, _) => "there is none".to_owned(),
            (count, _) if count > MOST_CLASSES => format!("there are {count}"),
            (_, Some(k)) => format!("'{}' is there twice", names[k]),
            _ => return Ok(Self { names, roles }),
        };
        Err(SegmentError::Classes { names, problem })
    }

    /// How many there are.
    #[expect(clippy::len_without_is_empty, reason = "there is at least one")]
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// Their names.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Their roles.
    pub fn roles(&self) -> &[Role] {
        &self.roles
    }

    /// The numbers of those that play this role.
    pub fn of(&self, role: Role) -> impl Iterator<Item = usize> {
        let numbers = self.roles.iter().enumerate();
        numbers
            .filter(move |(_, r)| **r == role)
            .map(|(number, _)| number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_roles() {
        for (name, role) in [
            ("wood", Role::Wood),
            ("Branches", Role::Wood),
            ("trunk", Role::Wood),
            ("Apple", Role::Fruit),
            ("wires", Role::Post),
            ("peduncle", Role::Peduncle),
            ("background", Role::Rest),
            ("s", Role::Rest),
        ] {
            assert_eq!(Role::of_name(name), role, "{name}");
        }
        for role in Role::ALL {
            assert_eq!(Role::of_name(role.name()), role);
        }
    }

    #[test]
    fn classes_share_roles() {
        let classes = Classes::by_names(["leaf", "branch", "trunk"]).unwrap();
        assert_eq!(classes.of(Role::Wood).collect::<Vec<_>>(), [1, 2]);
        assert_eq!(classes.of(Role::Post).count(), 0);
        assert_eq!(classes.len(), 3);
    }

    #[test]
    fn classes_without_sense_are_refused() {
        let message = |names: &[&str]| {
            Classes::by_names(names.iter().copied())
                .unwrap_err()
                .to_string()
        };
        assert!(message(&[]).contains("there is none"));
        assert!(message(&["a", "b", "a"]).contains("'a' is there twice"));
        let many: Vec<String> = (0..256).map(|k| k.to_string()).collect();
        assert!(
            Classes::by_names(many)
                .unwrap_err()
                .to_string()
                .contains("256")
        );
    }
}
