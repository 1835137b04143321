//! A frame, factored once.

use std::sync::Arc;

use nalgebra::{SVector, Vector3};
use splines::{Axis, Line, Probe};

use crate::assembly::Assembly;
use crate::certificate::Certificate;
use crate::element::Element;
use crate::error::{Error, Fault, Item, Quantity};
use crate::factor::{Factor, Refusal, Tail};
use crate::freedoms::{Freedoms, Sum};
use crate::mechanism::{PIVOT, PIVOT_EXTENDED, weakest};
use crate::memory::allow;
use crate::model::{Freedom, Model};
use crate::rail::{Rail, lay};
use crate::real::Extended;
use crate::solver::Solver;

/// Error bound that a frame must meet where nothing else is asked.
pub const ACCURACY: f64 = 1e-6;
/// Share of the accuracy that the factor may use up in doubles; evaluation needs some.
const ROOM: f64 = 0.9;
/// Operations beyond which double-doubles take minutes.
const LONG: f64 = 1e10;
/// Unknowns up to which double-doubles cost next to nothing and are always used.
const SMALL: usize = 100;

/// A model and its rails, numbered, assembled and factored: answers any number of questions.
#[derive(Debug)]
pub struct Frame {
    pub(crate) elements: Vec<Element>,
    pub(crate) freedoms: Freedoms,
    assembly: Assembly,
    pub(crate) solver: Solver,
    certificate: Certificate,
    /// Bound of |(S K S)^-1|.
    pub(crate) inverse: f64,
    /// Error bound asked.
    pub(crate) accuracy: f64,
    line: Option<Arc<Line>>,
    states: Vec<[Sum; 6]>,
}

impl Frame {
    /// Checks, assembles and factors. Freedoms that nothing stiffens are left out.
    ///
    /// # Errors
    /// An entry that cannot be used; a mechanism, by point and freedom; a stiffness so badly
    /// conditioned that no digit can be trusted.
    pub fn new(m: &Model, rails: &[Rail]) -> Result<Frame, Error> {
        Frame::accurate(m, rails, ACCURACY)
    }

    /// The same, with compliances whose error bound is at most `accuracy`, relative: in doubles where that
    /// suffices, else in double-doubles formed from the model anew.
    ///
    /// # Errors
    /// As [`Frame::new`].
    pub fn accurate(m: &Model, rails: &[Rail], accuracy: f64) -> Result<Frame, Error> {
        m.check()?;
        let elements: Vec<Element> =
            (0..m.members.len()).map(|index| Element::new(m, index)).collect::<Result<_, _>>()?;
        let freedoms = Freedoms::new(m);
        let layout = if rails.is_empty() { None } else { Some(lay(m, rails, &elements, &freedoms)?) };
        if let Some(layout) = &layout {
            covered(&layout.line, rails)?;
        }
        let assembly = Assembly::new(m, &elements, &freedoms);
        let (solver, certificate, inverse) = certified(m, &assembly, &freedoms, accuracy)?;
        let (line, states) = match layout {
            Some(layout) => (Some(Arc::new(layout.line)), layout.states),
            None => Default::default(),
        };
        Ok(Frame { elements, freedoms, assembly, solver, certificate, inverse, accuracy, line, states })
    }

    /// How far compliances of this frame can be trusted.
    #[must_use]
    pub fn certificate(&self) -> Certificate {
        self.certificate
    }

    /// Bytes of the factor.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.solver.bytes()
    }

    /// Number of unknown freedoms.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        self.solver.len()
    }

    /// The cells of the rails; state k of the line is state k of the surface.
    ///
    /// # Errors
    /// The frame has no rail.
    pub fn line(&self) -> Result<&Arc<Line>, Error> {
        self.line.as_ref().ok_or(Error::NoRails)
    }

    /// Whether the structure resists forces along `axis` everywhere on `rail`.
    #[must_use]
    pub fn available(&self, rail: usize, axis: Axis) -> bool {
        let Some(line) = &self.line else { return false };
        let mut cells = line.cells().iter().filter(|cell| cell.rail == rail).peekable();
        cells.peek().is_some()
            && cells.all(|cell| {
                let [a, b] = cell.x;
                [a + 0.25 * (b - a), 0.5 * (a + b), b - 0.25 * (b - a)]
                    .into_iter()
                    .all(|x| self.load(Probe { rail, x, axis }).is_ok())
            })
    }

    pub(crate) fn states(&self) -> &[[Sum; 6]] {
        &self.states
    }

    /// Shape row of a probe over the motions of the bodies, and its cell.
    pub(crate) fn row(&self, probe: Probe) -> Result<(Sum, usize), Error> {
        let row = self.line()?.row(probe)?;
        let mut sum = Sum::default();
        for (&index, &value) in row.indices().iter().zip(row.values()) {
            sum.add_scaled(&self.states[index / 6][index % 6], value);
        }
        Ok((sum, row.cell))
    }

    /// Scaled load of a unit force at a probe, and its cell.
    pub(crate) fn load(&self, probe: Probe) -> Result<(Vec<(usize, f64)>, usize), Error> {
        let (sum, cell) = self.row(probe)?;
        let Probe { rail, x, axis } = probe;
        let load = self.scaled(&sum).ok_or(splines::Error::Unstiffened { rail, x, axis })?;
        Ok((load, cell))
    }

    /// A sum over motions of the bodies as a load on the scaled unknowns; `None` where a freedom that
    /// nothing stiffens takes part.
    pub(crate) fn scaled(&self, sum: &Sum) -> Option<Vec<(usize, f64)>> {
        let mut load = Vec::with_capacity(sum.terms.len());
        for (column, value) in self.freedoms.supported(sum).significant() {
            let k = self.assembly.numbering.unknown[column]?;
            load.push((k, value * self.assembly.numbering.scale[k]));
        }
        Some(load)
    }

    /// A sum over motions of the bodies as a load on the scaled unknowns, less what acts on freedoms that
    /// nothing stiffens.
    pub(crate) fn stiffened(&self, sum: &Sum) -> Vec<(usize, f64)> {
        let supported = self.freedoms.supported(sum);
        let known = supported.significant().filter_map(|(column, value)| {
            let k = self.assembly.numbering.unknown[column]?;
            Some((k, value * self.assembly.numbering.scale[k]))
        });
        known.collect()
    }

    /// Motion of the references of all bodies, six each, under a scaled load.
    pub(crate) fn motions(&self, load: &[(usize, f64)]) -> Vec<SVector<f64, 6>> {
        let mut x = vec![0.0; self.solver.len()];
        load.iter().for_each(|&(k, value)| x[k] += value);
        self.solver.solve(&mut x);
        let mut motions = vec![SVector::<f64, 6>::zeros(); self.freedoms.bodies.len()];
        for (k, value) in x.into_iter().enumerate() {
            let column = self.assembly.numbering.column[k];
            motions[column / 6][column % 6] = value * self.assembly.numbering.scale[k];
        }
        motions.iter().zip(&self.freedoms.bodies).map(|(motion, body)| body.basis * motion).collect()
    }

    /// Refuses a certificate that is worse than asked.
    pub(crate) fn meets(&self, certificate: Certificate) -> Result<Certificate, Error> {
        if certificate.error_bound <= self.accuracy {
            return Ok(certificate);
        }
        Err(ill(certificate, self.accuracy, &self.assembly, &self.freedoms))
    }

    /// Unknown of a column of the bodies, if it is one.
    pub(crate) fn unknown(&self, column: usize) -> Option<usize> {
        self.assembly.numbering.unknown[column]
    }

    /// Scale of an unknown.
    pub(crate) fn scale(&self, unknown: usize) -> f64 {
        self.assembly.numbering.scale[unknown]
    }

    pub(crate) fn forward(&self, loads: &[Vec<(usize, f64)>]) -> Vec<Tail> {
        self.solver.forward(loads)
    }

    /// Six sums of a point's own freedoms.
    pub(crate) fn point(&self, point: usize) -> [Sum; 6] {
        let motion = self.freedoms.motion(point, &Vector3::zeros());
        let columns = 6 * self.freedoms.body[point];
        Freedom::ALL.map(|freedom| {
            let mut sum = Sum::default();
            (0..6).for_each(|k| sum.add(columns + k, motion[(freedom as usize, k)]));
            sum
        })
    }
}

/// Factors in doubles, or in double-doubles where the bound demands it.
fn certified(
    m: &Model,
    assembly: &Assembly,
    freedoms: &Freedoms,
    accuracy: f64,
) -> Result<(Solver, Certificate, f64), Error> {
    let unknowns = assembly.numbering.column.len();
    if !assembly.norm().is_finite() {
        return Err(Error::Factor { unknowns });
    }
    let long = assembly.numbering.operations > LONG;
    if unknowns > SMALL {
        match Factor::new(&assembly.upper) {
            Ok(factor) if factor.least_pivot() > PIVOT => {
                let (certificate, inverse) = Certificate::new(assembly, &factor);
                if certificate.error_bound <= ROOM * accuracy {
                    return Ok((Solver::Double(factor), certificate, inverse));
                }
                if long {
                    return Err(ill(certificate, accuracy, assembly, freedoms));
                }
            }
            Ok(_) | Err(Refusal::Indefinite) if long => return Err(mechanism(assembly, freedoms)),
            Ok(_) | Err(Refusal::Indefinite) => {}
            Err(Refusal::Size(entries)) => return Err(oversize(unknowns, entries, DOUBLE)),
        }
    }
    let extended = Assembly::<Extended>::again(m, &assembly.numbering)?;
    let factor = match Factor::new(&extended.upper) {
        Ok(factor) if factor.least_pivot() > PIVOT_EXTENDED => factor,
        Ok(_) | Err(Refusal::Indefinite) => return Err(mechanism(assembly, freedoms)),
        Err(Refusal::Size(entries)) => return Err(oversize(unknowns, entries, 2 * DOUBLE)),
    };
    let (certificate, inverse) = Certificate::new(&extended, &factor);
    if certificate.error_bound > accuracy {
        return Err(ill(certificate, accuracy, assembly, freedoms));
    }
    Ok((Solver::Extended(factor), certificate, inverse))
}

/// Bytes of a double.
const DOUBLE: u64 = size_of::<f64>() as u64;

/// A factor of too many entries, or of indices that run out.
fn oversize(unknowns: usize, entries: u64, size: u64) -> Error {
    allow(Quantity::Factor, entries, size).err().unwrap_or(Error::Factor { unknowns })
}

/// A stiffness without a factor.
fn mechanism(assembly: &Assembly, freedoms: &Freedoms) -> Error {
    let (point, freedom) = weakest(assembly, freedoms);
    Error::Mechanism { point, freedom }
}

/// An error bound above the accuracy asked.
fn ill(certificate: Certificate, asked: f64, assembly: &Assembly, freedoms: &Freedoms) -> Error {
    let (point, freedom) = weakest(assembly, freedoms);
    let Certificate { condition, error_bound: bound, .. } = certificate;
    Error::Ill { condition, bound, asked, point, freedom }
}

fn covered(line: &Line, rails: &[Rail]) -> Result<(), Error> {
    for (rail, given) in rails.iter().enumerate() {
        for (station, &x) in given.stations.iter().enumerate() {
            let probe = Probe { rail, x, axis: Axis::Vertical };
            if let Err(splines::Error::OffRail { .. }) = line.row(probe) {
                let item = Item::Station { rail, station };
                return Err(Error::Invalid { item, fault: Fault::Uncovered { x } });
            }
        }
    }
    Ok(())
}

impl Frame {
    /// The scaled stiffness and its factor.
    pub(crate) fn system(&self) -> (&Assembly, &Solver) {
        (&self.assembly, &self.solver)
    }
}
