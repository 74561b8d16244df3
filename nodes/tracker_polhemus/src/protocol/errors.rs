//! The byte with which a record says that something is wrong, as a sentence: what has happened, and what to do.

use super::records::Family;

/// Whether a record says that nothing is wrong: a space; in the binary records of Liberty and Patriot also a zero.
pub fn is_well(family: Family, error: u8) -> bool {
    error == b' ' || (error == 0 && family != Family::Fastrak)
}

/// `None` for a byte that the device's table does not have.
pub fn sentence(family: Family, error: u8) -> Option<&'static str> {
    match family {
        Family::Fastrak => fastrak(error),
        Family::Liberty | Family::Patriot => command(error).or_else(|| liberty(error)),
    }
}

/// Fastrak manual, Rev. G (2012), page 71: the codes of its built-in test.
fn fastrak(letter: u8) -> Option<&'static str> {
    Some(match letter {
        b'a'..=b'c' => {
            "a driver of the source fails its self-calibration: switch off, plug the source in firmly, switch on"
        }
        b'd'..=b'f' => "a receiver's gain fails its self-calibration: switch off, plug it in firmly, switch on",
        b'g' => "the coils fail their self-calibration: switch off, plug source and receiver in firmly, switch on",
        b'j' => "the signal is saturated: the receiver is too near the source",
        b'k' => "the signal is low: the receiver is too far from the source, or not plugged in",
        b'l' => "there is no signal: plug the receiver in, and the source",
        b'm' | b'w' => "its memory of settings fails: switch it off and on; if it comes again it needs repair",
        b't' | b'u' => "its map of the room does not hold here: leave its compensation off",
        b'v' => "there is no CRT synchronisation: none is asked for; switch it off and on",
        b'x' => "the receiver is out of the box that the device was told to watch: switch it off and on",
        b'y' => "the receiver is turned beyond the angles that the device was told to watch: switch it off and on",
        _ => return None,
    })
}

/// Patriot manual, section 2.4, and Liberty's, which goes on behind 0x15; known by the tables of two public drivers (Sheller's for the
/// Patriot, 2010, and one for the Liberty): what went wrong with a command, or as the device started.
fn command(code: u8) -> Option<&'static str> {
    Some(match code {
        0x01..=0x07 | 0x10 | 0x13 => {
            "it got a command that it does not understand: bytes are lost towards it; lower the baud rate or shorten the cable"
        }
        0x08..=0x0D => "its sensors' processors do not answer: switch it off and on; if it comes again it needs repair",
        0x0E => "its source's processor does not start: switch off, plug the source in firmly, switch on",
        0x0F => "its memory is full: switch it off and on",
        0x11 => "it is in a mode for its maker's tests: switch it off and on",
        0x12 => "the source's own calibration cannot be read: switch off, plug the source in firmly, switch on",
        0x14 => "it has something to say that is no error: its maker's program shows what",
        0x15 => "its map of the room cannot be loaded: leave its compensation off",
        0x16 => "its sensors are not in step: switch it off and on",
        0x17 | 0x18 => {
            "the programs of its processors do not fit together: bring them up to date with its maker's tool"
        }
        _ => return None,
    })
}

/// The same tables: what is wrong while it measures.
fn liberty(letter: u8) -> Option<&'static str> {
    Some(match letter {
        b'a'..=b'g' => "coils of the source fail: switch off, plug the source in firmly, switch on",
        b'A'..=b'G' => {
            "coils of the source fail, and its own test has found errors: switch off, plug the source in firmly, switch on"
        }
        b'I' => "its own test has found errors: switch it off and on; if they come again it needs repair",
        b'u' => "the sensor is outside of the part of the room that was mapped: bring it nearer, or clear the map",
        _ => return None,
    })
}
