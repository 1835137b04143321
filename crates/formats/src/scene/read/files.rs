//! Files to which a scene refers.

use crate::check::Check;
use crate::text::diagnostic::Diagnostic;
use crate::text::fault::Fault;
use crate::text::inputs::{Input, Inputs};
use crate::text::place::Place;

/// The files of a scene and their faults.
pub(in crate::scene) struct Files<'i> {
    inputs: &'i mut Inputs,
    /// The faults, each once.
    pub wrong: Vec<Diagnostic>,
}

impl<'i> Files<'i> {
    /// Starts without faults.
    pub fn of(inputs: &'i mut Inputs) -> Self {
        Files {
            inputs,
            wrong: Vec::new(),
        }
    }

    /// Applies `read` to the file named at a place; `None` if the file does not exist or has faults.
    pub fn read<'c, T>(
        &mut self,
        name: &str,
        at: &Place<'_>,
        check: &mut Check<'c>,
        read: impl FnOnce(&Input, &mut Check<'c>) -> Result<T, Vec<Diagnostic>>,
    ) -> Option<T> {
        let input = match self.inputs.open_referenced(name) {
            Ok(input) => input,
            Err(why) => {
                let fault = Fault::new(at, format!("\"{name}\" {why}"));
                check
                    .faults
                    .add(fault.hint("paths are relative to the scene's folder"));
                return None;
            }
        };
        match read(input, check) {
            Ok(found) => Some(found),
            Err(wrong) => {
                for one in wrong {
                    if !self.wrong.contains(&one) {
                        self.wrong.push(one);
                    }
                }
                None
            }
        }
    }
}
