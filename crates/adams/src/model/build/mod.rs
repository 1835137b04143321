//! Construction of a model from the statements of a data set.
//!
//! Statements are read kind by kind, those that others refer to first. Expressions are compiled last, once
//! every identifier is known.

mod constraints;
mod context;
mod loads;
mod units;

use super::arguments::Arguments;
use super::compiler::{Compiler, Symbols};
use super::data::{AdamsModel, Diff, Owner, Request};
use super::formula::Formula;
use super::order;
use super::part::{Marker, Part};
use crate::tables::{SplineFunction, SplineMethod};
use crate::{AdamsFault, DataSet, Error, StatementId, expression, tables};
use context::{Build, Pending, Target, missing};
use std::collections::{BTreeMap, BTreeSet};

/// Statements without effect on a solution: settings of the solver and of output, and values that only
/// statements read which are not executed.
const IGNORED: &[&str] = &[
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

/// Statements that are executed.
const EXECUTED: &[&str] = &[
    "ACCGRAV", "BEAM", "DIFF", "GFORCE", "JOINT", "JPRIM", "MARKER", "MOTION", "PART", "REQUEST",
    "SFORCE", "SPLINE", "UNITS", "VARIABLE", "VFORCE",
];

impl AdamsModel {
    /// Resolves every reference of a data set.
    ///
    /// # Errors
    /// [`Error::Statement`] for statements that are not executed, arguments that are missing or have the
    /// wrong form, and references to statements that do not exist. [`Error::In`] for expressions that cannot
    /// be parsed, use unknown names, or call a function with a wrong number of arguments.
    pub fn new(set: &DataSet) -> Result<AdamsModel, Error> {
        let (symbols, model) = (Symbols::default(), AdamsModel::default());
        let mut build = Build {
            set,
            symbols,
            model,
            pending: Vec::new(),
        };
        build.check_kinds()?;
        build.parts()?;
        build.gravity()?;
        build.splines()?;
        build.variables()?;
        build.differential_equations()?;
        loads::read(&mut build)?;
        constraints::read(&mut build)?;
        build.requests()?;
        build.compile()
    }
}

impl<'a> Build<'a> {
    /// Checks that every kind of statement is known and every identifier is used once.
    fn check_kinds(&self) -> Result<(), Error> {
        let mut seen = BTreeSet::new();
        for statement in &self.set.statements {
            let arguments = Arguments { statement };
            let keyword = statement.keyword.as_str();
            if !IGNORED.contains(&keyword) && !EXECUTED.contains(&keyword) {
                return Err(arguments.fault(AdamsFault::Unsupported));
            }
            if let Some(id) = statement.id
                && !seen.insert((keyword, id))
            {
                return Err(arguments.fault(AdamsFault::DuplicateId { id }));
            }
            if statement.get("ROUTINE").is_some() {
                return Err(arguments.fault(AdamsFault::Unsupported));
            }
        }
        Ok(())
    }

    /// PART and MARKER. Markers name their part, and parts name the marker at their centre of mass.
    fn parts(&mut self) -> Result<(), Error> {
        let mut parts = BTreeMap::new();
        for arguments in self.each("PART") {
            parts.insert(arguments.id()?, self.model.parts.len());
            self.model.parts.push(Part::read(&arguments)?);
        }
        for arguments in self.each("MARKER") {
            let id = arguments
                .reference("PART")?
                .ok_or_else(|| arguments.missing_argument("PART"))?;
            let part = parts
                .get(&id)
                .copied()
                .ok_or_else(|| missing(&arguments, "PART", id))?;
            self.symbols
                .markers
                .insert(arguments.id()?, self.model.markers.len());
            self.model.markers.push(Marker::read(&arguments, part)?);
        }
        for (k, arguments) in self.each("PART").enumerate() {
            let cm = self.marker(&arguments, "CM")?;
            if cm.is_some_and(|cm| {
                self.model.markers[cm].part != k || self.model.markers[cm].floating
            }) {
                return Err(arguments.wrong_form("CM"));
            }
            self.model.parts[k].cm = cm;
        }
        Ok(())
    }

    /// UNITS and ACCGRAV.
    fn gravity(&mut self) -> Result<(), Error> {
        let mut factor = 1.0;
        for arguments in self.each("UNITS") {
            factor = units::force_of_mass(&arguments)?;
        }
        for arguments in self.each("ACCGRAV") {
            for (k, name) in ["IGRAV", "JGRAV", "KGRAV"].into_iter().enumerate() {
                self.model.gravity[k] = factor * arguments.number(name)?.unwrap_or(0.0);
            }
        }
        Ok(())
    }

    /// SPLINE, once for AKISPL and once for CUBSPL.
    fn splines(&mut self) -> Result<(), Error> {
        for arguments in self.each("SPLINE") {
            let spline = tables::of_statement(arguments.statement)?;
            for method in [SplineMethod::Akima, SplineMethod::Natural] {
                let family = SplineFunction::new(&spline, method);
                let found = (self.model.families.len(), family.is_surface());
                self.symbols
                    .families
                    .insert((arguments.id()?, method), found);
                self.model.families.push(family);
                self.model.splines.push(spline.id);
            }
        }
        Ok(())
    }

    /// VARIABLE.
    fn variables(&mut self) -> Result<(), Error> {
        for arguments in self.each("VARIABLE") {
            let slot = self.slot(&arguments, "FUNCTION", Owner::Variable)?;
            self.model.slots[slot].guess = arguments.number("IC")?.unwrap_or(0.0);
            self.symbols.variables.insert(arguments.id()?, slot);
        }
        Ok(())
    }

    /// DIFF.
    fn differential_equations(&mut self) -> Result<(), Error> {
        for arguments in self.each("DIFF") {
            let (id, index) = (arguments.id()?, self.model.diffs.len());
            let slot = self.slot(&arguments, "FUNCTION", Owner::Rate(index))?;
            // IC is the initial value of DIF; an implicit DIFF may also give a guess of DIF1.
            let starts = arguments.numbers("IC")?.unwrap_or_default();
            self.model.slots[slot].guess = starts.get(1).copied().unwrap_or(0.0);
            let start = starts.first().copied().unwrap_or(0.0);
            self.model.diffs.push(Diff {
                id,
                start,
                slot,
                hold: arguments.flag("STATIC_HOLD"),
            });
            self.symbols.diffs.insert(id, (index, slot));
        }
        Ok(())
    }

    /// REQUEST.
    fn requests(&mut self) -> Result<(), Error> {
        const COLUMNS: [&str; 8] = ["F1", "F2", "F3", "F4", "F5", "F6", "F7", "F8"];
        for arguments in self.each("REQUEST") {
            let index = self.model.requests.len();
            let mut columns = Vec::new();
            for (k, name) in COLUMNS.into_iter().enumerate() {
                if arguments.flag(name) {
                    let target = Target::Request(index, columns.len());
                    columns.push((k, Formula::Number(0.0)));
                    self.pending.push(Pending {
                        statement: arguments.statement,
                        argument: name,
                        target,
                    });
                }
            }
            self.model.requests.push(Request {
                id: arguments.id()?,
                columns,
            });
        }
        Ok(())
    }

    /// Compiles the expressions and orders the slots.
    fn compile(mut self) -> Result<AdamsModel, Error> {
        for Pending {
            statement,
            argument,
            target,
        } in std::mem::take(&mut self.pending)
        {
            let arguments = Arguments { statement };
            let text = arguments
                .function(argument)?
                .ok_or_else(|| arguments.missing_argument(argument))?;
            let reactions = matches!(target, Target::Request(..));
            let compiler = Compiler {
                symbols: &self.symbols,
                reactions,
            };
            let formula = expression::parse(text).and_then(|tree| compiler.compile(&tree));
            let formula = formula.map_err(|(offset, fault)| Error::In {
                statement: StatementId::new(&statement.keyword, statement.id.unwrap_or(0)),
                argument,
                offset,
                fault: Box::new(fault),
            })?;
            match target {
                Target::Slot(slot) => self.model.slots[slot].formula = formula,
                Target::Request(request, column) => {
                    self.model.requests[request].columns[column].1 = formula
                }
                Target::Motion(constraint) => {
                    if let Some(motion) = &mut self.model.constraints[constraint].motion {
                        // A prescribed velocity is integrated over time, so it must not depend on anything
                        // else.
                        if motion.start.is_some() && !formula.is_function_of_time() {
                            return Err(arguments.fault(AdamsFault::Unsupported));
                        }
                        motion.formula = formula;
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
                slot.formula.needs(&model.loads, &mut out);
                out
            })
            .collect();
        let implicit: Vec<bool> = model.slots.iter().map(|slot| slot.implicit).collect();
        let preferred: Vec<bool> = model
            .slots
            .iter()
            .map(|slot| slot.owner == Owner::Variable)
            .collect();
        model.order = order::order(&needs, &implicit, &preferred);
        model.needs = needs;
        model.symbols = self.symbols;
        Ok(model)
    }
}
