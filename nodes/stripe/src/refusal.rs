//! What looked like a peak and was not taken, counted by reason.

use wire::Refusal;

/// Why a peak was not taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Reason {
    /// Its background lies outside the picture.
    Edge,
    /// Too wide: a lit area.
    Wide,
    /// Too narrow: a hot pixel.
    Narrow,
    /// Too low once the background is known.
    Faint,
    /// No maximum of the shape of a line.
    Shapeless,
    /// More peaks in the line than may be kept.
    Crowded,
    /// Too few of the lines around it hold the line, too.
    Alone,
}

const ALL: [(Reason, &str); 7] = [
    (Reason::Edge, "peak at the edge of the picture"),
    (Reason::Wide, "peak wider than a laser line"),
    (Reason::Narrow, "peak narrower than a laser line"),
    (Reason::Faint, "peak too faint above its background"),
    (Reason::Shapeless, "peak without the shape of a line"),
    (Reason::Crowded, "more peaks in a line than are kept"),
    (Reason::Alone, "peak that no line goes on from"),
];

/// Counts since the frame began.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Refusals([u64; ALL.len()]);

impl Refusals {
    pub(crate) fn count(&mut self, reason: Reason) {
        self.0[reason as usize] += 1;
    }

    /// As they travel: the reasons that occurred, always in the same order.
    pub(crate) fn to_wire(self) -> Vec<Refusal> {
        ALL.iter()
            .map(|&(reason, text)| Refusal { reason: text.to_owned(), count: self.0[reason as usize] })
            .filter(|refusal| refusal.count > 0)
            .collect()
    }
}
