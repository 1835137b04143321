//! The girderway program.

use std::io::Write;
use std::process::ExitCode;

use clap::Parser;
use girderway::cli::{Cli, Command};
use girderway::commands;
use girderway::exit::{Exit, Failure};

fn main() -> ExitCode {
    let cli = Cli::parse();
    let global = cli.global;
    let result = match cli.command {
        Command::Run(args) => commands::run::run(&args, global),
        Command::Fea(args) => commands::fea::run(&args, global),
    };
    let exit = result.unwrap_or_else(|failure: Failure| {
        // where standard error is closed there is nobody to tell
        let _ = std::io::stderr().write_all(failure.report(global.json).as_bytes());
        failure.exit()
    });
    ExitCode::from(Exit::status(exit))
}
