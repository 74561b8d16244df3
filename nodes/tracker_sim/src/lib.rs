//! Poses from an honest simulated tracker
