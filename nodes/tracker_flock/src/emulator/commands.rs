//! What the host says, cut into commands.

/// A command for a unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Command {
    /// The unit; 0 is whoever is on the line.
    pub address: u8,
    /// The letter.
    pub code: u8,
    /// What follows it.
    pub data: Vec<u8>,
}

/// The first whole command, and how many bytes it has.
pub(super) fn next_command(heard: &[u8]) -> Option<(Command, usize)> {
    let (address, start) = match heard {
        [first @ 0xF1..=0xFF, ..] => (first - 0xF0, 1),
        [first @ 0xE0..=0xEE, ..] => (first - 0xE0 + 16, 1),
        [0xA0, address, ..] => (*address, 2),
        [0xA0] => return None,
        _ => (0, 0),
    };
    let code = *heard.get(start)?;
    let length = match code {
        b'P' => 1 + change_length(*heard.get(start + 1)?),
        code => data_length(code),
    };
    let end = start + 1 + length;
    let data = heard.get(start + 1..end)?.to_vec();
    Some((Command { address, code, data }, end))
}

fn data_length(code: u8) -> usize {
    match code {
        b'O' | b'M' | b'A' | b'0' => 1,
        b'L' | b's' => 2,
        b'q' | b'r' | b'K' => 6,
        b'J' | b'H' => 12,
        _ => 0,
    }
}

fn change_length(parameter: u8) -> usize {
    match parameter {
        3 | 4 | 6 | 7 | 22 | 32 => 2,
        5 | 12 | 13 => 14,
        23 | 24 => 6,
        28 => 10,
        _ => 1,
    }
}
