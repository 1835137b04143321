//! The content of the report of a run, section by section.

pub(crate) mod codes_story;
pub(crate) mod fatigue_story;
pub(crate) mod response_story;
pub mod story;
