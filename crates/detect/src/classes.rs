use pomona_network::{Malformed, nearest};
use serde::Deserialize;

/// Which of the model's classes is an apple.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(untagged, expecting = "expected a class's name or number")]
pub enum ClassChoice {
    /// By its number.
    Number(usize),
    /// By its name in the description beside the model or in the model's own metadata, or among COCO's where a
    /// model of 80 classes has no names.
    Name(String),
}

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

/// The class that counts where nobody says which.
const APPLE: &str = "apple";

/// The number of the class that counts.
///
/// `names` are those of the description, `count` is how many classes the model has, as far as its outputs tell.
/// Without a choice it is the class named `apple`, else the first.
pub(crate) fn choose(
    choice: Option<&ClassChoice>,
    names: Option<&[String]>,
    count: Option<usize>,
) -> Result<usize, Malformed> {
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
    let find = |wanted: &str| {
        let exact = names.iter().position(|name| *name == wanted);
        exact.or_else(|| {
            names
                .iter()
                .position(|name| name.eq_ignore_ascii_case(wanted))
        })
    };
    match choice {
        None => Ok(find(APPLE).unwrap_or(0)),
        Some(ClassChoice::Number(number)) => {
            let count = count.or((!names.is_empty()).then_some(names.len()));
            check(*number, count)?;
            Ok(*number)
        }
        Some(ClassChoice::Name(name)) => find(name).ok_or_else(|| {
            let place = format!("class `{name}`");
            if names.is_empty() {
                Malformed::new(
                    place,
                    "the model's classes have no names here",
                    "give the class's number, or list `classes` in the description beside the model",
                )
            } else {
                Malformed::new(
                    place,
                    format!("none of the {} classes has this name", names.len()),
                    format!("the nearest are {}", nearest(name, &names)),
                )
            }
        }),
    }
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

    #[test]
    fn by_name_by_number_or_the_apple() {
        let names = ["leaf".to_owned(), "Apple".to_owned()];
        assert_eq!(choose(None, Some(&names), Some(2)), Ok(1));
        assert_eq!(choose(Some(&name("leaf")), Some(&names), Some(2)), Ok(0));
        assert_eq!(choose(Some(&name("apple")), Some(&names), None), Ok(1));
        assert_eq!(
            choose(Some(&ClassChoice::Number(0)), Some(&names), Some(2)),
            Ok(0)
        );
        assert_eq!(choose(None, None, Some(3)), Ok(0));
        assert_eq!(choose(None, None, None), Ok(0));
        assert_eq!(choose(None, None, Some(80)), Ok(47));
        assert_eq!(choose(Some(&name("orange")), None, Some(80)), Ok(49));
        assert_eq!(choose(Some(&ClassChoice::Number(7)), None, None), Ok(7));
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
