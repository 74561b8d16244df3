//! A line goes on from row to row; a grain of noise or of texture does not.

use crate::lateral::LinePeak;

/// So many lines (rows or columns) before and after a peak are asked.
pub(crate) const REACH: usize = 4;

/// For each peak, in how many of the lines around it another one lies where a stripe that steps aside by no more than
/// `link_px` a line could have left it. `peaks` are sorted by line and position.
pub(crate) fn count(peaks: &[LinePeak], link_px: f32, support: &mut Vec<u8>) {
    support.clear();
    support.resize(peaks.len(), 0);
    let reach = REACH as i64;
    for apart in (-reach..=reach).filter(|apart| *apart != 0) {
        let gap = link_px * apart.abs() as f32;
        // The first that is not before the place asked about; both only go forwards.
        let mut near = 0;
        for (support, LinePeak { line, peak, .. }) in support.iter_mut().zip(peaks) {
            let line = i64::from(*line) + apart;
            let before = |p: &LinePeak| match i64::from(p.line) {
                there if there == line => p.peak.position < peak.position - gap,
                there => there < line,
            };
            near += peaks[near..].iter().take_while(|p| before(p)).count();
            let found = |p: &LinePeak| i64::from(p.line) == line && p.peak.position <= peak.position + gap;
            *support += u8::from(peaks.get(near).is_some_and(found));
        }
    }
}
