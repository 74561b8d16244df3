//! Poses from an Ascension Flock of Birds.
