//! Tables of sheets that other programs wrote: steps by the number of wheels, and frames beside other solvers.

use serde::Deserialize;

use crate::number::{number, time, whole};

/// A row of `docs/wheels.csv`.
#[derive(Clone, Debug, Deserialize)]
pub struct Wheels {
    n: usize,
    steps: f64,
    stages: f64,
    #[serde(rename = "us a step")]
    us: f64,
    residual: f64,
}

/// A row of `docs/frames.csv`.
#[derive(Clone, Debug, Deserialize)]
pub struct Frame {
    frame: String,
    freedoms: usize,
    loads: usize,
    code: String,
    ms: f64,
}

/// Codes beside ours in the table of frames.
const OTHERS: [&str; 4] = ["CHOLMOD", "SuperLU", "OpenSees", "PyNite"];

/// Time of a step by the number of wheels.
pub fn wheels(all: &[Wheels]) -> String {
    let mut out = "| wheels | steps | contact solutions a step | time of a step | energy left over |\n|---|---|---|---|---|\n".to_owned();
    for own in all {
        out += &format!(
            "| {} | {} | {} | {} | {:.0e} |\n",
            own.n,
            own.steps,
            own.stages / own.steps,
            time(1e-6 * own.us),
            own.residual
        );
    }
    out
}

/// Frames beside other solvers: a row a frame and number of loads.
pub fn frames(all: &[Frame]) -> String {
    let mut out = "| frame, freedoms | loads | girderway, ms".to_owned();
    OTHERS.iter().for_each(|code| out += &format!(" | {code}"));
    out += &format!(" | ours / CHOLMOD |\n|---|---|---{}|---|\n", "|---".repeat(OTHERS.len()));
    let same = |a: &Frame, b: &Frame| (&a.frame, a.freedoms, a.loads) == (&b.frame, b.freedoms, b.loads);
    for own in all.chunk_by(same) {
        let of = |code: &str| own.iter().find(|own| own.code == code).map(|own| own.ms);
        let text = |value: Option<f64>, digits| value.map_or_else(String::new, |value| number(value, digits));
        out += &format!(
            "| {} {} | {} | {}",
            own[0].frame,
            whole(own[0].freedoms),
            own[0].loads,
            text(of("girderway"), 3)
        );
        OTHERS.iter().for_each(|code| out += &format!(" | {}", text(of(code), 3)));
        let by = of("girderway").zip(of("CHOLMOD")).map(|(ours, other)| ours / other);
        out += &format!(" | {} |\n", text(by, 2));
    }
    out
}
