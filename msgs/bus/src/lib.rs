//! How messages travel: the only crate that names zenoh
