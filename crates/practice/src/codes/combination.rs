//! Groups of crane loads and their factors, as data for a program that applies them.
//!
//! A [`LoadGroup`] names the loads that act at once, each with a [`LoadFactor`]: a number, or a dynamic factor that
//! depends on the crane and is found in [`DynamicFactors`]. Partial factors of EN 1990 are not included; those of
//! the combinations of AIST TR-13 for strength design are.

use super::clause::{CodeClause, Evidence, en_1991_3};
use super::{buffer, factor};
use crate::Error;

/// A load of a crane or of the structure that carries it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CraneLoad {
    /// Dead load of the structure, D.
    Dead,
    /// Live load of the structure, such as that of walkways, L.
    Live,
    /// Self-weight of the crane, Q_C or C_d.
    SelfWeight,
    /// Hoisted load, Q_H or C_v.
    HoistLoad,
    /// The least hoisted load, C_v,min: that of the crane without payload.
    LeastHoistLoad,
    /// Vertical impact, C_i.
    Impact,
    /// Longitudinal and lateral forces of the drives of the bridge, H_L and H_T.
    BridgeDrives,
    /// Lateral force of the drives of the trolley, H_T,3.
    TrolleyDrives,
    /// Skewing of the crane, H_S.
    Skewing,
    /// Side thrust, C_ss.
    SideThrust,
    /// Traction, C_ls.
    Traction,
    /// Wind on the crane in service, F_W.
    Wind,
    /// Test load, Q_T.
    TestLoad,
    /// Buffer force at the end stops, H_B or C_bs.
    BufferForce,
    /// Tilting of a crane whose load or lifting attachment is guided, H_TA.
    Tilting,
}

impl CraneLoad {
    /// Its name in summaries.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            CraneLoad::Dead => "dead",
            CraneLoad::Live => "live",
            CraneLoad::SelfWeight => "crane",
            CraneLoad::HoistLoad => "hoist",
            CraneLoad::LeastHoistLoad => "least hoist",
            CraneLoad::Impact => "impact",
            CraneLoad::BridgeDrives => "bridge drives",
            CraneLoad::TrolleyDrives => "trolley drives",
            CraneLoad::Skewing => "skewing",
            CraneLoad::SideThrust => "side thrust",
            CraneLoad::Traction => "traction",
            CraneLoad::Wind => "wind",
            CraneLoad::TestLoad => "test load",
            CraneLoad::BufferForce => "buffer",
            CraneLoad::Tilting => "tilting",
        }
    }
}

/// Factor of a load in a group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LoadFactor {
    /// A number.
    Number(f64),
    /// phi1, on the self-weight while a load leaves the ground: upper value.
    Phi1,
    /// phi2, on the hoisted load while it leaves the ground.
    Phi2,
    /// phi3, on the hoisted load while a part of it is released.
    Phi3,
    /// phi4, while the crane travels.
    Phi4,
    /// phi5, on forces of drives.
    Phi5,
    /// phi6, on a test load.
    Phi6,
    /// phi7, on buffer forces.
    Phi7,
    /// eta, the part of the hoisted load that remains when the payload is removed.
    Remaining,
}

/// The dynamic factors of a crane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DynamicFactors {
    /// phi1 to phi7.
    pub phi: [f64; 7],
    /// eta, the part of the hoisted load that remains when the payload is removed.
    pub remaining: f64,
}

impl DynamicFactors {
    /// The factors of a crane with the hoisting factor `phi2`, the factor `phi5` of its drives, a whole load that
    /// may be released (`release`), and spring buffers: phi1 = 1.1, phi4 = 1, phi6 = (1 + phi2)/2, phi7 = 1.25.
    ///
    /// # Errors
    /// [`Error::Range`] for a factor phi2 below one or not finite.
    ///
    /// # Source
    /// EN 1991-3:2006, Table 2.4, 2.10 and 2.11.1.
    pub fn of_crane(
        phi2: f64,
        phi5: f64,
        release: factor::Release,
    ) -> Result<DynamicFactors, Error> {
        let phi3 = factor::phi3(1.0, 1.0, release)?;
        let phi7 = buffer::phi7(0.5)?;
        let phi = [
            factor::PHI1[1],
            phi2,
            phi3,
            factor::PHI4,
            phi5,
            factor::phi6(phi2)?,
            phi7,
        ];
        Ok(DynamicFactors {
            phi,
            remaining: 0.0,
        })
    }
}

impl LoadFactor {
    /// Its value for the crane with these dynamic factors.
    #[must_use]
    pub fn value(self, crane: &DynamicFactors) -> f64 {
        let [phi1, phi2, phi3, phi4, phi5, phi6, phi7] = crane.phi;
        match self {
            LoadFactor::Number(value) => value,
            LoadFactor::Phi1 => phi1,
            LoadFactor::Phi2 => phi2,
            LoadFactor::Phi3 => phi3,
            LoadFactor::Phi4 => phi4,
            LoadFactor::Phi5 => phi5,
            LoadFactor::Phi6 => phi6,
            LoadFactor::Phi7 => phi7,
            LoadFactor::Remaining => crane.remaining,
        }
    }
}

/// A load with its factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FactoredLoad {
    /// The load.
    pub load: CraneLoad,
    /// Its factor.
    pub factor: LoadFactor,
}

/// The verification for which a group is intended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GroupUse {
    /// Ultimate limit state, before partial factors.
    Ultimate,
    /// Test of the crane.
    Test,
    /// Accidental situation.
    Accidental,
    /// Allowable stress design.
    AllowableStress,
    /// Strength design (LRFD), with its load factors.
    Strength,
    /// Fatigue.
    Fatigue,
}

/// Loads that act at once, with their factors.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadGroup {
    /// Its number or name in the code.
    pub name: &'static str,
    /// The verification for which it is intended.
    pub purpose: GroupUse,
    /// Whether it applies to one crane alone; otherwise to all cranes that may act together.
    pub is_single_crane: bool,
    /// The loads.
    pub loads: Vec<FactoredLoad>,
    /// Code, edition, clause and check.
    pub clause: CodeClause,
}

impl LoadGroup {
    /// The factor of a load; zero for a load that the group does not contain.
    #[must_use]
    pub fn factor(&self, load: CraneLoad, crane: &DynamicFactors) -> f64 {
        let own = self.loads.iter().find(|factored| factored.load == load);
        own.map_or(0.0, |factored| factored.factor.value(crane))
    }
}

/// The groups 1 to 10 of EN 1991-3, each of which is one characteristic crane action.
///
/// | load | 1 | 2 | 3 | 4 | 5 | 6 | 7 | 8 | 9 | 10 |
/// |---|---|---|---|---|---|---|---|---|---|---|
/// | self-weight of the crane | phi1 | phi1 | 1 | phi4 | phi4 | phi4 | 1 | phi1 | 1 | 1 |
/// | hoisted load | phi2 | phi3 | - | phi4 | phi4 | phi4 | eta | - | 1 | 1 |
/// | drives of the bridge | phi5 | phi5 | phi5 | phi5 | - | - | - | phi5 | - | - |
/// | skewing | - | - | - | - | 1 | - | - | - | - | - |
/// | drives of the trolley | - | - | - | - | - | 1 | - | - | - | - |
/// | wind in service | 1 | 1 | 1 | 1 | 1 | - | - | 1 | - | - |
/// | test load | - | - | - | - | - | - | - | phi6 | - | - |
/// | buffer force | - | - | - | - | - | - | - | - | phi7 | - |
/// | tilting force | - | - | - | - | - | - | - | - | - | 1 |
///
/// Groups 1 to 7 are for ultimate limit states, 8 for the test, 9 and 10 for accidental situations. The vertical
/// loads and the drives of groups 1 to 5 and the vertical loads of group 8 are those of a public program; the rest
/// is *not confirmed*.
///
/// # Source
/// EN 1991-3:2006, Table 2.2.
#[must_use]
pub fn eurocode_groups() -> Vec<LoadGroup> {
    use CraneLoad::{
        BridgeDrives, BufferForce, HoistLoad, SelfWeight, Skewing, TestLoad, Tilting,
        TrolleyDrives, Wind,
    };
    use LoadFactor::{Number, Phi1, Phi2, Phi3, Phi4, Phi5, Phi6, Phi7, Remaining};
    let one = Number(1.0);
    let group = |name, purpose, evidence, loads: &[(CraneLoad, LoadFactor)]| LoadGroup {
        name,
        purpose,
        is_single_crane: false,
        loads: loads
            .iter()
            .map(|&(load, factor)| FactoredLoad { load, factor })
            .collect(),
        clause: en_1991_3("Table 2.2", evidence),
    };
    let (ultimate, used, memory) = (GroupUse::Ultimate, Evidence::Used, Evidence::Memory);
    let drives = [(BridgeDrives, Phi5), (Wind, one)];
    vec![
        group(
            "1",
            ultimate,
            used,
            &[(SelfWeight, Phi1), (HoistLoad, Phi2), drives[0], drives[1]],
        ),
        group(
            "2",
            ultimate,
            used,
            &[(SelfWeight, Phi1), (HoistLoad, Phi3), drives[0], drives[1]],
        ),
        group(
            "3",
            ultimate,
            used,
            &[(SelfWeight, one), drives[0], drives[1]],
        ),
        group(
            "4",
            ultimate,
            used,
            &[(SelfWeight, Phi4), (HoistLoad, Phi4), drives[0], drives[1]],
        ),
        group(
            "5",
            ultimate,
            used,
            &[
                (SelfWeight, Phi4),
                (HoistLoad, Phi4),
                (Skewing, one),
                (Wind, one),
            ],
        ),
        group(
            "6",
            ultimate,
            memory,
            &[(SelfWeight, Phi4), (HoistLoad, Phi4), (TrolleyDrives, one)],
        ),
        group(
            "7",
            ultimate,
            memory,
            &[(SelfWeight, one), (HoistLoad, Remaining)],
        ),
        group(
            "8",
            GroupUse::Test,
            memory,
            &[(SelfWeight, Phi1), drives[0], drives[1], (TestLoad, Phi6)],
        ),
        group(
            "9",
            GroupUse::Accidental,
            memory,
            &[(SelfWeight, one), (HoistLoad, one), (BufferForce, Phi7)],
        ),
        group(
            "10",
            GroupUse::Accidental,
            memory,
            &[(SelfWeight, one), (HoistLoad, one), (Tilting, one)],
        ),
    ]
}
