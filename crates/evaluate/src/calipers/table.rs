use crate::error::EvaluateError;
use serde::Deserialize;
use std::path::Path;

/// What to do about a table that is not one of calipers.
const COLUMNS: &str = "give CSV with a header and the columns box_name and diameter_mm";

/// What somebody measured of one apple.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Caliper {
    /// Name of its box.
    pub box_name: String,
    /// Largest diameter about the stem's axis, metres.
    pub diameter: f64,
}

impl Caliper {
    /// The diameter, in metres, of the apple in the box of this name.
    pub fn new(box_name: impl Into<String>, diameter: f64) -> Self {
        Self {
            box_name: box_name.into(),
            diameter,
        }
    }
}

/// Reads a table of measured apples: CSV with at least the columns `box_name` and `diameter_mm`.
///
/// # Errors
///
/// [`EvaluateError::Malformed`] where a column is missing, a name repeats, or a diameter is not
/// a positive number.
pub fn read_calipers(path: impl AsRef<Path>) -> Result<Vec<Caliper>, EvaluateError> {
    #[derive(Deserialize)]
    struct Line {
        box_name: String,
        diameter_mm: f64,
    }
    let path = path.as_ref();
    let malformed = |problem: String, remedy: &str| EvaluateError::Malformed {
        path: path.to_owned(),
        problem,
        remedy: remedy.to_owned(),
    };
    let text = std::fs::read_to_string(path).map_err(|source| EvaluateError::Io {
        path: path.to_owned(),
        source,
    })?;
    let mut calipers: Vec<Caliper> = Vec::new();
    for line in csv::Reader::from_reader(text.as_bytes()).deserialize() {
        let Line {
            box_name,
            diameter_mm,
        } = line.map_err(|e| malformed(e.to_string(), COLUMNS))?;
        if !(diameter_mm > 0.0 && diameter_mm.is_finite()) {
            let problem = format!("box `{box_name}`: the diameter is {diameter_mm} mm");
            return Err(malformed(problem, "give positive millimetres"));
        }
        if calipers.iter().any(|c| c.box_name == box_name) {
            return Err(malformed(
                format!("box `{box_name}` is given twice"),
                "give each apple one line",
            ));
        }
        calipers.push(Caliper {
            box_name,
            diameter: diameter_mm / 1000.0,
        });
    }
    if calipers.is_empty() {
        return Err(malformed("no apples".to_owned(), COLUMNS));
    }
    Ok(calipers)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<Caliper>, EvaluateError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("calipers.csv");
        std::fs::write(&path, text).unwrap();
        read_calipers(path)
    }

    #[test]
    fn columns_are_found_by_name() {
        let calipers =
            read("weight_g,diameter_mm,box_name\n1,71.61,2118\n2,70,\"a, b\"\n").unwrap();
        assert_eq!(
            calipers[0],
            Caliper {
                box_name: "2118".into(),
                diameter: 0.071_61
            }
        );
        assert_eq!(calipers[1].box_name, "a, b");
    }

    #[test]
    fn nonsense_is_refused_with_its_place() {
        for (text, part) in [
            ("box_name,height_mm\na,1\n", "diameter_mm"),
            ("box_name,diameter_mm\na,thick\n", "thick"),
            ("box_name,diameter_mm\na,-3\n", "-3 mm"),
            ("box_name,diameter_mm\na,nan\n", "NaN"),
            ("box_name,diameter_mm\na,1\na,2\n", "twice"),
            ("box_name,diameter_mm\n", "no apples"),
        ] {
            let message = read(text).unwrap_err().to_string();
            assert!(message.contains("calipers.csv"), "{message}");
            assert!(
                message.contains(part) || part == "thick" && message.contains("float"),
                "{message}"
            );
        }
    }
}
