//! Influence coefficients between any places of the rails of a solved structure.

use formats::grid::{GridBlock, axes};
use nalgebra::DMatrix;
use splines::{Compliance, Error, Influence, Probe};

use crate::solved::SolvedModel;

impl SolvedModel {
    /// Influence coefficients G(i, j), the displacement at `x[i]` of one rail under a unit load at `z[j]` of another or
    /// the same, in length per force; `block` gives the directions of both, `rails` the indices of the rails.
    ///
    /// They are exact at every place. Entries between two stations are those of the grid, so that they are equal to
    /// those of its file to the last bit; both kinds agree within the error bound of the grid.
    ///
    /// ```
    /// use formats::grid::GridBlock;
    /// use formats::spec::Spec;
    /// use formats::text::source::Source;
    ///
    /// let text = r#"{"format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
    ///     "theory": "euler-bernoulli", "girder": {"spans": [10], "E": 210e6, "I_vertical": 5.768e-4}}"#;
    /// let spec = Spec::read(&Source::from_bytes("girder.json", text.into()).expect("UTF-8"), None).expect("a spec");
    /// let solved = foundations::solve(&spec).expect("a girder that stands");
    ///
    /// let g = solved.influence(GridBlock::Vertical, [0, 0], &[5.0], &[2.5, 5.0]).expect("places of the rail");
    /// assert_eq!(g.shape(), (1, 2));
    /// assert!((g[(0, 1)] * 48.0 * 210e6 * 5.768e-4 / 1e3 - 1.0).abs() < 1e-12);
    /// ```
    ///
    /// # Errors
    /// A place beyond the ends of its rail, or a direction that nothing resists there.
    pub fn influence(
        &self,
        block: GridBlock,
        rails: [usize; 2],
        x: &[f64],
        z: &[f64],
    ) -> Result<DMatrix<f64>, Error> {
        let axes = axes(block);
        let probes = |axis, rail, places: &[f64]| -> Vec<Probe> {
            places.iter().map(|&x| Probe { rail, x, axis }).collect()
        };
        let (rows, columns) = (probes(axes.0, rails[0], x), probes(axes.1, rails[1], z));
        let mut found = match &self.surface {
            Some(surface) if rows == columns => {
                let mut out = Influence::zeros(rows.len());
                surface.fill(&rows, &mut out)?;
                out.value
            }
            Some(surface) => {
                let mut out = DMatrix::zeros(x.len(), z.len());
                let lines = surface.displacement_lines(&rows)?;
                for (load, mut column) in columns.iter().zip(out.column_iter_mut()) {
                    lines.fill(*load, column.as_mut_slice())?;
                }
                out
            }
            None => DMatrix::from_element(x.len(), z.len(), f64::NAN),
        };
        self.take_stations(block, &rows, &columns, &mut found);
        Ok(found)
    }

    /// Replaces the entries between two stations by those of the grid.
    fn take_stations(
        &self,
        block: GridBlock,
        rows: &[Probe],
        columns: &[Probe],
        found: &mut DMatrix<f64>,
    ) {
        let Some(grid) = self.grid.block(block) else {
            return;
        };
        let stations = self.grid.stations();
        let index = |probe: &Probe| stations.iter().position(|at| *at == (probe.rail, probe.x));
        let rows: Vec<Option<usize>> = rows.iter().map(index).collect();
        for (j, column) in columns
            .iter()
            .enumerate()
            .filter_map(|(j, load)| Some((j, index(load)?)))
        {
            for (i, row) in rows
                .iter()
                .enumerate()
                .filter_map(|(i, row)| Some((i, (*row)?)))
            {
                found[(i, j)] = grid[(row, column)];
            }
        }
    }
}
