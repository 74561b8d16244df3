//! The eyes of the operator: every stream in Rerun
