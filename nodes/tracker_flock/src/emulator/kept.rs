//! Parameters that a unit keeps for its host and tells when it is asked; nothing that is played here acts on them.

/// Number and value after power-up: data-ready character on or off, and which (a comma); which errors are told; whether the
/// reference frame turns positions; how the transmitter is driven; alignment and reference frame in angles; the delay
/// of replies on the FBB.
const POWER_UP: [(u8, &[u8]); 8] =
    [(8, &[0]), (9, b","), (11, &[0]), (17, &[0]), (18, &[0]), (23, &[0; 6]), (24, &[0; 6]), (32, &[0; 2])];

/// Their values.
#[derive(Debug, Clone)]
pub(super) struct Kept(Vec<(u8, Vec<u8>)>);

impl Kept {
    /// As they are after power-up.
    pub fn new() -> Self {
        Self(POWER_UP.iter().map(|(number, value)| (*number, value.to_vec())).collect())
    }

    /// Keeps a value; an error when there is no such parameter, or its values have another length.
    pub fn set(&mut self, parameter: u8, value: &[u8]) -> Result<(), ()> {
        let fits = |kept: &&mut (u8, Vec<u8>)| kept.0 == parameter && kept.1.len() == value.len();
        self.0.iter_mut().find(fits).ok_or(())?.1.copy_from_slice(value);
        Ok(())
    }

    /// What EXAMINE answers; nothing when there is no such parameter.
    pub fn get(&self, parameter: u8) -> Vec<u8> {
        self.0.iter().find(|(number, _)| *number == parameter).map_or_else(Vec::new, |(_, value)| value.clone())
    }
}
