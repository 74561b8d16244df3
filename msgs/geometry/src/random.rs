//! Random numbers as pure functions of where they are used, so that no thread's order counts.

/// A well-mixed word (the finaliser of SplitMix64; Steele, Lea, Flood 2014), which can be entered anywhere.
pub fn word(seed: u64, index: u64) -> u64 {
    let mut z = seed.wrapping_add(index.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Evenly in 0..1.
pub fn uniform(seed: u64, index: u64) -> f64 {
    (word(seed, index) >> 11) as f64 / (1u64 << 53) as f64
}

/// 1 or -1, evenly.
pub fn sign(seed: u64, index: u64) -> f64 {
    if word(seed, index) & 1 == 0 { 1.0 } else { -1.0 }
}
