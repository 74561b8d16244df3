//! What a device says of itself, in text.

/// Bytes of a Fastrak's answer to `S`.
pub const FASTRAK_STATUS_BYTES: usize = 55;
/// Bytes of the longest answer to Ctrl-V; some revisions say less.
pub const WHO_AM_I_BYTES: usize = 196;

/// A Fastrak's status.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FastrakStatus {
    /// Records are binary.
    pub binary: bool,
    /// Positions are in centimetres.
    pub centimetres: bool,
    /// It sends without being asked.
    pub continuous: bool,
    /// The number of what failed in its own test; 0 is nothing.
    pub self_test: u16,
    /// Its program.
    pub firmware: String,
    /// Its own words.
    pub name: String,
}

impl FastrakStatus {
    /// From the answer; `None` when it is none. Columns: 0 `2`, 2 `S`, 3-5 flags and 6-8 self-test in hex, 15-20
    /// firmware, 21-52 name.
    pub fn of(answer: &[u8]) -> Option<Self> {
        if answer.len() < FASTRAK_STATUS_BYTES - 1 || answer[0] != b'2' || answer[2] != b'S' {
            return None;
        }
        let text = |from: usize, to: usize| printable(answer.get(from..to).unwrap_or_default());
        let hex = |from: usize, to: usize| u16::from_str_radix(&text(from, to), 16).ok();
        let flags = hex(3, 6)?;
        Some(Self {
            binary: flags & 1 != 0,
            centimetres: flags & 2 != 0,
            continuous: flags & 8 != 0,
            self_test: hex(6, 9).unwrap_or(0),
            firmware: text(15, 21),
            name: text(21, 53),
        })
    }
}

/// What can be read of bytes that should be text.
pub fn printable(bytes: &[u8]) -> String {
    let letters = bytes.iter().map(|&byte| if byte.is_ascii_graphic() { char::from(byte) } else { ' ' });
    letters.collect::<String>().split_whitespace().collect::<Vec<_>>().join(" ")
}
