//! `girderway splines --check`: errors of the methods of reading tables.

use std::path::Path;

use crate::cli::{Global, SplinesArgs};
use crate::exit::{Exit, Failure};
use crate::output;
use crate::progress::Progress;
use formats::text::diagnostic::Diagnostic;
use outputs::files;
use outputs::files::json as json_text;
use report::chart::stack;
use study::table_quality::{
    TableQuality, TableQualitySettings, TableReadingMethod, TableSource, figure, json, text,
};

/// Reads the grid or the tables, prints their errors to standard output, and writes them to a file if one is named.
///
/// Returns [`Exit::Differs`] if a table is asymmetric or not positive semi-definite by more than its digits explain,
/// or if the error of the tested reading exceeds the tolerance.
///
/// # Errors
/// The input is invalid, the extension of the output file is unknown, or the file cannot be written.
pub fn run(args: &SplinesArgs, global: Global) -> Result<Exit, Failure> {
    let form = args.output.as_deref().map(form).transpose()?;
    let subject = TableSource::open(&args.grid)?;
    let progress = Progress::new(global);
    let settings = TableQualitySettings {
        load: args.load,
        spacing: args.spacing,
        beyond: args.beyond,
        judged: args.tolerance.map(|tolerance| {
            (
                args.reading
                    .map_or(TableReadingMethod::Akispl, TableReadingMethod::from),
                tolerance,
            )
        }),
    };
    let mut all = Vec::with_capacity(subject.items.len());
    let bar = progress.bar("checking", subject.items.len() as u64);
    for index in 0..subject.items.len() {
        all.push(
            TableQuality::of(&subject, index, &settings)
                .map_err(|error| refuse(&subject, index, &error))?,
        );
        bar.set(index as u64 + 1);
    }
    drop(bar);
    if let (Some(path), Some(form)) = (args.output.as_deref(), form) {
        let body = match form {
            Form::Json => json_text(&json::json(&subject, &all)),
            Form::Page => figure::page(&subject, &all).map_err(Failure::untrusted)?,
            Form::Picture => drawing(&subject, &all)?,
        };
        files::write(path, body.as_bytes())?;
        progress.say(&format!("wrote {}", path.display()));
    }
    let text = if global.json {
        json_text(&json::json(&subject, &all))
    } else {
        text::text(&subject, &all)
    };
    output::print(&text)?;
    let failed = all.iter().any(|found| !found.verdicts.is_empty());
    Ok(if failed { Exit::Differs } else { Exit::Done })
}

#[derive(Clone, Copy, Debug)]
enum Form {
    Picture,
    Page,
    Json,
}

fn form(path: &Path) -> Result<Form, Failure> {
    let ending = path
        .extension()
        .map(|ending| ending.to_string_lossy().to_lowercase())
        .unwrap_or_default();
    match ending.as_str() {
        "svg" => Ok(Form::Picture),
        "html" => Ok(Form::Page),
        "json" => Ok(Form::Json),
        _ => {
            let wrong = Diagnostic::of_file(
                path.display().to_string(),
                "unsupported file extension for --check",
            );
            Err(wrong.hint("use .svg, .html or .json").into())
        }
    }
}

fn drawing(subject: &TableSource, all: &[TableQuality]) -> Result<String, Failure> {
    let mut pictures = Vec::new();
    for found in all {
        for figure in figure::figures(subject, found).map_err(Failure::untrusted)? {
            pictures.push(figure.svg().map_err(Failure::untrusted)?);
        }
    }
    if pictures.is_empty() {
        let wrong = "no figure: the exact influence function of the tables is unknown".to_owned();
        return Err(Diagnostic::of_file(&subject.file, wrong)
            .hint("check the grid file of these tables")
            .into());
    }
    Ok(stack(&pictures).file())
}

/// Creates the error of a table whose exact surface cannot be evaluated.
fn refuse(subject: &TableSource, index: usize, error: &splines::Error) -> Failure {
    let item = &subject.items[index];
    let wrong = format!("SPLINE/{} cannot be checked: {error}", item.id);
    Diagnostic::of_file(&subject.file, wrong)
        .hint("does the surface belong to these tables?")
        .into()
}
