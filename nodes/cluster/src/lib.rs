//! The ball clustering of the paper, incremental
