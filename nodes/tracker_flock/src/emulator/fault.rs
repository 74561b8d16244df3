//! The last error of a flock, as it is told and forgotten.

/// Its bit in the status word goes out when that word is read, its code when it is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Fault {
    code: u8,
    detail: u8,
    lit: bool,
}

impl Fault {
    /// As it was found; 0 is none.
    pub fn new(code: u8) -> Self {
        Self { code, detail: 0, lit: code != 0 }
    }

    /// Something has gone wrong. The detail tells, with code 13, which unit did not answer.
    pub fn raise(&mut self, code: u8, detail: u8) {
        *self = Self { code, detail, lit: true };
    }

    /// The bit of the status word.
    pub fn take_bit(&mut self) -> bool {
        std::mem::take(&mut self.lit)
    }

    /// Code and detail.
    pub fn take(&mut self) -> [u8; 2] {
        let said = [self.code, self.detail];
        *self = Self::new(0);
        said
    }
}
