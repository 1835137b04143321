//! Values that are only rounding are zero: a table of moments at a support is read by people.

use trains::{CaseEnvelopes, GirderResponse, Governing};

/// Values below this fraction of the largest of their kind are rounding errors.
const ROUNDING: f64 = 1e-13;

/// Largest force, moment and deflection of a case; moments include forces times the length of the rails.
pub(crate) struct Sizes {
    force: f64,
    moment: f64,
    deflection: f64,
}

impl Sizes {
    /// The sizes of a case with rails of `length`.
    pub fn of(envelopes: &CaseEnvelopes, length: f64) -> Sizes {
        let most = |is_own: &dyn Fn(GirderResponse) -> bool| {
            let own = envelopes.extremes.iter().filter(|e| is_own(e.quantity));
            own.map(|e| e.governing.value.abs()).fold(0.0, f64::max)
        };
        let reactions = envelopes
            .effects
            .iter()
            .flatten()
            .map(|g| g.value.abs())
            .fold(0.0, f64::max);
        let force = most(&|quantity| kind(quantity) == Kind::Force).max(reactions);
        let moment = most(&|quantity| kind(quantity) == Kind::Moment).max(force * length);
        Sizes {
            force,
            moment,
            deflection: most(&|quantity| kind(quantity) == Kind::Deflection),
        }
    }

    fn size(&self, kind: Kind) -> f64 {
        match kind {
            Kind::Force => self.force,
            Kind::Moment => self.moment,
            Kind::Deflection => self.deflection,
        }
    }

    fn cleaned(&self, value: f64, kind: Kind) -> f64 {
        if value.abs() <= ROUNDING * self.size(kind) {
            0.0
        } else {
            value
        }
    }

    fn clean(&self, governing: &mut Governing, kind: Kind) {
        governing.value = self.cleaned(governing.value, kind);
        governing.dead = self.cleaned(governing.dead, kind);
        for (value, kind) in
            governing
                .coincident
                .iter_mut()
                .zip([Kind::Moment, Kind::Force, Kind::Deflection])
        {
            *value = self.cleaned(*value, kind);
        }
    }

    /// Replaces what is only rounding by zero.
    pub fn clean_all(&self, envelopes: &mut CaseEnvelopes) {
        envelopes
            .envelopes
            .iter_mut()
            .for_each(|e| self.clean(&mut e.governing, kind(e.quantity)));
        for (index, governing) in &mut envelopes.other_sides {
            self.clean(governing, kind(envelopes.envelopes[*index].quantity));
        }
        for extreme in &mut envelopes.extremes {
            self.clean(&mut extreme.governing, kind(extreme.quantity));
            extreme.bound = self.cleaned(extreme.bound, kind(extreme.quantity));
        }
        envelopes
            .deflections
            .iter_mut()
            .for_each(|d| self.clean(&mut d.governing, Kind::Deflection));
        // A reaction may be a force or a moment: the smaller size leaves more.
        envelopes
            .effects
            .iter_mut()
            .flatten()
            .for_each(|g| self.clean(g, Kind::Force));
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Force,
    Moment,
    Deflection,
}

const fn kind(quantity: GirderResponse) -> Kind {
    match quantity {
        GirderResponse::Normal | GirderResponse::VerticalShear | GirderResponse::LateralShear => {
            Kind::Force
        }
        GirderResponse::Torsion
        | GirderResponse::VerticalMoment
        | GirderResponse::LateralMoment => Kind::Moment,
        GirderResponse::VerticalDeflection | GirderResponse::LateralDeflection => Kind::Deflection,
    }
}
