//! The model under construction, and what the readers of all kinds of statements share.

use super::super::arguments::Arguments;
use super::super::compiler::Symbols;
use super::super::data::{AdamsModel, Owner, Slot};
use super::super::formula::Formula;
use crate::{AdamsFault, DataSet, Error, Statement, StatementId};

/// A model under construction.
pub(super) struct Build<'a> {
    pub set: &'a DataSet,
    pub symbols: Symbols,
    pub model: AdamsModel,
    /// Expressions to compile once every identifier is known.
    pub pending: Vec<Pending<'a>>,
}

/// An expression to compile, and the place of its formula.
pub(super) struct Pending<'a> {
    pub statement: &'a Statement,
    pub argument: &'static str,
    pub target: Target,
}

/// The place of a formula in the model.
pub(super) enum Target {
    /// A slot.
    Slot(usize),
    /// The prescribed motion of a constraint.
    Motion(usize),
    /// A request and the index of its column.
    Request(usize, usize),
}

impl<'a> Build<'a> {
    /// The statements of a kind.
    pub fn each(&self, keyword: &str) -> impl Iterator<Item = Arguments<'a>> + use<'a> {
        let keyword = keyword.to_owned();
        let all = self
            .set
            .statements
            .iter()
            .filter(move |one| one.keyword == keyword);
        all.map(|statement| Arguments { statement })
    }

    /// The index of the marker that an argument names.
    pub fn marker(
        &self,
        arguments: &Arguments<'_>,
        name: &'static str,
    ) -> Result<Option<usize>, Error> {
        let Some(id) = arguments.reference(name)? else {
            return Ok(None);
        };
        let found = self.symbols.markers.get(&id).copied();
        found
            .map(Some)
            .ok_or_else(|| missing(arguments, "MARKER", id))
    }

    /// The index of the marker that a required argument names.
    pub fn required_marker(
        &self,
        arguments: &Arguments<'_>,
        name: &'static str,
    ) -> Result<usize, Error> {
        self.marker(arguments, name)?
            .ok_or_else(|| arguments.missing_argument(name))
    }

    /// Adds a slot for the expression of an argument.
    pub fn slot(
        &mut self,
        arguments: &Arguments<'a>,
        argument: &'static str,
        owner: Owner,
    ) -> Result<usize, Error> {
        let slot = self.model.slots.len();
        self.model.slots.push(Slot {
            owner,
            id: arguments.id()?,
            formula: Formula::Number(0.0),
            implicit: matches!(owner, Owner::Rate(_)) && arguments.flag("IMPLICIT"),
            guess: 0.0,
        });
        self.pending.push(Pending {
            statement: arguments.statement,
            argument,
            target: Target::Slot(slot),
        });
        Ok(slot)
    }
}

/// The error of a reference to a statement that does not exist.
pub(super) fn missing(arguments: &Arguments<'_>, keyword: &str, id: u32) -> Error {
    arguments.fault(AdamsFault::Missing {
        statement: StatementId::new(keyword, id),
    })
}
