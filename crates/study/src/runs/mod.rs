//! The runs of a study: settings made ready, converged references, the choice by "auto", times, the study itself.

pub(crate) mod auto;
pub(crate) mod investigate;
pub(crate) mod point;
pub(crate) mod reference;
pub(crate) mod setup;
pub(crate) mod timing;
