//! Data set to model.

use super::fields::Fields;
use super::load::{Kind, Law, Load};
use super::names::{Compiler, Symbols};
use super::{Beam, Constraint, Diff, Marker, Model, Owner, Part, Request, Slot, constraint, order, units};
use crate::code::Code;
use crate::interpolation::{Family, Method};
use crate::{DataSet, Error, Fault, Statement, expression, tables};
use std::collections::{BTreeMap, BTreeSet};

/// Statements that say how to solve, draw and print, and change no force.
const SILENT: &[&str] = &[
    "DEBUG",
    "EQUILIBRIUM",
    "GRAPHICS",
    "IC",
    "INTEGRATOR",
    "KINEMATICS",
    "LSOLVER",
    "MATERIAL",
    "OUTPUT",
    "PREFERENCES",
    "RESULTS",
];

const EXECUTED: &[&str] = &[
    "ACCGRAV", "BEAM", "DIFF", "GFORCE", "JOINT", "JPRIM", "MARKER", "MOTION", "PART", "REQUEST", "SFORCE",
    "SPLINE", "UNITS", "VARIABLE", "VFORCE",
];

/// What is being built.
struct Build<'a> {
    set: &'a DataSet,
    symbols: Symbols,
    model: Model,
    /// Expressions to compile once every name is known: slot or, for requests and motions, another place.
    pending: Vec<Pending<'a>>,
}

struct Pending<'a> {
    statement: &'a Statement,
    argument: &'static str,
    target: Target,
}

enum Target {
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
    fn each(&self, keyword: &str) -> impl Iterator<Item = Fields<'a>> + use<'a> {
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

    fn marker(&self, fields: &Fields<'_>, name: &str) -> Result<Option<usize>, Error> {
        let Some(id) = fields.reference(name)? else { return Ok(None) };
        let found = self.symbols.markers.get(&id).copied();
        found.map(Some).ok_or_else(|| missing(fields, "MARKER", id))
    }

    fn needed(&self, fields: &Fields<'_>, name: &str) -> Result<usize, Error> {
        self.marker(fields, name)?.ok_or_else(|| fields.lacks(name))
    }

    /// A new slot for the expression of an argument.
    fn slot(&mut self, fields: &Fields<'a>, argument: &'static str, owner: Owner) -> Result<usize, Error> {
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

    fn loads(&mut self) -> Result<(), Error> {
        for kind in [Kind::Sforce, Kind::Vforce, Kind::Gforce, Kind::Beam] {
            for fields in self.each(kind.keyword()) {
                let index = self.model.loads.len();
                let id = fields.id()?;
                let i = self.needed(&fields, "I")?;
                let other = if matches!(kind, Kind::Vforce | Kind::Gforce) { "JFLOAT" } else { "J" };
                let j = self.needed(&fields, other)?;
                if self.model.markers[i].floating || (other == "J" && self.model.markers[j].floating) {
                    return Err(fields.fault(Fault::Floating));
                }
                let law = match kind {
                    Kind::Beam => Law::Beam(Box::new(Beam::read(&fields)?)),
                    Kind::Sforce => {
                        let slot = self.slot(&fields, "FUNCTION", Owner::Load(index, 0))?;
                        let alone = fields.flag("ACTIONONLY");
                        let twists = fields.one_of(&["TRANSLATIONAL", "ROTATIONAL"])? == Some("ROTATIONAL");
                        if twists { Law::Twist { slot, alone } } else { Law::Line { slot, alone } }
                    }
                    Kind::Vforce | Kind::Gforce => self.components(&fields, index, i, j)?,
                };
                self.symbols.loads.insert((kind, id), index);
                self.model.loads.push(Load { kind, id, i, j, law });
            }
        }
        Ok(())
    }

    fn components(&mut self, fields: &Fields<'a>, index: usize, i: usize, j: usize) -> Result<Law, Error> {
        let floating = &mut self.model.markers[j];
        if !floating.floating || floating.follows.replace(i).is_some() {
            return Err(fields.fault(Fault::Floating));
        }
        let rm = self.needed(fields, "RM")?;
        if self.model.markers[rm].floating {
            return Err(fields.fault(Fault::Floating));
        }
        let mut slots = [None; 6];
        for (k, name) in ["FX", "FY", "FZ", "TX", "TY", "TZ"].into_iter().enumerate() {
            if fields.flag(name) {
                slots[k] = Some(self.slot(fields, name, Owner::Load(index, k))?);
            }
        }
        if fields.flag("FUNCTION") {
            return Err(fields.fault(Fault::Unsupported));
        }
        if slots.iter().all(Option::is_none) {
            return Err(fields.lacks("FX"));
        }
        Ok(Law::Components { slots, rm })
    }

    fn constraints(&mut self) -> Result<(), Error> {
        const JOINTS: &[&str] = &[
            "REVOLUTE",
            "TRANSLATIONAL",
            "FIXED",
            "PLANAR",
            "CYLINDRICAL",
            "SPHERICAL",
            "HOOKE",
            "UNIVERSAL",
            "CONVEL",
            "SCREW",
            "RACKPIN",
        ];
        const PRIMITIVES: &[&str] =
            &["ATPOINT", "INLINE", "INPLANE", "ORIENTATION", "PARALLEL_AXES", "PERPENDICULAR"];
        for (keyword, kinds) in [("JOINT", JOINTS), ("JPRIM", PRIMITIVES)] {
            for fields in self.each(keyword) {
                let kind = fields.one_of(kinds)?.ok_or_else(|| fields.fault(Fault::Type))?;
                let (i, j) = (self.needed(&fields, "I")?, self.needed(&fields, "J")?);
                let equations = constraint::equations(kind);
                if equations.is_empty() {
                    return Err(fields.fault(Fault::Unsupported));
                }
                self.constrain(keyword, &fields, [i, j], equations, None)?;
            }
        }
        for fields in self.each("MOTION") {
            let (markers, equation) = self.motion(&fields)?;
            let level = fields.one_of(&["DISPLACEMENT", "VELOCITY", "ACCELERATION"])?;
            let start = match level {
                Some("VELOCITY") => Some(fields.number("ICDISP")?.unwrap_or(0.0)),
                Some("ACCELERATION") => return Err(fields.fault(Fault::Unsupported)),
                _ => None,
            };
            let drive = constraint::Drive { code: Code::Number(0.0), start };
            let index = self.constrain("MOTION", &fields, markers, vec![equation], Some(drive))?;
            let target = Target::Drive(index);
            self.pending.push(Pending { statement: fields.statement, argument: "FUNCTION", target });
        }
        Ok(())
    }

    fn constrain(
        &mut self,
        keyword: &'static str,
        fields: &Fields<'_>,
        [i, j]: [usize; 2],
        equations: Vec<constraint::Equation>,
        drive: Option<constraint::Drive>,
    ) -> Result<usize, Error> {
        let (id, index) = (fields.id()?, self.model.constraints.len());
        if self.model.markers[i].floating || self.model.markers[j].floating {
            return Err(fields.fault(Fault::Floating));
        }
        self.symbols.constraints.insert((keyword, id), index);
        self.model.constraints.push(Constraint { keyword, id, i, j, equations, drive });
        Ok(index)
    }

    /// Markers and equation of a motion: of a joint, or between two markers.
    fn motion(&self, fields: &Fields<'_>) -> Result<([usize; 2], constraint::Equation), Error> {
        use constraint::Equation::{About, Along};
        if let Some(joint) = fields.reference("JOINT")? {
            let found = self.symbols.constraints.get(&("JOINT", joint));
            let index = *found.ok_or_else(|| missing(fields, "JOINT", joint))?;
            let joint = &self.model.constraints[index];
            let turns = !joint.equations.contains(&constraint::Equation::Normal(0, 1));
            let slides = !joint.equations.contains(&Along(2));
            let kind = match fields.one_of(&["ROTATIONAL", "TRANSLATIONAL"])? {
                Some("ROTATIONAL") if turns => About,
                Some("TRANSLATIONAL") if slides => Along(2),
                None if turns != slides => {
                    if turns {
                        About
                    } else {
                        Along(2)
                    }
                }
                _ => return Err(fields.fault(Fault::Type)),
            };
            return Ok(([joint.i, joint.j], kind));
        }
        let markers = [self.needed(fields, "I")?, self.needed(fields, "J")?];
        let equation = match fields.one_of(&["X", "Y", "Z", "B1", "B2", "B3"])? {
            Some("X") => Along(0),
            Some("Y") => Along(1),
            Some("Z") => Along(2),
            Some(_) => return Err(fields.fault(Fault::Unsupported)),
            None => return Err(fields.fault(Fault::Type)),
        };
        Ok((markers, equation))
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

fn missing(fields: &Fields<'_>, keyword: &str, id: u32) -> Error {
    fields.fault(Fault::Missing { keyword: keyword.to_owned(), id })
}
