//! Which boxes of a file are of what is looked for.

use super::class_choice::{ClassChoice, is_kind_of};
use super::labelled::{LabelKind, LabelledBox};
use super::pixel_box::PixelBox;
use pomona_files::{Malformed, Warning, WarningCode, WithWarnings};

/// Which boxes of a file are wanted.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct BoxChoice {
    /// Their class. Where none is given, it is what is an apple by its name; the only class that a file declares; or
    /// all boxes where a file has one class without a name, or gives each box a name of its own.
    pub class: Option<ClassChoice>,
    /// The lowest score; 0 takes all.
    pub min_score: f64,
}

impl BoxChoice {
    /// Changes fields in place: the struct is `non_exhaustive`.
    #[must_use]
    pub fn with(mut self, change: impl FnOnce(&mut Self)) -> Self {
        change(&mut self);
        self
    }

    /// The boxes that are wanted of `labels`; `classes` are those that the file declares, `file` is its name.
    pub(super) fn of(
        &self,
        file: &str,
        labels: Vec<LabelledBox>,
        classes: &[String],
    ) -> Result<WithWarnings<Vec<PixelBox>>, Malformed> {
        let mut warnings = Vec::new();
        let (crowd, labels): (Vec<_>, Vec<_>) = labels
            .into_iter()
            .partition(|label| label.kind == LabelKind::Crowd);
        let mut left_out = Counts::default();
        left_out.add("crowd regions", crowd.len());
        let meant = self.meant(file, &labels, classes, &mut warnings)?;
        let mut boxes = Vec::new();
        for label in labels {
            if !meant.contains(&Class::of(&label)) {
                left_out.add(&format!("of {}", Class::of(&label)), 1);
            } else if label.bounds.score < self.min_score {
                left_out.add(&format!("of a score below {}", self.min_score), 1);
            } else {
                boxes.push(label.bounds);
            }
        }
        if !left_out.0.is_empty() {
            let message = format!(
                "{file}: {} boxes are taken; left out are {left_out}",
                boxes.len()
            );
            let message = message.replacen(" 1 boxes are", " 1 box is", 1);
            warnings.push(Warning::new(WarningCode::BoxesLeftOut, message));
        }
        Ok(WithWarnings::new(boxes, warnings))
    }

    /// The classes whose boxes are taken.
    fn meant(
        &self,
        file: &str,
        labels: &[LabelledBox],
        declared: &[String],
        warnings: &mut Vec<Warning>,
    ) -> Result<Vec<Class>, Malformed> {
        let mut present: Vec<Class> = Vec::new();
        for label in labels {
            let class = Class::of(label);
            if !present.contains(&class) {
                present.push(class);
            }
        }
        if present.is_empty() {
            return Ok(present);
        }
        if let Some(choice) = &self.class {
            let meant: Vec<Class> = chosen(choice, &present).into_iter().cloned().collect();
            let is_declared = match choice {
                ClassChoice::Name(name) => {
                    let names: Vec<&str> = declared.iter().map(String::as_str).collect();
                    !ClassChoice::named(name, &names).is_empty()
                }
                ClassChoice::Number(number) => *number < declared.len(),
            };
            if meant.is_empty() && !is_declared {
                let remedy = "give one of these by --class";
                return Err(none_of(
                    &format!("the class {choice}"),
                    labels,
                    &present,
                    remedy,
                ));
            }
            return Ok(meant);
        }
        let is_apple = |name: &str| is_kind_of(ClassChoice::DEFAULT_NAME, name);
        let apples: Vec<Class> = present
            .iter()
            .filter(|class| class.name.as_deref().is_some_and(is_apple))
            .cloned()
            .collect();
        if !apples.is_empty() || declared.iter().any(|name| is_apple(name)) {
            return Ok(apples);
        }
        if are_single_names(labels)
            || present
                .iter()
                .all(|class| class.number.is_none() && class.name.is_none())
        {
            return Ok(present);
        }
        if let [only] = &*present {
            if only.name.is_none() {
                return Ok(present);
            }
            if declared.len() == 1 {
                warnings.push(Warning::new(
                    WarningCode::BoxClassAssumed,
                    format!("{file}: {only}, the only class of it, is taken for apples; --class states it"),
                ));
                return Ok(present);
            }
        }
        let remedy = "say which of these are apples by --class NAME or --class N";
        Err(none_of(
            "a class that is an apple by its name",
            labels,
            &present,
            remedy,
        ))
    }
}

/// The classes that a choice means.
fn chosen<'a>(choice: &ClassChoice, present: &'a [Class]) -> Vec<&'a Class> {
    match choice {
        ClassChoice::Number(number) => {
            let text = number.to_string();
            let is = |class: &&Class| match class.number {
                Some(own) => own == *number as u64,
                None => class.name.as_ref() == Some(&text),
            };
            present.iter().filter(is).collect()
        }
        ClassChoice::Name(name) => {
            let names: Vec<&str> = present
                .iter()
                .map(|class| class.name.as_deref().unwrap_or_default())
                .collect();
            ClassChoice::named(name, &names)
                .into_iter()
                .map(|k| &present[k])
                .collect()
        }
    }
}

fn none_of(wanted: &str, labels: &[LabelledBox], present: &[Class], remedy: &str) -> Malformed {
    let mut counts = Counts::default();
    for class in present {
        let count = labels
            .iter()
            .filter(|label| Class::of(label) == *class)
            .count();
        counts.add(&format!("of {class}"), count);
    }
    Malformed::new(
        "classes",
        format!("no box is of {wanted}; there are {counts}"),
        remedy,
    )
}

/// Whether the names are those of single things, not of classes: numbers, or each with a number and none twice. Files
/// of classes and numbers give names to classes alone.
fn are_single_names(labels: &[LabelledBox]) -> bool {
    let name = |label: &LabelledBox| {
        label
            .class_name
            .clone()
            .filter(|_| label.class_number.is_none())
    };
    let Some(mut names) = labels.iter().map(name).collect::<Option<Vec<String>>>() else {
        return false;
    };
    if names.iter().all(|name| name.parse::<u64>().is_ok()) {
        return true;
    }
    let count = names.len();
    let with_digits = names
        .iter()
        .all(|name| name.contains(|c: char| c.is_ascii_digit()));
    names.sort_unstable();
    names.dedup();
    with_digits && names.len() == count
}

/// A class as a file states it.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Class {
    number: Option<u64>,
    name: Option<String>,
}

impl Class {
    fn of(label: &LabelledBox) -> Self {
        Self {
            number: label.class_number,
            name: label.class_name.clone(),
        }
    }
}

impl std::fmt::Display for Class {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (&self.name, self.number) {
            (Some(name), _) => write!(f, "`{name}`"),
            (None, Some(number)) => write!(f, "class {number}"),
            (None, None) => f.write_str("no class"),
        }
    }
}

/// How many of which, in the order of their first.
#[derive(Default)]
struct Counts(Vec<(String, usize)>);

/// How many kinds a message lists.
const SHOWN: usize = 8;

impl Counts {
    fn add(&mut self, what: &str, count: usize) {
        if count == 0 {
            return;
        }
        match self.0.iter_mut().find(|(known, _)| known == what) {
            Some((_, so_far)) => *so_far += count,
            None => self.0.push((what.to_owned(), count)),
        }
    }
}

impl std::fmt::Display for Counts {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let shown = self
            .0
            .iter()
            .take(SHOWN)
            .map(|(what, count)| format!("{count} {what}"));
        let more = if self.0.len() > SHOWN { ", …" } else { "" };
        write!(f, "{}{more}", shown.collect::<Vec<_>>().join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn label(number: Option<u64>, name: Option<&str>) -> LabelledBox {
        LabelledBox {
            class_number: number,
            class_name: name.map(str::to_owned),
            ..LabelledBox::new(PixelBox {
                name: name.unwrap_or("0").to_owned(),
                x_min: 1.0,
                y_min: 1.0,
                x_max: 2.0,
                y_max: 2.0,
                score: 0.5,
            })
        }
    }

    fn named(names: &[&str]) -> Vec<LabelledBox> {
        names.iter().map(|name| label(None, Some(name))).collect()
    }

    /// Names of the boxes taken, and what is said.
    fn taken(
        choice: &BoxChoice,
        labels: Vec<LabelledBox>,
        classes: &[&str],
    ) -> Result<(Vec<String>, String), String> {
        let classes: Vec<String> = classes.iter().map(ToString::to_string).collect();
        let found = choice
            .of("b.xml", labels, &classes)
            .map_err(|e| e.problem)?;
        let said: Vec<String> = found.warnings.iter().map(|w| w.message.clone()).collect();
        Ok((
            found.value.into_iter().map(|b| b.name).collect(),
            said.join("; "),
        ))
    }

    fn by_default(
        labels: Vec<LabelledBox>,
        classes: &[&str],
    ) -> Result<(Vec<String>, String), String> {
        taken(&BoxChoice::default(), labels, classes)
    }

    #[test]
    fn what_is_an_apple_by_its_name_is_taken_and_the_rest_counted() {
        let (names, said) = by_default(
            named(&["apple", "leaf", "Apple_Ripe", "leaf", "trunk"]),
            &[],
        )
        .unwrap();
        assert_eq!(names, ["apple", "Apple_Ripe"]);
        assert_eq!(
            said,
            "b.xml: 2 boxes are taken; left out are 2 of `leaf`, 1 of `trunk`"
        );
        // No apple in this image, though the file knows them: none is right.
        let leaves = vec![label(Some(1), Some("leaf")); 3];
        assert_eq!(
            by_default(leaves.clone(), &["apple", "leaf"])
                .unwrap()
                .0
                .len(),
            0
        );
        let refused = by_default(leaves, &["trunk", "leaf"]).unwrap_err();
        assert!(refused.contains("3 of `leaf`"), "{refused}");
        assert!(by_default(named(&["leaf"]), &[]).is_err());
        assert_eq!(by_default(Vec::new(), &["leaf"]).unwrap().0.len(), 0);
    }

    #[test]
    fn files_that_name_no_class_or_one_or_each_box_are_taken_whole() {
        assert_eq!(
            by_default(named(&["2118", "2118", "7"]), &[])
                .unwrap()
                .0
                .len(),
            3
        );
        assert_eq!(
            by_default(named(&["2118", "BALL_060"]), &[])
                .unwrap()
                .0
                .len(),
            2
        );
        assert!(by_default(named(&["leaf1", "leaf1"]), &[]).is_err());
        let numbered = |numbers: &[u64]| {
            numbers
                .iter()
                .map(|&n| label(Some(n), None))
                .collect::<Vec<_>>()
        };
        assert_eq!(
            by_default(numbered(&[3, 3]), &[]).unwrap(),
            (vec!["0".to_owned(); 2], String::new())
        );
        let refused = by_default(numbered(&[0, 0, 1]), &[]).unwrap_err();
        assert!(refused.contains("2 of class 0, 1 of class 1"), "{refused}");
        let (names, said) = by_default(vec![label(Some(1), Some("fruit"))], &["fruit"]).unwrap();
        assert!(names.len() == 1 && said.contains("`fruit`"), "{said}");
    }

    #[test]
    fn the_class_that_is_asked_for_is_taken_or_refused() {
        let choose = |class| BoxChoice::default().with(|c| c.class = Some(class));
        let leaf = choose(ClassChoice::Name("Leaf".to_owned()));
        assert_eq!(
            taken(&leaf, named(&["apple", "leaf"]), &[]).unwrap().0,
            ["leaf"]
        );
        let pear = choose(ClassChoice::Name("pear".to_owned()));
        let refused = taken(&pear, named(&["apple", "leaf"]), &[]).unwrap_err();
        assert!(
            refused.contains("`pear`") && refused.contains("1 of `leaf`"),
            "{refused}"
        );
        assert_eq!(
            taken(&pear, named(&["apple"]), &["apple", "pear"])
                .unwrap()
                .0
                .len(),
            0
        );
        let second = choose(ClassChoice::Number(1));
        let labels = vec![label(Some(0), None), label(Some(1), None)];
        assert_eq!(taken(&second, labels, &[]).unwrap().0.len(), 1);
        assert!(taken(&second, vec![label(Some(0), None)], &[]).is_err());
    }

    #[test]
    fn crowds_and_low_scores_are_left_out_and_counted() {
        let crowd = LabelledBox {
            kind: LabelKind::Crowd,
            ..label(Some(1), Some("apple"))
        };
        let choice = BoxChoice::default().with(|c| c.min_score = 0.6);
        let sure = LabelledBox {
            bounds: PixelBox {
                score: 0.7,
                ..crowd.bounds.clone()
            },
            ..label(Some(1), Some("apple"))
        };
        let (names, said) = taken(
            &choice,
            vec![crowd, label(Some(1), Some("apple")), sure],
            &["apple"],
        )
        .unwrap();
        assert_eq!(names.len(), 1);
        assert_eq!(
            said,
            "b.xml: 1 box is taken; left out are 1 crowd regions, 1 of a score below 0.6"
        );
    }
}
