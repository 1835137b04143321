//! Figures and runs with their names.

use crate::Picture;
use crate::chart::{self, Chart, Svg};
use formats::scene::Scene;
use results::columns::NamedColumns;

/// A figure of a run: a picture with a name and a caption.
pub struct RunFigure {
    /// File name without extension.
    pub name: String,
    /// The caption.
    pub caption: String,
    /// The picture.
    pub picture: Picture,
}

impl RunFigure {
    /// A chart.
    pub fn chart(name: impl Into<String>, caption: impl Into<String>, chart: Chart) -> RunFigure {
        RunFigure {
            name: name.into(),
            caption: caption.into(),
            picture: chart.into(),
        }
    }

    /// A drawing that is finished.
    pub(super) fn drawing(
        name: impl Into<String>,
        caption: impl Into<String>,
        svg: Svg,
    ) -> RunFigure {
        RunFigure {
            name: name.into(),
            caption: caption.into(),
            picture: svg.into(),
        }
    }

    /// As SVG.
    ///
    /// # Errors
    /// Data that the chart cannot draw.
    pub fn svg(&self) -> Result<Svg, chart::Error> {
        self.picture.svg()
    }
}

/// A run with its label.
pub struct LabelledRun<'a> {
    /// The label of its case.
    pub label: String,
    /// Its scene.
    pub scene: &'a Scene,
    /// Its history as named columns.
    pub record: &'a NamedColumns,
}
