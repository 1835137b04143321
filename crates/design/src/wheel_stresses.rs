//! Local stresses in webs under wheels, by EN 1993-6, 5.7.

use practice::clause::{CodeClause, Evidence, en_1993_6};
use practice::local_stress::{LocalStresses, RailFixing, RailSeat};
use trains::{GirderResponse, Train};

use crate::fibres::Fibres;
use crate::girder_sections::by_reason;
use crate::outcome::{WheelCycle, WheelStress};
use crate::state_forces::StateForces;
use crate::stresses::StressBasis;
use formats::spec::{SectionPlates, SpecCraneRail};
use formats::units::Length;
use formats::verdict::OmittedCheck;

/// Whether any rail has a crane rail on an upright I section.
pub(crate) fn has_any(basis: &StressBasis<'_>) -> bool {
    (0..basis.lines.count()).any(|rail| seats(basis, rail).is_ok())
}

/// The local stresses under the largest wheel of each rail in each case.
pub(crate) fn wheel_stresses(basis: &StressBasis<'_>, forces: &StateForces) -> Vec<WheelStress> {
    let mut out = Vec::new();
    for case in 0..basis.cases.len() {
        for rail in 0..basis.lines.count() {
            let Ok(seats) = seats(basis, rail) else {
                continue;
            };
            let rows = seats
                .iter()
                .filter_map(|seat| seat.under_wheels(basis, case, rail, forces));
            out.extend(rows.reduce(|best, next| {
                if next.vertical > best.vertical {
                    next
                } else {
                    best
                }
            }));
        }
    }
    out
}

/// What is left out for want of data.
pub(crate) fn left_out(basis: &StressBasis<'_>) -> Vec<OmittedCheck> {
    let rails = basis.design.spec.rails();
    let lacks: Vec<(String, String)> = rails
        .iter()
        .enumerate()
        .filter_map(|(rail, outline)| Some((outline.name.clone(), seats(basis, rail).err()?)))
        .collect();
    by_reason("local wheel stress in the web", &lacks)
}

/// A crane rail on a section.
struct Seat<'a> {
    fibres: &'a Fibres,
    crane_rail: &'static str,
    fastening: (&'static str, bool),
    clause: CodeClause,
    web: f64,
    length: f64,
}

/// The seats of a rail, one for each section under it, or what is missing.
fn seats<'a>(basis: &StressBasis<'a>, rail: usize) -> Result<Vec<Seat<'a>>, String> {
    let carried = basis.design.spec.crane_rails.get(rail).copied().flatten();
    let carried = carried.ok_or("specify the `crane_rail`")?;
    let mut out = Vec::new();
    for fibres in basis.sections.distinct(rail) {
        let Some(plates) = fibres.plates() else {
            continue;
        };
        out.push(seat(basis, fibres, &plates, &carried)?);
    }
    match out.is_empty() {
        false => Ok(out),
        true => {
            let lacks = basis.sections.lacks(rail, false);
            Err(lacks
                .first()
                .cloned()
                .unwrap_or_else(|| "an upright I section is required".to_owned()))
        }
    }
}

fn seat<'a>(
    basis: &StressBasis<'a>,
    fibres: &'a Fibres,
    plates: &SectionPlates,
    carried: &SpecCraneRail,
) -> Result<Seat<'a>, String> {
    let profile = carried.profile;
    let default = if carried.is_composite {
        RailFixing::Rigid
    } else {
        RailFixing::Loose
    };
    let fixing = basis.design.practice.rail_fastening.unwrap_or(default);
    let one = Length::Millimetre.in_units_of(basis.design.units.length);
    let (width, flange) = (plates.widths[1], plates.flanges[1]);
    let mut seat = RailSeat {
        fixing,
        inertia: 0.0,
        flange_width: width,
        flange,
        web: plates.web,
        rail_height: profile.height * one,
        rail_foot: profile.base * one,
    };
    let own = profile.i_vertical.ok_or_else(|| {
        format!(
            "the tables have no second moment of area for vertical bending of the crane rail {}",
            profile.name
        )
    })?;
    seat.inertia = own * one.powi(4);
    if fixing == RailFixing::Rigid {
        let (Some(area), Some(centroid)) = (profile.area, profile.centroid) else {
            return Err(format!(
                "the tables have no area or no centroid of the crane rail {}, which rigid fastening requires",
                profile.name
            ));
        };
        let effective = seat.effective_width().map_err(|error| error.to_string())?;
        seat.inertia = with_flange(
            seat.inertia,
            area * one.powi(2),
            centroid * one,
            effective,
            flange,
        );
    }
    let length = seat.effective_length().map_err(|error| error.to_string())?;
    let (word, table, evidence) = match fixing {
        RailFixing::Rigid => ("rigid", "5.7.1, Table 5.1 a", Evidence::Memory),
        RailFixing::Loose => ("loose", "5.7.1, Table 5.1 b", Evidence::Used),
        RailFixing::ElasticPad => ("pad", "5.7.1, Table 5.1 c", Evidence::Memory),
    };
    let fastening = (word, basis.design.practice.rail_fastening.is_none());
    let clause = en_1993_6(table, evidence);
    Ok(Seat {
        fibres,
        crane_rail: profile.name,
        fastening,
        clause,
        web: plates.web,
        length,
    })
}

/// I_rf of a rail and the effective flange below it as one section: I_r + b_eff t^3/12 + A_r A_f/(A_r + A_f) d^2 with
/// d = centroid + t/2.
fn with_flange(inertia: f64, area: f64, centroid: f64, width: f64, flange: f64) -> f64 {
    let plate = width * flange;
    let distance = centroid + 0.5 * flange;
    inertia + plate * flange.powi(2) / 12.0 + area * plate / (area + plate) * distance.powi(2)
}

impl Seat<'_> {
    /// The stresses under the largest wheel of a case, and the cycles of all wheels.
    fn under_wheels(
        &self,
        basis: &StressBasis<'_>,
        case: usize,
        rail: usize,
        forces: &StateForces,
    ) -> Option<WheelStress> {
        let design = basis.design;
        let indices = &design.cases[case].trains;
        let stresses = |force: f64| LocalStresses::over(force, self.length, self.web).ok();
        let mut largest: Option<((String, usize), f64)> = None;
        let mut cycles = Vec::new();
        for (k, (train, &index)) in basis.trains[case].trains.iter().zip(indices).enumerate() {
            for (number, wheel) in train.wheels.iter().enumerate() {
                if wheel.rail != rail || wheel.vertical <= 0.0 {
                    continue;
                }
                let name = (design.trains[index].name.clone(), number + 1);
                if largest
                    .as_ref()
                    .is_none_or(|(_, most)| wheel.vertical > *most)
                {
                    largest = Some((name.clone(), wheel.vertical));
                }
                // Each train of the case passes; one that is listed twice has the same cycles.
                if !indices[..k].contains(&index) {
                    let found = stresses(wheel.vertical)?;
                    cycles.push(WheelCycle {
                        wheel: name,
                        vertical: found.vertical,
                        shear: 2.0 * found.shear,
                    });
                }
            }
        }
        let (wheel, force) = largest?;
        let trains = &basis.trains[case].trains;
        let overlapping = trains
            .iter()
            .map(|train| self.overlapping(train, rail))
            .fold(force, f64::max);
        let found = stresses(overlapping)?;
        Some(WheelStress {
            case: case + 1,
            rail: design.spec.rails()[rail].name.clone(),
            section: self.fibres.name.clone(),
            crane_rail: self.crane_rail,
            clause: self.clause,
            fastening: self.fastening,
            wheel,
            force,
            overlapping,
            length: self.length,
            vertical: found.vertical,
            shear: found.shear,
            global_shear: self.global_shear(basis, case, rail, forces),
            yield_strength: self.fibres.yield_strength,
            cycles,
        })
    }

    /// Largest sum of the forces of the wheels of a train on a rail that stand on less than one effective length, so that their
    /// stresses are superposed.
    fn overlapping(&self, train: &Train, rail: usize) -> f64 {
        let on_rail = || {
            train
                .wheels
                .iter()
                .filter(|wheel| wheel.rail == rail && wheel.vertical > 0.0)
        };
        let from = |x: f64| -> f64 {
            let near = on_rail().filter(|wheel| wheel.x >= x && wheel.x - x < self.length);
            near.map(|wheel| wheel.vertical).sum()
        };
        on_rail().map(|wheel| from(wheel.x)).fold(0.0, f64::max)
    }

    /// Largest shear stress of the girder in a case where it has this section.
    fn global_shear(
        &self,
        basis: &StressBasis<'_>,
        case: usize,
        rail: usize,
        forces: &StateForces,
    ) -> f64 {
        let area = self.fibres.web_area().unwrap_or(f64::INFINITY);
        let states = basis.states(case, rail, &[GirderResponse::VerticalShear]);
        let own = states.filter(|(_, governing)| {
            let carrier = forces.carrier_at(rail, governing.x, governing.side);
            let member = carrier.map(|carrier| forces.carrying()[carrier].member);
            member.and_then(|member| basis.sections.of(rail, member)) == Some(self.fibres)
        });
        own.map(|(_, governing)| governing.value.abs() / area)
            .fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hand calculation in mm: a rail of 40 x 60 on a plate of 200 x 20 are a T section: areas 2400 and 4000, distance of the
    /// centroids 40, I = 40 * 60^3/12 + 200 * 20^3/12 + 2400 * 4000/6400 * 40^2 = 720000 + 133333.3 + 2400000.
    #[test]
    fn a_rigid_rail_and_its_flange_are_one_section() {
        let found = with_flange(720_000.0, 2400.0, 30.0, 200.0, 20.0);
        assert!(
            (found - (720_000.0 + 400_000.0 / 3.0 + 2_400_000.0)).abs() < 1e-6,
            "{found}"
        );
    }
}
