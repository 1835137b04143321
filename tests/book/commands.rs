//! The page of the commands is the help of the program.

use std::fs;
use std::process::Command;

use super::root;

/// Commands in the order of the help, with the starters of their pages.
const COMMANDS: [&str; 14] = [
    "run",
    "sim",
    "fea",
    "splines",
    "deck",
    "import",
    "crosscheck",
    "study",
    "design",
    "sweep",
    "sections",
    "schema",
    "init",
    "man",
];

fn help(arguments: &[&str]) -> String {
    let run = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args(arguments)
        .arg("--help")
        .env("COLUMNS", "100")
        .output()
        .expect("the program starts");
    assert!(run.status.success(), "{arguments:?}");
    let text = String::from_utf8(run.stdout).expect("UTF-8");
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    lines.join("\n").trim().to_owned()
}

#[test]
fn the_page_of_the_commands_is_the_help_of_the_program() {
    let mut page = "# Commands\n\nFor users of the command line: every command with its arguments, as `girderway COMMAND --help` prints \
                    them.\nThis page is generated (see CONTRIBUTING.md).\n"
        .to_owned();
    let mut add = |title: &str, text: &str| {
        page.push_str(&format!("\n## {title}\n\n```text\n{text}\n```\n"));
    };
    let whole = help(&[]);
    add("girderway", &whole);
    for command in COMMANDS {
        assert!(whole.contains(&format!("\n  {command} ")), "{command}");
        add(&format!("girderway {command}"), &help(&[command]));
    }
    let path = root().join("docs/commands.md");
    if std::env::var_os("GIRDERWAY_UPDATE").is_some() {
        fs::write(&path, &page).expect("a writable folder");
    }
    let stored = fs::read_to_string(&path).expect("docs/commands.md");
    assert!(
        stored == page,
        "docs/commands.md is not the help of the program; to write it: \
         GIRDERWAY_UPDATE=1 cargo test -p girderway --test it commands"
    );
}
