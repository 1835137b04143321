//! Limits of deflections against the results of a design, and loads for fatigue.

use formats::design::{CODE_PARTS, Design, DesignTrain, DesignWheel, TILTING};
use formats::text::fault::number;
use formats::units::{Dimension, Scale, Units};
use formats::verdict::{OmittedCheck, rail_phrase};
use practice::duty::{equivalent_load, fatigue_factor};
use practice::factor::PHI1;
use practice::limit_choice::code_name;
use practice::limits::{DeflectionLimit, LimitedDisplacement};
use trains::{CaseEnvelopes, GirderResponse, Governing};

use crate::chords::{Chords, PLANES};
use crate::outcome::{FatigueLoads, LimitCheck};
use crate::service::{ServiceCase, ServiceLoad};

/// Lateral deflections below this fraction of the largest deflection are rounding.
pub(crate) const ROUNDING: f64 = 1e-9;

/// The limits on the deflections of all spans and overhangs; `found` are the responses of each service case, whose spans are
/// those of the vertical plane, with their ends in `vertical` by rail.
pub(crate) fn check_limits(
    design: &Design,
    vertical: &[Vec<f64>],
    cases: &[ServiceCase],
    found: &[CaseEnvelopes],
) -> Vec<LimitCheck> {
    let mut out = Vec::new();
    for (service, found) in cases.iter().zip(found) {
        let cranes = design.cases[service.case].trains.len();
        for limit in &design.practice.limits {
            if !service.serves(limit.loads, limit.displacement, cranes) {
                continue;
            }
            let rows = Rows {
                design,
                service,
                limit,
            };
            match limit.displacement {
                LimitedDisplacement::Overhang => rows.overhangs(vertical, found, &mut out),
                _ => rows.spans(found, &mut out),
            }
        }
    }
    out
}

/// Rows of one limit in one service case.
struct Rows<'a> {
    design: &'a Design,
    service: &'a ServiceCase,
    limit: &'a DeflectionLimit,
}

impl Rows<'_> {
    /// Deflections of spans from their chords. Under vertical loads alone a lateral deflection counts where it is not
    /// rounding: inclined or eccentric rails and unsymmetric structures move sideways.
    fn spans(&self, found: &CaseEnvelopes, out: &mut Vec<LimitCheck>) {
        let wanted = match self.limit.displacement {
            LimitedDisplacement::RunwayVertical => GirderResponse::VerticalDeflection,
            LimitedDisplacement::RunwayLateral => GirderResponse::LateralDeflection,
            _ => return,
        };
        let sizes = found.deflections.iter().map(|d| d.governing.value.abs());
        let least = ROUNDING * sizes.fold(0.0, f64::max);
        let is_side_effect = wanted == GirderResponse::LateralDeflection
            && self.service.load == ServiceLoad::Vertical;
        for deflection in found.deflections.iter().filter(|d| d.quantity == wanted) {
            if is_side_effect && deflection.governing.value.abs() <= least {
                continue;
            }
            let place = (deflection.rail, deflection.span);
            out.extend(self.row(place, deflection.ends, &deflection.governing));
        }
    }

    /// Largest absolute deflections of overhangs.
    fn overhangs(&self, vertical: &[Vec<f64>], found: &CaseEnvelopes, out: &mut Vec<LimitCheck>) {
        for (rail, span, ends) in overhangs(self.design, vertical) {
            let own = found.extremes.iter().filter(|e| {
                (e.rail, e.span, e.quantity) == (rail, span, GirderResponse::VerticalDeflection)
            });
            let largest =
                own.max_by(|a, b| a.governing.value.abs().total_cmp(&b.governing.value.abs()));
            out.extend(
                largest.and_then(|largest| self.row((rail, span), ends, &largest.governing)),
            );
        }
    }

    fn row(
        &self,
        (rail, span): (usize, usize),
        ends: [f64; 2],
        governing: &Governing,
    ) -> Option<LimitCheck> {
        let metre = metre(self.design);
        let allowed = self.limit.allowable((ends[1] - ends[0]) * metre).ok()?;
        Some(LimitCheck {
            clause: self.limit.clause,
            quantity: self.limit.displacement.phrase(),
            formula: self.limit.formula(),
            loads: self.service.words(self.limit.loads),
            value: governing.value.abs(),
            limit: allowed / metre,
            case: self.service.case + 1,
            rail: self.design.spec.rails()[rail].name.clone(),
            span,
            ends: Some(ends),
            x: governing.x,
            position: governing.trains.first().map(|train| train.position),
            is_sampled: false,
        })
    }
}

/// A metre over the unit of length of the design, so that a length times it is in m.
pub(crate) fn metre(design: &Design) -> f64 {
    let scale = Scale {
        from: design.units,
        to: Units::SI,
    };
    scale.factor(Dimension::LENGTH)
}

/// Overhangs: rail, number of the span, coordinates of the ends; `vertical` are the ends of spans by rail.
fn overhangs(design: &Design, vertical: &[Vec<f64>]) -> Vec<(usize, usize, [f64; 2])> {
    let mut out = Vec::new();
    for (rail, outline) in design.spec.rails().iter().enumerate() {
        let ends = &vertical[rail];
        let (Some(first), Some(last)) = (ends.first(), ends.last()) else {
            continue;
        };
        let [low, high] = outline.range;
        let slack = 1e-9 * (high - low);
        let both = [(0, [low, *first]), (ends.len(), [*last, high])];
        let real = both.into_iter().filter(|(_, [from, to])| to - from > slack);
        out.extend(real.map(|(span, ends)| (rail, span, ends)));
    }
    out
}

/// Limits that a design cannot check, and groups of loads that it cannot form, with the reasons; `rows` are the limits that
/// are checked.
pub(crate) fn left_out(
    design: &Design,
    chords: &Chords,
    groups: Vec<OmittedCheck>,
    rows: &[LimitCheck],
) -> Vec<OmittedCheck> {
    let mut out = Vec::new();
    for limit in &design.practice.limits {
        let omitted = |reason: &str| omitted_limit(limit, limit.displacement.phrase(), reason);
        let quantity = limit.displacement.phrase();
        let is_checked = rows
            .iter()
            .any(|row| row.clause == limit.clause && row.quantity == quantity);
        let plane = match limit.displacement {
            LimitedDisplacement::RunwayVertical => Some(0),
            LimitedDisplacement::RunwayLateral => Some(1),
            _ => None,
        };
        let undefined: Vec<_> = chords
            .undefined
            .iter()
            .filter(|(own, ..)| Some(*own) == plane)
            .collect();
        for (plane, rail, reason) in &undefined {
            let name = &design.spec.rails()[*rail].name;
            let check = format!("{} deflection of {}", PLANES[*plane], rail_phrase(name));
            out.push(omitted_limit(limit, &check, reason));
        }
        if is_checked || !undefined.is_empty() {
            continue;
        }
        match limit.displacement {
            LimitedDisplacement::RunwayVertical => {
                out.push(omitted("no train has vertical forces"))
            }
            LimitedDisplacement::RunwayLateral => out.push(omitted(
                "no train has lateral forces, or the rails have no lateral stiffness",
            )),
            LimitedDisplacement::Overhang => out.push(omitted("no rail has an overhang")),
            LimitedDisplacement::MonorailVertical | LimitedDisplacement::BridgeGirder => {
                out.push(omitted("a design calculates runways"));
            }
            LimitedDisplacement::GaugeChange | LimitedDisplacement::HeightDifference => {
                out.push(omitted(
                    "no train has these loads on two rails that resist these displacements",
                ));
            }
            LimitedDisplacement::FrameLateral | LimitedDisplacement::FrameDifference => {
                out.push(omitted(
                    "a design computes deflections of rails, not of frames; use `record` in a scene",
                ));
            }
        }
    }
    out.extend(overhangs_without_limit(design, chords));
    out.extend(eccentric_loads(design));
    if design.practice.s_class.is_some() && design.practice.phi2().is_none() {
        out.push(OmittedCheck::new(
            "damage-equivalent wheel loads",
            "give `hoisting` and `hoist_speed` for phi2",
        ));
    }
    if design.practice.s_class.is_some() && !design.trains.iter().any(has_parts) {
        out.push(OmittedCheck::new(
            "damage-equivalent wheel loads",
            "give vertical forces in the parts `crane` and `hoist`",
        ));
    }
    out.extend(groups);
    out
}

/// A limit that was not checked.
fn omitted_limit(limit: &DeflectionLimit, check: &str, reason: &str) -> OmittedCheck {
    let clause = &limit.clause;
    OmittedCheck::new(check, reason).of_code(clause.standard, Some(clause.clause))
}

/// The eccentricity of wheel loads that EN 1991-3 requires, where no wheel has one.
fn eccentric_loads(design: &Design) -> Option<OmittedCheck> {
    let code = design.practice.code.as_ref()?;
    let is_en = matches!(code_name(code), "EN 1991-3" | "EN 1993-6");
    let wheels = || design.trains.iter().flat_map(|train| &train.wheels);
    let is_central = wheels().all(|wheel| wheel.eccentricity == 0.0);
    (is_en && is_central).then(|| {
        let reason = "no train has an `eccentricity`; the code requires a quarter of the width of the rail head";
        OmittedCheck::new("torsion from eccentric wheel loads", reason).of_code("EN 1991-3:2006", None)
    })
}

/// Overhangs on which no limit bears although a code is named.
fn overhangs_without_limit(design: &Design, chords: &Chords) -> Vec<OmittedCheck> {
    let has_own = |limit: &DeflectionLimit| limit.displacement == LimitedDisplacement::Overhang;
    let (Some(code), false) = (
        &design.practice.code,
        design.practice.limits.iter().any(has_own),
    ) else {
        return Vec::new();
    };
    let rails = design.spec.rails();
    let omitted = |(rail, _, ends): (usize, usize, [f64; 2])| {
        let [from, to] = ends.map(number);
        let check = format!(
            "deflection of the overhang from {from} to {to} of {}",
            rail_phrase(&rails[rail].name)
        );
        let reason =
            "no limit of the code for overhangs is known; specify `practice.limits.overhang`";
        OmittedCheck::new(check, reason).of_code(code.clone(), None)
    };
    overhangs(design, &chords.ends[0])
        .into_iter()
        .map(omitted)
        .collect()
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
