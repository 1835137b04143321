//! Cases from the groups of crane loads of a code.

use formats::design::{
    CODE_PARTS, Design, DesignCase, DesignWheel, TILTING, TROLLEY_DRIVES, WHOLE,
};
use formats::verdict::OmittedCheck;
use practice::combination::{
    CraneLoad, DynamicFactors, GroupUse, LoadFactor, LoadGroup, eurocode_groups,
};
use practice::factor::{Release, phi5, test_load};
use practice::limit_choice::code_name;
use practice::mill_combination::{asce_group, mill_combinations, mill_fatigue};

/// A design with the cases of its code's groups behind its own, where its `practice` asks for them. Every case without
/// factors of its own is repeated with the factors of each group whose loads it has.
///
/// Dead load keeps the factor 1 in the groups of EN 1991-3 and ASCE 7, which are groups of crane loads. The forces of
/// drives, side thrust and traction are those that the trains give.
#[must_use]
pub fn with_combinations(design: &Design) -> Design {
    let mut out = design.clone();
    out.cases.extend(combined(design).0);
    out
}

/// The groups that a design cannot form, with the reasons.
pub(crate) fn groups_left_out(design: &Design) -> Vec<OmittedCheck> {
    combined(design).1
}

/// The cases of the groups, and the groups that are left out.
fn combined(design: &Design) -> (Vec<DesignCase>, Vec<OmittedCheck>) {
    let mut cases = Vec::new();
    let mut left_out = Vec::new();
    if !design.practice.combinations {
        return (cases, left_out);
    }
    let (groups, dynamic) = match groups(design) {
        Ok(found) => found,
        Err(why) => {
            let code = design.practice.code.clone().unwrap_or_default();
            left_out.push(OmittedCheck::new("load groups", why).of_code(code, None));
            return (cases, left_out);
        }
    };
    left_out.extend(wind(&groups));
    left_out.extend(remaining(&groups));
    for group in &groups {
        let own = design.cases.iter().filter(|case| case.factors.is_empty());
        let fitting = own.filter(|case| !group.is_single_crane || case.trains.len() == 1);
        for case in fitting {
            let code = group.clause.standard;
            let name = match group.purpose {
                GroupUse::Strength => format!("{}: {code} {} (strength)", case.name, group.name),
                GroupUse::Fatigue | GroupUse::AllowableStress => {
                    format!("{}: {code} {}", case.name, group.name)
                }
                _ => format!("{}: {code} group {}", case.name, group.name),
            };
            match factors(design, case, group, &dynamic) {
                Ok(factors) => cases.push(DesignCase {
                    name,
                    factors,
                    ..case.clone()
                }),
                Err(why) => {
                    let line =
                        OmittedCheck::new(format!("group {}", group.name), why).of_code(code, None);
                    if !left_out.contains(&line) {
                        left_out.push(line);
                    }
                }
            }
        }
    }
    (cases, left_out)
}

/// The groups whose wind in service is left out.
fn wind(groups: &[LoadGroup]) -> Option<OmittedCheck> {
    let with_wind = groups
        .iter()
        .filter(|group| group.loads.iter().any(|own| own.load == CraneLoad::Wind));
    let names: Vec<&str> = with_wind.clone().map(|group| group.name).collect();
    let code = with_wind.map(|group| group.clause.standard).next()?;
    let check = format!("in-service wind in groups {}", names.join(", "));
    Some(OmittedCheck::new(check, "a design has no wind loads").of_code(code, None))
}

/// The groups whose hoisted load is the part that remains without the payload, which is left out.
fn remaining(groups: &[LoadGroup]) -> Option<OmittedCheck> {
    let remains = |group: &&LoadGroup| {
        group
            .loads
            .iter()
            .any(|own| own.factor == LoadFactor::Remaining)
    };
    let group = groups.iter().find(remains)?;
    let check = format!(
        "part eta of the hoisted load that remains after release, in group {}",
        group.name
    );
    let reason = "it is not specified in a design and is taken as 0";
    Some(OmittedCheck::new(check, reason).of_code(group.clause.standard, None))
}

/// The groups of the code, with the dynamic factors of the crane.
fn groups(design: &Design) -> Result<(Vec<LoadGroup>, DynamicFactors), String> {
    let code = design.practice.code.as_deref().unwrap_or("");
    let plain = DynamicFactors {
        phi: [1.0; 7],
        remaining: 0.0,
    };
    match code_name(code) {
        "EN 1991-3" | "EN 1993-6" => {
            let phi2 = design
                .practice
                .phi2()
                .ok_or("give `hoisting` and `hoist_speed` for phi2")?;
            let [_, phi5] = phi5(design.practice.drives);
            let factors = DynamicFactors::of_crane(
                phi2,
                phi5,
                design.practice.release.unwrap_or(Release::Rapid),
            );
            Ok((
                eurocode_groups(),
                factors.map_err(|error| error.to_string())?,
            ))
        }
        "AIST TR-13" => {
            let mut all = mill_combinations(GroupUse::AllowableStress);
            all.push(mill_fatigue());
            Ok((all, plain))
        }
        "ASCE 7" => Ok((vec![asce_group(design.practice.operation)], plain)),
        other => Err(format!(
            "{other} defines deflection limits but no load groups"
        )),
    }
}

/// The factors of a group for the loads of a case.
fn factors(
    design: &Design,
    case: &DesignCase,
    group: &LoadGroup,
    dynamic: &DynamicFactors,
) -> Result<Vec<(String, f64)>, String> {
    let of = |load: CraneLoad| group.factor(load, dynamic);
    let releases = group
        .loads
        .iter()
        .any(|factored| factored.factor == LoadFactor::Phi3);
    if releases && design.practice.release.is_none() {
        return Err("give `release` where grabs or magnets release the load".to_owned());
    }
    let wheels = || {
        case.trains
            .iter()
            .flat_map(|&train| &design.trains[train].wheels)
    };
    let needed = [
        (
            CraneLoad::Skewing,
            wheels().any(|w| w.skewing != 0.0),
            "no wheel has a `skewing` force",
        ),
        (
            CraneLoad::BufferForce,
            wheels().any(|w| w.buffer != 0.0),
            "no train has a `buffer` force",
        ),
        (
            CraneLoad::TrolleyDrives,
            wheels().any(|w| w.trolley_drives != 0.0),
            "no train has `hoist_load` and `trolley`, which determine the force of the trolley drives",
        ),
        (
            CraneLoad::TestLoad,
            wheels().any(|w| w.vertical.iter().any(|(name, _)| name == CODE_PARTS[1])),
            "no wheel has a hoisted load",
        ),
        (
            CraneLoad::Tilting,
            wheels().any(DesignWheel::tilts),
            "no wheel has a `tilting` force, which is required for a crane with a guided load or lifting attachment",
        ),
    ];
    if let Some((.., why)) = needed
        .iter()
        .find(|(load, is_there, _)| of(*load) != 0.0 && !is_there)
    {
        return Err((*why).to_owned());
    }
    let is_asce = group.clause.standard.starts_with("ASCE");
    let is_mill = group.clause.standard.starts_with("AIST");
    // TR-13 factors the impact of the kind of crane, ASCE 7 gives it.
    let impact = of(CraneLoad::Impact)
        * if is_mill {
            design.practice.kind.fractions().impact
        } else {
            1.0
        };
    let [crane, mut hoist] =
        [of(CraneLoad::SelfWeight), of(CraneLoad::HoistLoad)].map(|factor| factor + impact);
    if of(CraneLoad::TestLoad) != 0.0 {
        // The larger of the static test, 1.25 times the hoisted load with phi6 = 1, and the dynamic one, phi6 times 1.1.
        hoist = test_load(dynamic.phi[1]).map_err(|error| error.to_string())?;
    }
    // The factors 0.2 and 0.1 of ASCE 7 make the forces that the trains give already.
    let given = |factor: f64| {
        if is_asce {
            f64::from(u8::from(factor != 0.0))
        } else {
            factor
        }
    };
    let mut out = vec![
        (
            "dead".to_owned(),
            if is_mill { of(CraneLoad::Dead) } else { 1.0 },
        ),
        (
            "lateral".to_owned(),
            given(of(CraneLoad::BridgeDrives) + of(CraneLoad::SideThrust)),
        ),
        (
            "longitudinal".to_owned(),
            given(of(CraneLoad::BridgeDrives) + of(CraneLoad::Traction)),
        ),
        ("skewing".to_owned(), of(CraneLoad::Skewing)),
        ("buffer".to_owned(), of(CraneLoad::BufferForce)),
    ];
    let trolley = of(CraneLoad::TrolleyDrives);
    out.extend((trolley != 0.0).then(|| (TROLLEY_DRIVES.to_owned(), trolley)));
    let tilting = of(CraneLoad::Tilting);
    out.extend((tilting != 0.0).then(|| (TILTING.to_owned(), tilting)));
    let in_parts = wheels().any(|wheel| wheel.vertical.iter().any(|(name, _)| name != WHOLE));
    if in_parts {
        out.extend([("crane".to_owned(), crane), ("hoist".to_owned(), hoist)]);
    }
    if is_asce {
        out.push((WHOLE.to_owned(), crane));
    }
    Ok(out)
}
