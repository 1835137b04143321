//! Sections of a report and their parts: facts, tables, figures.

use crate::chart::{self, Chart, Drawing, Svg};
use crate::document::animated::Animation;

/// A section of a report. Its parts are shown in the order of the fields; empty parts are omitted.
///
/// ```
/// use report::{ReportSection, TableCell};
///
/// let section = ReportSection::new("Results").paragraph("All runs reached their ends.").fact("steps", 120_usize, "");
/// assert_eq!(section.facts[0].value, TableCell::Number(120.0));
/// assert_eq!(section.paragraphs.len(), 1);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReportSection {
    /// Heading, also in the table of contents.
    pub heading: String,
    /// A verdict in one line, above everything else.
    pub banner: Option<Banner>,
    /// Paragraphs of text.
    pub paragraphs: Vec<String>,
    /// Facts, shown as a table of names and values.
    pub facts: Vec<Fact>,
    /// Further tables.
    pub tables: Vec<ReportTable>,
    /// Charts and pictures.
    pub figures: Vec<Figure>,
    /// Whether a new page follows it in print.
    pub ends_page: bool,
}

impl ReportSection {
    /// An empty section.
    pub fn new(heading: impl Into<String>) -> Self {
        ReportSection {
            heading: heading.into(),
            ..ReportSection::default()
        }
    }

    /// The same section, after which a new page begins in print.
    pub fn ending_page(mut self) -> Self {
        self.ends_page = true;
        self
    }

    /// The same section with one more paragraph.
    pub fn paragraph(mut self, paragraph: impl Into<String>) -> Self {
        self.paragraphs.push(paragraph.into());
        self
    }

    /// The same section with one more fact.
    pub fn fact(
        mut self,
        name: impl Into<String>,
        value: impl Into<TableCell>,
        unit: impl Into<String>,
    ) -> Self {
        self.facts.push(Fact {
            name: name.into(),
            value: value.into(),
            unit: unit.into(),
        });
        self
    }

    /// The same section with one more figure.
    pub fn figure(mut self, picture: impl Into<Picture>, caption: impl Into<String>) -> Self {
        self.figures.push(Figure {
            picture: picture.into(),
            caption: caption.into(),
        });
        self
    }

    /// The same section with one more table.
    pub fn table(mut self, table: ReportTable) -> Self {
        self.tables.push(table);
        self
    }
}

/// A verdict in one line.
#[derive(Clone, Debug, PartialEq)]
pub struct Banner {
    /// The line.
    pub text: String,
    /// What it says.
    pub tone: BannerTone,
}

/// What a banner says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BannerTone {
    /// All checks passed.
    Good,
    /// A check failed.
    Bad,
    /// Nothing was checked.
    Neutral,
}

/// A value of a fact or of a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum TableCell {
    /// Nothing to show.
    #[default]
    Empty,
    /// Text, shown as it is.
    Text(String),
    /// A number, shown with four significant digits, or in full where it is a whole number below ten million.
    Number(f64),
}

impl From<f64> for TableCell {
    fn from(value: f64) -> Self {
        TableCell::Number(value)
    }
}

impl From<usize> for TableCell {
    fn from(value: usize) -> Self {
        TableCell::Number(value as f64)
    }
}

impl From<&str> for TableCell {
    fn from(value: &str) -> Self {
        TableCell::Text(value.to_owned())
    }
}

impl From<String> for TableCell {
    fn from(value: String) -> Self {
        TableCell::Text(value)
    }
}

/// A name with its value.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fact {
    /// Name of the quantity.
    pub name: String,
    /// The value.
    pub value: TableCell,
    /// Unit; empty where there is none.
    pub unit: String,
}

/// The header of a column.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TableColumn {
    /// Name of the quantity in the column.
    pub name: String,
    /// Unit of its numbers; empty where there is none.
    pub unit: String,
}

impl TableColumn {
    /// A header from its parts.
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        TableColumn {
            name: name.into(),
            unit: unit.into(),
        }
    }
}

/// A table; every row has one cell for each column.
///
/// ```
/// use report::{ReportTable, TableCell, TableColumn};
///
/// let columns = vec![TableColumn::new("wheel", ""), TableColumn::new("largest force", "kN")];
/// let rows = vec![vec!["front".into(), TableCell::Number(81.3)], vec!["rear".into(), TableCell::Number(79.0)]];
/// let table = ReportTable { caption: "Wheel forces".to_owned(), columns, rows };
/// assert!(table.rows.iter().all(|row| row.len() == table.columns.len()));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReportTable {
    /// Caption, shown above the table after its number.
    pub caption: String,
    /// Headers.
    pub columns: Vec<TableColumn>,
    /// Rows, each with one cell for each column.
    pub rows: Vec<Vec<TableCell>>,
}

/// Content of a figure.
#[derive(Clone, Debug, PartialEq)]
pub enum Picture {
    /// A chart; where scripts run, values are shown under the pointer.
    Chart(Box<Chart>),
    /// The same, with its drawing.
    Drawn(Box<(Chart, Drawing)>),
    /// A finished SVG picture; it is trusted and inserted unchanged.
    Svg(Svg),
    /// An animation, which requires scripts; without them it shows one frame.
    Animation(Box<Animation>),
}

impl Picture {
    /// The drawing of a chart that has none yet.
    ///
    /// # Errors
    /// Data that the chart cannot draw.
    pub fn drawing(&self) -> Result<Option<Drawing>, chart::Error> {
        match self {
            Picture::Chart(chart) => chart.draw().map(Some),
            Picture::Drawn(_) | Picture::Svg(_) | Picture::Animation(_) => Ok(None),
        }
    }

    /// The picture with its drawing, so that a page does not repeat it.
    #[must_use]
    pub fn with_drawing(self, drawing: Option<Drawing>) -> Picture {
        match (self, drawing) {
            (Picture::Chart(chart), Some(drawing)) => Picture::Drawn(Box::new((*chart, drawing))),
            (picture, _) => picture,
        }
    }

    /// As SVG.
    ///
    /// # Errors
    /// Data that the chart cannot draw.
    pub fn svg(&self) -> Result<Svg, chart::Error> {
        match self {
            Picture::Chart(chart) => chart.svg(),
            Picture::Drawn(drawn) => Ok(drawn.1.svg.clone()),
            Picture::Svg(svg) => Ok(svg.clone()),
            Picture::Animation(animation) => Ok(animation.svg.clone()),
        }
    }
}

impl From<Chart> for Picture {
    fn from(chart: Chart) -> Self {
        Picture::Chart(Box::new(chart))
    }
}

impl From<Svg> for Picture {
    fn from(svg: Svg) -> Self {
        Picture::Svg(svg)
    }
}

/// A picture with its caption.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// What is shown.
    pub picture: Picture,
    /// Caption, shown below the picture after its number.
    pub caption: String,
}
