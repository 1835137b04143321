//! Load cases in which limits of deflections are checked: the trains of the cases of a design under the loads that the
//! limits name, without factors.

use formats::design::{Design, DesignTrain, DesignWheel};
use practice::cmaa::LATERAL_FRACTION;
use practice::limits::{LimitLoads, LimitedDisplacement};
use splines::Axis;
use trains::{Structure, Train, TrainCase, TrainWheel};

/// Loads of the wheels in a check of deflections.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ServiceLoad {
    /// Vertical wheel loads.
    Vertical,
    /// Side thrust with the vertical wheel loads.
    SideThrust,
    /// Skewing forces with the vertical wheel loads.
    Skewing,
    /// Lateral forces of the trolley's drives with the vertical wheel loads.
    TrolleyDrives,
    /// A tenth of the vertical wheel loads, acting laterally, alone.
    Tenth,
}

/// Trains of a case, or one of them alone, under the loads of a check.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ServiceCase {
    /// Index of the first case of the design with these trains.
    pub case: usize,
    /// Indices of the trains.
    pub trains: Vec<usize>,
    ordered: bool,
    gap: f64,
    /// The loads.
    pub load: ServiceLoad,
}

impl ServiceCase {
    /// Whether a limit for `loads` of a displacement applies to this case; `cranes` is the number of trains of the case of
    /// the design.
    pub fn serves(
        &self,
        loads: LimitLoads,
        displacement: LimitedDisplacement,
        cranes: usize,
    ) -> bool {
        let is_whole = self.trains.len() == cranes;
        let is_alone = self.trains.len() == 1;
        let is_lateral = displacement == LimitedDisplacement::RunwayLateral;
        match loads {
            LimitLoads::StaticWheels => is_whole && self.load == ServiceLoad::Vertical,
            LimitLoads::OneCrane => is_alone && self.load == ServiceLoad::Vertical,
            LimitLoads::Tenth => is_whole && is_lateral && self.load == ServiceLoad::Tenth,
            LimitLoads::Horizontal => is_whole && is_lateral && self.load != ServiceLoad::Tenth,
            LimitLoads::WithTemperature => is_whole && self.load != ServiceLoad::Tenth,
            LimitLoads::Surge => {
                is_whole && matches!(self.load, ServiceLoad::SideThrust | ServiceLoad::Vertical)
            }
            LimitLoads::OneSideThrust => {
                is_alone && matches!(self.load, ServiceLoad::SideThrust | ServiceLoad::Vertical)
            }
            LimitLoads::OneSideThrustOrWind | LimitLoads::Payload | LimitLoads::TrolleyAndLoad => {
                false
            }
        }
    }

    /// The applied loads in words, for a limit whose loads are `named`.
    pub fn words(&self, named: LimitLoads) -> &'static str {
        match (self.load, named) {
            (ServiceLoad::Vertical, LimitLoads::StaticWheels | LimitLoads::OneCrane)
            | (ServiceLoad::Tenth, _) => named.words(),
            (_, LimitLoads::WithTemperature) => match self.load {
                ServiceLoad::Vertical => "vertical wheel loads, without temperature effects",
                ServiceLoad::SideThrust => {
                    "characteristic side thrust with vertical wheel loads, without temperature effects"
                }
                ServiceLoad::Skewing => {
                    "characteristic skewing forces with vertical wheel loads, without temperature effects"
                }
                _ => {
                    "characteristic forces of the trolley drives with vertical wheel loads, without temperature effects"
                }
            },
            (ServiceLoad::Vertical, _) => {
                "vertical wheel loads only, which displace the rail laterally"
            }
            (ServiceLoad::SideThrust, LimitLoads::OneSideThrust) => {
                "side thrust of one crane with its vertical wheel loads"
            }
            (ServiceLoad::SideThrust, _) => {
                "characteristic side thrust with vertical wheel loads, without dynamic factors"
            }
            (ServiceLoad::Skewing, _) => {
                "characteristic skewing forces with vertical wheel loads, without dynamic factors"
            }
            (ServiceLoad::TrolleyDrives, _) => {
                "characteristic forces of the trolley drives with vertical wheel loads, without dynamic factors"
            }
        }
    }

    /// The trains with their loads.
    pub fn train_case(&self, design: &Design) -> TrainCase {
        let trains = self.trains.iter();
        TrainCase {
            trains: trains
                .map(|&train| self.train(&design.trains[train]))
                .collect(),
            ordered: self.ordered,
            gap: self.gap,
            dead: 0.0,
        }
    }

    fn train(&self, train: &DesignTrain) -> Train {
        let wheel = |wheel: &DesignWheel| {
            let vertical = wheel.whole_vertical();
            let (vertical, lateral) = match self.load {
                ServiceLoad::Vertical => (vertical, 0.0),
                ServiceLoad::SideThrust => (vertical, wheel.lateral),
                ServiceLoad::Skewing => (vertical, wheel.skewing),
                ServiceLoad::TrolleyDrives => (vertical, wheel.trolley_drives),
                ServiceLoad::Tenth => (0.0, LATERAL_FRACTION * vertical),
            };
            TrainWheel {
                rail: wheel.rail,
                x: wheel.x,
                vertical,
                lateral,
                longitudinal: 0.0,
                eccentricity: wheel.eccentricity,
            }
        };
        Train {
            wheels: train.wheels.iter().map(wheel).collect(),
            ends: train.ends,
            turned: train.turned,
            reverses: train.reverses || self.load == ServiceLoad::Tenth,
            enters: train.enters,
        }
    }
}

/// The load cases that the limits of a design need. Lateral loads act where the rails of all their wheels resist them.
pub(crate) fn service_cases(design: &Design, structure: &Structure) -> Vec<ServiceCase> {
    let mut out: Vec<ServiceCase> = Vec::new();
    for (index, case) in design.cases.iter().enumerate() {
        let whole = std::iter::once(case.trains.clone());
        let alone = case.trains.iter().map(|&train| vec![train]);
        for trains in whole.chain(alone) {
            for load in [
                ServiceLoad::Vertical,
                ServiceLoad::SideThrust,
                ServiceLoad::Skewing,
                ServiceLoad::TrolleyDrives,
                ServiceLoad::Tenth,
            ] {
                let is_alone = trains.len() == 1;
                let service = ServiceCase {
                    case: index,
                    trains: trains.clone(),
                    ordered: case.ordered && !is_alone,
                    gap: if is_alone { 0.0 } else { case.gap },
                    load,
                };
                let is_needed = design.practice.limits.iter().any(|limit| {
                    service.serves(limit.loads, limit.displacement, case.trains.len())
                });
                let is_known = out.iter().any(|known| {
                    ServiceCase {
                        case: index,
                        ..known.clone()
                    } == service
                });
                if is_needed && !is_known && service.acts(design, structure) {
                    out.push(service);
                }
            }
        }
    }
    out
}

impl ServiceCase {
    /// Whether any wheel has the forces that give the case its name, and the structure resists them.
    fn acts(&self, design: &Design, structure: &Structure) -> bool {
        let train_case = self.train_case(design);
        let mut all = train_case.trains.iter().flat_map(|train| &train.wheels);
        if !all.all(|wheel| {
            wheel.lateral == 0.0 || structure.frame().resists(wheel.rail, Axis::Lateral)
        }) {
            return false;
        }
        let mut wheels = self
            .trains
            .iter()
            .flat_map(|&train| &design.trains[train].wheels);
        wheels.any(|wheel| match self.load {
            ServiceLoad::Vertical | ServiceLoad::Tenth => wheel.whole_vertical() != 0.0,
            ServiceLoad::SideThrust => wheel.lateral != 0.0,
            ServiceLoad::Skewing => wheel.skewing != 0.0,
            ServiceLoad::TrolleyDrives => wheel.trolley_drives != 0.0,
        })
    }
}
