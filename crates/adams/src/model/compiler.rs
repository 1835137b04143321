//! Compiler of expressions: names and identifiers are replaced by indices into the model.

use super::formula::Formula;
use super::load::LoadKind;
use crate::expression::functions::Function;
use crate::expression::{Expression, ExpressionName};
use crate::kinematics::Measure;
use crate::tables::SplineMethod;
use crate::{AdamsFault, StatementId};
use std::collections::BTreeMap;

/// The indices that identifiers refer to.
#[derive(Clone, Debug, Default)]
pub(crate) struct Symbols {
    pub markers: BTreeMap<u32, usize>,
    pub variables: BTreeMap<u32, usize>,
    /// Index of the DIFF, and slot of its DIF1.
    pub diffs: BTreeMap<u32, (usize, usize)>,
    pub loads: BTreeMap<(LoadKind, u32), usize>,
    pub constraints: BTreeMap<(&'static str, u32), usize>,
    /// Index of the family, and whether it depends on z.
    pub families: BTreeMap<(u32, SplineMethod), (usize, bool)>,
}

/// What is needed to compile an expression.
pub(super) struct Compiler<'a> {
    pub symbols: &'a Symbols,
    /// Whether reactions of joints may be read.
    pub reactions: bool,
}

type Compiled = Result<Formula, (usize, AdamsFault)>;

impl Compiler<'_> {
    /// Compiles an expression.
    ///
    /// # Errors
    /// The number of characters before the first name that is not known or not executed, and what is wrong
    /// with it.
    pub fn compile(&self, expression: &Expression) -> Compiled {
        match expression {
            Expression::Number(value) => Ok(Formula::Number(*value)),
            Expression::Name(name) => match name.word.as_str() {
                "TIME" => Ok(Formula::Time),
                "MODE" => Ok(Formula::Mode),
                "PI" => Ok(Formula::Number(std::f64::consts::PI)),
                "DTOR" => Ok(Formula::Number(std::f64::consts::PI / 180.0)),
                "RTOD" => Ok(Formula::Number(180.0 / std::f64::consts::PI)),
                _ => Err((
                    name.offset,
                    AdamsFault::Unknown {
                        name: name.word.clone(),
                    },
                )),
            },
            Expression::Sum(terms) => {
                let each = terms
                    .iter()
                    .map(|(sign, term)| Ok((*sign, self.compile(term)?)));
                Ok(Formula::Sum(each.collect::<Result<_, _>>()?))
            }
            Expression::Product(factors) => {
                let each = factors
                    .iter()
                    .map(|(factor, part)| Ok((*factor, self.compile(part)?)));
                Ok(Formula::Product(each.collect::<Result<_, _>>()?))
            }
            Expression::Power(base, exponent) => Ok(Formula::Power(
                Box::new(self.compile(base)?),
                Box::new(self.compile(exponent)?),
            )),
            Expression::Call(name, arguments) => self.call(name, arguments),
        }
    }

    /// A function call.
    fn call(&self, name: &ExpressionName, arguments: &[Expression]) -> Compiled {
        let word = name.word.as_str();
        let fault = |fault: AdamsFault| (name.offset, fault);
        if let Some((what, most)) = measure(word) {
            return self.measure(name, arguments, what, most);
        }
        if let Some((function, least, most)) = Function::find(word) {
            if !(least..=most).contains(&arguments.len()) {
                return Err(fault(AdamsFault::Arguments));
            }
            let all: Result<Vec<Formula>, _> =
                arguments.iter().map(|one| self.compile(one)).collect();
            return Ok(Formula::Call(function, all?));
        }
        match (word, arguments) {
            ("IF", [test, below, zero, above]) => {
                let all = [
                    self.compile(test)?,
                    self.compile(below)?,
                    self.compile(zero)?,
                    self.compile(above)?,
                ];
                Ok(Formula::Choice(Box::new(all)))
            }
            ("VARVAL", [id]) => {
                let id = whole(id, name)?;
                let slot = self.symbols.variables.get(&id).copied();
                slot.map(Formula::Slot)
                    .ok_or_else(|| fault(missing("VARIABLE", id)))
            }
            ("DIF" | "DIF1", [id]) => {
                let id = whole(id, name)?;
                let found = self.symbols.diffs.get(&id).copied();
                let (index, slot) = found.ok_or_else(|| fault(missing("DIFF", id)))?;
                Ok(if word == "DIF" {
                    Formula::Differential(index)
                } else {
                    Formula::Slot(slot)
                })
            }
            ("AKISPL", _) => self.spline(name, arguments, SplineMethod::Akima),
            ("CUBSPL", _) => self.spline(name, arguments, SplineMethod::Natural),
            (
                "SFORCE" | "VFORCE" | "GFORCE" | "BEAM" | "JOINT" | "JPRIM" | "MOTION",
                [id, rest @ ..],
            ) => self.force(name, id, rest),
            (
                "IF" | "VARVAL" | "DIF" | "DIF1" | "SFORCE" | "VFORCE" | "GFORCE" | "BEAM"
                | "JOINT" | "MOTION",
                _,
            ) => Err(fault(AdamsFault::Arguments)),
            _ => Err(fault(AdamsFault::Unknown {
                name: name.word.clone(),
            })),
        }
    }

    /// The index of a marker; the identifier zero is ground.
    fn marker(
        &self,
        argument: &Expression,
        name: &ExpressionName,
    ) -> Result<Option<usize>, (usize, AdamsFault)> {
        match whole(argument, name)? {
            0 => Ok(None),
            id => {
                let found = self.symbols.markers.get(&id).copied();
                found
                    .map(Some)
                    .ok_or_else(|| (name.offset, missing("MARKER", id)))
            }
        }
    }

    /// A kinematic function, DX to WM and AX to AZ.
    fn measure(
        &self,
        name: &ExpressionName,
        arguments: &[Expression],
        what: Measure,
        most: usize,
    ) -> Compiled {
        if arguments.is_empty() || arguments.len() > most {
            return Err((name.offset, AdamsFault::Arguments));
        }
        let mut markers = [None; 4];
        // VM and VR have no axes to be resolved in: their third marker is the frame of the derivative.
        let skips = matches!(what, Measure::Speed | Measure::RadialSpeed);
        for (k, argument) in arguments.iter().enumerate() {
            markers[if skips && k == 2 { 3 } else { k }] = self.marker(argument, name)?;
        }
        Ok(Formula::Measure(what, markers))
    }

    /// AKISPL or CUBSPL with the arguments (x, z, id, order).
    fn spline(
        &self,
        name: &ExpressionName,
        arguments: &[Expression],
        method: SplineMethod,
    ) -> Compiled {
        let fault = |fault: AdamsFault| (name.offset, fault);
        let (x, z, id, order) = match arguments {
            [x, z, id] => (x, z, id, 0),
            [x, z, id, order] => (x, z, id, whole(order, name)?),
            _ => return Err(fault(AdamsFault::Arguments)),
        };
        let id = whole(id, name)?;
        let found = self.symbols.families.get(&(id, method)).copied();
        let (family, surface) = found.ok_or_else(|| fault(missing("SPLINE", id)))?;
        if order > 0 && surface {
            return Err(fault(AdamsFault::Derivative));
        }
        if order > 2 {
            return Err(fault(AdamsFault::Arguments));
        }
        let (x, z) = (Box::new(self.compile(x)?), Box::new(self.compile(z)?));
        Ok(Formula::Spline {
            family,
            order: order as usize,
            x,
            z,
        })
    }

    /// A component of a force or reaction, with the arguments (id, jflag, comp, rm).
    fn force(&self, name: &ExpressionName, id: &Expression, rest: &[Expression]) -> Compiled {
        let fault = |fault: AdamsFault| (name.offset, fault);
        let id = whole(id, name)?;
        let (on_j, component, frame) = match rest {
            [on_j, component] => (on_j, component, None),
            [on_j, component, frame] => (on_j, component, self.marker(frame, name)?),
            _ => return Err(fault(AdamsFault::Arguments)),
        };
        let (on_j, component) = (whole(on_j, name)?, whole(component, name)? as usize);
        if on_j > 1 || !(1..=8).contains(&component) {
            return Err(fault(AdamsFault::Arguments));
        }
        let on_j = on_j == 1;
        let kind = match name.word.as_str() {
            "SFORCE" => LoadKind::Sforce,
            "VFORCE" => LoadKind::Vforce,
            "GFORCE" => LoadKind::Gforce,
            "BEAM" => LoadKind::Beam,
            word => {
                let all = &self.symbols.constraints;
                let found = all
                    .iter()
                    .find(|((keyword, other), _)| *keyword == word && *other == id);
                let (_, &constraint) = found.ok_or_else(|| fault(missing(word, id)))?;
                if !self.reactions {
                    return Err(fault(AdamsFault::Reaction));
                }
                return Ok(Formula::Reaction {
                    constraint,
                    on_j,
                    component,
                    frame,
                });
            }
        };
        let load = self
            .symbols
            .loads
            .get(&(kind, id))
            .copied()
            .ok_or_else(|| fault(missing(&name.word, id)))?;
        Ok(Formula::Load {
            load,
            on_j,
            component,
            frame,
        })
    }
}

/// The fault of a statement that does not exist.
fn missing(keyword: &str, id: u32) -> AdamsFault {
    AdamsFault::Missing {
        statement: StatementId::new(keyword, id),
    }
}

/// An identifier or another argument that must be a whole number, not an expression.
fn whole(argument: &Expression, name: &ExpressionName) -> Result<u32, (usize, AdamsFault)> {
    argument.whole().ok_or((name.offset, AdamsFault::Id))
}

/// The kinematic function of a name, DX to WM and AX to AZ, with its largest number of markers.
fn measure(word: &str) -> Option<(Measure, usize)> {
    let axis = match word.as_bytes() {
        [_, b'X'] => 0,
        [_, b'Y'] => 1,
        [_, b'Z'] => 2,
        _ => 3,
    };
    Some(match (word.as_bytes(), axis) {
        ([b'D', _], 0..=2) => (Measure::Displacement(axis), 3),
        ([b'V', _], 0..=2) => (Measure::Velocity(axis), 4),
        ([b'W', _], 0..=2) => (Measure::AngularVelocity(axis), 3),
        ([b'A', _], 0..=2) => (Measure::Angle(axis), 2),
        (b"DM", _) => (Measure::Distance, 2),
        (b"VM", _) => (Measure::Speed, 3),
        (b"VR", _) => (Measure::RadialSpeed, 3),
        (b"WM", _) => (Measure::AngularSpeed, 2),
        _ => return None,
    })
}
