//! Names in expressions to what they mean.

use super::Kind;
use crate::Fault;
use crate::code::Code;
use crate::expression::{Expression, Name};
use crate::frame::Measure;
use crate::functions::Function;
use crate::interpolation::Method;
use std::collections::BTreeMap;

/// What identifiers refer to.
#[derive(Clone, Debug, Default)]
pub(crate) struct Symbols {
    pub markers: BTreeMap<u32, usize>,
    pub variables: BTreeMap<u32, usize>,
    /// Index and slot of DIF1.
    pub diffs: BTreeMap<u32, (usize, usize)>,
    pub loads: BTreeMap<(Kind, u32), usize>,
    pub constraints: BTreeMap<(&'static str, u32), usize>,
    /// Index among the families, and whether it is a surface.
    pub families: BTreeMap<(u32, Method), (usize, bool)>,
}

/// An expression on its way to code.
pub(super) struct Compiler<'a> {
    pub symbols: &'a Symbols,
    /// Reactions of joints may be read.
    pub reactions: bool,
}

type Compiled = Result<Code, (usize, Fault)>;

impl Compiler<'_> {
    /// # Errors
    /// What is not known or not executed, with the number of characters before it.
    pub fn compile(&self, expression: &Expression) -> Compiled {
        match expression {
            Expression::Number(value) => Ok(Code::Number(*value)),
            Expression::Name(name) => match name.word.as_str() {
                "TIME" => Ok(Code::Time),
                "MODE" => Ok(Code::Mode),
                "PI" => Ok(Code::Number(std::f64::consts::PI)),
                "DTOR" => Ok(Code::Number(std::f64::consts::PI / 180.0)),
                "RTOD" => Ok(Code::Number(180.0 / std::f64::consts::PI)),
                _ => Err((name.offset, Fault::Unknown { name: name.word.clone() })),
            },
            Expression::Sum(terms) => {
                let each = terms.iter().map(|(sign, term)| Ok((*sign, self.compile(term)?)));
                Ok(Code::Sum(each.collect::<Result<_, _>>()?))
            }
            Expression::Product(factors) => {
                let each = factors.iter().map(|(factor, part)| Ok((*factor, self.compile(part)?)));
                Ok(Code::Product(each.collect::<Result<_, _>>()?))
            }
            Expression::Power(base, exponent) => {
                Ok(Code::Power(Box::new(self.compile(base)?), Box::new(self.compile(exponent)?)))
            }
            Expression::Call(name, arguments) => self.call(name, arguments),
        }
    }

    fn call(&self, name: &Name, arguments: &[Expression]) -> Compiled {
        let word = name.word.as_str();
        let fault = |fault: Fault| (name.offset, fault);
        if let Some((what, most)) = measure(word) {
            return self.measure(name, arguments, what, most);
        }
        if let Some((function, least, most)) = Function::find(word) {
            if !(least..=most).contains(&arguments.len()) {
                return Err(fault(Fault::Arguments));
            }
            let all: Result<Vec<Code>, _> = arguments.iter().map(|one| self.compile(one)).collect();
            return Ok(Code::Call(function, all?));
        }
        match (word, arguments) {
            ("IF", [test, below, zero, above]) => {
                let all =
                    [self.compile(test)?, self.compile(below)?, self.compile(zero)?, self.compile(above)?];
                Ok(Code::Choice(Box::new(all)))
            }
            ("VARVAL", [id]) => {
                let id = whole(id, name)?;
                let slot = self.symbols.variables.get(&id).copied();
                slot.map(Code::Slot).ok_or_else(|| fault(missing("VARIABLE", id)))
            }
            ("DIF" | "DIF1", [id]) => {
                let id = whole(id, name)?;
                let found = self.symbols.diffs.get(&id).copied();
                let (index, slot) = found.ok_or_else(|| fault(missing("DIFF", id)))?;
                Ok(if word == "DIF" { Code::Differential(index) } else { Code::Slot(slot) })
            }
            ("AKISPL", _) => self.spline(name, arguments, Method::Akima),
            ("CUBSPL", _) => self.spline(name, arguments, Method::Natural),
            ("SFORCE" | "VFORCE" | "GFORCE" | "BEAM" | "JOINT" | "JPRIM" | "MOTION", [id, rest @ ..]) => {
                self.force(name, id, rest)
            }
            (
                "IF" | "VARVAL" | "DIF" | "DIF1" | "SFORCE" | "VFORCE" | "GFORCE" | "BEAM" | "JOINT"
                | "MOTION",
                _,
            ) => Err(fault(Fault::Arguments)),
            _ => Err(fault(Fault::Unknown { name: name.word.clone() })),
        }
    }

    /// A marker; zero is ground.
    fn marker(&self, argument: &Expression, name: &Name) -> Result<Option<usize>, (usize, Fault)> {
        match whole(argument, name)? {
            0 => Ok(None),
            id => {
                let found = self.symbols.markers.get(&id).copied();
                found.map(Some).ok_or_else(|| (name.offset, missing("MARKER", id)))
            }
        }
    }

    fn measure(&self, name: &Name, arguments: &[Expression], what: Measure, most: usize) -> Compiled {
        if arguments.is_empty() || arguments.len() > most {
            return Err((name.offset, Fault::Arguments));
        }
        let mut markers = [None; 4];
        // Speeds have no frame to be resolved in: the third marker is that of the derivative.
        let skips = matches!(what, Measure::Speed | Measure::Recession);
        for (k, argument) in arguments.iter().enumerate() {
            markers[if skips && k == 2 { 3 } else { k }] = self.marker(argument, name)?;
        }
        Ok(Code::Measure(what, markers))
    }

    fn spline(&self, name: &Name, arguments: &[Expression], method: Method) -> Compiled {
        let fault = |fault: Fault| (name.offset, fault);
        let (x, z, id, order) = match arguments {
            [x, z, id] => (x, z, id, 0),
            [x, z, id, order] => (x, z, id, whole(order, name)?),
            _ => return Err(fault(Fault::Arguments)),
        };
        let id = whole(id, name)?;
        let found = self.symbols.families.get(&(id, method)).copied();
        let (family, surface) = found.ok_or_else(|| fault(missing("SPLINE", id)))?;
        if order > 0 && surface {
            return Err(fault(Fault::Derivative));
        }
        if order > 2 {
            return Err(fault(Fault::Arguments));
        }
        let (x, z) = (Box::new(self.compile(x)?), Box::new(self.compile(z)?));
        Ok(Code::Spline { family, order: order as usize, x, z })
    }

    /// (id, jflag, comp, rm)
    fn force(&self, name: &Name, id: &Expression, rest: &[Expression]) -> Compiled {
        let fault = |fault: Fault| (name.offset, fault);
        let id = whole(id, name)?;
        let (on_j, component, frame) = match rest {
            [on_j, component] => (on_j, component, None),
            [on_j, component, frame] => (on_j, component, self.marker(frame, name)?),
            _ => return Err(fault(Fault::Arguments)),
        };
        let (on_j, component) = (whole(on_j, name)?, whole(component, name)? as usize);
        if on_j > 1 || !(1..=8).contains(&component) {
            return Err(fault(Fault::Arguments));
        }
        let on_j = on_j == 1;
        let kind = match name.word.as_str() {
            "SFORCE" => Kind::Sforce,
            "VFORCE" => Kind::Vforce,
            "GFORCE" => Kind::Gforce,
            "BEAM" => Kind::Beam,
            word => {
                let all = &self.symbols.constraints;
                let found = all.iter().find(|((keyword, other), _)| *keyword == word && *other == id);
                let (_, &constraint) = found.ok_or_else(|| fault(missing(word, id)))?;
                if !self.reactions {
                    return Err(fault(Fault::Reaction));
                }
                return Ok(Code::Reaction { constraint, on_j, component, frame });
            }
        };
        let load =
            self.symbols.loads.get(&(kind, id)).copied().ok_or_else(|| fault(missing(&name.word, id)))?;
        Ok(Code::Load { load, on_j, component, frame })
    }
}

fn missing(keyword: &str, id: u32) -> Fault {
    Fault::Missing { keyword: keyword.to_owned(), id }
}

/// An identifier or another number that must be whole and written out.
fn whole(argument: &Expression, name: &Name) -> Result<u32, (usize, Fault)> {
    argument.whole().ok_or((name.offset, Fault::Id))
}

/// DX to WM and AX to AZ, with the greatest number of markers.
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
        ([b'W', _], 0..=2) => (Measure::Spin(axis), 3),
        ([b'A', _], 0..=2) => (Measure::Angle(axis), 2),
        (b"DM", _) => (Measure::Distance, 2),
        (b"VM", _) => (Measure::Speed, 3),
        (b"VR", _) => (Measure::Recession, 3),
        (b"WM", _) => (Measure::SpinSpeed, 2),
        _ => return None,
    })
}
