//! A bird whose switch 8 stands at test (manual, pages 19-21): it says things of its own, or plays with what it hears.

use super::commands::EXAMINE;

/// Fewer bytes that count up may be an accident.
const LEAST_COUNT: usize = 4;

/// Whether this is what a bird in one of its test modes says: `OK` twice a second; what it was told, of which a question is
/// known; or the numbers from 0 to 255, one or all of them for each byte that it hears.
///
/// ```
/// use tracker_flock::protocol::test_mode::is_test_mode;
/// assert!(is_test_mode(b"OK\r\n"));
/// assert!(is_test_mode(&[b'O', 0, b'O', 15]), "the questions come back");
/// assert!(is_test_mode(&[254, 255, 0, 1]));
/// assert!(!is_test_mode(&[0x78, 0x00, 0x60, 0x1E]));
/// ```
pub fn is_test_mode(heard: &[u8]) -> bool {
    let says_ok = heard.windows(2).any(|two| two == b"OK");
    let echoes = heard.len() >= 2 && heard.chunks(2).all(|two| matches!(two, [EXAMINE, 0..=50]));
    let counts = heard.len() >= LEAST_COUNT && heard.windows(2).all(|two| two[1] == two[0].wrapping_add(1));
    says_ok || echoes || counts
}
