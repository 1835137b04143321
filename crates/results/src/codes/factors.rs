//! Factors of the codes and wheel loads by them, which characterise the crane.

use practice::clause::{
    CodeClause, Evidence, aist_2021, cmaa_1983, cmaa_2010, en_1991_3, mechanics,
};
use practice::factor::DriveOnset;
use practice::{aist, buffer, cmaa, duty, factor};

use super::case::CodeCase;
use super::formulas::aist_evidence;
use super::value::{CodeValue, with_speed};
use formats::units::Dimension;

use Evidence::{Memory, Quoted, Used};

/// A factor or a wheel load by a code.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeFactor {
    /// Its name in summaries.
    pub name: &'static str,
    /// Its dimension.
    pub dimension: Dimension,
    /// Code, clause, formula and value.
    pub value: CodeValue,
}

/// Name, dimension, clause, formula and value of a factor.
type FactorEntry = (&'static str, Dimension, CodeClause, String, Option<f64>);

/// A factor without dimension.
fn number(
    name: &'static str,
    clause: CodeClause,
    formula: &str,
    value: Option<f64>,
) -> FactorEntry {
    (name, Dimension::NUMBER, clause, formula.to_owned(), value)
}

/// A wheel load.
fn force(name: &'static str, clause: CodeClause, formula: &str, value: Option<f64>) -> FactorEntry {
    (name, Dimension::FORCE, clause, formula.to_owned(), value)
}

/// All factors of the codes and the wheel loads by them; values outside the domain of a formula are omitted.
#[must_use]
pub(super) fn factors(case: &CodeCase) -> Vec<CodeFactor> {
    let list = eurocode_factors(case)
        .into_iter()
        .chain(cmaa_factors(case))
        .chain(wheel_loads(case));
    let finite =
        list.chain(fatigue(case))
            .filter_map(|(name, dimension, clause, formula, value)| {
                let value = value.filter(|value| value.is_finite())?;
                Some(CodeFactor {
                    name,
                    dimension,
                    value: CodeValue {
                        clause,
                        formula,
                        value,
                    },
                })
            });
    finite.collect()
}

/// Dynamic factors of EN 1991-3.
fn eurocode_factors(case: &CodeCase) -> [FactorEntry; 11] {
    let practice = case.practice;
    let phi5 = factor::phi5(practice.drives);
    let phi3 = factor::phi3(1.0, 1.0, practice.release).ok();
    let phi6 = case.phi2.and_then(|phi2| factor::phi6(phi2).ok());
    let test = case.phi2.and_then(|phi2| factor::test_load(phi2).ok());
    let en = en_1991_3;
    let known = if practice.drives == DriveOnset::Smooth {
        Used
    } else {
        Memory
    };
    let [least, most] = factor::PHI1;
    [
        number(
            "phi1_least",
            en("Table 2.4", Used),
            "dead weight, lifting",
            Some(least),
        ),
        number(
            "phi1_most",
            en("Table 2.4", Used),
            "dead weight, lifting",
            Some(most),
        ),
        number(
            "phi2",
            en("Tables 2.4, 2.5", Used),
            "load, lifting: phi2,min + beta2 v",
            case.phi2,
        ),
        number(
            "phi3",
            en("Table 2.4", Used),
            "load, the whole of it released",
            phi3,
        ),
        number(
            "phi4",
            en("Table 2.4", Used),
            "travelling on rails within tolerance",
            Some(factor::PHI4),
        ),
        number(
            "phi5_least",
            en("Table 2.6", known),
            "forces of drives",
            Some(phi5[0]),
        ),
        number(
            "phi5_most",
            en("Table 2.6", known),
            "forces of drives",
            Some(phi5[1]),
        ),
        number(
            "phi6",
            en("2.10", Used),
            "dynamic test load: (1 + phi2)/2",
            phi6,
        ),
        number(
            "phi6_static",
            en("2.10", Used),
            "static test load of 1.25 times the rated load",
            Some(1.0),
        ),
        number(
            "test_load",
            en("2.10", Used),
            "larger of 1.25 and phi6 1.1, times the rated load",
            test,
        ),
        number(
            "phi7",
            en("Table 2.10", Used),
            "buffers, springs",
            buffer::phi7(0.5).ok(),
        ),
    ]
}

/// Factors of CMAA 70.
fn cmaa_factors(case: &CodeCase) -> [FactorEntry; 4] {
    let crane = case.crane;
    let skew = cmaa::skew_coefficient(crane.model.span, crane.wheel_base()).ok();
    let inertia = case
        .measured
        .acceleration
        .and_then(|a| cmaa::drive_inertia(a * case.metre).ok());
    let [hoist, dead] = [
        with_speed("HLF by the hoisting speed", crane.speeds[2]),
        with_speed("DLF by the speed of the bridge", crane.speeds[0]),
    ];
    [
        number(
            "hoist_load_factor",
            cmaa_2010("3.3.2.1.4.2", Quoted),
            &hoist,
            Some(case.hoist_load_factor()),
        ),
        number(
            "dead_load_factor",
            cmaa_2010("3.3.2.1.4.1", Quoted),
            &dead,
            Some(case.dead_load_factor()),
        ),
        number(
            "skew_coefficient",
            cmaa_2010("3.3.2.2.2", Memory),
            "S_sk",
            skew,
        ),
        number(
            "bridge_girder_inertia",
            cmaa_1983("3.3.2.1.1.5", Quoted),
            "lateral over vertical load of the bridge girders, no load of the runway: 7.8 % per ft/s2 of the \
             bridge's acceleration in this run, at least 2.5 %",
            inertia,
        ),
    ]
}

/// The impact factors, and loads of one wheel: static, in load group 1, and with impact.
fn wheel_loads(case: &CodeCase) -> [FactorEntry; 5] {
    let kind = case.practice.kind;
    let [near, far] = [
        case.full.map(|full| full.near),
        case.full.map(|full| full.far),
    ];
    let group = case
        .phi2
        .and_then(|phi2| case.crane.model.wheel_loads(factor::PHI1[1], phi2).ok());
    let group = group.map(|group| group.near);
    let with_impact = case
        .full
        .and_then(|full| aist::with_impact(kind, full.near).ok());
    let clause = aist_2021("3.7.2, Table 3.2", aist_evidence(kind));
    [
        number(
            "impact",
            clause,
            "of the largest wheel loads",
            Some(kind.fractions().impact),
        ),
        force(
            "wheel_near",
            mechanics("statics"),
            "trolley at its approach",
            near,
        ),
        force("wheel_far", mechanics("statics"), "on the other rail", far),
        force(
            "wheel_group_1",
            en_1991_3("2.6, Table 2.2", Used),
            "near, phi1 and phi2",
            group,
        ),
        force("wheel_impact", clause, "near, with impact", with_impact),
    ]
}

/// Damage-equivalent factors and wheel loads of the class of load effect history, if one is specified.
fn fatigue(case: &CodeCase) -> Vec<FactorEntry> {
    let Some(class) = case.practice.s_class else {
        return Vec::new();
    };
    let factors = case.phi2.and_then(|phi2| {
        Some([
            duty::fatigue_factor(factor::PHI1[1]).ok()?,
            duty::fatigue_factor(phi2).ok()?,
        ])
    });
    let most = factors.and_then(|[dead, hoist]| case.crane.model.wheel_loads(dead, hoist).ok());
    // the factors phi_fat of the parts are in the wheel load, so that of their sum is one
    let load =
        |lambda: f64| most.and_then(|most| duty::equivalent_load(most.near, lambda, 1.0).ok());
    let (normal, shear) = (class.normal(), class.shear());
    let [table, clause] = [en_1991_3("Table 2.12", Used), en_1991_3("2.12.1", Used)];
    let formula =
        "near, lambda (phi_fat,1 on dead weight, phi_fat,2 on the load), phi_fat = (1 + phi)/2";
    vec![
        number(
            "lambda_normal",
            table,
            "damage-equivalent factor of the class, normal stress",
            Some(normal),
        ),
        number(
            "lambda_shear",
            table,
            "damage-equivalent factor of the class, shear stress",
            Some(shear),
        ),
        number(
            "phi_fat_dead",
            clause,
            "(1 + phi1)/2",
            factors.map(|[dead, _]| dead),
        ),
        number(
            "phi_fat_hoist",
            clause,
            "(1 + phi2)/2",
            factors.map(|[_, hoist]| hoist),
        ),
        force("wheel_fatigue_normal", clause, formula, load(normal)),
        force("wheel_fatigue_shear", clause, formula, load(shear)),
    ]
}
