//! Little steps through bytes that may end anywhere.

use crate::Reason;

/// What is left of a file.
pub(crate) struct Cursor<'a> {
    all: &'a [u8],
    at: usize,
}

impl<'a> Cursor<'a> {
    pub fn new(all: &'a [u8]) -> Self {
        Self { all, at: 0 }
    }

    /// The line, from 1, of the next byte.
    pub fn line(&self) -> usize {
        1 + self.all[..self.at].iter().filter(|&&b| b == b'\n').count()
    }

    /// The next `count` bytes; `inside` names the part that they belong to.
    pub fn take(&mut self, count: usize, inside: &str) -> Result<&'a [u8], Reason> {
        let rest = &self.all[self.at..];
        let taken = rest.get(..count).ok_or_else(|| Reason::truncated(inside))?;
        self.at += count;
        Ok(taken)
    }

    /// The next `N` bytes.
    pub fn array<const N: usize>(&mut self, inside: &str) -> Result<[u8; N], Reason> {
        let mut out = [0; N];
        out.copy_from_slice(self.take(N, inside)?);
        Ok(out)
    }

    /// The next line without its end; `None` behind the last.
    pub fn next_line(&mut self) -> Option<&'a [u8]> {
        let rest = &self.all[self.at..];
        if rest.is_empty() {
            return None;
        }
        let end = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
        self.at += (end + 1).min(rest.len());
        Some(rest[..end].strip_suffix(b"\r").unwrap_or(&rest[..end]))
    }

    /// The next word between white space; `None` behind the last.
    pub fn word(&mut self) -> Option<&'a str> {
        let rest = &self.all[self.at..];
        let start = rest.iter().position(|b| !b.is_ascii_whitespace())?;
        let length = rest[start..].iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len() - start);
        self.at += start + length;
        // Bytes that are no text are no number or keyword either: the empty word is refused by whoever asked.
        Some(std::str::from_utf8(&rest[start..start + length]).unwrap_or_default())
    }
}
