//! A scene as a complete ADAMS/Solver data set, and its comparison with the simulator.
//!
//! Every wheel is a GFORCE between its centre and a FLOATING marker on ground, in the frame of its rail. The
//! displacement of the rail under it is a VARIABLE that evaluates the SPLINEs with the forces of all wheels. ADAMS
//! solves the coupled displacements and forces in its own Newton iteration.
//!
//! ```
//! use deck::{DeckForm, check, deck, plan};
//! use formats::scene::Document;
//! use foundations::{distinct_specs, solve_specs};
//!
//! let document = Document::open("../../examples/bogie/scene.json".as_ref()).expect("a scene without faults");
//! let solved = solve_specs(&document, &distinct_specs(&document)).expect("a girder that stands");
//! let plan = plan(document.scene(), &solved, DeckForm::Factored, "scene.json").expect("a scene for a deck");
//! let deck = deck(&plan, &solved, "bogie").expect("tables for SPLINEs");
//!
//! let text = deck.set.write().expect("statements");
//! assert!(text.contains("GFORCE") && deck.commands.starts_with("file/model=bogie"));
//! let report = check::check(&plan, &text, 20).expect("a data set that can be executed");
//! assert!(report.holds(), "{:?}", report.lines());
//! ```
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
pub use model::refuse::unsupported;
pub use words::form::DeckForm;

use foundations::SolvedStructure;

/// A data set with the command file that runs it: see the example of [the crate](crate).
#[derive(Clone, Debug, PartialEq)]
pub struct Deck {
    /// The statements.
    pub set: DataSet,
    /// The command file.
    pub commands: String,
}

/// The deck of a plan; `known` has the solutions of the specs of the scene, from which reactions are computed;
/// `model` is the name of the file without the extension.
///
/// # Errors
/// [`Error::Spline`] for tables that do not form a valid SPLINE.
pub fn deck(plan: &DeckPlan<'_>, known: &[SolvedStructure], model: &str) -> Result<Deck, Error> {
    let (mut markers, mut ids) = (plan.markers, plan.splines);
    let mut statements = statements::solver::head(plan);
    statements.extend(statements::parts::statements(plan));
    statements.extend(statements::joints::statements(plan, &mut markers));
    for compliance in &plan.compliances {
        statements.extend(compliance.splines()?);
    }
    statements.extend(statements::contact::statements(plan));
    statements.extend(statements::request::statements(plan, known, &mut ids)?);
    statements.extend(statements::solver::tail(plan));
    words::text::distinct(&mut statements);
    let wheels = plan.wheels.len();
    let s = if wheels == 1 { "" } else { "s" };
    let title = format!(
        "{}: {wheels} wheel{s}, form {}",
        plan.scene.name,
        plan.form.word()
    );
    Ok(Deck {
        set: DataSet { title, statements },
        commands: statements::solver::commands(plan, model),
    })
}
