//! Whole rigs as real processes on a real bus
