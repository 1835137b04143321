"""The part of the package girderway that is written in Rust."""
