//! Brightness and two differences of colour, made into red, green and blue: the one place that knows how.

/// Weights of red and blue in the brightness (ITU-R BT.601).
const RED: f32 = 0.299;
const BLUE: f32 = 0.114;
const GREEN: f32 = 1.0 - RED - BLUE;
/// Cb and Cr of all that is grey.
const NO_COLOUR: f32 = 128.0;
const WHITE: f32 = 255.0;

/// What bytes of Y, Cb and Cr stand for: BT.601, over one of its two ranges of levels.
///
/// ```
/// use wire::YCbCr;
/// assert_eq!(YCbCr::LIMITED.rgb8([235, 128, 128]), [255; 3]);
/// assert_eq!(YCbCr::FULL.rgb8([235, 128, 128]), [235; 3]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct YCbCr {
    black: f32,
    slopes: [[f32; 3]; 3],
}

impl YCbCr {
    /// Y from 16 to 235, Cb and Cr from 16 to 240: what V4L2 means by Y'CbCr unless a driver says otherwise.
    pub const LIMITED: Self = Self::over(16.0, 235.0 - 16.0, 240.0 - 16.0);
    /// All three from 0 to 255, as in a JPEG (JFIF).
    pub const FULL: Self = Self::over(0.0, WHITE, WHITE);

    const fn over(black: f32, luma_levels: f32, chroma_levels: f32) -> Self {
        let (y, c) = (WHITE / luma_levels, WHITE / chroma_levels);
        let (cr, cb) = (2.0 * (1.0 - RED) * c, 2.0 * (1.0 - BLUE) * c);
        Self { black, slopes: [[y, 0.0, cr], [y, -cb * BLUE / GREEN, -cr * RED / GREEN], [y, cb, 0.0]] }
    }

    /// By how many grey levels red, green and blue (the rows) rise with each level of Y, Cb and Cr (the columns).
    pub const fn slopes(&self) -> [[f32; 3]; 3] {
        self.slopes
    }

    /// Red, green and blue in grey levels, 0 to 255; what no light can be is clipped.
    #[inline]
    pub fn rgb(&self, ycbcr: [u8; 3]) -> [f32; 3] {
        let [y, cb, cr] = ycbcr.map(f32::from);
        let from_black = [y - self.black, cb - NO_COLOUR, cr - NO_COLOUR];
        self.slopes.map(|[a, b, c]| (a * from_black[0] + b * from_black[1] + c * from_black[2]).clamp(0.0, WHITE))
    }

    /// The same in whole grey levels.
    #[inline]
    pub fn rgb8(&self, ycbcr: [u8; 3]) -> [u8; 3] {
        // None is negative, so this is the nearest.
        self.rgb(ycbcr).map(|level| (level + 0.5) as u8)
    }
}
