//! Data set to model.

use super::fields::Fields;
use super::names::{Compiler, Symbols};
use super::{Diff, Marker, Model, Owner, Part, Request, Slot, order, units};
use crate::code::Code;
use crate::interpolation::{Family, Method};
use crate::{DataSet, Error, Fault, Statement, expression, tables};
use std::collections::{BTreeMap, BTreeSet};

/// Statements that say how to solve, draw and print, and values that only statements which are not executed read.
const SILENT: &[&str] = &[
    "ARRAY",
    "DEBUG",
    "EQUILIBRIUM",
    "GRAPHICS",
    "IC",
    "INTEGRATOR",
    "KINEMATICS",
    "LIST",
    "LSOLVER",
    "MATERIAL",
    "MATRIX",
    "OUTPUT",
    "PREFERENCES",
    "RESULTS",
    "STRING",
];

const EXECUTED: &[&str] = &[
    "ACCGRAV", "BEAM", "DIFF", "GFORCE", "JOINT", "JPRIM", "MARKER", "MOTION", "PART", "REQUEST", "SFORCE",
    "SPLINE", "UNITS", "VARIABLE", "VFORCE",
];

/// What is being built.
pub(super) struct Build<'a> {
    set: &'a DataSet,
    pub symbols: Symbols,
    pub model: Model,
    /// Expressions to compile once every name is known: slot or, for requests and motions, another place.
    pub pending: Vec<Pending<'a>>,
}

/// An expression to compile, and where its code goes.
pub(super) struct Pending<'a> {
    pub statement: &'a Statement,
    pub argument: &'static str,
    pub target: Target,
}

/// Where the code of an expression goes.
pub(super) enum Target {
    Slot(usize),
    Drive(usize),
    Request(usize, usize),
}

impl Model {
    /// A data set with every reference resolved.
    ///
    /// # Errors
    /// [`Error::Statement`] and [`Error::In`] by keyword and identifier: statements that are not executed;
    /// arguments that are missing or given something else; references to what is not there; expressions that
    /// cannot be parsed, with names that are not known, or with a number of arguments that a function has not.
    pub fn new(set: &DataSet) -> Result<Model, Error> {
        let mut build = Build {
            set,
            symbols: Symbols::default(),
            model: Model {
                parts: Vec::new(),
                markers: Vec::new(),
                loads: Vec::new(),
                constraints: Vec::new(),
                slots: Vec::new(),
                diffs: Vec::new(),
                requests: Vec::new(),
                families: Vec::new(),
                splines: Vec::new(),
                gravity: [0.0; 3],
                order: Vec::new(),
                symbols: Symbols::default(),
            },
            pending: Vec::new(),
        };
        build.kinds()?;
        build.bodies()?;
        build.scalars()?;
        build.loads()?;
        build.constraints()?;
        build.requests()?;
        build.compile()
    }
}

impl<'a> Build<'a> {
    pub fn each(&self, keyword: &str) -> impl Iterator<Item = Fields<'a>> + use<'a> {
        let keyword = keyword.to_owned();
        let all = self.set.statements.iter().filter(move |one| one.keyword == keyword);
        all.map(|statement| Fields { statement })
    }

    /// Only known statements, each identifier once.
    fn kinds(&self) -> Result<(), Error> {
        let mut seen = BTreeSet::new();
        for statement in &self.set.statements {
            let fields = Fields { statement };
            let keyword = statement.keyword.as_str();
            if !SILENT.contains(&keyword) && !EXECUTED.contains(&keyword) {
                return Err(fields.fault(Fault::Unsupported));
            }
            if let Some(id) = statement.id
                && !seen.insert((keyword, id))
            {
                return Err(fields.fault(Fault::Twice { id }));
            }
            if statement.get("ROUTINE").is_some() {
                return Err(fields.fault(Fault::Unsupported));
            }
        }
        Ok(())
    }

    fn bodies(&mut self) -> Result<(), Error> {
        let mut parts = BTreeMap::new();
        for fields in self.each("PART") {
            parts.insert(fields.id()?, self.model.parts.len());
            self.model.parts.push(Part::read(&fields)?);
        }
        for fields in self.each("MARKER") {
            let id = fields.reference("PART")?.ok_or_else(|| fields.lacks("PART"))?;
            let part = parts.get(&id).copied().ok_or_else(|| missing(&fields, "PART", id))?;
            self.symbols.markers.insert(fields.id()?, self.model.markers.len());
            self.model.markers.push(Marker::read(&fields, part)?);
        }
        for (k, fields) in self.each("PART").enumerate() {
            let cm = self.marker(&fields, "CM")?;
            if cm.is_some_and(|cm| self.model.markers[cm].part != k || self.model.markers[cm].floating) {
                return Err(fields.fault(Fault::Given { argument: "CM".to_owned() }));
            }
            self.model.parts[k].cm = cm;
        }
        let mut factor = 1.0;
        for fields in self.each("UNITS") {
            factor = units::factor(fields.statement)?;
        }
        for fields in self.each("ACCGRAV") {
            for (k, name) in ["IGRAV", "JGRAV", "KGRAV"].into_iter().enumerate() {
                self.model.gravity[k] = factor * fields.number(name)?.unwrap_or(0.0);
            }
        }
        for fields in self.each("SPLINE") {
            let spline = tables::of_statement(fields.statement)?;
            for method in [Method::Akima, Method::Natural] {
                let family = Family::new(&spline, method);
                let found = (self.model.families.len(), family.is_surface());
                self.symbols.families.insert((fields.id()?, method), found);
                self.model.families.push(family);
                self.model.splines.push(spline.id);
            }
        }
        Ok(())
    }

    pub fn marker(&self, fields: &Fields<'_>, name: &str) -> Result<Option<usize>, Error> {
        let Some(id) = fields.reference(name)? else { return Ok(None) };
        let found = self.symbols.markers.get(&id).copied();
        found.map(Some).ok_or_else(|| missing(fields, "MARKER", id))
    }

    pub fn needed(&self, fields: &Fields<'_>, name: &str) -> Result<usize, Error> {
        self.marker(fields, name)?.ok_or_else(|| fields.lacks(name))
    }

    /// A new slot for the expression of an argument.
    pub fn slot(
        &mut self,
        fields: &Fields<'a>,
        argument: &'static str,
        owner: Owner,
    ) -> Result<usize, Error> {
        let slot = self.model.slots.len();
        self.model.slots.push(Slot {
            owner,
            id: fields.id()?,
            code: Code::Number(0.0),
            implicit: matches!(owner, Owner::Rate(_)) && fields.flag("IMPLICIT"),
            guess: 0.0,
        });
        self.pending.push(Pending { statement: fields.statement, argument, target: Target::Slot(slot) });
        Ok(slot)
    }

    fn scalars(&mut self) -> Result<(), Error> {
        for fields in self.each("VARIABLE") {
            let slot = self.slot(&fields, "FUNCTION", Owner::Variable)?;
            self.model.slots[slot].guess = fields.number("IC")?.unwrap_or(0.0);
            self.symbols.variables.insert(fields.id()?, slot);
        }
        for fields in self.each("DIFF") {
            let (id, index) = (fields.id()?, self.model.diffs.len());
            let slot = self.slot(&fields, "FUNCTION", Owner::Rate(index))?;
            // IC is the state, and for implicit ones also a guess of its rate.
            let starts = fields.numbers("IC")?.unwrap_or_default();
            self.model.slots[slot].guess = starts.get(1).copied().unwrap_or(0.0);
            let start = starts.first().copied().unwrap_or(0.0);
            self.model.diffs.push(Diff { id, start, slot, hold: fields.flag("STATIC_HOLD") });
            self.symbols.diffs.insert(id, (index, slot));
        }
        Ok(())
    }

    fn requests(&mut self) -> Result<(), Error> {
        const COLUMNS: [&str; 8] = ["F1", "F2", "F3", "F4", "F5", "F6", "F7", "F8"];
        for fields in self.each("REQUEST") {
            let index = self.model.requests.len();
            let mut columns = Vec::new();
            for (k, name) in COLUMNS.into_iter().enumerate() {
                if fields.flag(name) {
                    let target = Target::Request(index, columns.len());
                    columns.push((k, Code::Number(0.0)));
                    self.pending.push(Pending { statement: fields.statement, argument: name, target });
                }
            }
            self.model.requests.push(Request { id: fields.id()?, columns });
        }
        Ok(())
    }

    fn compile(mut self) -> Result<Model, Error> {
        for Pending { statement, argument, target } in std::mem::take(&mut self.pending) {
            let fields = Fields { statement };
            let text = fields.function(argument)?.ok_or_else(|| fields.lacks(argument))?;
            let reactions = matches!(target, Target::Request(..));
            let compiler = Compiler { symbols: &self.symbols, reactions };
            let code = expression::parse(text).and_then(|tree| compiler.compile(&tree));
            let code = code.map_err(|(offset, fault)| Error::In {
                keyword: statement.keyword.clone(),
                id: statement.id.unwrap_or(0),
                argument: argument.to_owned(),
                offset,
                fault: Box::new(fault),
            })?;
            match target {
                Target::Slot(slot) => self.model.slots[slot].code = code,
                Target::Request(request, column) => self.model.requests[request].columns[column].1 = code,
                Target::Drive(constraint) => {
                    if let Some(drive) = &mut self.model.constraints[constraint].drive {
                        if drive.start.is_some() && !code.of_time() {
                            return Err(fields.fault(Fault::Unsupported));
                        }
                        drive.code = code;
                    }
                }
            }
        }
        let mut model = self.model;
        let needs: Vec<BTreeSet<usize>> = model
            .slots
            .iter()
            .map(|slot| {
                let mut out = BTreeSet::new();
                slot.code.needs(&model, &mut out);
                out
            })
            .collect();
        let implicit: Vec<bool> = model.slots.iter().map(|slot| slot.implicit).collect();
        let preferred: Vec<bool> = model.slots.iter().map(|slot| slot.owner == Owner::Variable).collect();
        model.order = order::order(&needs, &implicit, &preferred);
        model.symbols = self.symbols;
        Ok(model)
    }
}

pub(super) fn missing(fields: &Fields<'_>, keyword: &str, id: u32) -> Error {
    fields.fault(Fault::Missing { keyword: keyword.to_owned(), id })
}
