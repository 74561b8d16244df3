//! The letter with which a record says that something is wrong.

use super::records::Family;

/// What has happened, and what to do: Fastrak manual, Rev. G (2012), page 71, the codes of its built-in test. The manuals of
/// Liberty and Patriot have tables of their own, which were not at hand: their letters are told as they are.
pub fn sentence(family: Family, letter: u8) -> Option<&'static str> {
    if family != Family::Fastrak {
        return None;
    }
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
