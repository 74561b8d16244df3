//! Display values and light (IEC 61966-2-1): pictures store the former, glTF's factors are the latter.

/// Light, 0..1, of a stored byte.
pub(super) fn linear(byte: u8) -> f32 {
    let value = f32::from(byte) / 255.0;
    if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// The stored byte of light; beyond 0..1 it is clipped, and what is no number is 0.
pub(super) fn byte(light: f32) -> u8 {
    let value = if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
    (value * 255.0).round() as u8
}

/// One colour seen under another: the product of their light.
pub(super) fn product(a: [u8; 3], b: [u8; 3]) -> [u8; 3] {
    std::array::from_fn(|c| byte(linear(a[c]) * linear(b[c])))
}
