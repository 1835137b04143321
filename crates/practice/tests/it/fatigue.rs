//! Rainflow counts, strength curves, damage, stresses.

use practice::fatigue::{CATEGORIES, CUT_OFF_CYCLES, LIMIT_CYCLES, REFERENCE_CYCLES, Stress};
use practice::rainflow::ranges;
use practice::stress::{direct, weights};
use practice::{Cycle, Error, Repetition, SectionPoint, SectionProperties, Strength, rainflow};

fn close(found: f64, expected: f64, slack: f64) {
    assert!(
        (found - expected).abs() <= slack,
        "{found} is not {expected}"
    );
}

/// The history of E1049, Figures 6 and 7.
const PUBLISHED: [f64; 9] = [-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0];

/// Pseudorandom numbers from a seed.
fn history(seed: u64, length: usize, levels: u64) -> Vec<f64> {
    let mut random = fastrand::Rng::with_seed(seed);
    (0..length).map(|_| random.u64(..levels) as f64).collect()
}

/// The three-point rule of E1049, 5.4.4, applied to turning points.
fn by_three_points(points: &[f64]) -> Vec<[f64; 2]> {
    let mut counts: Vec<[f64; 2]> = Vec::new();
    let mut kept: Vec<f64> = Vec::new();
    for &point in points {
        kept.push(point);
        while let [.., a, b, c] = kept[..] {
            if (c - b).abs() < (b - a).abs() {
                break;
            }
            let start = kept.len() == 3;
            counts.push([(b - a).abs(), if start { 0.5 } else { 1.0 }]);
            if start {
                kept.remove(0);
            } else {
                kept.drain(kept.len() - 3..kept.len() - 1);
            }
        }
    }
    counts.extend(kept.windows(2).map(|pair| [(pair[0] - pair[1]).abs(), 0.5]));
    counts
}

/// Counts by whole range.
fn table(counts: &[[f64; 2]]) -> Vec<f64> {
    let mut table = vec![0.0; 64];
    for [range, count] in counts {
        table[*range as usize] += count;
    }
    table
}

#[test]
fn the_published_history_is_counted_exactly() -> Result<(), Error> {
    // External: ASTM E1049-85, Figure 6.
    let cycles = rainflow(&PUBLISHED, Repetition::Once)?;
    assert_eq!(
        ranges(&cycles),
        [[3.0, 0.5], [4.0, 1.5], [6.0, 0.5], [8.0, 1.0], [9.0, 0.5]]
    );
    let whole: Vec<&Cycle> = cycles.iter().filter(|cycle| cycle.count == 1.0).collect();
    assert_eq!(whole.len(), 1);
    assert_eq!((whole[0].samples, whole[0].mean()), ([4, 5], 1.0));
    Ok(())
}

#[test]
fn the_published_history_repeated_is_counted_exactly() -> Result<(), Error> {
    // External: ASTM E1049-85, Figure 7.
    let cycles = rainflow(&PUBLISHED, Repetition::Repeated)?;
    assert_eq!(
        ranges(&cycles),
        [[3.0, 1.0], [4.0, 1.0], [7.0, 1.0], [9.0, 1.0]]
    );
    Ok(())
}

#[test]
fn another_program_counts_the_same() -> Result<(), Error> {
    // External: printed by the Python package rainflow 3.1 for this signal in its description.
    let signal: Vec<f64> = (0..=200)
        .map(|k| 4.0 * f64::from(k) / 200.0)
        .map(|t| 0.2 + 0.5 * t.sin() + 0.2 * (10.0 * t).cos() + 0.2 * (4.0 * t).sin())
        .collect();
    let expected = [
        [0.04258965150708488, 0.5],
        [0.10973439445727551, 1.0],
        [0.11294628078612906, 0.5],
        [0.2057106991158965, 1.0],
        [0.21467990941625242, 1.0],
        [0.4388985979776988, 1.0],
        [0.48305748051348263, 0.5],
        [0.5286423866535466, 0.5],
        [0.7809330293159786, 0.5],
        [1.4343610172143002, 0.5],
    ];
    let found = ranges(&rainflow(&signal, Repetition::Once)?);
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        close(found[0], expected[0], 1e-14);
        assert_eq!(found[1], expected[1]);
    }
    Ok(())
}

#[test]
fn four_points_count_what_three_points_count() -> Result<(), Error> {
    // Independent: the rule of the standard, word by word.
    for seed in 0..300 {
        for levels in [3, 7, 50] {
            let values = history(seed, 200, levels);
            let mut points: Vec<f64> = Vec::new();
            for (k, &value) in values.iter().enumerate() {
                let next = values[k + 1..].iter().find(|next| **next != value);
                let before = values[..k].iter().rfind(|before| **before != value);
                let repeats = k > 0 && values[k - 1] == value;
                let turns = match (before, next) {
                    (Some(before), Some(next)) => (value > *before) != (*next > value),
                    _ => true,
                };
                if turns && !repeats {
                    points.push(value);
                }
            }
            let found = ranges(&rainflow(&values, Repetition::Once)?);
            assert_eq!(
                table(&found),
                table(&by_three_points(&points)),
                "seed {seed}, {levels} levels"
            );
        }
    }
    Ok(())
}

#[test]
fn a_repeated_history_closes_wherever_it_begins() -> Result<(), Error> {
    for seed in 0..50 {
        let values = history(seed, 60, 40);
        let counts = ranges(&rainflow(&values, Repetition::Repeated)?);
        let turned: Vec<f64> = values[23..].iter().chain(&values[..23]).copied().collect();
        assert_eq!(
            counts,
            ranges(&rainflow(&turned, Repetition::Repeated)?),
            "seed {seed}"
        );
        assert!(
            counts.iter().all(|pair| pair[1].fract() == 0.0),
            "halves make wholes"
        );
    }
    Ok(())
}

#[test]
fn between_turning_points_nothing_counts() -> Result<(), Error> {
    let coarse = rainflow(&[0.0, 10.0, 4.0, 12.0, 0.0], Repetition::Once)?;
    let fine = rainflow(
        &[0.0, 3.0, 3.0, 10.0, 7.0, 5.0, 4.0, 4.0, 9.0, 12.0, 1.0, 0.0],
        Repetition::Once,
    )?;
    assert_eq!(ranges(&coarse), ranges(&fine));
    assert_eq!(ranges(&coarse), [[6.0, 1.0], [12.0, 1.0]]);
    assert_eq!(rainflow(&[5.0; 8], Repetition::Repeated)?, []);
    assert_eq!(rainflow(&[], Repetition::Repeated)?, []);
    assert_eq!(
        rainflow(&[1.0, f64::NAN], Repetition::Once),
        Err(Error::Number {
            series: 0,
            sample: 1
        })
    );
    Ok(())
}

#[test]
fn a_strength_curve_goes_through_its_corners() -> Result<(), Error> {
    for category in CATEGORIES {
        let curve = Strength::new(Stress::Direct, category, 1.0, 1.0)?;
        // External: EN 1993-1-9, 7.1: 0.737, and 0.549 of that.
        close(curve.fatigue_limit() / category, 0.737, 5e-4);
        close(curve.cut_off() / curve.fatigue_limit(), 0.549, 5e-4);
        close(1.0 / curve.damage(category)?, REFERENCE_CYCLES, 1e-3);
        close(
            1.0 / curve.damage(curve.fatigue_limit())?,
            LIMIT_CYCLES,
            1e-2,
        );
        close(
            1.0 / curve.damage(curve.fatigue_limit() * (1.0 - 1e-15))?,
            LIMIT_CYCLES,
            1e-2,
        );
        close(
            1.0 / curve.damage(curve.cut_off() * (1.0 + 1e-12))?,
            CUT_OFF_CYCLES,
            1.0,
        );
        assert_eq!(curve.damage(curve.cut_off())?, 0.0);
        close(
            curve.damage(2.0 * category)? / curve.damage(category)?,
            8.0,
            1e-12,
        );
        close(curve.damage(0.8 * category)?, 0.8_f64.powi(3) / 2e6, 1e-18);
        close(
            curve.damage(0.7 * category)? / curve.damage(0.5 * category)?,
            1.4_f64.powi(5),
            1e-9,
        );
    }
    let shear = Strength::new(Stress::Shear, 100.0, 1.0, 1.0)?;
    close(shear.cut_off(), 45.7, 0.05);
    close(1.0 / shear.damage(100.0)?, REFERENCE_CYCLES, 1e-3);
    close(
        shear.equivalent(1e6 * shear.damage(80.0)?)?,
        80.0 * 0.5_f64.powf(0.2),
        1e-9,
    );
    close(
        shear.damage(90.0)? / shear.damage(60.0)?,
        1.5_f64.powi(5),
        1e-9,
    );
    Ok(())
}

#[test]
fn partial_factors_count_on_either_side() -> Result<(), Error> {
    let both = Strength::new(Stress::Direct, 80.0, 1.1, 1.35)?;
    let plain = Strength::new(Stress::Direct, 80.0, 1.0, 1.0)?;
    close(
        both.damage(100.0)?,
        plain.damage(100.0 * 1.1 * 1.35)?,
        1e-18,
    );
    Ok(())
}

#[test]
fn miners_sum_and_its_equivalent_range_belong_together() -> Result<(), Error> {
    let curve = Strength::new(Stress::Direct, 71.0, 1.0, 1.0)?;
    // Two ranges of 100 as half cycles, and one of 20 below the cut-off.
    let cycles = rainflow(
        &[0.0, 100.0, 0.0, 100.0, 80.0, 100.0, 0.0],
        Repetition::Once,
    )?;
    let damage = curve.miner(&cycles)?;
    close(damage.largest_range, 100.0, 0.0);
    let one = (100.0_f64 / 71.0).powi(3) / 2e6;
    close(damage.sum, 2.0 * one, 1e-18);
    assert!(!damage.below_limit);
    close(
        damage.repeats().expect("there is damage"),
        1.0 / (2.0 * one),
        1e-3,
    );
    // 1e6 cycles of the range are worth 2e6 of the range by the cube root of a half.
    close(curve.equivalent(1e6 * one)?, 100.0 * 0.5_f64.cbrt(), 1e-9);
    close(curve.equivalent(1.0)?, 71.0, 1e-12);
    let small = curve.miner(&rainflow(&[0.0, 50.0, 0.0], Repetition::Once)?)?;
    assert!(small.below_limit && small.sum > 0.0);
    assert!(
        !curve
            .miner(&rainflow(&[0.0, 60.0, 0.0], Repetition::Once)?)?
            .below_limit
    );
    let none = curve.miner(&rainflow(&[0.0, 20.0, 0.0], Repetition::Once)?)?;
    assert_eq!((none.sum, none.repeats()), (0.0, None));
    assert!(Strength::new(Stress::Direct, 0.0, 1.0, 1.0).is_err());
    Ok(())
}

#[test]
fn stresses_add_up_to_the_forces_they_come_from() -> Result<(), Error> {
    // Independent: integrate over a rectangle by midpoints; M_y = sum z sigma, M_z = -sum y sigma.
    let (height, width) = (0.6, 0.3);
    let section = SectionProperties {
        area: height * width,
        iy: height * width * width * width / 12.0,
        iz: width * height * height * height / 12.0,
    };
    let forces = [120.0, 7.0, -3.0, 11.0, 35.0, -90.0];
    let count = 200;
    let place = |k: usize, size: f64| size * ((k as f64 + 0.5) / count as f64 - 0.5);
    let cell = height * width / (count * count) as f64;
    let (mut n, mut my, mut mz) = (0.0, 0.0, 0.0);
    for i in 0..count {
        for j in 0..count {
            let point = SectionPoint {
                y: place(i, height),
                z: place(j, width),
            };
            let force = direct(&section, point, forces)? * cell;
            n += force;
            my += point.z * force;
            mz -= point.y * force;
        }
    }
    close(n, 120.0, 1e-9);
    close(my, 35.0, 35.0 * 3e-5);
    close(mz, -90.0, 90.0 * 3e-5);
    // A positive Mz causes tension at -y, a positive My at +z.
    assert!(weights(&section, SectionPoint { y: -0.3, z: 0.0 })?[5] > 0.0);
    assert!(weights(&section, SectionPoint { y: 0.0, z: 0.15 })?[4] > 0.0);
    assert!(
        direct(
            &SectionProperties {
                area: 0.0,
                ..section
            },
            SectionPoint { y: 0.0, z: 0.0 },
            forces
        )
        .is_err()
    );
    assert!(direct(&section, SectionPoint { y: 0.0, z: 0.0 }, [f64::NAN; 6]).is_err());
    Ok(())
}

/// Published: AISC 360, Appendix 3: the line 1000 (C_f/n)^(1/3) of category C meets its threshold of 10 ksi
/// at 4.4 million cycles, of category A 24 ksi at 1.8 million.
#[test]
fn categories_of_aisc_meet_their_thresholds_where_they_are_known_to() {
    use practice::aisc::{AiscCategory, AiscCurve};
    for (category, cycles) in [(AiscCategory::C, 4.4e6), (AiscCategory::A, 25e9 / 13824.0)] {
        let curve = AiscCurve::new(category, 6.894_757).expect("a unit");
        let damage = curve.damage(curve.limit()).expect("a range");
        assert!(
            (damage * cycles - 1.0).abs() < 1e-12,
            "{category:?}: {damage:e}"
        );
        let reference = curve.damage(curve.reference()).expect("a range");
        assert!((reference * 2e6 - 1.0).abs() < 1e-12);
        assert!((curve.equivalent(0.125).expect("a sum") / curve.reference() - 0.5).abs() < 1e-12);
    }
}
