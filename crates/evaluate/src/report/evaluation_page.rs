use super::{difficulty, lab_tables, overview, reliability, repeats, spread};
use crate::apple_row::AppleRow;
use crate::error::EvaluateError;
use crate::evaluation::Evaluation;
use crate::suite::SuiteResult;
use pomona_report::html::{escape, page, paragraph};
use pomona_report::plot::PlotError;

/// A self-contained page with the tables and plots of an evaluation, the paper's figures beside ours.
///
/// # Errors
///
/// [`EvaluateError::Plot`] where a plot cannot be drawn.
pub fn report_page(evaluation: &Evaluation) -> Result<String, EvaluateError> {
    let mut body = paragraph(&format!(
        "pomona {}, seed {}. Accuracy is measured against the truth of each scene; repeatability, where a suite \
         repeats one scene, against the mean of the answers themselves. Intervals are 95 %: Wilson for shares, \
         bootstrap over scenes for means. Paper: Gao et al. 2022, Agriculture 12(8), 1170.",
        evaluation.version, evaluation.seed
    ));
    body += &overview::tables(evaluation);
    body += &reliability::overview(evaluation);
    for result in &evaluation.results {
        let rows: Vec<&AppleRow> = evaluation
            .apples
            .iter()
            .filter(|row| row.target && row.suite == result.suite && row.method == result.method)
            .collect();
        body += &suite(result, &rows)?;
    }
    Ok(page("Evaluation", &body))
}

fn suite(result: &SuiteResult, rows: &[&AppleRow]) -> Result<String, PlotError> {
    let mut text = format!(
        "<h2>{}, method {}</h2>\n",
        escape(&result.suite),
        escape(&result.method)
    );
    text += &overview::refusals(result);
    text += &lab_tables::section(result)?;
    text += &repeats::section(result, rows)?;
    text += &spread::section(rows)?;
    text += &reliability::section(result, rows)?;
    text += &difficulty::section(result, rows)?;
    text += &overview::timing(result);
    Ok(text)
}

#[cfg(test)]
mod tests {
    use crate::run::evaluate;
    use crate::subject::Subject;
    use pomona::{Config, Method, Picker};

    #[test]
    fn the_page_is_whole_and_needs_nothing_else() {
        let subjects = Subject::named("lab15", Some(2)).unwrap();
        let [paper, robust] = [Method::Paper, Method::Robust].map(|method| {
            let config = Config::default().with(|c| c.method = method);
            Picker::new(config).unwrap()
        });
        let evaluation = evaluate(&subjects, &[&paper, &robust], 0, &|| {}).unwrap();
        assert_eq!(evaluation.results[0].reliability, None);
        let page = super::report_page(&evaluation).unwrap();
        for part in [
            "Table 1",
            "Table 4",
            "lab15, method paper",
            "<svg",
            "24.74",
            "lab15 · robust less paper",
            "Does it know how sure it is?",
            "Confidence against outcome",
            "</html>",
        ] {
            assert!(page.contains(part), "{part}");
        }
        for outside in ["http://", "https://", "src=", "@import", "url("] {
            let found = page
                .replace("http://www.w3.org/2000/svg", "")
                .contains(outside);
            assert!(!found, "{outside}");
        }
    }
}
