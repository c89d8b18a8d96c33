//! The gripper in the base's frame as tables of text.

use super::text_table::{UNKNOWN, degrees, known, mm, percent, table};
use crate::terminal::Terminal;
use pomona_evaluate::{BaseResult, BudgetTerm, Coverage, Evaluation};

/// Nothing where no robot was simulated.
pub(super) fn tables(evaluation: &Evaluation, terminal: Terminal) -> String {
    let results: Vec<(&str, &str, &BaseResult)> = evaluation
        .results
        .iter()
        .filter_map(|of| Some((of.suite.as_str(), of.method.as_str(), of.base.as_ref()?)))
        .collect();
    if results.is_empty() {
        return String::new();
    }
    let budget = |title: &str, of: fn(&BaseResult) -> &[BudgetTerm], unit: fn(f64) -> String| {
        let header = [
            "suite", "method", "part", "answers", "mean", "median", "p95", "rms", "stated",
        ];
        let rows: Vec<Vec<String>> = results
            .iter()
            .flat_map(|(suite, method, result)| {
                of(result).iter().map(|part| {
                    let cells = [part.error.mean, part.error.median, part.error.p95, part.rms];
                    let mut row = vec![
                        (*suite).to_owned(),
                        (*method).to_owned(),
                        part.name.replace('_', " "),
                        part.error.count.to_string(),
                    ];
                    row.extend(cells.map(unit));
                    row.push(known(part.stated_rms, unit));
                    row
                })
            })
            .collect();
        "\n".to_owned() + &table(title, &header, &rows, 3, terminal)
    };
    let place = budget(
        "Gripper in the base's frame: place against the apple's, mm (stated: rms by the covariances)",
        |result| &result.position,
        mm,
    );
    let direction = budget(
        "Gripper in the base's frame: direction, degrees, of the answers at most 20° off in the camera's frame",
        |result| &result.direction,
        degrees,
    );
    let header = [
        "suite",
        "method",
        "place NEES",
        "<=50 %",
        "<=95 %",
        "direction NEES",
        "<=50 %",
        "<=95 %",
        "all deg",
        "with way %",
        "place mm",
        "deg",
    ];
    let rows: Vec<Vec<String>> = results
        .iter()
        .map(|(suite, method, result)| {
            let mut row = vec![(*suite).to_owned(), (*method).to_owned()];
            row.extend(coverage(result.position_coverage.as_ref()));
            row.extend(coverage(result.direction_coverage.as_ref()));
            let planned = &result.planned;
            row.extend([
                known(result.direction_of_all.as_ref(), |s| degrees(s.mean)),
                percent(&planned.with_way),
                known(planned.position_error.as_ref(), |s| mm(s.mean)),
                known(planned.direction_error.as_ref(), |s| degrees(s.mean)),
            ]);
            row
        })
        .collect();
    let title = "Stated covariances against errors (calibrated: NEES 3 and 2 in the mean), all directions, and the \
                 planned grasps";
    place + &direction + "\n" + &table(title, &header, &rows, 2, terminal)
}

fn coverage(of: Option<&Coverage>) -> [String; 3] {
    of.map_or([(); 3].map(|()| UNKNOWN.to_owned()), |of| {
        [
            format!("{:.1}", of.normalized.mean),
            percent(&of.within_50),
            percent(&of.within_95),
        ]
    })
}
