//! A frame with its rails, factored once.

use std::sync::{Arc, OnceLock};

use nalgebra::{Matrix3, SVector, Vector3};
use splines::{Axis, Probe, Rails, ShapeRow};

use crate::assembly::{Bodies, Combination, Element, Extended, Real, ScaledStiffness};
use crate::error::{EntryFault, Error, ModelEntry};
use crate::factor::{Certificate, Factored, Gram, Solver, SparseLoad, ill_conditioned};
use crate::influence::layout::{ExactLayout, Layout, StateRows};
use crate::influence::load::RailLoads;
use crate::model::{Model, Rail};

/// Accuracy of [`FactoredFrame::new`]: largest relative error bound of a compliance.
pub const DEFAULT_ACCURACY: f64 = 1e-6;

/// A model and its rails, numbered, assembled and factored: answers any number of questions.
///
/// # Example
/// ```
/// use fea::{FactoredFrame, Girder};
/// use splines::{Axis, Probe};
///
/// let girder = Girder { spans: vec![60.0], e: 4.32e9, i_vertical: 9.528, ..Girder::default() };
/// let (model, rail) = girder.model_and_rail()?;
/// let frame = FactoredFrame::new(&model, &[rail])?;
/// // One factor serves grids, surfaces, reactions and internal forces.
/// let probe = Probe { rail: 0, x: 15.0, axis: Axis::Vertical };
/// let grid = frame.grid(&[probe])?;
/// let reactions = frame.reactions(&model, &[probe])?;
/// assert!((reactions.value.sum() + 1.0).abs() < 1e-12, "the supports carry the load");
/// # assert!(grid.value[(0, 0)] > 0.0);
/// # Ok::<(), fea::Error>(())
/// ```
#[derive(Debug)]
pub struct FactoredFrame {
    pub(crate) elements: Vec<Element>,
    pub(crate) bodies: Bodies,
    stiffness: ScaledStiffness,
    factored: Factored,
    /// Largest relative error bound allowed.
    accuracy: f64,
    line: Option<Arc<Rails>>,
    states: Vec<[Combination; 6]>,
    exact: ExactLayout,
    /// The model, for what is formed again in double-doubles.
    model: Model,
    extended: OnceLock<Option<ExtendedFrame>>,
}

/// What the evaluation in double-doubles needs beside the frame.
#[derive(Debug)]
pub(crate) struct ExtendedFrame {
    /// The factor; `None` where that of the frame is in double-doubles.
    pub factored: Option<Factored>,
    pub bodies: Bodies<Extended>,
}

impl FactoredFrame {
    /// Checks, assembles and factors a model, with the accuracy [`DEFAULT_ACCURACY`].
    ///
    /// Degrees of freedom that nothing stiffens are left out: a load on them is refused.
    ///
    /// # Errors
    /// [`Error::Invalid`] for an entry that cannot be used; [`Error::Mechanism`] or [`Error::Released`] for
    /// a structure that can move without strain; [`Error::IllConditioned`] for a stiffness so badly conditioned that
    /// the accuracy cannot be met; [`Error::Memory`] or [`Error::NotFactorable`] for one that is too large.
    pub fn new(m: &Model, rails: &[Rail]) -> Result<FactoredFrame, Error> {
        FactoredFrame::with_accuracy(m, rails, DEFAULT_ACCURACY)
    }

    /// [`FactoredFrame::new`] with a given accuracy: the largest relative error bound of its compliances.
    ///
    /// The factor is in doubles where their bound suffices. Otherwise stiffness and factor are formed again
    /// in double-doubles from the doubles of the model.
    ///
    /// # Errors
    /// As [`FactoredFrame::new`].
    pub fn with_accuracy(m: &Model, rails: &[Rail], accuracy: f64) -> Result<FactoredFrame, Error> {
        m.check()?;
        let elements = Element::all(m)?;
        let mut bodies = Bodies::new(m);
        let layout = if rails.is_empty() {
            None
        } else {
            Some(Layout::new(m, rails, &elements, &bodies)?)
        };
        if let Some(layout) = &layout {
            check_coverage(&layout.line, rails)?;
        }
        let stiffness = ScaledStiffness::new(m, &elements, &mut bodies)?;
        let factored = Factored::new(m, &stiffness, &bodies, accuracy)?;
        let (line, states, exact) = match layout {
            Some(layout) => (Some(Arc::new(layout.line)), layout.states, layout.exact),
            None => Default::default(),
        };
        let (model, extended) = (m.clone(), OnceLock::new());
        Ok(FactoredFrame {
            elements,
            bodies,
            stiffness,
            factored,
            accuracy,
            line,
            states,
            exact,
            model,
            extended,
        })
    }

    /// The frame of a model that differs by its axial forces alone, without rails.
    ///
    /// # Errors
    /// As [`FactoredFrame::new`].
    pub(crate) fn reloaded(&self, m: &Model) -> Result<FactoredFrame, Error> {
        m.check()?;
        let elements = Element::all(m)?;
        let mut bodies = Bodies::new(m);
        bodies.turn(&self.stiffness.numbering.turned);
        let Some(stiffness) =
            ScaledStiffness::renumbered(m, &elements, &bodies, &self.stiffness.numbering)
        else {
            return FactoredFrame::with_accuracy(m, &[], self.accuracy);
        };
        let factored = Factored::new(m, &stiffness, &bodies, self.accuracy)?;
        Ok(FactoredFrame {
            elements,
            bodies,
            stiffness,
            factored,
            accuracy: self.accuracy,
            line: None,
            states: Vec::new(),
            exact: ExactLayout::default(),
            model: m.clone(),
            extended: OnceLock::new(),
        })
    }

    /// The same frame with rails.
    ///
    /// # Errors
    /// A rail that cannot be used.
    pub(crate) fn with_rails(mut self, rails: &[Rail]) -> Result<FactoredFrame, Error> {
        if !rails.is_empty() {
            let layout = Layout::new(
                &self.model,
                rails,
                &self.elements,
                &Bodies::new(&self.model),
            )?;
            check_coverage(&layout.line, rails)?;
            (self.line, self.states, self.exact) =
                (Some(Arc::new(layout.line)), layout.states, layout.exact);
        }
        Ok(self)
    }

    /// Condition of the stiffness, and bound of the error of compliances.
    #[must_use]
    pub fn certificate(&self) -> Certificate {
        self.factored.certificate
    }

    /// Bytes of the factor.
    #[must_use]
    pub fn factor_bytes(&self) -> u64 {
        self.factored.solver.bytes()
    }

    /// Number of unknown degrees of freedom.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        self.factored.solver.len()
    }

    /// The rail elements of the rails; state k of the line is state k of the surface.
    ///
    /// # Errors
    /// [`Error::NoRails`].
    pub fn line(&self) -> Result<&Arc<Rails>, Error> {
        self.line.as_ref().ok_or(Error::NoRails)
    }

    /// Whether the structure resists forces along `axis` at three places of every rail element of `rail`.
    #[must_use]
    pub fn resists(&self, rail: usize, axis: Axis) -> bool {
        let Some(line) = &self.line else { return false };
        let mut cells = line
            .elements()
            .iter()
            .filter(|cell| cell.rail == rail)
            .peekable();
        cells.peek().is_some()
            && cells.all(|cell| {
                let [a, b] = cell.x;
                [a + 0.25 * (b - a), 0.5 * (a + b), b - 0.25 * (b - a)]
                    .into_iter()
                    .all(|x| self.load(Probe { rail, x, axis }).is_ok())
            })
    }

    /// Loads of forces on the rails.
    pub(crate) fn rail_loads(&self) -> RailLoads<'_> {
        RailLoads {
            line: self.line.as_deref(),
            states: &self.states,
            bodies: &self.bodies,
            numbering: &self.stiffness.numbering,
        }
    }

    /// Displacements and rotations of all states over the motions of the bodies.
    pub(crate) fn states(&self) -> &[[Combination; 6]] {
        &self.states
    }

    /// Rail elements and states to all digits.
    pub(super) fn exact_layout(&self) -> &ExactLayout {
        &self.exact
    }

    /// The model that the frame was made of.
    pub(crate) fn model(&self) -> &Model {
        &self.model
    }

    /// The axes of a rail as rows x, up and z, global.
    pub(crate) fn rail_axes(&self, rail: usize) -> Matrix3<f64> {
        let elements = self.line.iter().flat_map(|line| line.elements());
        let state = elements
            .filter(|element| element.rail == rail)
            .map(|element| element.ends[0])
            .next();
        state.map_or_else(Matrix3::identity, |state| {
            self.exact.states[state].rail().axes.map(Real::double)
        })
    }

    /// The body of a state of the rails, and the arm from its reference to the state, global.
    pub(crate) fn state_arm(&self, state: usize) -> (usize, Vector3<f64>) {
        let (point, offset) = match &self.exact.states[state] {
            StateRows::Tip { point, offset, .. } => (*point, *offset),
            StateRows::Released { member, end, .. } => {
                let element = &self.elements[*member];
                (element.points[*end], element.offsets[*end])
            }
        };
        (
            self.bodies.of_point[point],
            self.bodies.arms[point].map(Real::double) + offset,
        )
    }

    /// What the evaluation in double-doubles needs, once it has been asked for.
    pub(super) fn extended_cell(&self) -> &OnceLock<Option<ExtendedFrame>> {
        &self.extended
    }

    /// The scaled stiffness.
    pub(crate) fn stiffness(&self) -> &ScaledStiffness {
        &self.stiffness
    }

    /// Its factor.
    pub(crate) fn solver(&self) -> &Solver {
        &self.factored.solver
    }

    /// Bound of |(S K S)^-1| in the 1-norm.
    pub(crate) fn inverse_norm(&self) -> f64 {
        self.factored.inverse_norm
    }

    /// Largest relative error bound allowed.
    pub(crate) fn accuracy(&self) -> f64 {
        self.accuracy
    }

    /// Displacement at a probe over the motions of the bodies, and the rail element of the probe.
    pub(crate) fn row(&self, probe: Probe) -> Result<(Combination, usize), Error> {
        self.rail_loads().row(probe)
    }

    /// Scaled load of a unit force at a probe, and the rail element of the probe.
    pub(crate) fn load(&self, probe: Probe) -> Result<(SparseLoad, usize), Error> {
        let row = self.line()?.row(probe)?;
        Ok((self.load_of_row(probe, &row)?, row.element))
    }

    /// The same by the shape row of the probe.
    pub(crate) fn load_of_row(&self, probe: Probe, row: &ShapeRow) -> Result<SparseLoad, Error> {
        let Probe { rail, x, axis } = probe;
        let load = self.scaled(&self.rail_loads().of_row(row));
        Ok(load.ok_or(splines::Error::NoStiffness { rail, x, axis })?)
    }

    /// A combination as a load on the scaled unknowns; `None` if it acts on a degree of freedom that nothing
    /// stiffens.
    pub(crate) fn scaled(&self, row: &Combination) -> Option<SparseLoad> {
        self.rail_loads().scaled(row)
    }

    /// A combination as a load on the scaled unknowns, without what acts on degrees of freedom that nothing
    /// stiffens.
    pub(crate) fn scaled_where_stiffened(&self, row: &Combination) -> SparseLoad {
        self.rail_loads().scaled_where_stiffened(row)
    }

    /// Motion of the references of all bodies under a scaled load.
    pub(crate) fn motions(&self, load: &[(usize, f64)]) -> Vec<SVector<f64, 6>> {
        let mut x = vec![0.0; self.unknowns()];
        load.iter().for_each(|&(k, value)| x[k] += value);
        self.solver().solve(&mut x);
        self.body_motions(&x)
    }

    /// Motion of the references of all bodies by the scaled unknowns.
    pub(crate) fn body_motions(&self, x: &[f64]) -> Vec<SVector<f64, 6>> {
        let numbering = &self.stiffness.numbering;
        let mut motions = vec![SVector::<f64, 6>::zeros(); self.bodies.list.len()];
        for ((&value, &column), &scale) in x.iter().zip(&numbering.column).zip(&numbering.scale) {
            motions[column / 6][column % 6] = value * scale;
        }
        motions
            .iter()
            .zip(&self.bodies.list)
            .map(|(motion, body)| body.basis * motion)
            .collect()
    }

    /// Refuses a certificate that does not meet the accuracy.
    pub(crate) fn require(&self, certificate: Certificate) -> Result<Certificate, Error> {
        if certificate.error_bound <= self.accuracy {
            return Ok(certificate);
        }
        Err(ill_conditioned(
            certificate,
            self.accuracy,
            &self.stiffness,
            &self.bodies,
        ))
    }

    /// Unknown of a column of the bodies, if it is one.
    pub(crate) fn unknown(&self, column: usize) -> Option<usize> {
        self.stiffness.numbering.unknown[column]
    }

    /// Scale of an unknown.
    pub(crate) fn scale(&self, unknown: usize) -> f64 {
        self.stiffness.numbering.scale[unknown]
    }

    /// Products of all pairs of scaled loads.
    pub(crate) fn gram(&self, loads: &[SparseLoad]) -> Gram {
        self.solver().gram(loads)
    }

    /// The six displacements and rotations of a point.
    pub(crate) fn point(&self, point: usize) -> [Combination; 6] {
        self.bodies
            .combinations(point, &self.bodies.motion(point, &Vector3::zeros()))
    }
}

/// Refuses a station that no segment covers.
fn check_coverage(line: &Rails, rails: &[Rail]) -> Result<(), Error> {
    for (rail, given) in rails.iter().enumerate() {
        for (station, &x) in given.stations.iter().enumerate() {
            let probe = Probe {
                rail,
                x,
                axis: Axis::Vertical,
            };
            if let Err(splines::Error::OffRail { .. }) = line.row(probe) {
                let item = ModelEntry::Station { rail, station };
                return Err(Error::Invalid {
                    entry: item,
                    fault: EntryFault::Uncovered { x },
                });
            }
        }
    }
    Ok(())
}
