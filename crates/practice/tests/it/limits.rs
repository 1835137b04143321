//! Every function returns finite numbers or an error for any input.

use practice::factor::{HoistingClass, Release};
use practice::fatigue::Stress;
use practice::skew::{Guide, WheelPairs};
use practice::{
    Crane, Decay, Error, HistorySpectrum, Repetition, ResponseSettings, SectionPoint,
    SectionProperties, SineComponent, Strength, aist, asce, buffer, cmaa, decay, drive, duty,
    factor, limits, local_stress, osha, rainflow, response, skew, stress,
};

const ODD: [f64; 13] = [
    0.0,
    -0.0,
    5e-324,
    1e-40,
    1e-30,
    1.0,
    -1.0,
    1e30,
    1e100,
    f64::MAX,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
];

/// Counts of numbers and of refusals.
#[derive(Default)]
struct Tally {
    numbers: usize,
    refusals: usize,
}

impl Tally {
    fn add(&mut self, result: Result<Vec<f64>, Error>) {
        match result {
            Ok(values) => {
                assert!(values.iter().all(|value| value.is_finite()), "{values:?}");
                self.numbers += 1;
            }
            Err(_) => self.refusals += 1,
        }
    }

    fn one(&mut self, result: Result<f64, Error>) {
        self.add(result.map(|value| vec![value]));
    }
}

#[test]
fn formulas_give_numbers_or_refuse() {
    let mut tally = Tally::default();
    for a in ODD {
        tally.one(factor::phi2(HoistingClass::Hc4, a));
        tally.one(factor::phi6(a));
        tally.one(buffer::phi7(a));
        tally.one(skew::friction(a));
        tally.one(cmaa::hoist_load_factor(a));
        tally.one(cmaa::dead_load_factor(a));
        tally.one(cmaa::drive_inertia(a));
        tally.one(osha::brake_distance(a));
        tally.one(aist::drift(a));
        tally.one(aist::with_impact(aist::CraneKind::Ladle, a));
        tally.one(duty::fatigue_factor(a));
        tally.one(factor::test_load(a));
        tally.one(local_stress::cmaa_bearing_length(a));
        for limit in limits::EN_1993_6_LIMITS.iter().chain(&limits::CMAA_LIMITS) {
            tally.one(limit.allowable(a));
        }
        for b in ODD {
            tally.one(factor::phi3(a, b, Release::Rapid));
            tally.one(skew::fem_coefficient(a, b));
            tally.one(cmaa::skew_coefficient(a, b));
            tally.one(buffer::trolley_force(a, b));
            tally.one(asce::lateral_force(a, b));
            tally.one(asce::longitudinal_force(&[a, b]));
            tally.one(drive::drive_force(a, &[b, b]));
            tally.one(cmaa::collision_energy([a, b], [b, a]));
            for c in ODD {
                tally.one(duty::equivalent_load(a, b, c));
                tally.one(skew::angle(Guide::Flanges, a, b, c));
                tally.one(buffer::stopping_force(a, b, c, 0.5));
                let seat = local_stress::RailSeat {
                    fixing: local_stress::RailFixing::ElasticPad,
                    inertia: a,
                    flange_width: b,
                    flange: c,
                    web: a,
                    rail_height: b,
                    rail_foot: c,
                };
                tally.add(
                    seat.stresses(b)
                        .map(|found| vec![found.vertical, found.shear]),
                );
                tally.one(buffer::buffer_force(1.25, a, b, c));
                tally.one(
                    Strength::new(Stress::Direct, a, b, 1.0).and_then(|curve| curve.damage(c)),
                );
                tally.one(
                    Strength::new(Stress::Shear, a, 1.0, b).and_then(|curve| curve.equivalent(c)),
                );
                let section = SectionProperties {
                    area: a,
                    iy: b,
                    iz: c,
                };
                tally.one(stress::direct(
                    &section,
                    SectionPoint { y: b, z: c },
                    [a, b, c, c, b, a],
                ));
                for kind in [WheelPairs::AloneFixed, WheelPairs::CoupledFree] {
                    let forces = skew::skewing(kind, a, 0.6, &[b, c]);
                    tally.add(forces.map(|found| {
                        let across = found.across.into_iter().flatten();
                        across
                            .chain(found.along)
                            .chain([found.guide, found.rotation_distance])
                            .collect()
                    }));
                }
                let crane = Crane {
                    lifted: a,
                    trolley: b,
                    bridge: c,
                    span: a,
                    approach: b,
                    wheels: 2,
                };
                tally.add(
                    crane
                        .wheel_loads(c, 1.0)
                        .map(|loads| vec![loads.near, loads.far]),
                );
                tally.one(
                    aist::side_thrust(aist::CraneKind::Stacker, &crane)
                        .map(|thrusts| thrusts.governing()),
                );
                let travel = drive::AcceleratingCrane {
                    span: a,
                    guides: b,
                    heavy: c,
                    light: b,
                    drive: a,
                    factor: 1.5,
                    rails: 2,
                };
                tally.add(drive::traction(&travel).map(|found| {
                    vec![
                        found.fraction,
                        found.along,
                        found.moment,
                        found.heavy,
                        found.light,
                    ]
                }));
            }
        }
    }
    assert!(tally.numbers > 1000 && tally.refusals > 1000);
}

#[test]
fn histories_give_numbers_or_refuse() {
    let mut tally = Tally::default();
    let times: Vec<f64> = (0..40).map(f64::from).collect();
    let view = ResponseSettings {
        from: 0.0,
        settled: 0.0,
        step: 0.5,
        cut_off: Some(0.3),
        excursion_fraction: 0.1,
    };
    for a in ODD {
        for b in ODD {
            for c in [a, b, 0.3] {
                let values: Vec<f64> = (0..40).map(|k| [a, b, c, 1.0][k * k % 7 % 4]).collect();
                tally.add(rainflow(&values, Repetition::Repeated).map(|cycles| {
                    cycles
                        .iter()
                        .flat_map(|cycle| [cycle.range(), cycle.mean()])
                        .collect()
                }));
                tally.add(response(&times, &values, &view).map(|found| {
                    [
                        [found.mean, found.peak.value],
                        [found.trough.value, found.trough.time],
                    ]
                    .concat()
                }));
                let tone = |tone: SineComponent| vec![tone.frequency, tone.amplitude];
                for (step, band) in [(0.5, [0.0, 1.0]), (c, [a, b])] {
                    let strongest = |spectrum: HistorySpectrum| spectrum.strongest(band);
                    let found = HistorySpectrum::new(&values, step).and_then(strongest);
                    tally.add(found.map(|found| found.map_or_else(Vec::new, tone)));
                }
                let ring = |ring: Decay| vec![ring.ratio, ring.frequency];
                tally.add(decay(&values, 0.5, 0.0).map(|found| found.map_or_else(Vec::new, ring)));
                tally.add(decay(&times, c, a).map(|found| found.map_or_else(Vec::new, ring)));
                let odd = ResponseSettings {
                    from: a,
                    settled: b,
                    step: c,
                    cut_off: Some(b),
                    excursion_fraction: c,
                };
                tally.add(
                    response(&times, &times, &odd).map(|found| vec![found.mean, found.peak.value]),
                );
            }
        }
    }
    assert!(tally.numbers > 100 && tally.refusals > 100);
}
