//! Lights that are played: for the tests of their driver, and of whole rigs.

use serial_line::Emulated;

/// A sketch, or a Ciclop's board: outputs 1 and 2.
#[derive(Default)]
pub struct Board {
    pub horus: bool,
    pub deaf: bool,
    pub line: String,
    pub says: Vec<u8>,
    pub on: [bool; 2],
    /// Each state that it was in.
    pub states: Vec<[bool; 2]>,
}

impl Board {
    fn obey(&mut self, line: &str) {
        let before = self.on;
        let answer = match (self.horus, line) {
            (_, "") => return,
            (false, "light?") => "limn-light 1".to_owned(),
            (false, _) if line.starts_with("light ") => {
                self.on = [line.as_bytes()[6] == b'1', line.as_bytes()[8] == b'1'];
                line.replace("light", "ok")
            }
            (true, "\u{18}") => {
                self.on = [false; 2];
                "\r\nHorus 0.2 ['$' for help]\r".to_owned()
            }
            (true, _) if line.starts_with("M7") => {
                let output = usize::from(line.as_bytes()[4] - b'1');
                self.on[output] = line.as_bytes()[2] == b'1';
                "ok\r".to_owned()
            }
            _ => format!("? {line}"),
        };
        if self.on != before {
            self.states.push(self.on);
        }
        self.says.extend(answer.bytes().chain([b'\n']));
    }
}

impl Emulated for Board {
    fn hear(&mut self, bytes: &[u8], _: i64) {
        for &byte in bytes {
            if byte == b'\n' {
                let line = std::mem::take(&mut self.line);
                self.obey(line.trim_end_matches('\r'));
            } else {
                self.line.push(byte as char);
            }
        }
    }

    fn speak(&mut self, now_nanos: i64) -> Option<(i64, Vec<u8>)> {
        let says = std::mem::take(&mut self.says);
        (!self.deaf && !says.is_empty()).then_some((now_nanos, says))
    }
}
