//! Exit status by the verdict on a design or a run.

use formats::verdict::Verdict;

use crate::cli::FailOnLimit;
use crate::exit::{Exit, Failure};

/// The exit status of a command with this verdict.
///
/// # Errors
/// The verdict fails the command as asked.
pub fn exit(verdict: &Verdict, fail: Option<FailOnLimit>) -> Result<Exit, Failure> {
    let is_strict = fail == Some(FailOnLimit::Strict);
    match fail {
        Some(_) if !verdict.within() => Err(Failure::Differs(verdict.banner())),
        Some(_) if is_strict && verdict.is_incomplete() => {
            let missing = verdict.not_checked.iter().find(|one| one.code.is_some());
            let first = missing.map_or_else(String::new, |one| format!("; first: {one}"));
            Err(Failure::Differs(format!("{}{first}", verdict.banner())))
        }
        _ => Ok(Exit::Done),
    }
}
