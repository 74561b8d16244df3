//! Random numbers as pure functions of where they are used: no state, so any sample can be had in any order.

/// A well-mixed word from a seed and a counter (the finaliser of SplitMix64; Steele, Lea, Flood 2014).
pub fn word(seed: u64, index: u64) -> u64 {
    let mut z = seed.wrapping_mul(0xd134_2543_de82_ef95).wrapping_add(index.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    for _ in 0..2 {
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
    }
    z
}

/// Evenly in 0..1, the ends excluded.
pub fn uniform(seed: u64, index: u64) -> f64 {
    ((word(seed, index) >> 11) as f64 + 0.5) / (1u64 << 53) as f64
}

/// Normal with mean 0 and standard deviation 1 (Box and Muller 1958).
pub fn normal(seed: u64, index: u64) -> f64 {
    let radius = (-2.0 * uniform(seed, 2 * index).ln()).sqrt();
    radius * (std::f64::consts::TAU * uniform(seed, 2 * index + 1)).cos()
}

/// Three of them.
pub fn normal3(seed: u64, index: u64) -> nalgebra::Vector3<f64> {
    nalgebra::Vector3::from_fn(|axis, _| normal(seed, 3 * index + axis as u64))
}

/// Smooth noise in -1..1 from random values on the whole numbers (value noise, cubic blend).
pub fn lattice(seed: u64, at: [f64; 3]) -> f64 {
    let cell = at.map(f64::floor);
    let blend = [0, 1, 2].map(|axis| {
        let t = at[axis] - cell[axis];
        t * t * (3.0 - 2.0 * t)
    });
    let mut sum = 0.0;
    for corner in 0..8u64 {
        let mut weight = 1.0;
        let mut key = seed;
        for axis in 0..3 {
            let step = (corner >> axis) & 1;
            weight *= if step == 1 { blend[axis] } else { 1.0 - blend[axis] };
            key = word(key, (cell[axis] as i64).wrapping_add(step as i64) as u64);
        }
        sum += weight * (2.0 * uniform(key, 0) - 1.0);
    }
    sum
}
