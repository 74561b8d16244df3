//! What the host says, cut into commands, and what the device does about it.

use super::PolhemusEmulator;
use crate::protocol::records::{Family, Item};
use nalgebra::Vector3;

impl PolhemusEmulator {
    pub(super) fn obey(&mut self, command: &str, now: i64) {
        let fastrak = self.config.family == Family::Fastrak;
        let mut letters = command.chars();
        let (letter, rest) = (letters.next().unwrap_or('\r'), letters.as_str());
        let mut numbers = rest.split(',').map(|number| number.trim().parse::<i64>().unwrap_or(-1));
        match letter {
            'c' if fastrak => self.set.continuous = false,
            'C' => self.set.continuous = true,
            'P' => {
                self.set.continuous = false;
                self.report(now);
            }
            'f' if fastrak => self.set.binary = true,
            'F' => self.set.binary = rest == "1",
            'U' if fastrak => self.set.centimetres = false,
            'u' if fastrak => self.set.centimetres = true,
            'U' => self.set.centimetres = rest == "1",
            'Q' => self.clock_zero_nanos = now,
            'S' if fastrak => {
                let flags = u8::from(self.set.binary)
                    | u8::from(self.set.centimetres) << 1
                    | u8::from(self.set.continuous) << 3;
                let name = format!("2 S{flags:03X}000      3.01  {:<32}\r\n", "3SPACE FASTRAK, emulated");
                self.speech.say(now, name.into_bytes());
            }
            '\x16' => {
                let name = if self.config.family == Family::Patriot { "Patriot" } else { "Liberty" };
                self.speech.say(now, format!("{:<194}\r\n", format!("0 Polhemus {name}, emulated")).into_bytes());
            }
            'l' if fastrak => {
                let (station, on) = (numbers.next().unwrap_or(0), numbers.next());
                match (self.set.active.get_mut((station - 1).max(0) as usize), on) {
                    (Some(active), Some(on)) => *active = on == 1,
                    (_, None) => self.tell_stations(station, now),
                    (None, Some(_)) => {}
                }
            }
            '\x19' => self.restart(now),
            'H' => {
                let mut numbers = rest.split(',').map(|number| number.trim().parse().unwrap_or(0.0));
                let mut next = || numbers.next().unwrap_or(0.0);
                if let Some(half) = self.set.hemispheres.get_mut((next() as usize).wrapping_sub(1)) {
                    *half = Vector3::new(next(), next(), next());
                }
            }
            'O' => {
                let station = numbers.next().unwrap_or(0);
                let items = numbers.filter_map(|code| item_of(code, self.config.family)).collect();
                if let Some(layout) = self.set.layouts.get_mut((station - 1).max(0) as usize) {
                    layout.items = items;
                }
            }
            _ => {}
        }
    }
}

impl PolhemusEmulator {
    /// Which stations are on: a digit for each of four.
    fn tell_stations(&mut self, station: i64, now: i64) {
        let digits: String = (0..4).map(|k| if self.set.active.get(k) == Some(&true) { '1' } else { '0' }).collect();
        self.speech.say(now, format!("2{station}l{digits}\r\n").into_bytes());
    }
}

/// The first whole command, and how many bytes it has. A Fastrak knows many of its commands by their letter; what has
/// arguments ends with CR.
pub(super) fn next_command(heard: &[u8], family: Family) -> Option<(String, usize)> {
    let first = *heard.first()?;
    let alone = match family {
        Family::Fastrak => b"PcCfFUuSWYt\x19\x0B\r".contains(&first),
        // A single record is the one command that does not wait for CR.
        _ => matches!(first, b'P' | b'\r'),
    };
    if alone {
        return Some((char::from(first).to_string(), 1));
    }
    let end = heard.iter().position(|&byte| byte == b'\r')?;
    Some((String::from_utf8_lossy(&heard[..end]).into_owned(), end + 1))
}

fn item_of(code: i64, family: Family) -> Option<Item> {
    const ALL: [Item; 10] = [
        Item::Space,
        Item::CrLf,
        Item::Position,
        Item::PositionPrecise,
        Item::Euler,
        Item::Quaternion,
        Item::TimeStamp,
        Item::FrameCount,
        Item::Stylus,
        Item::Distortion,
    ];
    ALL.into_iter().find(|item| item.code(family).map(i64::from) == Some(code))
}
