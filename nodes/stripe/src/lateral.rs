//! Along the stripe: peaks of neighbouring lines that follow one another are averaged by a short straight fit. Against
//! speckle only this helps, because speckle errs by whole widths of the line (Dorsch, Haeusler and Herrmann 1994).

use crate::measure::Peak;
use crate::scatter;
use std::ops::Range;

/// A peak with the line (row or column) that it stands in.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LinePeak {
    pub line: u32,
    pub best: bool,
    pub peak: Peak,
}

/// A neighbour may depart from the fit by so many of its standard deviations; a corner of the surface departs by more.
const DEPARTURE: f32 = 3.5;
/// Speckle spans about three lines, so an average of many has about three times the variance of independent ones. Used
/// where the stripe is too short to show it.
const SPECKLE_LINES: f32 = 3.0;

/// One link of a chain.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Link {
    /// Which peak.
    peak: u32,
    pub position: f32,
    pub noise_variance: f32,
    pub speckle_variance: f32,
}

/// Buffers, kept from frame to frame.
#[derive(Debug, Default)]
pub(crate) struct Lateral {
    next: Vec<u32>,
    follows: Vec<bool>,
    links: Vec<Link>,
    smooth: Vec<Link>,
    chains: Vec<Range<usize>>,
    scatter: Vec<[f32; 3]>,
}

/// How the averaging is done.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Averaging {
    /// Neighbours on either side.
    pub lines: usize,
    /// Largest step from line to line.
    pub link_px: f32,
    /// Contrast of the speckle where nothing better is known.
    pub contrast: f32,
}

const NONE: u32 = u32::MAX;

impl Lateral {
    /// Replaces each peak's position by its average, and its two variances by the one of that average, all in
    /// `noise_variance`; `peaks` are sorted by line.
    pub(crate) fn average(&mut self, peaks: &mut [LinePeak], averaging: Averaging) {
        self.link(peaks, averaging.link_px);
        self.chain(peaks);
        let raw = scatter::contrast_squared(&self.links, &self.chains, 4, &mut self.scatter)
            .unwrap_or(averaging.contrast * averaging.contrast);
        self.smooth.clear();
        for chain in &self.chains {
            let links = &self.links[chain.clone()];
            self.smooth.extend((0..links.len()).map(|at| fit(links, at, averaging.lines, raw)));
        }
        let lines = 2 * averaging.lines + 1;
        // Averages that share no pixel and no speckle.
        let apart = lines + 3;
        let averaged = if averaging.lines == 0 {
            raw
        } else {
            scatter::contrast_squared(&self.smooth, &self.chains, apart, &mut self.scatter)
                .map_or(SPECKLE_LINES * raw, |seen| seen.min(raw * lines as f32))
        };
        for link in &self.smooth {
            let peak = &mut peaks[link.peak as usize].peak;
            peak.position = link.position;
            peak.noise_variance = link.noise_variance + averaged * link.speckle_variance;
            peak.speckle_variance = 0.0;
        }
    }

    /// Each peak's successor in the next line: the nearest, if each is the other's nearest.
    fn link(&mut self, peaks: &[LinePeak], link_px: f32) {
        self.next.clear();
        self.next.resize(peaks.len(), NONE);
        self.follows.clear();
        self.follows.resize(peaks.len(), false);
        let nearest = |of: usize, among: Range<usize>| {
            let gap = |i: usize| (peaks[i].peak.position - peaks[of].peak.position).abs();
            among.map(|i| (gap(i), i)).filter(|(gap, _)| *gap <= link_px).min_by(|a, b| a.0.total_cmp(&b.0))
        };
        let mut here = 0..0;
        while here.end < peaks.len() {
            let there = line_from(peaks, here.end);
            if !here.is_empty() && peaks[there.start].line == peaks[here.start].line + 1 {
                for i in here.clone() {
                    if let Some((_, j)) = nearest(i, there.clone())
                        && nearest(j, here.clone()).is_some_and(|(_, back)| back == i)
                    {
                        self.next[i] = j as u32;
                        self.follows[j] = true;
                    }
                }
            }
            here = there;
        }
    }

    /// Lays the links of each chain side by side.
    fn chain(&mut self, peaks: &[LinePeak]) {
        self.links.clear();
        self.chains.clear();
        for first in 0..peaks.len() {
            if self.follows[first] {
                continue;
            }
            let start = self.links.len();
            let mut at = first as u32;
            while let Some(LinePeak { peak, .. }) = peaks.get(at as usize) {
                let Peak { position, noise_variance, speckle_variance, .. } = *peak;
                self.links.push(Link { peak: at, position, noise_variance, speckle_variance });
                at = self.next[at as usize];
            }
            self.chains.push(start..self.links.len());
        }
    }
}

/// The peaks of the line that begins at `start`.
fn line_from(peaks: &[LinePeak], start: usize) -> Range<usize> {
    let count = peaks[start..].iter().take_while(|p| p.line == peaks[start].line).count();
    start..start + count
}

/// The value at `at` of the straight line through it and its neighbours, over the widest span that is straight.
fn fit(links: &[Link], at: usize, lines: usize, contrast_squared: f32) -> Link {
    let mut half = lines;
    while half > 0 {
        let from = at.saturating_sub(half);
        let to = (at + half + 1).min(links.len());
        if let Some(link) = straight(&links[from..to], at - from, contrast_squared) {
            return link;
        }
        half /= 2;
    }
    links[at]
}

/// Least squares, weighted by the variances; `None` when a neighbour departs by more than its noise allows.
fn straight(links: &[Link], at: usize, contrast_squared: f32) -> Option<Link> {
    if links.len() < 3 {
        return None;
    }
    let weight = |l: &Link| 1.0 / (l.noise_variance + contrast_squared * l.speckle_variance);
    let place = |i: usize| i as f32 - at as f32;
    let centre = links[at].position;
    let (mut s0, mut s1, mut s2, mut x0, mut x1) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (i, link) in links.iter().enumerate() {
        let (w, t, x) = (weight(link), place(i), link.position - centre);
        s0 += w;
        s1 += w * t;
        s2 += w * t * t;
        x0 += w * x;
        x1 += w * t * x;
    }
    let determinant = s0 * s2 - s1 * s1;
    let value = (s2 * x0 - s1 * x1) / determinant;
    let slope = (s0 * x1 - s1 * x0) / determinant;
    let (mut noise_variance, mut speckle_variance) = (0.0, 0.0);
    for (i, link) in links.iter().enumerate() {
        let (w, t) = (weight(link), place(i));
        let departure = link.position - centre - value - slope * t;
        if departure * departure * w > DEPARTURE * DEPARTURE {
            return None;
        }
        let share = w * (s2 - s1 * t) / determinant;
        noise_variance += share * share * link.noise_variance;
        speckle_variance += share * share * link.speckle_variance;
    }
    Some(Link { peak: links[at].peak, position: centre + value, noise_variance, speckle_variance })
}
