//! Limits of codes against the results of a design, and loads for fatigue.

use formats::design::{CODE_PARTS, Design, DesignTrain, DesignWheel, TILTING};
use formats::units::{Dimension, Scale, Units};
use practice::duty::{equivalent_load, fatigue_factor};
use practice::factor::PHI1;
use practice::limits::{DeflectionLimit, LimitedDisplacement};
use trains::GirderResponse;

use crate::outcome::{FatigueLoads, LimitCheck, RailPairResponse, SolvedCase};

/// Lateral deflections below this fraction of the largest deflection are rounding.
const ROUNDING: f64 = 1e-9;

/// Loads of a lateral deflection where no train of the case has lateral forces.
const VERTICAL_ALONE: &str = "vertical wheel loads only, which displace the rail laterally";

/// Checks the limits of the design's code: deflections of spans from the chords between their ends, under the trains alone
/// and without factors, as the codes want them.
pub(crate) fn check_limits(design: &Design, cases: &[SolvedCase]) -> Vec<LimitCheck> {
    let rails = design.spec.rails();
    let metric = Scale {
        from: design.units,
        to: Units::SI,
    }
    .factor(Dimension::LENGTH);
    let mut out = Vec::new();
    for (number, (case, solved)) in design.cases.iter().zip(cases).enumerate() {
        if !case.factors.is_empty() {
            continue;
        }
        let sizes = solved
            .envelopes
            .deflections
            .iter()
            .map(|found| found.governing.value.abs());
        let is_thrust = case
            .trains
            .iter()
            .any(|&train| design.trains[train].has_lateral_forces());
        let least = ROUNDING * sizes.fold(0.0, f64::max);
        for deflection in &solved.envelopes.deflections {
            let moves = deflection.governing.value.abs() > least;
            for limit in &design.practice.limits {
                let Some(quantity) = words(limit, deflection.quantity, moves || is_thrust) else {
                    continue;
                };
                let is_sideways = deflection.quantity == GirderResponse::LateralDeflection;
                let span = (deflection.ends[1] - deflection.ends[0]) * metric;
                let Ok(allowed) = limit.allowable(span) else {
                    continue;
                };
                out.push(LimitCheck {
                    clause: limit.clause,
                    quantity,
                    formula: limit.formula(),
                    loads: if is_sideways && !is_thrust {
                        VERTICAL_ALONE
                    } else {
                        limit.loads
                    },
                    value: deflection.governing.value.abs(),
                    limit: allowed / metric,
                    case: number + 1,
                    rail: rails[deflection.rail].name.clone(),
                    span: deflection.span,
                    is_sampled: false,
                });
            }
        }
    }
    out
}

/// What a limit bounds, where it bounds this deflection of a runway; `is_lateral` is whether lateral deflections count. One that
/// is not zero counts also where no lateral force acts: inclined or eccentric rails and unsymmetric structures move sideways
/// under vertical forces.
fn words(
    limit: &DeflectionLimit,
    quantity: GirderResponse,
    is_lateral: bool,
) -> Option<&'static str> {
    match (limit.displacement, quantity) {
        (LimitedDisplacement::RunwayVertical, GirderResponse::VerticalDeflection) => {
            Some("vertical deflection")
        }
        (LimitedDisplacement::RunwayLateral, GirderResponse::LateralDeflection) if is_lateral => {
            Some("lateral deflection")
        }
        _ => None,
    }
}

/// Limits of the code that a design cannot check, and groups of loads that it cannot form, with the reasons; `pairs` are the
/// responses of pairs of rails, `rows` the limits that are checked.
pub(crate) fn left_out(
    design: &Design,
    groups: &[String],
    pairs: &[RailPairResponse],
    rows: &[LimitCheck],
) -> Vec<String> {
    let mut out = Vec::new();
    for limit in &design.practice.limits {
        let why = match limit.displacement {
            LimitedDisplacement::RunwayVertical => continue,
            LimitedDisplacement::RunwayLateral
                if design.trains.iter().any(DesignTrain::has_lateral_forces)
                    || rows.iter().any(|row| row.quantity == "lateral deflection") =>
            {
                continue;
            }
            LimitedDisplacement::RunwayLateral => "no train has lateral forces",
            LimitedDisplacement::MonorailVertical | LimitedDisplacement::BridgeGirder => {
                "a design calculates runways"
            }
            LimitedDisplacement::GaugeChange | LimitedDisplacement::HeightDifference => {
                let quantity = if limit.displacement == LimitedDisplacement::GaugeChange {
                    "change of gauge"
                } else {
                    "difference in height"
                };
                if pairs.iter().any(|pair| pair.quantity == quantity) {
                    continue;
                }
                "no train of a case without factors is on two rails that resist these displacements"
            }
            _ => "a design computes deflections of rails, not of frames; use `record` in a scene",
        };
        let name = limit.displacement.word();
        let clause = limit.clause;
        out.push(format!(
            "{name} ({} {}): {why}",
            clause.standard, clause.clause
        ));
    }
    if design.practice.s_class.is_some() && design.practice.phi2().is_none() {
        out.push(
            "damage-equivalent wheel loads: give `hoisting` and `hoist_speed` for phi2".to_owned(),
        );
    }
    if design.practice.s_class.is_some() && !design.trains.iter().any(has_parts) {
        out.push(
            "damage-equivalent wheel loads: give vertical forces in the parts `crane` and `hoist`"
                .to_owned(),
        );
    }
    out.extend(groups.iter().cloned());
    out
}

fn has_parts(train: &DesignTrain) -> bool {
    train.wheels.iter().all(DesignWheel::has_code_parts)
}

/// Damage-equivalent loads Q_e = lambda (phi_fat,1 Q_C + phi_fat,2 Q_H), phi_fat,i = (1 + phi_i)/2, by EN 1991-3, 2.12.1,
/// of the trains whose vertical forces are given in the parts `crane` and `hoist`.
pub(crate) fn fatigue_loads(design: &Design) -> Vec<FatigueLoads> {
    let (Some(class), Some(phi2)) = (design.practice.s_class, design.practice.phi2()) else {
        return Vec::new();
    };
    let lambda = [class.normal(), class.shear()];
    let Ok(dynamic) = fatigue_factor(PHI1[1]).and_then(|a| Ok([a, fatigue_factor(phi2)?])) else {
        return Vec::new();
    };
    let of_wheel = |vertical: &[(String, f64)]| {
        lambda.map(|lambda| {
            let part = |(name, force): &(String, f64)| {
                let factor = dynamic[usize::from(name == CODE_PARTS[1])];
                equivalent_load(*force, lambda, factor).unwrap_or(0.0)
            };
            vertical
                .iter()
                .filter(|(name, _)| name != TILTING)
                .map(part)
                .sum()
        })
    };
    let loads = |train: &DesignTrain| FatigueLoads {
        train: train.name.clone(),
        lambda,
        dynamic,
        wheels: train
            .wheels
            .iter()
            .map(|wheel| of_wheel(&wheel.vertical))
            .collect(),
    };
    design
        .trains
        .iter()
        .filter(|train| has_parts(train))
        .map(loads)
        .collect()
}
