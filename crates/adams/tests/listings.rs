//! The paper's listings, rebuilt, and the trunnion path that they give.

use adams::{DataSet, Model};

fn listing(text: &str) -> Model {
    let mut set = DataSet::read(text).unwrap_or_else(|error| panic!("{error}"));
    let tables = DataSet::read(include_str!("../../../examples/bogie/printed.adm"));
    let tables = tables.unwrap_or_else(|error| panic!("{error}"));
    set.statements.extend(tables.statements.into_iter().filter(|one| one.keyword == "SPLINE"));
    Model::new(&set).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn path() {
    let model = listing(include_str!("listings/flexible.adm"));
    let times: Vec<f64> = (0..=120).map(|k| 0.5 * f64::from(k)).collect();
    let path = model.path(&times).unwrap_or_else(|error| panic!("{error}"));
    for one in &path {
        println!(
            "{} {:.6} it {} und {} {:?}",
            one.state.time,
            1.25 - one.state.parts[&2].origin.y,
            one.iterations,
            one.undetermined,
            one.solution.requests[&1]
        );
    }
}
