//! Limits of deflections by the names of code and class, as an input file has them.

use super::aist::BuildingClass;
use super::limits::{
    CMAA_LIMITS, DeflectionLimit, EN_1993_6_LIMITS, GantryCrane, ServiceClass, design_guide_limits,
    is_800_limits, mill_limits,
};

/// Names of the codes that [`limits_of`] knows; those of EN 1993-6 also for EN 1991-3.
pub const LIMIT_CODES: [&str; 6] = [
    "EN 1991-3",
    "EN 1993-6",
    "CMAA 70",
    "AISC Design Guide 7",
    "AIST TR-13",
    "IS 800",
];

/// The service class of CMAA 70 with this letter; `None` beyond A to F.
#[must_use]
pub fn service_class(letter: &str) -> Option<ServiceClass> {
    match letter {
        "A" => Some(ServiceClass::A),
        "B" => Some(ServiceClass::B),
        "C" => Some(ServiceClass::C),
        "D" => Some(ServiceClass::D),
        "E" => Some(ServiceClass::E),
        "F" => Some(ServiceClass::F),
        _ => None,
    }
}

/// The class of a mill building in AIST TR-13 with this letter; `None` beyond A to D.
#[must_use]
pub fn building_class(letter: &str) -> Option<BuildingClass> {
    match letter {
        "A" => Some(BuildingClass::A),
        "B" => Some(BuildingClass::B),
        "C" => Some(BuildingClass::C),
        "D" => Some(BuildingClass::D),
        _ => None,
    }
}

/// The name of a code without the edition behind a colon, as in `EN 1993-6:2007`.
#[must_use]
pub fn code_name(code: &str) -> &str {
    code.split_once(':').map_or(code, |(name, _)| name).trim()
}

/// The limits of a code by its name and class. An edition after the name, as in `EN 1993-6:2007`, is ignored.
///
/// The class is that of the crane (A to F) for AISC Design Guide 7, that of the building (A to D) for AIST TR-13, and
/// `manual`, `electric` (up to 50 t) or `heavy` (electric, above 50 t) for IS 800, whose frames are those of cab-operated
/// cranes; the others have no classes. `None` for a code that is not in [`LIMIT_CODES`], and for a class that the code
/// needs and does not have.
///
/// ```
/// use practice::limit_choice::limits_of;
/// use practice::limits::LimitedDisplacement;
///
/// let limits = limits_of("AISC Design Guide 7", Some("D")).expect("heavy service");
/// assert_eq!(limits[0].displacement, LimitedDisplacement::RunwayVertical);
/// assert_eq!(limits[0].formula(), "L/800");
/// assert_eq!(limits_of("AISC Design Guide 7", None), None, "the guide needs a class");
/// ```
#[must_use]
pub fn limits_of(code: &str, class: Option<&str>) -> Option<Vec<DeflectionLimit>> {
    match code_name(code) {
        "EN 1991-3" | "EN 1993-6" => Some(EN_1993_6_LIMITS.to_vec()),
        "CMAA 70" => Some(CMAA_LIMITS.to_vec()),
        "AISC Design Guide 7" => Some(design_guide_limits(service_class(class?)?).to_vec()),
        "AIST TR-13" => Some(mill_limits(building_class(class?)?).to_vec()),
        "IS 800" => {
            let crane = match class? {
                "manual" => GantryCrane::Manual,
                "electric" => GantryCrane::ElectricTo50Tonnes,
                "heavy" => GantryCrane::ElectricAbove50Tonnes,
                _ => return None,
            };
            Some(is_800_limits(crane, true).to_vec())
        }
        _ => None,
    }
}
