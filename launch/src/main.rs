//! The binary `limn`.
fn main() {}
