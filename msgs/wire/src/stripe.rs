//! The laser line found in a picture (paper, section 2.2: image points).

use crate::layout::{element, layout, message};
use crate::{Bulk, Header, Light, Refusal};

element! {
    /// One subpixel peak of the laser line in one row or column.
    pub struct StripePeak {
        /// To the right.
        pub u_px: f32,
        /// Down.
        pub v_px: f32,
        /// One standard deviation across the line.
        pub sigma_px: f32,
        /// Height above the background, in grey levels of the laser channel.
        pub amplitude: f32,
        /// Standard deviation of the line's profile.
        pub width_px: f32,
        /// [`StripePeak::BEST`] | [`StripePeak::SATURATED`].
        pub flags: u32,
    }
}

impl StripePeak {
    /// The chosen one of its row or column.
    pub const BEST: u32 = 1;
    /// Its top is clipped; the sigma says what that costs.
    pub const SATURATED: u32 = 2;

    /// True for the chosen peak of its row or column.
    pub fn is_best(&self) -> bool {
        self.flags & Self::BEST != 0
    }
}

layout! {
    /// All peaks of one picture, row by row (or column by column), and along each from small to large.
    pub struct Stripe {
        /// The stamp is the frame's.
        pub header: Header,
        /// Pixels in a row of the picture.
        pub width: u32,
        /// Rows of the picture.
        pub height: u32,
        /// What lit the picture; without the laser there are no peaks.
        pub light: Light,
        /// The peaks.
        pub peaks: Bulk<StripePeak>,
        /// What looked like a peak and was not taken.
        pub refused: Vec<Refusal>,
    }
}
message!(Stripe @ 1);
