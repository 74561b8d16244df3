//! The filters of a bird, and how much older they make what it measures.

use super::Config;

impl Config {
    /// Data of parameter 4: filters that are off.
    pub(crate) fn filters_off(&self) -> u16 {
        u16::from(!self.ac_narrow_filter) << 2 | u16::from(!self.ac_wide_filter) << 1 | u16::from(!self.dc_filter)
    }

    /// Name, parameter and data of the tables of the adaptive filter that are to be changed.
    pub(crate) fn filter_tables(&self) -> Vec<(&'static str, u8, [u16; 7])> {
        let gains = |table: [f64; 7]| table.map(|gain| (gain * 32768.0).round() as u16);
        let least = self.dc_alpha_min.map(|table| ("dc_alpha_min", 5, gains(table)));
        let motion = self.dc_motion.map(|table| ("dc_motion", 12, table));
        let most = self.dc_alpha_max.map(|table| ("dc_alpha_max", 13, gains(table)));
        [least, motion, most].into_iter().flatten().collect()
    }

    /// How old position and rotation are when their record leaves, in nanoseconds.
    pub fn latencies_nanos(&self) -> (i64, i64) {
        const WIDE_CYCLES: f64 = 2.5;
        const NARROW_CYCLES: f64 = 0.5;
        let wide = if self.ac_wide_filter { WIDE_CYCLES } else { 0.0 };
        let narrow = if self.ac_narrow_filter { NARROW_CYCLES } else { 0.0 };
        let filters_ms = (wide + narrow) * 1e3 / self.rate_hz;
        let nanos = |latency_ms: Option<f64>, unfiltered_ms| {
            (latency_ms.unwrap_or(unfiltered_ms + filters_ms) * 1e6).round() as i64
        };
        (nanos(self.position_latency_ms, 7.5), nanos(self.rotation_latency_ms, 2.0))
    }
}
