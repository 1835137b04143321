//! Values of codes: published numbers, equilibrium, closed forms.

use practice::aist::{self, BuildingClass, CraneKind};
use practice::factor::{self, DriveOnset, HoistingClass, Release};
use practice::skew::{self, Guide, WheelPairs};
use practice::{Crane, Error, buffer, cmaa, drive, duty, osha};

const FOOT: f64 = 0.3048;
const FOOT_PER_MINUTE: f64 = FOOT / 60.0;

fn close(found: f64, expected: f64, slack: f64) {
    assert!(
        (found - expected).abs() <= slack,
        "{found} is not {expected}"
    );
}

/// The maintenance crane of a published Chilean worked example by AIST TR-13 and CMAA 70 (kN, m).
fn maintenance() -> Crane {
    Crane {
        lifted: 200.0,
        trolley: 40.0,
        bridge: 190.0,
        span: 23.0,
        approach: 1.2,
        wheels: 2,
    }
}

#[test]
fn the_worked_case_comes_out_to_its_digits() -> Result<(), Error> {
    // External: 161.23913, 53.76087, 193.487; 60, 48, 43; 86 kN, all four wheels driven.
    let crane = maintenance();
    let loads = crane.wheel_loads(1.0, 1.0)?;
    close(loads.near, 161.23913, 5e-6);
    close(loads.far, 53.76087, 5e-6);
    close(2.0 * (loads.near + loads.far), crane.weight(), 1e-12);
    close(
        aist::with_impact(CraneKind::MotorRoom, loads.near)?,
        193.487,
        5e-4,
    );
    let thrust = aist::side_thrust(CraneKind::MotorRoom, &crane)?;
    close(thrust.lifted, 60.0, 1e-12);
    close(thrust.trolley, 48.0, 1e-12);
    close(thrust.crane, 43.0, 1e-12);
    close(thrust.governing(), 60.0, 1e-12);
    let driven = [loads.near, loads.near, loads.far, loads.far];
    close(
        aist::tractive_force(CraneKind::MotorRoom, &driven)?,
        86.0,
        1e-12,
    );
    // The CMAA factors of the same crane, at 4 and 30 m/min, are at their lower bounds.
    close(cmaa::hoist_load_factor(4.0 / 60.0)?, 0.15, 0.0);
    close(cmaa::dead_load_factor(30.0 / 60.0)?, 1.1, 0.0);
    Ok(())
}

#[test]
fn any_of_the_three_side_thrusts_can_govern() -> Result<(), Error> {
    let crane = maintenance();
    let heavy_trolley = Crane {
        trolley: 200.0,
        ..crane
    };
    let heavy_bridge = Crane {
        bridge: 700.0,
        ..crane
    };
    close(
        aist::side_thrust(CraneKind::MotorRoom, &heavy_trolley)?.governing(),
        0.2 * 400.0,
        1e-12,
    );
    close(
        aist::side_thrust(CraneKind::MotorRoom, &heavy_bridge)?.governing(),
        0.1 * 940.0,
        1e-12,
    );
    close(
        aist::side_thrust(CraneKind::Mill, &crane)?.governing(),
        80.0,
        1e-12,
    );
    close(aist::with_impact(CraneKind::Mill, 100.0)?, 125.0, 1e-12);
    Ok(())
}

#[test]
fn a_crane_without_load_stands_on_its_dead_weight() -> Result<(), Error> {
    let crane = maintenance();
    let empty = crane.wheel_loads(1.0, 0.0)?;
    close(2.0 * (empty.near + empty.far), 230.0, 1e-12);
    let group1 = crane.wheel_loads(1.1, 1.3)?;
    close(
        2.0 * (group1.near + group1.far),
        1.1 * 230.0 + 1.3 * 200.0,
        1e-12,
    );
    let middle = Crane {
        approach: 11.5,
        ..crane
    }
    .wheel_loads(1.0, 1.0)?;
    close(middle.near, middle.far, 1e-12);
    Ok(())
}

#[test]
fn hoisting_factors_are_those_of_the_table() -> Result<(), Error> {
    // External: EN 1991-3, Table 2.5, at 0.2 m/s.
    let expected = [1.084, 1.168, 1.252, 1.336];
    for (class, expected) in HoistingClass::ALL.into_iter().zip(expected) {
        close(factor::phi2(class, 0.2)?, expected, 1e-12);
    }
    close(factor::phi6(1.168)?, 1.084, 1e-12);
    close(factor::phi3(0.5, 1.0, Release::Slow)?, 0.25, 1e-12);
    close(factor::phi3(1.0, 1.0, Release::Rapid)?, -1.0, 1e-12);
    assert_eq!(factor::phi5(DriveOnset::Smooth), [1.0, 1.5]);
    Ok(())
}

#[test]
fn a_spring_buffer_meets_the_energy_balance() -> Result<(), Error> {
    // Analytic: m v^2/2 = F^2/(2 S).
    let (mass, stiffness, speed) = (40e3_f64, 2e6, 1.4);
    let force = buffer::buffer_force(1.0, speed, mass, stiffness)?;
    close(
        force * force / (2.0 * stiffness),
        mass * speed * speed / 2.0,
        1e-6,
    );
    // The work of a stopping force over its stroke is the same.
    let stroke = force / stiffness;
    close(
        buffer::stopping_force(mass, speed, stroke, 0.5)?,
        force,
        1e-6,
    );
    close(buffer::phi7(0.5)?, 1.25, 0.0);
    close(buffer::phi7(1.0)?, 1.6, 1e-12);
    close(buffer::trolley_force(200.0, 40.0)?, 24.0, 1e-12);
    let code = buffer::buffer_force(
        buffer::phi7(0.2)?,
        buffer::END_STOP_SPEED * 2.0,
        mass,
        stiffness,
    )?;
    close(code, 1.25 * force, 1e-6);
    Ok(())
}

#[test]
fn forces_of_acceleration_turn_nothing() -> Result<(), Error> {
    // Independent: the couple of the drives about the middle against the couples of both rails at the guides.
    let travel = drive::AcceleratingCrane {
        span: 18.0,
        guides: 4.0,
        heavy: 280.0,
        light: 120.0,
        drive: drive::drive_force(drive::FRICTION[0], &[30.0, 30.0])?,
        factor: 1.5,
        rails: 2,
    };
    let forces = drive::traction(&travel)?;
    close(travel.drive, 12.0, 1e-12);
    close(forces.along, 9.0, 1e-12);
    close(forces.fraction, 0.7, 1e-12);
    close(forces.moment, 12.0 * 0.2 * 18.0, 1e-12);
    close(
        (forces.heavy + forces.light) * travel.guides,
        travel.factor * forces.moment,
        1e-12,
    );
    close(forces.heavy / forces.light, 0.3 / 0.7, 1e-12);
    Ok(())
}

#[test]
fn friction_of_skewing_grows_from_250_alpha_to_its_end() -> Result<(), Error> {
    close(skew::friction(1e-9)? / 1e-9, 75.0, 1e-4);
    // External: 0.2929 at the largest angle.
    close(
        skew::friction(skew::MAX_ANGLE)?,
        0.3 * (1.0 - (-3.75_f64).exp()),
        1e-15,
    );
    close(skew::friction(1.0)?, 0.3, 1e-12);
    // 20 mm of slack, 60 mm of head, 4 m between flanges.
    close(
        skew::angle(Guide::Flanges, 0.02, 0.06, 4.0)?,
        (0.015 + 0.006) / 4.0 + 0.001,
        1e-15,
    );
    close(
        skew::angle(Guide::Rollers, 0.0, 0.06, 4.0)?,
        (0.005 + 0.0018) / 4.0 + 0.001,
        1e-15,
    );
    Ok(())
}

#[test]
fn forces_of_skewing_balance_across_and_about_the_guide() -> Result<(), Error> {
    let (span, share) = (18.0, 0.7);
    for pairs in [
        vec![0.0, 4.0],
        vec![0.5, 2.5, 5.0],
        vec![1.0, 1.0, 6.0, 6.5],
    ] {
        for kind in [
            WheelPairs::AloneFixed,
            WheelPairs::AloneFree,
            WheelPairs::CoupledFixed,
            WheelPairs::CoupledFree,
        ] {
            let forces = skew::skewing(kind, span, share, &pairs)?;
            let across: f64 = forces.across.iter().map(|pair| pair[0] + pair[1]).sum();
            close(across, forces.guide, 1e-12);
            let arms = forces.across.iter().zip(&pairs);
            let turning: f64 = arms.map(|(pair, arm)| (pair[0] + pair[1]) * arm).sum();
            let along: f64 = forces.along.iter().sum();
            close(turning, along * span, 1e-12);
        }
    }
    // External: a crane with two separately driven pairs, the first at the guide, rotates about the second.
    let two = skew::skewing(WheelPairs::AloneFixed, span, share, &[0.0, 4.0])?;
    close(two.rotation_distance, 4.0, 1e-12);
    close(two.guide, 0.5, 1e-12);
    close(two.across[0][0], 0.15, 1e-12);
    close(two.across[0][1], 0.35, 1e-12);
    close(two.across[1][0], 0.0, 1e-12);
    Ok(())
}

#[test]
fn cmaa_and_osha_agree_with_their_feet() -> Result<(), Error> {
    close(cmaa::hoist_load_factor(60.0 * FOOT_PER_MINUTE)?, 0.3, 1e-12);
    close(cmaa::hoist_load_factor(1.0)?, 0.5, 0.0);
    close(
        cmaa::dead_load_factor(200.0 * FOOT_PER_MINUTE)?,
        1.15,
        1e-12,
    );
    close(cmaa::dead_load_factor(10.0)?, 1.2, 0.0);
    close(cmaa::drive_inertia(0.0)?, 0.025, 0.0);
    close(cmaa::drive_inertia(FOOT)?, 0.078, 1e-12);
    close(
        cmaa::skew_coefficient(23.0, 3.4)?,
        0.05 + 0.02 * (23.0 / 3.4 - 3.0),
        1e-12,
    );
    close(cmaa::skew_coefficient(30.0, 3.0)?, 0.15, 0.0);
    close(skew::fem_coefficient(20.0, 10.0)?, 0.05, 1e-12);
    close(skew::fem_coefficient(20.0, 2.0)?, 0.2, 1e-12);
    // 25 ft at 250 ft/min.
    close(
        osha::brake_distance(250.0 * FOOT_PER_MINUTE)?,
        25.0 * FOOT,
        1e-12,
    );
    // Two equal cranes with a closing speed of 0.8 v lose half of the kinetic energy of one at that speed.
    close(
        cmaa::collision_energy([2.0, 2.0], [1.0, 1.0])?,
        0.5 * 1.0 * 0.64,
        1e-12,
    );
    Ok(())
}

#[test]
fn limits_of_runways_and_frames_are_those_of_tr_13() -> Result<(), Error> {
    assert_eq!(aist::runway_vertical(BuildingClass::B), 1000.0);
    assert_eq!(aist::runway_vertical(BuildingClass::C), 600.0);
    close(aist::drift(12.0)?, 0.03, 1e-15);
    close(aist::drift(40.0)?, 0.0508, 1e-15);
    Ok(())
}

#[test]
fn damage_equivalent_loads_follow_their_classes() -> Result<(), Error> {
    // Each class doubles the damage of the one below: by cubes for normal stresses, by fifth powers for
    // shear.
    for index in 0..10 {
        let class = duty::FatigueClass::new(index).expect("there are ten");
        let doublings = f64::from(index) - 7.0;
        close(class.normal(), (doublings / 3.0).exp2(), 5e-4);
        close(class.shear(), (doublings / 5.0).exp2(), 8e-4);
    }
    assert_eq!(duty::FatigueClass::new(10), None);
    close(
        duty::equivalent_load(100.0, 0.5, duty::fatigue_factor(1.1)?)?,
        52.5,
        1e-12,
    );
    Ok(())
}

#[test]
fn numbers_that_make_no_sense_are_refused() {
    let crane = maintenance();
    assert!(matches!(
        Crane { wheels: 0, ..crane }.wheel_loads(1.0, 1.0),
        Err(Error::Range { .. })
    ));
    assert!(
        Crane {
            approach: 24.0,
            ..crane
        }
        .wheel_loads(1.0, 1.0)
        .is_err()
    );
    assert!(
        Crane {
            lifted: f64::NAN,
            ..crane
        }
        .wheel_loads(1.0, 1.0)
        .is_err()
    );
    assert!(factor::phi2(HoistingClass::Hc1, f64::INFINITY).is_err());
    assert!(factor::phi3(2.0, 1.0, Release::Slow).is_err());
    assert!(buffer::phi7(1.1).is_err());
    assert!(buffer::stopping_force(1.0, 1.0, 0.0, 0.5).is_err());
    assert_eq!(
        skew::skewing(WheelPairs::AloneFixed, 10.0, 0.5, &[]),
        Err(Error::NoRotationCentre)
    );
    assert_eq!(
        skew::skewing(WheelPairs::CoupledFree, 10.0, 0.5, &[0.0]),
        Err(Error::NoRotationCentre)
    );
    assert!(osha::brake_distance(-1.0).is_err());
    assert!(aist::drift(0.0).is_err());
}
