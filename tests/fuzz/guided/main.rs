//! Executes the target that `GIRDERWAY_FUZZ_TARGET` names under libFuzzer.

#![no_main]

#[path = "../generate.rs"]
mod generate;
#[path = "../targets.rs"]
#[allow(
    dead_code,
    reason = "the corpus begins with files that the caller names, not with `seeds`"
)]
mod targets;

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use targets::{TARGETS, Target};

static CHOSEN: LazyLock<Target> = LazyLock::new(|| {
    let name =
        std::env::var("GIRDERWAY_FUZZ_TARGET").expect("GIRDERWAY_FUZZ_TARGET names a target");
    *TARGETS
        .iter()
        .find(|target| target.name == name)
        .expect("GIRDERWAY_FUZZ_TARGET names a target")
});

fuzz_target!(|data: &[u8]| {
    let _ = (CHOSEN.run)(data);
});
