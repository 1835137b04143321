//! Trains of a case with its factors.

use formats::design::{
    Design, DesignCase, DesignTrain, DesignWheel, TILTING, TROLLEY_DRIVES, WHOLE,
};
use trains::{Train, TrainCase, TrainWheel};

/// Which forces of the trains act.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadKind {
    /// All of them.
    All,
    /// Vertical forces.
    Vertical,
    /// Lateral forces.
    SideThrust,
    /// Longitudinal forces.
    Traction,
    /// Buffer forces.
    Buffer,
    /// Lateral forces from skewing.
    Skewing,
    /// Lateral forces of the trolley's drives.
    TrolleyDrives,
    /// Vertical and lateral forces of a crane that tilts against an obstacle.
    Tilting,
}

impl LoadKind {
    /// The kinds that are listed by themselves.
    pub const SINGLE: [LoadKind; 7] = [
        LoadKind::Vertical,
        LoadKind::SideThrust,
        LoadKind::Traction,
        LoadKind::Buffer,
        LoadKind::Skewing,
        LoadKind::TrolleyDrives,
        LoadKind::Tilting,
    ];
}

/// The trains of a case under its factors. The dead load acts with its factor where `kind` is all.
pub(crate) fn train_case(design: &Design, case: &DesignCase, kind: LoadKind) -> TrainCase {
    let all = kind == LoadKind::All;
    let trains = case
        .trains
        .iter()
        .map(|&index| train(&design.trains[index], case, kind))
        .collect();
    TrainCase {
        trains,
        ordered: case.ordered,
        gap: case.gap,
        dead: if all { case.factor("dead") } else { 0.0 },
    }
}

fn train(train: &DesignTrain, case: &DesignCase, kind: LoadKind) -> Train {
    let share = |own: LoadKind| f64::from(u8::from(kind == LoadKind::All || kind == own));
    let lateral = share(LoadKind::SideThrust) * case.factor("lateral");
    let longitudinal = share(LoadKind::Traction) * case.factor("longitudinal");
    // By themselves these are listed also where a case has no factor for them.
    let on_request = |own: LoadKind, name: &str| match kind {
        LoadKind::All => case.factor(name),
        kind if kind == own && !case.factors.iter().any(|(known, _)| known == name) => 1.0,
        _ => share(own) * case.factor(name),
    };
    let (buffer, skewing) = (
        on_request(LoadKind::Buffer, "buffer"),
        on_request(LoadKind::Skewing, "skewing"),
    );
    let tilting = on_request(LoadKind::Tilting, TILTING);
    // These follow from weights that may be given for other rows: they are listed only in cases that factor them.
    let trolley = share(LoadKind::TrolleyDrives) * case.factor(TROLLEY_DRIVES);
    let wheel = |wheel: &DesignWheel| TrainWheel {
        rail: wheel.rail,
        x: wheel.x,
        vertical: share(LoadKind::Vertical) * vertical(wheel, case) + tilting * tilting_part(wheel),
        lateral: lateral * wheel.lateral
            + skewing * wheel.skewing
            + trolley * wheel.trolley_drives
            + tilting * wheel.tilting,
        longitudinal: longitudinal * wheel.longitudinal + buffer * wheel.buffer,
        eccentricity: wheel.eccentricity,
    };
    Train {
        wheels: train.wheels.iter().map(wheel).collect(),
        ends: train.ends,
        turned: train.turned,
        reverses: train.reverses,
        enters: train.enters,
    }
}

/// Vertical force of a wheel: each part with the factor of its name or, where the case has none, that of `vertical`; without that
/// of tilting.
fn vertical(wheel: &DesignWheel, case: &DesignCase) -> f64 {
    let factor = |name: &str| {
        let own = case.factors.iter().find(|(known, _)| known == name);
        own.map_or_else(|| case.factor(WHOLE), |(_, factor)| *factor)
    };
    let parts = wheel.vertical.iter().filter(|(name, _)| name != TILTING);
    parts.map(|(name, force)| factor(name) * force).sum()
}

/// Change of the vertical force of a wheel while the crane tilts.
fn tilting_part(wheel: &DesignWheel) -> f64 {
    wheel
        .vertical
        .iter()
        .filter(|(name, _)| name == TILTING)
        .map(|(_, force)| force)
        .sum()
}

/// Whether any wheel of a case has a force of a kind.
pub(crate) fn has(design: &Design, case: &DesignCase, kind: LoadKind) -> bool {
    train_case(design, case, kind)
        .trains
        .iter()
        .flat_map(|train| &train.wheels)
        .any(|wheel| match kind {
            LoadKind::All => true,
            LoadKind::Vertical => wheel.vertical != 0.0,
            LoadKind::SideThrust | LoadKind::Skewing | LoadKind::TrolleyDrives => {
                wheel.lateral != 0.0
            }
            LoadKind::Traction | LoadKind::Buffer => wheel.longitudinal != 0.0,
            LoadKind::Tilting => wheel.vertical != 0.0 || wheel.lateral != 0.0,
        })
}
