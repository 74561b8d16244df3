//! The finished model, as files
