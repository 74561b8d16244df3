//! How a unit was told to measure metal.

/// Switched on or off, sensitivity, offset, slope, and the gain of its filter: five words, as parameter 28 has them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Metal([u16; 5]);

impl Metal {
    /// As it is after power-up: off.
    pub const OFF: Self = Self([0, 32, 0, 0, 12]);

    /// The command METAL: a flag says what the byte behind it is for.
    pub fn command(&mut self, flag: u8, data: u8) -> Result<(), ()> {
        match flag {
            0 => self.0[0] = 0,
            1 => self.0 = [1, 32, 0, 0, 12],
            2..=5 => self.0[usize::from(flag - 1)] = u16::from(data),
            _ => return Err(()),
        }
        Ok(())
    }

    /// CHANGE 28.
    pub fn change(&mut self, words: &[u8]) {
        for (word, bytes) in self.0.iter_mut().zip(words.chunks_exact(2)) {
            *word = u16::from_le_bytes([bytes[0], bytes[1]]);
        }
    }

    /// EXAMINE 28.
    pub fn bytes(&self) -> Vec<u8> {
        self.0.iter().flat_map(|word| word.to_le_bytes()).collect()
    }

    /// Whether a byte of it follows the words of a record.
    pub fn is_on(&self) -> bool {
        self.0[0] != 0
    }
}
