//! A line that is half dead.

use std::collections::VecDeque;

/// A line on which more of the bytes than this belong to no record is half dead.
const NOISY_SHARE: f64 = 0.25;
/// What is looked at slides with the time, in pieces: so a line that dies by so much is known within a second of it.
const PIECE_NANOS: i64 = 100_000_000;
const PIECES: i64 = 8;
/// Less of a stream says nothing: it begins in the middle of a record.
const LEAST_PIECES: i64 = 4;
const NAMED_AGAIN_NANOS: i64 = 30_000_000_000;

/// Knows which share of the bytes of the last 0.8 s belongs to no record.
///
/// ```
/// let mut noise = serial_line::Noise::default();
/// let mut told = None;
/// // A hundred records of 24 bytes a second, each second of which comes in pieces from the first second on.
/// for k in 0..200_i64 {
///     let skipped = if k >= 100 && k % 2 == 0 { 24 } else { 0 };
///     if let Some(share) = noise.hear(k * 10_000_000, 24, skipped) {
///         told = Some((k, share));
///     }
/// }
/// let (k, share) = told.ok_or("never told")?;
/// assert!((100..200).contains(&k) && (0.2..0.6).contains(&share));
/// # Ok::<(), &str>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Noise {
    pieces: VecDeque<Piece>,
    named_nanos: Option<i64>,
}

#[derive(Debug, Clone, Copy)]
struct Piece {
    index: i64,
    bytes: u64,
    skipped: u64,
}

impl Noise {
    /// So many bytes have come, and so many more are known by now to belong to no record; the share of those in what came
    /// lately, when it is high and was not told lately.
    pub fn hear(&mut self, now_nanos: i64, bytes: u64, skipped: u64) -> Option<f64> {
        let index = now_nanos.div_euclid(PIECE_NANOS);
        match self.pieces.back_mut() {
            Some(piece) if piece.index == index => {
                (piece.bytes, piece.skipped) = (piece.bytes + bytes, piece.skipped + skipped)
            }
            _ => self.pieces.push_back(Piece { index, bytes, skipped }),
        }
        while self.pieces.front().is_some_and(|piece| index - piece.index >= PIECES) {
            self.pieces.pop_front();
        }
        let lately = self.named_nanos.is_some_and(|at| now_nanos - at < NAMED_AGAIN_NANOS);
        let heard = self.pieces.front().map_or(0, |first| index - first.index);
        if lately || heard < LEAST_PIECES {
            return None;
        }
        let sum = |of: fn(&Piece) -> u64| self.pieces.iter().map(of).sum::<u64>() as f64;
        let share = sum(|piece| piece.skipped) / sum(|piece| piece.bytes).max(1.0);
        if share < NOISY_SHARE {
            return None;
        }
        self.named_nanos = Some(now_nanos);
        Some(share.min(1.0))
    }
}
