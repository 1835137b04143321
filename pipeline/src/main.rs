//! The girderway program.

use std::io::{IsTerminal, Write};
use std::panic;
use std::process::ExitCode;
use std::sync::OnceLock;

use clap::Parser;
use formats::text::diagnostic::Diagnostic;
use girderway::cli::{Cli, Command};
use girderway::commands;
use girderway::exit::{Exit, Failure};
use girderway::interrupt;
use girderway::output;

/// Where in the sources the program panicked first.
static PANICKED: OnceLock<String> = OnceLock::new();

fn main() -> ExitCode {
    // a panic is reported in one line below, with its place and without a backtrace
    panic::set_hook(Box::new(|found| {
        if let Some(place) = found.location() {
            PANICKED.get_or_init(|| format!(" at {}:{}", place.file(), place.line()));
        }
    }));
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return usage(&error).into(),
    };
    let json = cli.global.json;
    interrupt::listen();
    let result = panic::catch_unwind(|| dispatch(cli));
    let result = result.unwrap_or_else(|_| {
        let version = env!("CARGO_PKG_VERSION");
        let place = PANICKED.get().map_or("", |place| place.as_str());
        Err(Failure::Untrusted(format!(
            "internal error in version {version}{place}: please report it with its input"
        )))
    });
    result.unwrap_or_else(|failure| tell(&failure, json)).into()
}

fn dispatch(cli: Cli) -> Result<Exit, Failure> {
    match cli.command {
        Command::Run(args) => commands::run::run(&args, cli.global),
        Command::Sim(args) => commands::sim::run(&args, cli.global),
        Command::Fea(args) => commands::fea::run(&args, cli.global),
        Command::Splines(args) => commands::splines::run(&args, cli.global),
        Command::Deck(args) => commands::deck::run(&args, cli.global),
        Command::Import(args) => commands::import::run(&args, cli.global),
        Command::Crosscheck(args) => commands::crosscheck::run(&args, cli.global),
        Command::Study(args) => commands::study::run(&args, cli.global),
        Command::Design(args) => commands::design::run(&args, cli.global),
        Command::Sweep(args) => commands::sweep::run(&args, cli.global),
        Command::Sections(args) => commands::sections::run(&args, cli.global),
        Command::Schema(args) => commands::schema::run(&args, cli.global),
        Command::Init(args) => commands::init::run(&args, cli.global),
        Command::Completions(args) => commands::shell::completions(&args),
        Command::Man(args) => commands::shell::man(&args, cli.global),
    }
}

/// Writes help to standard output, and errors of usage to standard error, as JSON if --json is present.
fn usage(error: &clap::Error) -> Exit {
    if !error.use_stderr() {
        return match error.print() {
            // the reader of standard output may have closed it
            Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
                tell(&output::cannot_print(&error).into(), false)
            }
            _ => Exit::Done,
        };
    }
    if std::env::args_os().any(|argument| argument == "--json") {
        let text = error.to_string();
        let line = text.lines().next().unwrap_or_default();
        let message = line.strip_prefix("error: ").unwrap_or(line);
        return tell(
            &Diagnostic::of_file("command line", message)
                .hint("see --help")
                .into(),
            true,
        );
    }
    let _ = error.print();
    Exit::Input
}

fn tell(failure: &Failure, json: bool) -> Exit {
    let mut out = std::io::stderr();
    let text = if out.is_terminal() && !json {
        failure.report_with_excerpts()
    } else {
        failure.report(json)
    };
    // colours are left out where the terminal or the environment (NO_COLOR) does not want them; an error of writing is
    // ignored: standard error may be closed
    let _ = anstream::AutoStream::auto(&mut out).write_all(text.as_bytes());
    failure.exit()
}
