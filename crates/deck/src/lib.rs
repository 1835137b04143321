//! A scene as a complete ADAMS/Solver data set, and its comparison with the simulator.
//!
//! Every wheel is a GFORCE between its centre and a FLOATING marker on ground, in the frame of its rail. The rail's
//! displacement under it is a VARIABLE that reads the SPLINEs with the forces of all wheels; ADAMS solves the loop of
//! displacements and forces in its own Newton iteration.
//!
//! Wings, lowest first: error, words, model, statements, check

pub mod check;
mod error;
pub mod model;
pub mod statements;
pub mod words;

use adams::DataSet;

pub use error::Error;
pub use model::plan::{DeckPlan, plan};
pub use words::form::DeckForm;

use foundations::SolvedStructure;

/// A data set and the command file beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct Deck {
    /// The statements.
    pub set: DataSet,
    /// The command file.
    pub commands: String,
}

/// The deck of a plan; `model` is the name of its file, without the ending.
///
/// # Errors
/// Tables that are no SPLINE.
pub fn deck(plan: &DeckPlan<'_>, known: &[SolvedStructure], model: &str) -> Result<Deck, Error> {
    let (mut markers, mut ids) = (plan.markers, plan.splines);
    let mut statements = statements::solver::head(plan);
    statements.extend(statements::parts::statements(plan));
    statements.extend(statements::joints::statements(plan, &mut markers));
    for give in &plan.compliances {
        statements.extend(give.splines()?);
    }
    statements.extend(statements::contact::statements(plan));
    statements.extend(statements::request::statements(plan, known, &mut ids)?);
    statements.extend(statements::solver::tail(plan));
    words::name::distinct(&mut statements);
    let wheels = plan.wheels.len();
    let s = if wheels == 1 { "" } else { "s" };
    let title = format!("{}: {wheels} wheel{s}, form {}", plan.scene.name, plan.form.word());
    Ok(Deck { set: DataSet { title, statements }, commands: statements::solver::commands(plan, model) })
}
