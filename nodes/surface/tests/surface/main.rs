//! The surface against shapes whose truth is known, and against clouds that have none.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod animal;
mod bad_input;
mod check;
mod closed;
mod mesh;
mod shapes;
