//! Elements of a page, and the page.

/// Text escaped for an element or an attribute.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

/// A table of a header and rows of cells, which are text.
///
/// A column of words is aligned left, numbers right; what follows a line break in a cell is set small below it.
pub fn table(header: &[&str], rows: &[Vec<String>]) -> String {
    let is_word = |column: usize| {
        let begins = |cell: &String| cell.is_empty() || cell.starts_with(char::is_alphabetic);
        column == 0 || rows.iter().all(|row| begins(&row[column]))
    };
    let words: Vec<bool> = (0..header.len()).map(is_word).collect();
    let cells = |tag: &str, cells: &mut dyn Iterator<Item = &str>| -> String {
        let cells = cells.zip(&words).map(|(cell, &word)| {
            let class = if word { " class=\"word\"" } else { "" };
            let text = match cell.split_once('\n') {
                Some((first, second)) => {
                    format!("{}<small>{}</small>", escape(first), escape(second))
                }
                None => escape(cell),
            };
            format!("<{tag}{class}>{text}</{tag}>")
        });
        cells.collect()
    };
    let head = cells("th", &mut header.iter().copied());
    let body: Vec<String> = rows
        .iter()
        .map(|row| {
            let cells = cells("td", &mut row.iter().map(String::as_str));
            format!("<tr>{cells}</tr>\n")
        })
        .collect();
    let body = body.concat();
    format!(
        "<div class=\"wide\"><table><thead><tr>{head}</tr></thead><tbody>\n{body}</tbody></table></div>\n"
    )
}

/// SVG elements side by side, `in_a_row` of them (at most 3) in each row, each with its caption.
pub fn figures(in_a_row: usize, figures: &[(String, String)]) -> String {
    let figures: Vec<String> = figures
        .iter()
        .map(|(svg, caption)| {
            let caption = escape(caption);
            format!("<figure>{svg}<figcaption>{caption}</figcaption></figure>\n")
        })
        .collect();
    let figures = figures.concat();
    format!("<div class=\"figures in-{in_a_row}\">\n{figures}</div>\n")
}

/// A heading of the third level.
pub fn heading(text: &str) -> String {
    format!("<h3>{}</h3>\n", escape(text))
}

/// A paragraph.
pub fn paragraph(text: &str) -> String {
    format!("<p>{}</p>\n", escape(text))
}

/// A whole page around `body`, which is HTML.
pub fn page(title: &str, body: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>{STYLE}</style></head>\n\
         <body><main>\n<h1>{title}</h1>\n{body}</main></body></html>\n",
        title = escape(title)
    )
}

const STYLE: &str = "
body { margin: 0; background: #f6f7f8; color: #23282f; font: 15px/1.5 system-ui, 'DejaVu Sans', sans-serif; }
main { max-width: 1240px; margin: 0 auto; padding: 28px 24px 60px; }
h1 { font-size: 26px; margin: 0 0 4px; }
h2 { font-size: 20px; margin: 40px 0 8px; padding-top: 14px; border-top: 2px solid #b22a30; }
h3 { font-size: 16px; margin: 26px 0 6px; }
p { max-width: 78ch; margin: 6px 0 12px; color: #4a525c; }
.wide { overflow-x: auto; margin: 8px 0 18px; }
table { border-collapse: collapse; background: #fff; font-variant-numeric: tabular-nums; font-size: 13.5px;
  box-shadow: 0 0 0 1px #e2e5e9; }
th, td { padding: 5px 10px; text-align: right; white-space: nowrap; border-bottom: 1px solid #eceef1; }
th { background: #eef0f3; font-weight: 600; color: #3a424c; vertical-align: bottom; }
th.word, td.word { text-align: left; }
small { display: block; color: #7a828c; font-size: 11.5px; font-weight: 400; }
tbody tr:last-child td { border-bottom: 0; }
.figures { display: grid; gap: 14px; margin: 8px 0 18px; }
.in-2 { grid-template-columns: repeat(2, 1fr); }
.in-3 { grid-template-columns: repeat(3, 1fr); }
@media (max-width: 800px) { .figures { grid-template-columns: 1fr; } }
figure { margin: 0; background: #fff; padding: 10px; box-shadow: 0 0 0 1px #e2e5e9; }
figure svg { width: 100%; height: auto; display: block; }
figcaption { font-size: 13px; color: #4a525c; padding: 4px 6px 2px; }
";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_from_files_cannot_become_markup() {
        let page = table(&["<b>"], &[vec!["a & <script>\"x\"".to_owned()]]);
        assert!(page.contains("a &amp; &lt;script&gt;&quot;x&quot;") && !page.contains("<script"));
    }
}
