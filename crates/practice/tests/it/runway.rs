//! Limits of deflections, groups of loads and local stresses, each against a hand calculation.

use practice::aist::{self, BuildingClass, CraneKind};
use practice::asce::{self, CraneOperation};
use practice::clause::Evidence;
use practice::combination::{CraneLoad, DynamicFactors, GroupUse, LoadGroup, eurocode_groups};
use practice::factor::{self, Release};
use practice::limit_choice::{LIMIT_CODES, limits_of};
use practice::limits::{
    CMAA_LIMITS, DeflectionLimit, EN_1993_6_LIMITS, GantryCrane, LimitedDisplacement, ServiceClass,
    design_guide_limits, is_800_limits, mill_limits,
};
use practice::local_stress::{LocalStresses, RailFixing, RailSeat, cmaa_bearing_length};
use practice::mill_combination::{asce_group, mill_combinations, mill_fatigue};
use practice::skew::{self, Guide, WheelPairs};
use practice::{Crane, Error};

fn close(found: f64, expected: f64, slack: f64) {
    assert!(
        (found - expected).abs() <= slack,
        "{found} is not {expected}"
    );
}

/// Allowable displacement by the one limit of `displacement`, m.
fn allowable(limits: &[DeflectionLimit], displacement: LimitedDisplacement, length: f64) -> f64 {
    let mut own = limits
        .iter()
        .filter(|limit| limit.displacement == displacement);
    let limit = own.next().expect("a limit");
    assert!(own.next().is_none(), "one limit for each displacement");
    limit.allowable(length).expect("a positive length")
}

/// By hand: L/600 is 12.5 mm for 7.5 m; for 18 m it is 30 mm, so that 25 mm governs.
#[test]
fn the_smaller_of_ratio_and_length_governs() {
    let of = |length| {
        allowable(
            &EN_1993_6_LIMITS,
            LimitedDisplacement::RunwayVertical,
            length,
        )
    };
    close(of(7.5), 0.0125, 1e-15);
    close(of(18.0), 0.025, 1e-15);
    close(
        allowable(&EN_1993_6_LIMITS, LimitedDisplacement::RunwayLateral, 18.0),
        0.03,
        1e-15,
    );
    // rails 22.5 m apart: 10 mm of gauge, 37.5 mm of height
    close(
        allowable(&EN_1993_6_LIMITS, LimitedDisplacement::GaugeChange, 22.5),
        0.01,
        0.0,
    );
    close(
        allowable(
            &EN_1993_6_LIMITS,
            LimitedDisplacement::HeightDifference,
            22.5,
        ),
        0.0375,
        1e-15,
    );
    close(
        allowable(
            &EN_1993_6_LIMITS,
            LimitedDisplacement::MonorailVertical,
            5.0,
        ),
        0.01,
        1e-15,
    );
    assert_eq!(EN_1993_6_LIMITS[0].formula(), "L/600, at most 25 mm");
    assert!(EN_1993_6_LIMITS[0].allowable(0.0).is_err());
    assert!(EN_1993_6_LIMITS[0].allowable(f64::NAN).is_err());
}

/// By hand, for a span of 12 m: 20, 15 and 12 mm; laterally 30 mm. Bridge girders: 0.001125 x 24 m = 27 mm.
#[test]
fn limits_follow_classes() {
    let vertical = LimitedDisplacement::RunwayVertical;
    let lateral = LimitedDisplacement::RunwayLateral;
    let by_class = [
        (ServiceClass::A, 0.020),
        (ServiceClass::C, 0.020),
        (ServiceClass::D, 0.015),
        (ServiceClass::E, 0.012),
        (ServiceClass::F, 0.012),
    ];
    for (class, expected) in by_class {
        close(
            allowable(&design_guide_limits(class), vertical, 12.0),
            expected,
            1e-15,
        );
        close(
            allowable(&design_guide_limits(class), lateral, 12.0),
            0.03,
            1e-15,
        );
    }
    close(
        allowable(&mill_limits(BuildingClass::A), vertical, 12.0),
        0.012,
        1e-15,
    );
    close(
        allowable(&mill_limits(BuildingClass::D), vertical, 12.0),
        0.020,
        1e-15,
    );
    close(
        allowable(
            &mill_limits(BuildingClass::D),
            LimitedDisplacement::FrameLateral,
            40.0,
        ),
        0.0508,
        1e-15,
    );
    close(allowable(&CMAA_LIMITS, vertical, 12.0), 0.020, 1e-15);
    close(
        allowable(&CMAA_LIMITS, LimitedDisplacement::BridgeGirder, 24.0),
        0.027,
        1e-12,
    );
    assert_eq!(
        CMAA_LIMITS[2].formula(),
        "L/889",
        "0.001125 L, also written L/888"
    );
    close(
        allowable(&is_800_limits(GantryCrane::Manual, true), vertical, 12.0),
        0.024,
        1e-15,
    );
    close(
        allowable(
            &is_800_limits(GantryCrane::ElectricTo50Tonnes, true),
            vertical,
            12.0,
        ),
        0.016,
        1e-15,
    );
    close(
        allowable(
            &is_800_limits(GantryCrane::ElectricAbove50Tonnes, false),
            vertical,
            12.0,
        ),
        0.012,
        1e-15,
    );
    let frame = LimitedDisplacement::FrameLateral;
    close(
        allowable(&is_800_limits(GantryCrane::Manual, false), frame, 10.0),
        0.05,
        1e-15,
    );
    close(
        allowable(&is_800_limits(GantryCrane::Manual, true), frame, 10.0),
        0.025,
        1e-15,
    );
}

#[test]
fn limits_are_found_by_the_names_of_code_and_class() {
    let classes = [None, None, None, Some("E"), Some("C"), Some("heavy")];
    for (code, class) in LIMIT_CODES.into_iter().zip(classes) {
        let limits = limits_of(code, class).expect(code);
        assert!(
            limits
                .iter()
                .any(|limit| limit.displacement == LimitedDisplacement::RunwayVertical)
        );
    }
    assert_eq!(
        limits_of("EN 1993-6:2007", None),
        limits_of("EN 1991-3", Some("anything"))
    );
    assert_eq!(
        limits_of("AIST TR-13", Some("E")),
        None,
        "buildings have classes A to D"
    );
    assert_eq!(limits_of("AISC Design Guide 7", Some("G")), None);
    assert_eq!(limits_of("IS 800", Some("A")), None);
    assert_eq!(limits_of("DIN 4132", None), None);
}

/// By hand, for Q = 200, T = 40, B = 190 kN: 0.1 x 430 = 43 kN; 1.1 x 161.24 = 177.36 kN; 0.2 x 322.48 = 64.5 kN.
#[test]
fn pendant_cranes_of_tr_13_have_their_own_row() -> Result<(), Error> {
    let crane = Crane {
        lifted: 200.0,
        trolley: 40.0,
        bridge: 190.0,
        span: 23.0,
        approach: 1.2,
        wheels: 2,
    };
    let near = crane.wheel_loads(1.0, 1.0)?.near;
    close(
        aist::side_thrust(CraneKind::Pendant, &crane)?.governing(),
        43.0,
        1e-12,
    );
    close(aist::with_impact(CraneKind::Pendant, near)?, 177.363, 5e-4);
    close(
        aist::tractive_force(CraneKind::Pendant, &[near, near])?,
        64.4957,
        5e-4,
    );
    Ok(())
}

/// By hand: 0.2 x (200 + 40) = 48 kN, 0.1 x (100 + 100) = 20 kN.
#[test]
fn asce_7_has_its_fractions() -> Result<(), Error> {
    let impacts = [
        (CraneOperation::Monorail, 0.25),
        (CraneOperation::Cab, 0.25),
        (CraneOperation::Pendant, 0.10),
        (CraneOperation::HandGeared, 0.0),
    ];
    let factors = DynamicFactors::of_crane(1.1, 1.5, Release::Slow)?;
    for (operation, impact) in impacts {
        assert_eq!(operation.impact(), impact);
        let group = asce_group(operation);
        assert_eq!(group.factor(CraneLoad::Impact, &factors), impact);
        let powered = if operation == CraneOperation::HandGeared {
            0.0
        } else {
            1.0
        };
        assert_eq!(group.factor(CraneLoad::SideThrust, &factors), 0.2 * powered);
        assert_eq!(group.factor(CraneLoad::Traction, &factors), 0.1 * powered);
    }
    close(asce::lateral_force(200.0, 40.0)?, 48.0, 1e-12);
    close(asce::longitudinal_force(&[100.0, 100.0])?, 20.0, 1e-12);
    assert!(asce::lateral_force(-1.0, 0.0).is_err());
    Ok(())
}

/// By hand: phi2 = 1.168 gives phi6 = 1.084 and 1.1 x 1.084 = 1.1924 < 1.25.
#[test]
fn the_larger_test_load_governs() -> Result<(), Error> {
    close(factor::test_load(1.168)?, 1.25, 0.0);
    close(factor::test_load(1.5)?, 1.375, 1e-12);
    assert!(factor::test_load(0.9).is_err());
    Ok(())
}

fn named<'g>(groups: &'g [LoadGroup], name: &str) -> &'g LoadGroup {
    groups
        .iter()
        .find(|group| group.name == name)
        .expect("a group")
}

/// By hand, with phi1 = 1.1, phi2 = 1.168, phi3 = -1, phi4 = 1, phi5 = 1.5, phi6 = 1.084, phi7 = 1.25: the vertical
/// action of self-weight 230 and load 200 kN in groups 1 to 4 is 486.6, 53, 230 and 430 kN.
#[test]
fn groups_of_the_eurocode_multiply_their_loads() -> Result<(), Error> {
    let factors = DynamicFactors::of_crane(1.168, 1.5, Release::Rapid)?;
    let groups = eurocode_groups();
    assert_eq!(groups.len(), 10);
    let vertical = |name: &str| {
        let group = named(&groups, name);
        230.0 * group.factor(CraneLoad::SelfWeight, &factors)
            + 200.0 * group.factor(CraneLoad::HoistLoad, &factors)
    };
    let expected = [
        ("1", 1.1 * 230.0 + 1.168 * 200.0),
        ("2", 1.1 * 230.0 - 200.0),
        ("3", 230.0),
        ("4", 430.0),
        ("5", 430.0),
        ("6", 430.0),
        ("7", 230.0),
        ("8", 253.0),
        ("9", 430.0),
        ("10", 430.0),
    ];
    for (name, expected) in expected {
        close(vertical(name), expected, 1e-9);
    }
    let with = |load| -> Vec<&str> {
        let own = groups
            .iter()
            .filter(|group| group.factor(load, &factors) != 0.0);
        own.map(|group| group.name).collect()
    };
    assert_eq!(with(CraneLoad::BridgeDrives), ["1", "2", "3", "4", "8"]);
    assert_eq!(with(CraneLoad::Skewing), ["5"]);
    assert_eq!(with(CraneLoad::TrolleyDrives), ["6"]);
    assert_eq!(with(CraneLoad::BufferForce), ["9"]);
    assert_eq!(with(CraneLoad::Tilting), ["10"]);
    assert_eq!(with(CraneLoad::Wind), ["1", "2", "3", "4", "5", "8"]);
    close(
        named(&groups, "1").factor(CraneLoad::BridgeDrives, &factors),
        1.5,
        0.0,
    );
    close(
        named(&groups, "8").factor(CraneLoad::TestLoad, &factors),
        1.084,
        1e-12,
    );
    close(
        named(&groups, "9").factor(CraneLoad::BufferForce, &factors),
        1.25,
        0.0,
    );
    let remaining = DynamicFactors {
        remaining: 0.2,
        ..factors
    };
    close(
        named(&groups, "7").factor(CraneLoad::HoistLoad, &remaining),
        0.2,
        0.0,
    );
    assert_eq!(named(&groups, "9").purpose, GroupUse::Accidental);
    assert_eq!(named(&groups, "10").clause.evidence, Evidence::Memory);
    Ok(())
}

/// By hand, with D = 10, crane 230, hoisted load 200, impact 60, side thrust 43, traction 60 kN: 2a of ASD has
/// 10 + 230 + 200 downwards and no impact; 2b has impact and no side thrust; 4b of ASD 240 + 0.75 x 260 = 435; 2c of
/// LRFD 1.2 x 240 + 1.6 x 260 = 704.
#[test]
fn impact_and_side_thrust_of_tr_13_exclude_each_other() -> Result<(), Error> {
    let factors = DynamicFactors::of_crane(1.1, 1.5, Release::Slow)?;
    let [allowable, strength] =
        [GroupUse::AllowableStress, GroupUse::Strength].map(mill_combinations);
    assert_eq!([allowable.len(), strength.len()], [15, 14]);
    assert!(mill_combinations(GroupUse::Fatigue).is_empty());
    for group in allowable.iter().chain(&strength) {
        let of = |load| group.factor(load, &factors);
        assert!(
            of(CraneLoad::Impact) == 0.0 || of(CraneLoad::SideThrust) == 0.0,
            "{}",
            group.name
        );
        assert!(
            of(CraneLoad::Impact) == 0.0 || group.is_single_crane,
            "{}",
            group.name
        );
        assert!(
            of(CraneLoad::HoistLoad) == 0.0 || of(CraneLoad::LeastHoistLoad) == 0.0,
            "{}",
            group.name
        );
    }
    let vertical = |group: &LoadGroup| {
        let of = |load| group.factor(load, &factors);
        10.0 * of(CraneLoad::Dead)
            + 230.0 * of(CraneLoad::SelfWeight)
            + 200.0 * of(CraneLoad::HoistLoad)
            + 60.0 * of(CraneLoad::Impact)
    };
    close(vertical(named(&allowable, "2a")), 440.0, 1e-9);
    close(vertical(named(&allowable, "2b")), 500.0, 1e-9);
    close(vertical(named(&allowable, "4b")), 435.0, 1e-9);
    close(vertical(named(&strength, "2c")), 704.0, 1e-9);
    close(vertical(named(&strength, "9")), 216.0, 1e-9);
    close(
        named(&strength, "9").factor(CraneLoad::LeastHoistLoad, &factors),
        1.6,
        0.0,
    );
    close(
        named(&allowable, "9").factor(CraneLoad::BufferForce, &factors),
        0.67,
        0.0,
    );
    let fatigue = mill_fatigue();
    assert!(fatigue.is_single_crane);
    close(fatigue.factor(CraneLoad::SideThrust, &factors), 0.5, 0.0);
    close(fatigue.factor(CraneLoad::Impact, &factors), 0.0, 0.0);
    Ok(())
}

/// By hand, in mm and N: a rail of 90 cm4 (A45: 55 mm high, foot 125 mm) worn to 75 % beside the flange of a HEB
/// 400 (300 x 24, web 13.5). b_eff = min(300, 125 + 55 + 24) = 204; I_f,eff = 204 x 24^3/12 = 235008;
/// I_r + I_f,eff = 675000 + 235008 = 910008; (910008/13.5)^(1/3) = 40.698; 3.25 and 4.25 times that is 132.27 and
/// 172.97 mm. 180 kN over 132.27 x 13.5 mm2 is 100.8 N/mm2, and a fifth of it shear.
#[test]
fn wheel_loads_spread_over_the_effective_length() -> Result<(), Error> {
    let loose = RailSeat {
        fixing: RailFixing::Loose,
        inertia: 0.75 * 900_000.0,
        flange_width: 300.0,
        flange: 24.0,
        web: 13.5,
        rail_height: 55.0,
        rail_foot: 125.0,
    };
    close(loose.effective_width()?, 204.0, 1e-12);
    close(loose.effective_length()?, 132.27, 5e-3);
    close(
        RailSeat {
            fixing: RailFixing::ElasticPad,
            ..loose
        }
        .effective_length()?,
        172.97,
        5e-3,
    );
    let stresses = loose.stresses(180_000.0)?;
    close(stresses.vertical, 100.8, 0.05);
    close(stresses.shear, stresses.vertical / 5.0, 1e-12);
    close(stresses.total_shear(-30.0), 30.0 + 20.16, 0.02);
    // a narrow flange limits b_eff, and a rigid rail has the inertia of both as one section
    close(
        RailSeat {
            flange_width: 150.0,
            ..loose
        }
        .effective_width()?,
        150.0,
        0.0,
    );
    let rigid = RailSeat {
        fixing: RailFixing::Rigid,
        inertia: 8.0 * 13.5e3,
        ..loose
    };
    close(rigid.effective_length()?, 65.0, 1e-9);
    assert!(RailSeat { web: 0.0, ..loose }.effective_length().is_err());
    assert!(
        RailSeat {
            inertia: -1.0,
            ..loose
        }
        .stresses(1.0)
        .is_err()
    );
    // CMAA: 2 x 100 mm + 2 in = 250.8 mm
    let length = cmaa_bearing_length(0.1)?;
    close(length, 0.2508, 1e-12);
    close(
        LocalStresses::over(100.0, length, 0.01)?.vertical,
        100.0 / 0.002508,
        1e-6,
    );
    Ok(())
}

/// By hand, for two separately driven pairs, the first at the guide, and 70 % of the loads on the rail of the guide:
/// lambda_S = 0.5, lambda_S,1,1,T = 0.3/2 = 0.15, so that the rail receives 0.35.
#[test]
fn a_rail_receives_the_guide_force_less_the_force_of_its_wheel() -> Result<(), Error> {
    let forces = skew::skewing(WheelPairs::AloneFixed, 18.0, 0.7, &[0.0, 4.0])?;
    close(forces.net_on_rail(), 0.35, 1e-12);
    // the rest of the lateral forces balances it
    let rest: f64 = forces
        .across
        .iter()
        .map(|pair| pair[0] + pair[1])
        .sum::<f64>()
        - forces.across[0][0];
    close(forces.net_on_rail(), rest, 1e-12);
    // the angle does not exceed 0.015: (0.015 + 0.006)/1 + 0.001 would be 0.022
    close(skew::angle(Guide::Flanges, 0.02, 0.06, 1.0)?, 0.015, 0.0);
    Ok(())
}
