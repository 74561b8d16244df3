//! How a node lives
