//! What the selection of foundations asks of its provider, and the measures of the differences of runs, against the
//! rules that their documentation states and closed forms.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::f64::consts::PI;
use std::ops::ControlFlow;

use common::modes::{beam, oscillator};
use sim::{
    Bounces, Channel, Choice, Dynamics, Error, Fidelity, FidelityTrial, Foundation,
    FoundationProvider, History, Measure, ModalBasis, Reason, Record, RecordedQuantity, Run, Scene,
    Selection, Status, Structure, Tolerance, TrialCheck, choose, difference,
};

/// The beam at every fidelity, with what was asked for.
#[derive(Default)]
struct Beam {
    /// Without a mode that wheels excite.
    is_still: bool,
    /// Numbers of modes that were asked for.
    asked: Vec<usize>,
    /// Fidelity and accuracy of each run.
    runs: Vec<(Fidelity, f64)>,
    /// Samples in an output interval of each run, and its stages; how many are added to them.
    sampled: Vec<(usize, usize)>,
    more_stages: usize,
    /// Duration of a run, and the fidelities of those that ended before.
    end: f64,
    starts: Vec<Fidelity>,
    /// Whether the next run only shows what another lacks; fidelity and accuracy of such runs that did not end before.
    is_repetition: bool,
    wholes: Vec<(Fidelity, f64)>,
    fidelity: Option<Fidelity>,
    /// Factor on the forces that are observed in runs with influence functions.
    exaggerated: Option<f64>,
    /// Error of the displacements that are observed, relative to their size and by the accuracy of the run.
    by_steps: f64,
    accuracy: f64,
    /// Steps of runs with influence functions that hardly advance, and the part of the run by which each does; the number of
    /// modes above which runs cannot go on.
    idle_steps: usize,
    idle_step: f64,
    most_modes: Option<usize>,
    /// Number of modes below which repetitions of a start show that the run is wrong, and that of the run that is repeated.
    deceptive: usize,
    kept: usize,
    /// Whether inertia forces of each mode change a gauge, by as much as its number says.
    has_effects: bool,
    /// What was observed, and the deepest sum of penetration and deflection in it.
    records: Vec<(Fidelity, Record, f64)>,
}

impl FoundationProvider for Beam {
    type Error = Error;

    fn modes(&mut self, _: usize, count: usize) -> Result<Option<ModalBasis>, Error> {
        self.asked.push(count);
        let basis = |structure, is_whole| ModalBasis {
            structure,
            coupling: Vec::new(),
            effects: Vec::from_iter(self.has_effects.then(|| {
                let by_mode = (1..=count).map(|mode| 1e-7 * mode as f64).collect();
                (format!("{:?}", Channel::Gauge(0)), by_mode)
            })),
            is_whole,
        };
        let structure = beam(count, true).structure;
        Ok(structure.map(|structure| {
            if self.is_still {
                let dynamics = Dynamics::Modes {
                    omega: Vec::new(),
                    ratio: Vec::new(),
                };
                basis(
                    Structure {
                        dynamics,
                        ..structure
                    },
                    true,
                )
            } else {
                basis(structure, false)
            }
        }))
    }

    fn foundation(&mut self, _: usize, fidelity: Fidelity) -> Result<Foundation, Error> {
        (self.fidelity, self.is_repetition) = (Some(fidelity), false);
        Ok(match fidelity {
            Fidelity::Rigid => Foundation {
                rails: beam(0, true).rails,
                ..Foundation::rigid()
            },
            Fidelity::Influence => beam(0, true),
            Fidelity::Modal(modes) => beam(modes, true),
        })
    }

    fn finer_foundation(
        &mut self,
        structure: usize,
        modes: usize,
        kept: usize,
    ) -> Result<Foundation, Error> {
        let foundation = self.foundation(structure, Fidelity::Modal(modes));
        (self.is_repetition, self.kept) = (true, kept);
        foundation
    }

    fn run(
        &mut self,
        scene: &Scene,
        foundations: &[Foundation],
        watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Run, Error> {
        self.accuracy = scene.accuracy;
        let mut run = sim::run(scene, foundations, watch)?;
        if self.fidelity == Some(Fidelity::Influence) {
            let mut idle =
                (0..self.idle_steps).map(|step| (0.5 + self.idle_step * step as f64) * scene.end);
            if idle.any(|time| watch(time).is_break()) {
                run.status = Status::Stopped;
            }
        } else if let (Some(most), Some(Fidelity::Modal(modes))) = (self.most_modes, self.fidelity)
            && modes > most
        {
            run.status = Status::StepTooSmall(0.5 * scene.end);
        }
        run.counts.stages += self.more_stages;
        if scene.end < self.end {
            self.starts.extend(self.fidelity);
        } else if self.is_repetition {
            self.wholes
                .extend(self.fidelity.map(|fidelity| (fidelity, scene.accuracy)));
        } else {
            self.runs
                .extend(self.fidelity.map(|fidelity| (fidelity, scene.accuracy)));
            self.sampled.push((scene.output_parts, run.counts.stages));
        }
        Ok(run)
    }

    fn observe(&mut self, history: &History) -> Result<Record, Error> {
        let mut record = Record::of(history);
        if let (Some(factor), Some(Fidelity::Influence)) = (self.exaggerated, self.fidelity) {
            let forces = record
                .quantities
                .iter_mut()
                .filter(|quantity| quantity.kind == "force");
            forces.for_each(|quantity| {
                quantity
                    .values
                    .iter_mut()
                    .for_each(|value| *value *= factor)
            });
        }
        for quantity in record
            .quantities
            .iter_mut()
            .filter(|quantity| quantity.kind == "displacement")
        {
            let shown = if self.is_repetition && self.kept < self.deceptive {
                0.1
            } else {
                0.0
            };
            quantity
                .values
                .iter_mut()
                .for_each(|value| *value *= 1.0 + self.by_steps * self.accuracy + shown);
        }
        let pairs = history
            .column(Channel::Penetration(0))
            .into_iter()
            .zip(history.column(Channel::Deflection(0)));
        let deepest = pairs.fold(0.0, |most, (p, d)| f64::max(most, p + d));
        self.records.extend(
            self.fidelity
                .map(|fidelity| (fidelity, record.clone(), deepest)),
        );
        Ok(record)
    }
}

fn chosen(alpha: f64, tolerance: Tolerance, provider: &mut Beam) -> Choice {
    chosen_in(oscillator(0.5, 0.5, alpha), tolerance, provider)
}

fn chosen_in(mut scene: Scene, tolerance: Tolerance, provider: &mut Beam) -> Choice {
    (scene.output_dt, scene.accuracy) = (scene.end / 200.0, 1e-3);
    provider.end = scene.end;
    let watch = &mut |_| ControlFlow::Continue(());
    let Selection {
        mut choices, runs, ..
    } = choose(&scene, &[Some(tolerance)], provider, watch).expect("a valid scene");
    assert_eq!(
        runs,
        provider.runs.len() + provider.starts.len() + provider.wholes.len()
    );
    choices.remove(0)
}

const EXTREMES: Tolerance = Tolerance {
    value: 1e-2,
    measure: Measure::Extremes,
};

#[test]
fn runs_of_the_result_have_a_thousandth_or_two_of_the_tolerance() {
    assert!((EXTREMES.run_accuracy() / 2e-5 - 1.0).abs() < 1e-15);
    let history = Tolerance {
        measure: Measure::History,
        ..EXTREMES
    };
    assert!((history.run_accuracy() / 1e-5 - 1.0).abs() < 1e-15);
}

/// The first run and the one that only checks it have a tenth of the tolerance, the run of the result its own accuracy.
#[test]
fn runs_that_only_check_are_coarse_and_the_run_of_the_result_is_not() {
    for (alpha, measure) in [
        (0.003, Measure::Extremes),
        (0.03, Measure::Extremes),
        (0.25, Measure::History),
    ] {
        let tolerance = Tolerance {
            measure,
            ..EXTREMES
        };
        let mut provider = Beam::default();
        let choice = chosen(alpha, tolerance, &mut provider);
        assert!(
            choice.reason == Reason::Sufficient || choice.reason == Reason::Kept,
            "{choice:?}"
        );
        let coarse = 0.1 * tolerance.value;
        assert_eq!(provider.runs[0], (Fidelity::Influence, coarse));
        for &(fidelity, accuracy) in &provider.runs {
            assert!(accuracy <= coarse, "{fidelity:?}: {accuracy}");
            assert!(
                accuracy == coarse || accuracy == tolerance.run_accuracy(),
                "{fidelity:?}: {accuracy}"
            );
        }
        let own = provider
            .runs
            .iter()
            .filter(|(fidelity, _)| *fidelity == choice.fidelity);
        assert!(
            own.clone()
                .any(|(_, accuracy)| *accuracy == tolerance.run_accuracy()),
            "{:?}",
            provider.runs
        );
    }
}

/// A first run of short steps, three stages for each sample: the next run has as many samples as it had steps.
#[test]
fn further_runs_are_sampled_as_densely_as_the_first_was_stepped() {
    let rows = 201;
    for more_stages in [0, 1500, 30_000] {
        let mut provider = Beam {
            more_stages,
            ..Beam::default()
        };
        chosen(0.25, EXTREMES, &mut provider);
        let [(parts, stages), (next, _)] = provider.sampled[..2] else {
            panic!("{:?}", provider.sampled)
        };
        let wanted = (stages / 3 / rows).min(8 * parts);
        assert_eq!(
            next,
            parts.max(wanted),
            "{more_stages}: {:?}",
            provider.sampled
        );
        assert_eq!(
            next > parts,
            more_stages > 0,
            "{more_stages}: {:?}",
            provider.sampled
        );
    }
}

/// A quantity that is much smaller than the penetrations at rest, to which the accuracy is relative, may change by more than
/// the tolerance between the first run and its repetition. Here it does so by 0.98 of it, and then by 0.018.
#[test]
fn a_result_whose_steps_change_it_is_repeated_with_finer_ones() {
    let mut provider = Beam {
        by_steps: 10.0,
        ..Beam::default()
    };
    let choice = chosen(0.003, EXTREMES, &mut provider);
    assert_eq!(
        (choice.fidelity, choice.reason),
        (Fidelity::Influence, Reason::Sufficient)
    );
    let own = provider
        .runs
        .iter()
        .filter(|(fidelity, _)| *fidelity == choice.fidelity);
    let accuracies: Vec<f64> = own.map(|(_, accuracy)| *accuracy).collect();
    let wanted = [
        0.1 * EXTREMES.value,
        EXTREMES.run_accuracy(),
        0.1 * EXTREMES.run_accuracy(),
    ];
    assert_eq!(accuracies.len(), wanted.len(), "{accuracies:?}");
    assert!(
        accuracies
            .iter()
            .zip(wanted)
            .all(|(found, wanted)| (found / wanted - 1.0).abs() < 1e-12)
    );
}

/// By the rule: an undamped wheel that bounces n = 1/(4 alpha) times may amplify what influence functions lack by n. With 83
/// bounces an estimate of a twentieth of the tolerance asks for a run with modes, with 8 it does not; a fiftieth never does.
#[test]
fn influence_functions_suffice_at_once_where_bounces_cannot_amplify_what_they_lack() {
    for (alpha, share, is_checked) in [
        (0.003, 0.05, true),
        (0.003, 0.02, false),
        (0.03, 0.05, false),
        (0.03, 0.02, false),
    ] {
        let estimate = chosen(alpha, EXTREMES, &mut Beam::default()).tried[0].estimate;
        let mut provider = Beam::default();
        let choice = chosen(
            alpha,
            Tolerance {
                value: estimate / share,
                ..EXTREMES
            },
            &mut provider,
        );
        let found = choice.tried[0].estimate / (estimate / share);
        assert!((found / share - 1.0).abs() < 0.2, "{found} for {share}");
        assert_eq!(
            !provider.counts().is_empty(),
            is_checked,
            "{alpha}, {found}: {:?}",
            provider.runs
        );
    }
}

/// By the rule: a run with modes is repeated with more of them and 25 times its accuracy where its wheel remembers n = 1/(4
/// alpha) of its bounces, n from 8 on, and the error of its motion is more than 0.8/n of the tolerance.
#[test]
fn a_whole_run_is_repeated_where_bounces_may_amplify_what_its_start_does_not_show() {
    let mut repeated = [0, 0];
    for (alpha, value) in [
        (0.02, 5e-4),
        (0.02, 4e-3),
        (0.003, 1e-4),
        (0.003, 1e-3),
        (0.25, 1e-3),
        (0.5, 1e-3),
    ] {
        let (tolerance, mut provider) = (Tolerance { value, ..EXTREMES }, Beam::default());
        let choice = chosen(alpha, tolerance, &mut provider);
        let Fidelity::Modal(count) = choice.fidelity else {
            panic!("{choice:?}")
        };
        let is_earlier = |own: &&FidelityTrial| {
            own.fidelity == choice.fidelity && !matches!(own.against, TrialCheck::Whole(_))
        };
        let told = choice
            .tried
            .iter()
            .filter(is_earlier)
            .map(|own| own.estimate)
            .fold(0.0, f64::max);
        let bounces = 1.0 / (4.0 * alpha);
        let is_repeated = bounces >= 8.0 && told * bounces.min(30.0) > 0.8 * value;
        assert_eq!(
            !provider.wholes.is_empty(),
            is_repeated,
            "{alpha}: {choice:?}"
        );
        repeated[usize::from(is_repeated)] += 1;
        for &(fidelity, accuracy) in &provider.wholes {
            assert!(
                matches!(fidelity, Fidelity::Modal(more) if more > count),
                "{fidelity:?}, {count}"
            );
            let own = tolerance.run_accuracy();
            assert!(
                (accuracy / (25.0 * own) - 1.0).abs() < 1e-12,
                "{accuracy} for {own}"
            );
        }
    }
    assert!(repeated.iter().all(|count| *count > 0), "{repeated:?}");
}

/// Identities: where the force of a wheel hardly changes, influence functions lack by extremes what the modes add to them under
/// that force, with its phase; and the difference of two runs counts with what the second one lacks in phase, which is less
/// than the amplitude that this run is told to lack.
#[test]
fn influence_functions_and_differences_of_runs_count_with_phases() {
    for alpha in [0.25, 0.3, 0.35, 0.4, 0.5] {
        let scene = oscillator(0.01, 0.05, alpha);
        let mut provider = Beam::default();
        let choice = chosen_in(scene.clone(), EXTREMES, &mut provider);
        let (_, first, deepest) = &provider.records[0];
        let (_, second, _) = provider
            .records
            .iter()
            .find(|own| own.0 != Fidelity::Influence)
            .expect("modes");
        let slowest = (2.0 * PI * (deepest / scene.gravity).sqrt()).min(scene.end);
        let bounces = Bounces {
            slowest,
            remembered: 1.0,
        };
        let apart = difference(first, second, Measure::Extremes, bounces).largest;
        let [told, found, second] = [0, 1, 2].map(|k| choice.tried[k].estimate);
        println!(
            "{alpha}: {told:.3e} told for {apart:.3e}; {found:.3e} with {second:.3e} of the second run"
        );
        assert!((told / apart - 1.0).abs() < 6e-3, "{alpha}: {choice:?}");
        assert!(matches!(
            choice.tried[1].against,
            TrialCheck::Run(Fidelity::Modal(1))
        ));
        assert!(
            found > apart && found - apart < 0.9 * second,
            "{alpha}: {apart} {choice:?}"
        );
    }
}

/// By the rule: the gauge changes by inertia forces of the modes, which hardly falls with their number. The search for more modes
/// ends where half as many lack no more than 1.5 times as much, and even half of that is beyond ten times the tolerance.
#[test]
fn modes_that_cannot_help_are_not_computed() {
    for (value, known) in [(0.01, 144), (0.004, 96), (0.001, 48)] {
        let mut provider = Beam {
            has_effects: true,
            ..Beam::default()
        };
        let choice = chosen(0.25, Tolerance { value, ..EXTREMES }, &mut provider);
        assert_eq!(
            choice.tried[0].against,
            TrialCheck::Replay(known),
            "{value}: {choice:?}"
        );
    }
}

/// By the rule: one mode leaves an error between a tenth and a fifth of the tolerance. That is enough by extremes, but not in a
/// run of more than a hundred bounces, of which this one has 109.
#[test]
fn runs_of_many_bounces_aim_at_a_tenth_of_the_tolerance() {
    let mut provider = Beam::default();
    let choice = chosen(
        0.0023,
        Tolerance {
            value: 1.3e-4,
            ..EXTREMES
        },
        &mut provider,
    );
    assert!(
        choice.tried[0].estimate > 10.0 * 1.3e-4,
        "influence functions are far from enough: {choice:?}"
    );
    assert_eq!(provider.counts(), [2], "{choice:?}");
}

/// By the rule: without influence functions no two runs tell how much wheels amplify, and they count as remembering eight
/// bounces where they have fewer. More than a tenth of the tolerance is then shown by the whole run.
#[test]
fn without_influence_functions_the_whole_run_is_repeated() {
    for (value, is_repeated) in [(4e-6, false), (1.5e-6, true)] {
        let mut provider = Beam {
            idle_steps: 5000,
            idle_step: 1e-12,
            ..Beam::default()
        };
        let choice = chosen(0.25, Tolerance { value, ..EXTREMES }, &mut provider);
        let share = choice.tried[0].estimate / value;
        assert_eq!(share > 0.1, is_repeated, "{choice:?}");
        assert_eq!(
            !provider.wholes.is_empty(),
            is_repeated,
            "{:?}",
            provider.wholes
        );
    }
}

/// A massless rail on which wheels open and close without end: after 1,000 steps that lead nowhere the run with influence
/// functions is given up, for modes; where these cannot go on either, it gets all the steps it wants.
#[test]
fn a_first_run_that_hardly_advances_is_given_up() {
    for (idle_steps, modes_fail) in [(900, false), (5000, false), (5000, true)] {
        let most_modes = modes_fail.then_some(0);
        let mut provider = Beam {
            idle_steps,
            idle_step: 1e-12,
            most_modes,
            ..Beam::default()
        };
        let choice = chosen(0.003, EXTREMES, &mut provider);
        let first = |&(fidelity, _): &(Fidelity, f64)| fidelity == Fidelity::Influence;
        let (is_chosen, count) = (
            choice.fidelity == Fidelity::Influence,
            provider.runs.iter().filter(|own| first(own)).count(),
        );
        assert_eq!(is_chosen, idle_steps < 1000 || modes_fail, "{choice:?}");
        assert_eq!(
            choice.failed.contains(&Fidelity::Influence),
            idle_steps > 1000,
            "{choice:?}"
        );
        assert_eq!(
            count,
            if idle_steps < 1000 || modes_fail {
                2
            } else {
                1
            },
            "{:?}",
            provider.runs
        );
    }
}

/// By the rule: in a run that is shorter than a bounce, here half of one, 1,000 steps must advance it by a fiftieth of itself.
#[test]
fn a_first_run_shorter_than_a_bounce_must_advance_by_its_own_length() {
    for (idle_step, is_given_up) in [(1.5e-5, true), (2.5e-5, false)] {
        let mut provider = Beam {
            idle_steps: 5000,
            idle_step,
            ..Beam::default()
        };
        let choice = chosen(0.5, EXTREMES, &mut provider);
        assert_eq!(
            choice.failed.contains(&Fidelity::Influence),
            is_given_up,
            "{choice:?}"
        );
    }
}

/// Without influence functions the first run has 24 modes. Where it is not enough, and runs with more cannot go on, it is the
/// result, with the error that it has.
#[test]
fn a_run_with_modes_stays_the_result_where_more_modes_cannot_go_on() {
    let tolerance = Tolerance {
        value: 1e-7,
        measure: Measure::History,
    };
    let mut provider = Beam {
        idle_steps: 5000,
        idle_step: 1e-12,
        most_modes: Some(24),
        ..Beam::default()
    };
    let choice = chosen(0.25, tolerance, &mut provider);
    assert_eq!(
        (choice.fidelity, choice.reason),
        (Fidelity::Modal(24), Reason::NoBetter),
        "{choice:?}"
    );
    assert!(
        choice
            .estimate
            .is_some_and(|estimate| estimate > tolerance.value),
        "{choice:?}"
    );
    assert!(
        matches!(choice.failed[..], [Fidelity::Influence, Fidelity::Modal(more)] if more > 24),
        "{choice:?}"
    );
}

/// By the rule: the start of a run with m modes is repeated with at least 2 m of them, or 24 where that is less. Where that shows
/// an error beyond the tolerance, the run is not chosen, although the next one hardly differs from it, and the next one has at
/// least as many modes as the repetition.
#[test]
fn a_run_whose_start_is_refuted_is_followed_by_one_with_twice_as_many_modes() {
    for (alpha, value) in [(0.25, 1e-2), (0.25, 1e-3), (0.5, 1e-2), (0.02, 4e-3)] {
        let tolerance = Tolerance { value, ..EXTREMES };
        let plain = chosen(alpha, tolerance, &mut Beam::default());
        let Fidelity::Modal(first) = plain.fidelity else {
            panic!("{plain:?}")
        };
        let found = plain.tried.iter().find_map(|own| match own.against {
            TrialCheck::Start(Fidelity::Modal(more)) => Some(more),
            _ => None,
        });
        let repeated = found.expect("a start that is repeated");
        assert!(
            repeated > first && repeated >= (2 * first).min(24),
            "{repeated} for {first}"
        );
        let mut provider = Beam {
            deceptive: first + 1,
            ..Beam::default()
        };
        let choice = chosen(alpha, tolerance, &mut provider);
        assert!(
            matches!(choice.reason, Reason::Sufficient | Reason::Kept),
            "{choice:?}"
        );
        let most = 2 * provider.asked.last().expect("modes") / 3;
        assert!(
            choice.fidelity >= Fidelity::Modal(repeated.min(most)),
            "{first}, {repeated}: {choice:?}"
        );
    }
}

impl Beam {
    /// Numbers of modes of the runs with modes, each once, in the order of their first runs.
    fn counts(&self) -> Vec<usize> {
        let modal = self.runs.iter().filter_map(|(fidelity, _)| match fidelity {
            Fidelity::Modal(count) => Some(*count),
            _ => None,
        });
        modal.fold(Vec::new(), |mut counts, own| {
            if !counts.contains(&own) {
                counts.push(own);
            }
            counts
        })
    }
}

/// Where two runs differ by about as much as the modes left out let expect, the first number of modes is the last one.
/// Where they differ by far more, the wheels amplify what the rails lack, and the number is raised.
#[test]
fn the_number_of_modes_is_raised_where_runs_differ_by_more_than_was_estimated() {
    let mut raised = 0;
    for k in 0..24 {
        let (alpha, value) = (0.02, 5e-3 / 1.1_f64.powi(k));
        let tolerance = Tolerance { value, ..EXTREMES };
        let mut provider = Beam::default();
        let choice = chosen(alpha, tolerance, &mut provider);
        let counts = provider.counts();
        assert_eq!(counts.len(), 1, "{alpha}: {:?}", provider.runs);
        assert_eq!(choice.fidelity, Fidelity::Modal(counts[0]));
        let mut provider = Beam {
            exaggerated: Some(1.5),
            ..Beam::default()
        };
        let choice = chosen(alpha, tolerance, &mut provider);
        assert_eq!(choice.reason, Reason::Sufficient, "{choice:?}");
        let all = provider.counts();
        assert!(
            all.windows(2).all(|pair| pair[0] < pair[1]) && all.len() <= 3,
            "{alpha}: {all:?}"
        );
        raised += usize::from(all.len() > 1);
    }
    println!("{raised} of 24 raised");
    assert!(raised > 0);
}

/// A tolerance below what 144 modes leave out is reported as such, after fewer runs than are allowed.
#[test]
fn a_tolerance_that_no_number_of_modes_meets_is_reported() {
    let mut provider = Beam::default();
    let tolerance = Tolerance {
        value: 2e-9,
        measure: Measure::History,
    };
    let choice = chosen(0.5, tolerance, &mut provider);
    assert_eq!(
        choice.reason,
        Reason::NoBetter,
        "{choice:?} {:?}",
        provider.runs
    );
    assert!(choice.estimate.is_some_and(|estimate| estimate > 2e-9) && provider.counts().len() < 3);
}

/// Modes are computed until those that suffice are two thirds of them, or until there are 144.
#[test]
fn one_and_a_half_times_the_modes_that_suffice_are_known() {
    let mut most = 0;
    for (alpha, value) in [(0.25, 1e-2), (0.5, 1e-3), (0.5, 1e-4), (0.25, 1e-8)] {
        let mut provider = Beam::default();
        let choice = chosen(
            alpha,
            Tolerance {
                value,
                measure: Measure::History,
            },
            &mut provider,
        );
        let Fidelity::Modal(modes) = choice.fidelity else {
            panic!("{choice:?}")
        };
        assert_eq!(provider.asked[0], 24);
        assert!(
            provider.asked.windows(2).all(|pair| pair[0] < pair[1]),
            "{:?}",
            provider.asked
        );
        let known = provider.asked[provider.asked.len() - 1];
        assert!(
            known <= 144 && (3 * modes <= 2 * known || known == 144),
            "{modes} of {:?}",
            provider.asked
        );
        most = most.max(known);
    }
    assert_eq!(most, 144, "an accuracy of 1e-8 needs all of them");
}

#[test]
fn a_structure_that_no_wheel_moves_needs_no_modes_and_has_no_error() {
    let mut provider = Beam {
        is_still: true,
        ..Beam::default()
    };
    let choice = chosen(0.25, EXTREMES, &mut provider);
    assert_eq!(
        (choice.fidelity, choice.reason, choice.estimate),
        (Fidelity::Influence, Reason::Sufficient, Some(0.0))
    );
    assert_eq!(
        provider.runs,
        [(Fidelity::Influence, EXTREMES.run_accuracy())]
    );
}

/// A record of forces over time.
fn record(count: usize, forces: &[&dyn Fn(f64) -> f64]) -> Record {
    let time: Vec<f64> = (0..count).map(|i| i as f64 * 0.01).collect();
    let quantity = |(k, force): (usize, &&dyn Fn(f64) -> f64)| RecordedQuantity {
        name: format!("force {k}"),
        kind: "force",
        channel: None,
        is_position: false,
        group: String::new(),
        least_scale: 0.0,
        values: time.iter().map(|t| force(*t)).collect(),
    };
    let quantities = forces.iter().enumerate().map(quantity).collect();
    Record { time, quantities }
}

const BOUNCES: Bounces = Bounces {
    slowest: 1.0,
    remembered: 1.0,
};

/// Analytic: runs that a rule ended after 0.40 and 0.50 s differ by a fifth of the longer time; equal ends do not count,
/// and values are compared as far as both reach.
#[test]
fn runs_that_end_at_different_times_differ_by_the_time() {
    let constant: &dyn Fn(f64) -> f64 = &|_| 3.0;
    let (short, long) = (record(41, &[constant]), record(51, &[constant]));
    for measure in [Measure::Extremes, Measure::History] {
        for (a, b) in [(&short, &long), (&long, &short)] {
            let found = difference(a, b, measure, BOUNCES);
            assert!((found.largest - 0.2).abs() < 1e-14, "{found:?}");
            assert_eq!(found.quantity, "time of the end");
        }
        let same = difference(&long, &long, measure, BOUNCES);
        assert_eq!((same.largest, same.quantity.as_str()), (0.0, ""));
        // One of them has a sample more at the same end.
        let mut finer = long.clone();
        finer.time.insert(50, 0.495);
        finer.quantities[0].values.insert(50, 3.0);
        assert_eq!(difference(&finer, &long, measure, BOUNCES).largest, 0.0);
    }
    let late: &dyn Fn(f64) -> f64 = &|t| if t > 0.405 { 9.0 } else { 3.0 };
    let found = difference(&short, &record(51, &[late]), Measure::History, BOUNCES);
    assert!(
        (found.largest - 0.2).abs() < 1e-14,
        "beyond the shorter run nothing is compared: {found:?}"
    );
}

/// Analytic: quantities that are no wheels of one body are not exchanged for one another in a long run.
#[test]
fn quantities_without_a_group_are_compared_each_by_itself_in_a_long_run() {
    let wave = |size: f64| move |t: f64| size * (2.0 * PI * t).sin();
    let (large, small) = (wave(1.0), wave(0.9));
    let (a, b) = (
        record(3001, &[&large, &small]),
        record(3001, &[&small, &large]),
    );
    let long = Bounces {
        slowest: 1.0,
        remembered: 300.0,
    };
    let found = difference(&a, &b, Measure::Extremes, long).largest;
    assert!((found - 0.1 / 1.8).abs() < 1e-3, "{found}");
    // Of a group, in a short run, each is still itself.
    let grouped = |mut of: Record| {
        of.quantities
            .iter_mut()
            .for_each(|own| "wheels".clone_into(&mut own.group));
        of
    };
    let (a, b) = (grouped(a), grouped(b));
    let after = |bounces: f64| {
        let bounces = Bounces {
            slowest: 1.0,
            remembered: bounces,
        };
        difference(&a, &b, Measure::Extremes, bounces).largest
    };
    for bounces in [30.0, 90.0] {
        assert!(
            (after(bounces) - 0.1 / 1.8).abs() < 1e-3,
            "{bounces}: {}",
            after(bounces)
        );
    }
    // After more than a hundred bounces their phases cannot be known, and the wheels of a body are one.
    assert!(after(110.0) < 1e-12, "{}", after(110.0));
}

/// Analytic: a bounce of +-1 that stays at its peak for one period has a mean that is larger by a third over three
/// periods, while no envelope changes: a third of the amplitude, a sixth of its range. Windows overlap by half, so that
/// one of them contains the whole pause wherever it begins.
#[test]
fn a_pause_of_one_period_changes_the_mean_over_three_periods() {
    let wave: &dyn Fn(f64) -> f64 = &|t| (2.0 * PI * t).sin();
    for from in [4.25, 5.75, 7.25, 10.25] {
        let paused: &dyn Fn(f64) -> f64 = &|t| {
            if (from..from + 1.0).contains(&t) {
                1.0
            } else {
                (2.0 * PI * (t - from)).cos()
            }
        };
        let plain: &dyn Fn(f64) -> f64 = &|t| (2.0 * PI * (t - from)).cos();
        let found = difference(
            &record(3001, &[paused]),
            &record(3001, &[plain]),
            Measure::Extremes,
            BOUNCES,
        );
        assert!(
            (found.largest - 1.0 / 6.0).abs() < 2e-3,
            "from {from}: {found:?}"
        );
        assert!(
            difference(
                &record(3001, &[wave]),
                &record(3001, &[plain]),
                Measure::Extremes,
                BOUNCES
            )
            .largest
                < 0.01
        );
    }
}
