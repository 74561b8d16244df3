//! In which unit a file's numbers are: most formats do not say.

use clap::ValueEnum;

/// The unit of a file's coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Unit {
    /// Metres, as everything that limn writes.
    #[default]
    M,
    /// Millimetres.
    Mm,
}

impl Unit {
    /// Metres in one of it.
    pub fn metres(self) -> f32 {
        match self {
            Self::M => 1.0,
            Self::Mm => 1e-3,
        }
    }
}
