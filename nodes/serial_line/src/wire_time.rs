//! How long bytes are on their way.

/// A start bit, eight data bits, a stop bit.
const BITS_PER_BYTE: i64 = 10;

/// Nanoseconds that `bytes` take at so many bits a second, 8N1. At 0 baud (a line without one) they take none.
pub fn wire_nanos(bytes: usize, baud: u32) -> i64 {
    let bits = (bytes as i64).saturating_mul(BITS_PER_BYTE);
    bits.saturating_mul(1_000_000_000).checked_div(i64::from(baud)).unwrap_or(0)
}
