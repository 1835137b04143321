//! The motion of natural modes in a run, exactly as the steps have found it.
//!
//! In a step the load of a mode is a polynomial of time, and its motion the exact response to it ([`Propagator`]), which may have
//! many periods.

use crate::numerics::propagator::Propagator;

/// The motion of some modes over all steps.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ModalMotion {
    /// Frequency and damping ratio of each mode.
    modes: Vec<[f64; 2]>,
    /// Number of coefficients of a load.
    terms: usize,
    /// Start and end of each step.
    steps: Vec<[f64; 2]>,
    /// For each step and mode, displacement and speed at its start and the coefficients of the load by powers of the share of the
    /// step.
    values: Vec<f64>,
}

impl ModalMotion {
    /// Without steps.
    pub fn new(modes: Vec<[f64; 2]>, terms: usize) -> ModalMotion {
        ModalMotion {
            modes,
            terms,
            steps: Vec::new(),
            values: Vec::new(),
        }
    }

    /// Begins a step, the values of which must be appended to what is returned.
    pub fn begin(&mut self, step: [f64; 2]) -> &mut Vec<f64> {
        self.steps.push(step);
        &mut self.values
    }

    /// Number of modes.
    pub fn len(&self) -> usize {
        self.modes.len()
    }

    /// Writes the displacements of all modes at time `t` into the first half of `out` and their accelerations into the second. At
    /// an end of two steps they are those of the first of them, or of the second if it `is_after`.
    pub fn fill(&self, t: f64, is_after: bool, out: &mut [f64]) {
        let first = self
            .steps
            .partition_point(|[_, end]| *end < t || is_after && *end == t);
        let at = first.min(self.steps.len().saturating_sub(1));
        let Some([from, to]) = self.steps.get(at).copied() else {
            return out.fill(0.0);
        };
        let (h, n, each) = (to - from, self.len(), 2 + self.terms);
        let share = ((t - from) / h).clamp(0.0, 1.0);
        let own = self.values[at * n * each..(at + 1) * n * each].chunks_exact(each);
        let (q, a) = out.split_at_mut(n);
        for (((values, [omega, zeta]), q), a) in own.zip(&self.modes).zip(q).zip(a) {
            let (start, load) = values.split_at(2);
            let mode = Propagator::new(*omega, *zeta, h);
            let [qq, qv, vq, vv] = mode.free(share);
            let [mut own, mut speed, mut now, mut power] = [
                qq * start[0] + qv * start[1],
                vq * start[0] + vv * start[1],
                0.0,
                1.0,
            ];
            for (load, [by_q, by_v]) in load.iter().zip(mode.forced(share)) {
                own += load * by_q;
                speed += load * by_v;
                now += load * power;
                power *= share;
            }
            *q = own;
            *a = now - omega * (2.0 * zeta * speed + omega * own);
        }
    }
}
