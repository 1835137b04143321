//! The page of a report: sections as HTML.

use crate::chart::{Chart, Drawing, Style};
use crate::document::code::{coded, exponent, plain};
use crate::document::number::{number, with_numbers};
use crate::document::section::{
    BannerTone, Figure, Picture, ReportSection, ReportTable, TableCell, TableColumn,
};
use crate::error::Error;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use results::threads::parallel_map;
use serde_json::json;

const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("script.js");
const ANIMATION_SCRIPT: &str = include_str!("animation.js");
/// Significant digits of shown numbers with a fraction.
const DIGITS: usize = 4;
/// The same of whole numbers, such as counts and loads of a file.
const WHOLE_DIGITS: usize = 7;
/// Largest number of rows of a table that is never divided between pages.
const SHORT: usize = 24;
/// Mean width of a letter, space beside the text of a cell, and width of a page, in pixels.
const LETTER: f64 = 7.4;
const BESIDE: f64 = 26.0;
const ROOM: f64 = 1340.0;
/// Letters of a cell above which it takes a whole line of its row on a narrow screen.
const LONG: usize = 28;
/// Numbers of columns above which letters are smaller and much smaller in print, and the number up to which a table stays a table on a
/// narrow screen.
const WIDE: usize = 9;
const WIDER: usize = 11;
const NARROW: usize = 3;

/// A report: title and sections.
///
/// ```
/// use report::{Report, ReportSection};
///
/// let sections = vec![ReportSection::new("Case <1>").paragraph("Values are escaped.")];
/// let report = Report { title: "Crossing".to_owned(), subtitle: "one wheel".to_owned(), sections };
/// let page = report.html(None)?;
/// assert!(page.contains("Case &lt;1&gt;"));
/// # Ok::<(), report::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Title of the page.
    pub title: String,
    /// Line below the title.
    pub subtitle: String,
    /// Sections.
    pub sections: Vec<ReportSection>,
}

impl Report {
    /// The report as one HTML page without references to other files. All text except finished SVG pictures is
    /// escaped. Charts are drawn on at most `threads` threads; `None`: as many as the machine has.
    ///
    /// # Errors
    /// A number that is not finite, a row whose length differs from the number of columns, or a chart that cannot be
    /// drawn.
    pub fn html(&self, threads: Option<u16>) -> Result<String, Error> {
        let sections = self.sections.iter().enumerate();
        let figures: Vec<(usize, usize, &Figure)> = sections
            .clone()
            .flat_map(|(s, section)| {
                section
                    .figures
                    .iter()
                    .enumerate()
                    .map(move |(i, one)| (s, i, one))
            })
            .collect();
        let drawn = parallel_map(&figures, threads, |running, (s, i, one)| {
            figure(*s, *i, one, running + 1)
        });
        let (mut drawn, mut tables) = (drawn.into_iter(), 0);
        let bodies: Result<Vec<Markup>, Error> = sections
            .map(|(i, s)| section(i, s, &mut tables, &mut drawn))
            .collect();
        // A verdict stands above the contents.
        let first = usize::from(
            self.sections
                .first()
                .is_some_and(|one| one.banner.is_some()),
        );
        let bodies = bodies?;
        let moves = figures
            .iter()
            .any(|(.., figure)| matches!(figure.picture, Picture::Animation(_)));
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    title { (self.title) }
                    style { (PreEscaped(STYLE)) (PreEscaped(page_footer(&self.title))) }
                }
                body {
                    header {
                        h1 { (self.title) }
                        @if !self.subtitle.is_empty() { p.subtitle { (self.subtitle) } }
                    }
                    main {
                        @for body in &bodies[..first] { (body) }
                        nav aria-label="Contents" {
                            ol {
                                @for (i, one) in self.sections.iter().enumerate() {
                                    li { a href=(format!("#section-{}", i + 1)) { (one.heading) } }
                                }
                            }
                        }
                        @for body in &bodies[first..] { (body) }
                    }
                    footer { "girderway " (env!("CARGO_PKG_VERSION")) }
                    script { (PreEscaped(SCRIPT)) }
                    @if moves { script { (PreEscaped(ANIMATION_SCRIPT)) } }
                }
            }
        };
        Ok(page.into_string())
    }
}

/// Formats one section as HTML. `tables_before` is the number of tables before it on the page, and `drawn` yields the
/// figures of this section next.
fn section(
    index: usize,
    section: &ReportSection,
    tables_before: &mut usize,
    drawn: &mut impl Iterator<Item = Result<Markup, Error>>,
) -> Result<Markup, Error> {
    let mut facts = Vec::new();
    for (fact, one) in section.facts.iter().enumerate() {
        facts.push((
            one,
            shown(&one.value).ok_or(Error::Fact {
                section: index,
                fact,
            })?,
        ));
    }
    let mut tables = Vec::new();
    for (i, one) in section.tables.iter().enumerate() {
        *tables_before += 1;
        tables.push(table(index, i, one, *tables_before)?);
    }
    let figures = drawn
        .take(section.figures.len())
        .collect::<Result<Vec<Markup>, Error>>()?;
    Ok(html! {
        section id=(format!("section-{}", index + 1)) .ends-page[section.ends_page] {
            details open {
                summary { h2 { (section.heading) } }
                @if let Some(banner) = &section.banner {
                    p class=(format!("banner {}", tone(banner.tone))) { (words(&banner.text)) }
                }
                @for text in &section.paragraphs { p { (words(text)) } }
                @if !facts.is_empty() {
                    table.facts {
                        tbody {
                            @for (fact, value) in &facts {
                                tr {
                                    th scope="row" { (raised(&fact.name)) }
                                    td class=[matches!(fact.value, TableCell::Number(_)).then_some("number")] { (value) }
                                    td.unit { (fact.unit) }
                                }
                            }
                        }
                    }
                }
                @for body in &tables { (body) }
                @if !figures.is_empty() {
                    div .pictures[figures.len() > 1] { @for body in &figures { (body) } }
                }
            }
        }
    })
}

fn table(
    section: usize,
    index: usize,
    table: &ReportTable,
    running: usize,
) -> Result<Markup, Error> {
    let mut rows = Vec::new();
    for (row, cells) in table.rows.iter().enumerate() {
        let (found, expected) = (cells.len(), table.columns.len());
        if found != expected {
            return Err(Error::Row {
                section,
                table: index,
                row,
                found,
                expected,
            });
        }
        let mut texts = Vec::new();
        for (column, cell) in cells.iter().enumerate() {
            let text = shown(cell).ok_or(Error::Cell {
                section,
                table: index,
                row,
                column,
            })?;
            texts.push((matches!(cell, TableCell::Number(_)), text));
        }
        rows.push(texts);
    }
    // numbers and the headers of their columns are aligned; a text column is numeric where all its texts are numbers
    let is_text_of_numbers = |i: usize| {
        let mut texts = table
            .rows
            .iter()
            .filter(|row| row[i] != TableCell::Empty)
            .peekable();
        texts.peek().is_some()
            && texts.all(|row| match &row[i] {
                TableCell::Text(text) => is_numeral(text),
                _ => false,
            })
    };
    let aligned: Vec<bool> = (0..table.columns.len()).map(is_text_of_numbers).collect();
    let numeric = |i: usize| {
        aligned[i]
            || table
                .rows
                .iter()
                .any(|r| matches!(r[i], TableCell::Number(_)))
    };
    let is_stacked = table.columns.len() > NARROW;
    let is_short = table.rows.len() <= SHORT;
    Ok(html! {
        div.scroll .short[is_short] .roomy[is_roomy(table)] .wide[table.columns.len() > WIDE] .wider[table.columns.len() > WIDER] {
            table .stacked[is_stacked] style=[is_stacked.then(|| column_names(&table.columns))] {
                caption { b { "Table " (running) ". " } (table.caption) }
                thead {
                    tr {
                        @for (i, column) in table.columns.iter().enumerate() {
                            th scope="col" class=[numeric(i).then_some("number")] {
                                (column.name)
                                @if !column.unit.is_empty() { " " span.unit { "(" (column.unit) ")" } }
                            }
                        }
                    }
                }
                tbody {
                    @for row in &rows {
                        tr {
                            @for ((number, text), aligned) in row.iter().zip(&aligned) {
                                td .number[*number || *aligned] .long[text.chars().count() > LONG] { (text) }
                            }
                        }
                    }
                }
            }
        }
    })
}

/// Whether every text of a table has room in one line beside the others, on a page of full width.
fn is_roomy(table: &ReportTable) -> bool {
    let length = |text: &str| text.chars().count();
    let of_cell = |cell: &TableCell| match cell {
        TableCell::Empty => 0,
        TableCell::Text(text) => length(text),
        TableCell::Number(_) => DIGITS + 3,
    };
    let width = |i: usize, column: &TableColumn| {
        let header = column.name.split(' ').map(length).max().unwrap_or_default();
        let most = table
            .rows
            .iter()
            .map(|row| of_cell(&row[i]))
            .fold(header, usize::max);
        LETTER * most as f64 + BESIDE
    };
    table
        .columns
        .iter()
        .enumerate()
        .map(|(i, column)| width(i, column))
        .sum::<f64>()
        < ROOM
}

/// Whether a text is a number as [`number`] writes it.
fn is_numeral(text: &str) -> bool {
    let is_of_number = |c: char| {
        c.is_ascii_digit()
            || ".\u{2212}\u{202f} \u{d7}\u{207b}\u{2070}\u{b9}\u{b2}\u{b3}".contains(c)
    };
    let is_raised = |c: char| ('\u{2074}'..='\u{2079}').contains(&c);
    text.starts_with(|c: char| c.is_ascii_digit() || c == '\u{2212}')
        && text.chars().all(|c| is_of_number(c) || is_raised(c))
}

/// A text in which names of files and keys stand between backticks; numbers in it are written as in tables.
fn words(text: &str) -> Markup {
    html! {
        @for (i, part) in text.split('`').enumerate() {
            @if i % 2 == 1 { code { (part) } } @else { (raised(&with_numbers(part))) }
        }
    }
}

/// A text whose powers, such as `s^2`, are raised.
fn raised(text: &str) -> String {
    [("^2", "\u{b2}"), ("^3", "\u{b3}"), ("^4", "\u{2074}")]
        .into_iter()
        .fold(text.to_owned(), |text, (power, sign)| {
            text.replace(power, sign)
        })
}

fn figure(section: usize, index: usize, figure: &Figure, running: usize) -> Result<Markup, Error> {
    let mut still = None;
    let (svg, class, data) = match &figure.picture {
        Picture::Svg(svg) => (svg.clone(), "picture", None),
        Picture::Animation(animation) => {
            let data = animation.data().ok_or(Error::Animation {
                section,
                figure: index,
            })?;
            still = Some(animation.still_time);
            (animation.svg.clone(), "picture animation", Some(data))
        }
        Picture::Chart(chart) => {
            let drawing = chart.draw().map_err(|source| Error::Chart {
                section,
                figure: index,
                source,
            })?;
            let data = data(chart, &drawing);
            (drawing.svg, "picture chart", Some(data))
        }
        Picture::Drawn(drawn) => {
            let (chart, drawing) = &**drawn;
            (
                drawing.svg.clone(),
                "picture chart",
                Some(data(chart, drawing)),
            )
        }
    };
    let label = format!("figure-{running}");
    Ok(html! {
        figure {
            div class=(class) {
                (PreEscaped(svg.inline(&label)))
                @if let Some(data) = data {
                    script type="application/json" data-still=[still] { (PreEscaped(data)) }
                }
            }
            figcaption id=(label) { b { "Figure " (running) ". " } (figure.caption) }
        }
    })
}

/// Class of a banner in the style sheet.
fn tone(tone: BannerTone) -> &'static str {
    match tone {
        BannerTone::Good => "good",
        BannerTone::Bad => "bad",
        BannerTone::Neutral => "neutral",
    }
}

/// Names of the columns as properties of the table, which the style sheet puts before the cells of a narrow screen: once
/// for each column instead of in every cell.
fn column_names(columns: &[TableColumn]) -> String {
    let mut style = String::new();
    for (i, TableColumn { name, unit }) in columns.iter().enumerate() {
        let text = match (name.is_empty(), unit.is_empty()) {
            // the first column is the head of a row, and others have room for a name, so that values stand in line
            (true, _) if i == 0 => continue,
            (true, _) => "\u{a0}".to_owned(),
            (false, true) => name.clone(),
            (false, false) => format!("{name} ({unit})"),
        };
        style.push_str(&format!("--c{}:\"{}\";", i + 1, css_text(&text)));
    }
    style
}

/// Text of a string of a style sheet: every character that could end the string or the element is written by its code.
fn css_text(text: &str) -> String {
    let mut all = String::new();
    for c in text.chars() {
        match c {
            c if c.is_ascii_alphanumeric() || " ().,%-".contains(c) || !c.is_ascii() => all.push(c),
            c => all.push_str(&format!("\\{:x} ", u32::from(c))),
        }
    }
    all
}

/// Style of the lower margin of printed pages: the title of the report and its file, and the number of the page.
fn page_footer(title: &str) -> String {
    let text = css_text(title);
    format!(
        "@page {{ @bottom-left {{ content: \"{text} \\2013  report.html\"; }} \
         @bottom-right {{ content: \"Page \" counter(page) \" of \" counter(pages); }} }}\n"
    )
}

/// Text of a cell; `None` for a number that is not finite.
fn shown(cell: &TableCell) -> Option<String> {
    match cell {
        TableCell::Empty => Some(String::new()),
        TableCell::Text(text) => Some(text.clone()),
        TableCell::Number(value) if value.fract() == 0.0 && value.abs() < 1e7 => {
            number(*value, WHOLE_DIGITS)
        }
        TableCell::Number(value) => number(*value, DIGITS),
    }
}

/// The data of a chart for the display of values under the pointer, as JSON that is safe inside a script element.
fn data(chart: &Chart, drawing: &Drawing) -> String {
    let frame = &drawing.frame;
    let axis = |axis: &crate::chart::ChartAxis, range: [f64; 2]| {
        json!({
            "label": axis.label,
            "unit": axis.unit,
            "range": range,
            "log": axis.log,
            "flip": axis.downwards,
        })
    };
    let [x, y] = frame.ranges();
    let list = |values: &[f64], axis: &crate::chart::ChartAxis, range| {
        if axis.log {
            plain(values)
        } else {
            coded(values, exponent(range))
        }
    };
    // curves over the same abscissas store them once
    let mut places: Vec<Vec<f64>> = Vec::new();
    let series: Vec<_> = chart
        .series
        .iter()
        .zip(&drawing.series)
        .map(|(one, points)| {
            let [own, values] = [0, 1].map(|k| points.iter().map(|p| p[k]).collect::<Vec<f64>>());
            let at = places.iter().position(|known| *known == own).unwrap_or_else(|| {
                places.push(own);
                places.len() - 1
            });
            let is_apart = one.style == Style::Points;
            json!({"label": one.label, "x": at, "y": list(&values, &chart.y_axis, y), "apart": is_apart})
        })
        .collect();
    let places: Vec<_> = places
        .iter()
        .map(|own| list(own, &chart.x_axis, x))
        .collect();
    let place =
        [frame.left, frame.top, frame.width, frame.height].map(|v| (v * 100.0).round() / 100.0);
    let all = json!({
        "note": chart.note,
        "frame": place,
        "x": axis(&chart.x_axis, x),
        "y": axis(&chart.y_axis, y),
        "places": places,
        "series": series,
        "markers": chart.markers.iter().map(|marker| json!([marker.x, marker.label])).collect::<Vec<_>>(),
    });
    all.to_string().replace('<', "\\u003c")
}
