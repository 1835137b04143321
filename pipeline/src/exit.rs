//! Exit statuses and failures of commands.

use std::process::ExitCode;

use anstyle::{AnsiColor, Effects};
use formats::spec::SolveError;
use formats::tables::WriteError;
use formats::text::diagnostic::{Diagnostic, plain};

/// Largest number of errors that are printed as text.
const MOST: usize = 20;

/// Exit status of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// The command succeeded.
    Done,
    /// A comparison failed, or nothing could be compared.
    Differs,
    /// The usage or the input is invalid, or a file cannot be read or written.
    Input,
    /// The results cannot be trusted: the structure is a mechanism, the certified error exceeds the tolerance, or the
    /// time step became too small.
    Untrusted,
}

impl Exit {
    /// Exit status as a number.
    #[must_use]
    pub const fn status(self) -> u8 {
        match self {
            Exit::Done => 0,
            Exit::Differs => 1,
            Exit::Input => 2,
            Exit::Untrusted => 3,
        }
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> ExitCode {
        ExitCode::from(exit.status())
    }
}

/// Reason why a command has failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The input is invalid, or a file cannot be read or written.
    Input(Vec<Diagnostic>),
    /// Nothing could be compared, or a comparison failed.
    Differs(String),
    /// The results cannot be trusted.
    Untrusted(String),
}

impl Failure {
    /// The exit status that belongs to the failure.
    #[must_use]
    pub const fn exit(&self) -> Exit {
        match self {
            Failure::Input(_) => Exit::Input,
            Failure::Differs(_) => Exit::Differs,
            Failure::Untrusted(_) => Exit::Untrusted,
        }
    }

    /// Converts the error of a library to the failure [`Failure::Untrusted`].
    pub(crate) fn untrusted(error: impl std::fmt::Display) -> Failure {
        Failure::Untrusted(error.to_string())
    }

    /// Text for standard error: a line for each of the first errors, or one JSON object with all of them.
    #[must_use]
    pub fn report(&self, json: bool) -> String {
        if json {
            let errors = match self {
                Failure::Input(diagnostics) => serde_json::json!(diagnostics),
                Failure::Differs(message) | Failure::Untrusted(message) => {
                    serde_json::json!([{ "expected": message }])
                }
            };
            let object = serde_json::json!({ "status": self.exit().status(), "errors": errors });
            return format!("{object}\n");
        }
        self.text(|diagnostic| format!("{diagnostic}\n"), "girderway: ")
    }

    /// Text for a terminal: below each error the line of the file with a mark at the place, with colours.
    #[must_use]
    pub fn report_with_excerpts(&self) -> String {
        let strong = |colour: AnsiColor| colour.on_default().effects(Effects::BOLD);
        let (wrong, place) = (strong(AnsiColor::Red), AnsiColor::Cyan.on_default());
        let one = |diagnostic: &Diagnostic| {
            let message = diagnostic.to_string();
            let (position, rest) = message.split_at(diagnostic.position_length());
            let mut text = format!("{place}{position}{place:#}{rest}\n");
            if let (Some(line), Some(excerpt)) = (diagnostic.line, &diagnostic.excerpt) {
                let number = format!("{line:>6} | ");
                let blank = format!("{:>6} | {}", "", " ".repeat(excerpt.before));
                text += &format!(
                    "{place}{number}{place:#}{}\n{place}{blank}{place:#}{wrong}^{wrong:#}\n",
                    excerpt.text
                );
            }
            text
        };
        self.text(one, &format!("{wrong}girderway:{wrong:#} "))
    }

    /// Text of the failure: each of the first errors as `one` writes it, or a message behind a name.
    fn text(&self, one: impl Fn(&Diagnostic) -> String, name: &str) -> String {
        match self {
            Failure::Input(diagnostics) => {
                let mut lines: Vec<String> = diagnostics.iter().take(MOST).map(one).collect();
                match diagnostics.len().saturating_sub(MOST) {
                    0 => {}
                    1 => lines.push(format!("{name}and 1 more error\n")),
                    more => lines.push(format!("{name}and {more} more errors\n")),
                }
                lines.concat()
            }
            Failure::Differs(message) | Failure::Untrusted(message) => {
                format!("{name}{}\n", plain(message))
            }
        }
    }
}

impl From<Diagnostic> for Failure {
    fn from(diagnostic: Diagnostic) -> Self {
        Failure::Input(vec![diagnostic])
    }
}

impl From<Box<Diagnostic>> for Failure {
    fn from(diagnostic: Box<Diagnostic>) -> Self {
        Failure::from(*diagnostic)
    }
}

impl From<Vec<Diagnostic>> for Failure {
    fn from(diagnostics: Vec<Diagnostic>) -> Self {
        Failure::Input(diagnostics)
    }
}

impl From<SolveError> for Failure {
    fn from(error: SolveError) -> Self {
        match error {
            SolveError::Input(diagnostics) => Failure::Input(diagnostics),
            SolveError::NoSolution(message) => Failure::Untrusted(message),
        }
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        Failure::untrusted(error)
    }
}

impl From<results::Error> for Failure {
    fn from(error: results::Error) -> Self {
        match error {
            results::Error::Input(diagnostics) => Failure::Input(diagnostics),
            other => Failure::untrusted(other),
        }
    }
}

impl From<outputs::Error> for Failure {
    fn from(error: outputs::Error) -> Self {
        match error {
            outputs::Error::Files(diagnostics) => Failure::Input(diagnostics),
            outputs::Error::NotShown(why) | outputs::Error::NoResults(why) => {
                Failure::Untrusted(why)
            }
        }
    }
}

impl From<foundations::Error> for Failure {
    fn from(error: foundations::Error) -> Self {
        Failure::untrusted(error)
    }
}

impl From<deck::Error> for Failure {
    fn from(error: deck::Error) -> Self {
        match error {
            deck::Error::Refused(diagnostic) => Failure::from(diagnostic),
            other => Failure::untrusted(other),
        }
    }
}

impl From<study::Error> for Failure {
    fn from(error: study::Error) -> Self {
        match error {
            study::Error::Input(diagnostics) => Failure::Input(diagnostics),
            other => Failure::untrusted(other),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use formats::text::source::Source;

    #[test]
    fn a_terminal_shows_the_line_with_a_mark_below_the_place() {
        let text = "{\"format\": \"girderway-beam/1\",\n \"units\": {\"length\": \"cm\", \"force\": \"kN\", \"time\": \"s\"}}";
        let source = Source {
            name: "spec.json".to_owned(),
            text: text.to_owned(),
        };
        let faults = formats::spec::Spec::read(&source, None).expect_err("no such unit");
        let text =
            anstream::adapter::strip_str(&Failure::from(faults).report_with_excerpts()).to_string();
        let lines: Vec<&str> = text.lines().collect();
        let line = lines
            .iter()
            .position(|line| line.starts_with("spec.json:2:22: units.length"))
            .expect("the unit");
        assert_eq!(
            lines[line + 1],
            "     2 |  \"units\": {\"length\": \"cm\", \"force\": \"kN\", \"time\": \"s\"}}"
        );
        let mark = lines[line + 2].find('^').expect("a mark");
        assert_eq!(&lines[line + 1][mark..mark + 4], "\"cm\"");
    }
}
