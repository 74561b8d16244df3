//! Seconds as people write them, to nanoseconds and back without loss: an f64 of seconds since 1970 is off by 100 ns.

const NANOS: u64 = 1_000_000_000;

/// `-12.000000345` to nanoseconds; digits behind the ninth are dropped. `None` for anything else and beyond 292 years.
pub(super) fn parse(text: &str) -> Option<i64> {
    let (negative, digits) = match text.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, text.strip_prefix('+').unwrap_or(text)),
    };
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let is_digits = |part: &str| part.bytes().all(|b| b.is_ascii_digit());
    if whole.is_empty() && fraction.is_empty() || !is_digits(whole) || !is_digits(fraction) {
        return None;
    }
    let whole: u64 = if whole.is_empty() { 0 } else { whole.parse().ok()? };
    let nanos: u64 = format!("{fraction:0<9}").get(..9)?.parse().ok()?;
    let total = i64::try_from(whole.checked_mul(NANOS)?.checked_add(nanos)?).ok()?;
    Some(if negative { -total } else { total })
}

/// Nanoseconds as seconds with nine digits.
pub(super) fn text(nanos: i64) -> String {
    let size = nanos.unsigned_abs();
    format!("{}{}.{:09}", if nanos < 0 { "-" } else { "" }, size / NANOS, size % NANOS)
}
