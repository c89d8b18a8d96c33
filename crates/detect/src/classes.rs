use pomona_cloud::ClassChoice;
use pomona_network::{Malformed, nearest};

/// What the classes are called where 80 of them have no names: those of COCO, on which public models are trained, in
/// its order (Lin et al., Microsoft COCO, 2014).
const COCO: [&str; 80] = [
    "person",
    "bicycle",
    "car",
    "motorcycle",
    "airplane",
    "bus",
    "train",
    "truck",
    "boat",
    "traffic light",
    "fire hydrant",
    "stop sign",
    "parking meter",
    "bench",
    "bird",
    "cat",
    "dog",
    "horse",
    "sheep",
    "cow",
    "elephant",
    "bear",
    "zebra",
    "giraffe",
    "backpack",
    "umbrella",
    "handbag",
    "tie",
    "suitcase",
    "frisbee",
    "skis",
    "snowboard",
    "sports ball",
    "kite",
    "baseball bat",
    "baseball glove",
    "skateboard",
    "surfboard",
    "tennis racket",
    "bottle",
    "wine glass",
    "cup",
    "fork",
    "knife",
    "spoon",
    "bowl",
    "banana",
    "apple",
    "sandwich",
    "orange",
    "broccoli",
    "carrot",
    "hot dog",
    "pizza",
    "donut",
    "cake",
    "chair",
    "couch",
    "potted plant",
    "bed",
    "dining table",
    "toilet",
    "tv",
    "laptop",
    "mouse",
    "remote",
    "keyboard",
    "cell phone",
    "microwave",
    "oven",
    "toaster",
    "sink",
    "refrigerator",
    "book",
    "clock",
    "vase",
    "scissors",
    "teddy bear",
    "hair drier",
    "toothbrush",
];

/// Which classes count, and what was assumed to say so.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Chosen {
    /// Their numbers: several where several are apples by their names, such as ripe and unripe ones.
    pub(crate) classes: Vec<usize>,
    /// Their names, where they have any.
    pub(crate) names: Vec<String>,
    /// Whether neither a choice nor a name says that it is this one.
    pub(crate) is_guess: bool,
    /// What was assumed.
    pub(crate) note: Option<String>,
}

/// Which classes count.
///
/// `names` are those of the description, `count` is how many classes the model has, as far as its outputs tell.
/// Without a choice they are those that are apples by their names, and the only one where there is one. Where they have
/// no names it is the first.
pub(crate) fn choose(
    choice: Option<&ClassChoice>,
    names: Option<&[String]>,
    count: Option<usize>,
) -> Result<Chosen, Malformed> {
    let names: Vec<&str> = match (names, count) {
        (Some(names), _) => names.iter().map(String::as_str).collect(),
        (None, Some(count)) if count == COCO.len() => COCO.to_vec(),
        (None, _) => Vec::new(),
    };
    if let (Some(count), false) = (count, names.is_empty())
        && names.len() != count
    {
        return Err(Malformed::new(
            "`classes`",
            format!("{} names for a model of {count} classes", names.len()),
            "name every class of the model, in its order",
        ));
    }
    match choice {
        None => by_default(&names, count),
        Some(ClassChoice::Number(number)) => {
            let count = count.or((!names.is_empty()).then_some(names.len()));
            check(*number, count)?;
            Ok(those(vec![*number], &names))
        }
        Some(ClassChoice::Name(name)) => {
            let found = ClassChoice::named(name, &names);
            if found.is_empty() {
                return Err(unknown(name, &names));
            }
            Ok(those(found, &names))
        }
    }
}

fn those(classes: Vec<usize>, names: &[&str]) -> Chosen {
    let own = classes.iter().filter_map(|&class| names.get(class));
    Chosen {
        names: own.map(ToString::to_string).collect(),
        classes,
        ..Chosen::default()
    }
}

fn by_default(names: &[&str], count: Option<usize>) -> Result<Chosen, Malformed> {
    const APPLE: &str = ClassChoice::DEFAULT_NAME;
    let found = ClassChoice::named(APPLE, names);
    if !found.is_empty() {
        let mut chosen = those(found, names);
        if chosen
            .names
            .iter()
            .any(|name| !name.eq_ignore_ascii_case(APPLE))
        {
            chosen.note = Some(format!("{} taken for apples", listed(&chosen.names)));
        }
        return Ok(chosen);
    }
    let mut first = those(vec![0], names);
    match (names, count) {
        ([], Some(1)) => {}
        ([], _) => {
            let of = count.map_or_else(String::new, |count| format!(" of {count}"));
            first.is_guess = true;
            first.note = Some(format!(
                "the model does not name its classes: class 0{of} is taken for apples; state another by --class, or \
                 `classes` in the description beside it"
            ));
        }
        ([only], _) => first.note = Some(format!("its only class, `{only}`, is taken for apples")),
        _ => return Err(unknown(APPLE, names)),
    }
    Ok(first)
}

/// Classes as the subject of a sentence.
fn listed(names: &[String]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match &*quoted {
        [one] => format!("class {one} is"),
        several => format!("classes {} are", several.join(", ")),
    }
}

/// How many names a message lists.
const SHOWN: usize = 10;

fn unknown(name: &str, names: &[&str]) -> Malformed {
    let place = format!("class `{name}`");
    if names.is_empty() {
        return Malformed::new(
            place,
            "the model's classes have no names here",
            "give the class's number, or list `classes` in the description beside the model",
        );
    }
    let problem = format!("none of the {} classes has this name", names.len());
    let remedy = if names.len() > SHOWN {
        format!("the nearest are {}", nearest(name, names))
    } else {
        let all: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        format!("say by --class which of {} is an apple", all.join(", "))
    };
    Malformed::new(place, problem, remedy)
}

/// The names that an exporter wrote into the model under `names`, as Ultralytics' does: `{0: 'leaf', 1: 'apple'}`,
/// numbered from 0 without a gap. `None` where there are none, or they are written otherwise.
pub(crate) fn from_metadata(metadata: &[(String, String)]) -> Option<Vec<String>> {
    let (_, text) = metadata.iter().find(|(key, _)| key == "names")?;
    let mut rest = text.trim().strip_prefix('{')?.strip_suffix('}')?.trim();
    let mut names = Vec::new();
    while !rest.is_empty() {
        let (number, after) = rest.split_once(':')?;
        if number.trim().parse() != Ok(names.len()) {
            return None;
        }
        let after = after.trim_start();
        let quote = after.chars().next().filter(|c| matches!(c, '\'' | '"'))?;
        let (name, after) = after[1..].split_once(quote)?;
        names.push(name.to_owned());
        rest = after.trim_start();
        rest = rest.strip_prefix(',').unwrap_or(rest).trim_start();
    }
    (!names.is_empty()).then_some(names)
}

/// Whether a model of `count` classes has one of this number; passes where the count is not known.
pub(crate) fn check(number: usize, count: Option<usize>) -> Result<(), Malformed> {
    match count {
        Some(count) if number >= count => Err(Malformed::new(
            format!("class {number}"),
            format!("the model has {count} classes"),
            format!("give a number from 0 to {}", count.saturating_sub(1)),
        )),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(name: &str) -> ClassChoice {
        ClassChoice::Name(name.to_owned())
    }

    fn chosen(choice: Option<&ClassChoice>, names: &[&str], count: Option<usize>) -> Chosen {
        let names: Vec<String> = names.iter().map(ToString::to_string).collect();
        choose(choice, (!names.is_empty()).then_some(&*names), count).unwrap()
    }

    #[test]
    fn by_name_by_number_or_the_apple() {
        let numbers = |choice: Option<&ClassChoice>, names: &[&str], count| {
            chosen(choice, names, count).classes
        };
        let names = ["leaf", "Apple"];
        assert_eq!(numbers(None, &names, Some(2)), [1]);
        assert_eq!(numbers(Some(&name("leaf")), &names, Some(2)), [0]);
        assert_eq!(numbers(Some(&name("apple")), &names, None), [1]);
        assert_eq!(numbers(Some(&ClassChoice::Number(0)), &names, Some(2)), [0]);
        assert_eq!(numbers(None, &[], Some(80)), [47]);
        assert_eq!(numbers(Some(&name("orange")), &[], Some(80)), [49]);
        assert_eq!(numbers(Some(&ClassChoice::Number(7)), &[], None), [7]);
        assert_eq!(chosen(None, &names, Some(2)).note, None);
    }

    #[test]
    fn a_class_is_an_apple_by_a_word_of_its_name_and_never_by_being_the_first() {
        let ripe = chosen(None, &["Leaf", "Apple_Ripe", "Stem"], Some(3));
        assert_eq!(
            (&*ripe.classes, &*ripe.names),
            (&[1][..], &["Apple_Ripe".to_owned()][..])
        );
        assert_eq!(
            ripe.note.as_deref(),
            Some("class `Apple_Ripe` is taken for apples")
        );
        let both = chosen(None, &["ripe apple", "leaf", "unripe-apple"], Some(3));
        assert_eq!(both.classes, [0, 2]);
        let only = chosen(None, &["fruit"], Some(1));
        assert!(only.note.unwrap().contains("`fruit`"));
        let none = choose(
            None,
            Some(&["leaf".to_owned(), "trunk".to_owned()]),
            Some(2),
        )
        .unwrap_err();
        assert!(
            none.remedy.contains("--class") && none.remedy.contains("`trunk`"),
            "{none:?}"
        );
    }

    #[test]
    fn without_names_the_first_is_taken_and_said() {
        let one = chosen(None, &[], Some(1));
        assert_eq!((&*one.classes, one.note), (&[0][..], None));
        for (count, words) in [(Some(3), "class 0 of 3"), (None, "class 0 is taken")] {
            let guess = chosen(None, &[], count);
            assert!(
                guess.is_guess && guess.note.as_ref().unwrap().contains(words),
                "{guess:?}"
            );
        }
    }

    #[test]
    fn names_in_the_model_are_read() {
        let names = |text: &str| from_metadata(&[("names".to_owned(), text.to_owned())]);
        let expected = Some(vec!["leaf".to_owned(), "farmer's apple".to_owned()]);
        assert_eq!(names("{0: 'leaf', 1: \"farmer's apple\"}"), expected);
        assert_eq!(names("{0: 'leaf', 1: \"farmer's apple\",}"), expected);
        for bad in [
            "",
            "{",
            "{}",
            "{}}",
            "{0: }",
            "{0: 'a}",
            "{1: 'a'}",
            "['a']",
            "{0: 'a' 2: 'b'}",
            "{0: é}",
        ] {
            assert_eq!(names(bad), None, "{bad}");
        }
        assert_eq!(from_metadata(&[]), None);
    }

    #[test]
    fn what_does_not_exist_is_named() {
        let fault = choose(Some(&name("aple")), None, Some(80)).unwrap_err();
        assert!(fault.remedy.contains("`apple`"), "{fault:?}");
        let fault = choose(Some(&name("apple")), None, Some(3)).unwrap_err();
        assert!(fault.remedy.contains("number"), "{fault:?}");
        let fault = choose(Some(&ClassChoice::Number(80)), None, Some(80)).unwrap_err();
        assert!(fault.remedy.contains("0 to 79"), "{fault:?}");
        let fault = choose(None, Some(&["apple".to_owned()]), Some(2)).unwrap_err();
        assert!(fault.problem.contains("1 names"), "{fault:?}");
    }
}
