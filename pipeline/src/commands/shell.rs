//! `girderway completions` and `girderway man`: what a shell and its manual need, made from the command line itself.

use clap::CommandFactory;

use crate::cli::{Cli, CompletionsArgs, Global, ManArgs};
use crate::exit::{Exit, Failure};
use crate::output;
use crate::progress::Progress;
use outputs::files;
use outputs::folder::check_path;

/// Writes the completions of a shell to standard output.
///
/// # Errors
/// Standard output cannot be written.
pub fn completions(args: &CompletionsArgs) -> Result<Exit, Failure> {
    let mut command = Cli::command();
    let name = command.get_name().to_owned();
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command, name, &mut script);
    output::deliver_bytes(None, &script, &Progress::new(Global::default()))?;
    Ok(Exit::Done)
}

/// Writes the manual pages of the program and of each command: all into the named folder, or that of the program to
/// standard output.
///
/// # Errors
/// A page exists already and has other contents, or a file cannot be written.
pub fn man(args: &ManArgs, global: Global) -> Result<Exit, Failure> {
    let progress = Progress::new(global);
    let mut command = Cli::command();
    command.build();
    let Some(folder) = &args.folder else {
        output::deliver_bytes(None, &page(command)?, &progress)?;
        return Ok(Exit::Done);
    };
    check_path(folder)?;
    files::make(folder)?;
    let commands: Vec<clap::Command> = command.get_subcommands().cloned().collect();
    for command in std::iter::once(command).chain(commands) {
        if command.get_name() == "help" {
            continue;
        }
        let name = command
            .get_display_name()
            .unwrap_or(command.get_name())
            .to_owned();
        output::deliver_bytes(
            Some(&folder.join(format!("{name}.1"))),
            &page(command)?,
            &progress,
        )?;
    }
    Ok(Exit::Done)
}

/// The manual page of a command.
fn page(command: clap::Command) -> Result<Vec<u8>, Failure> {
    let mut text = Vec::new();
    let made = clap_mangen::Man::new(command).render(&mut text);
    made.map_err(|error| Failure::Untrusted(format!("the manual cannot be written: {error}")))?;
    Ok(text)
}
