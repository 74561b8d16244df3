//! What a refinement can say of itself.

use serde::Serialize;

/// Of one revision. Lengths in millimetres, angles in degrees, times in milliseconds, because people read it; sigmas are
/// one standard deviation.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Evidence {
    /// How well the points fit their common surface, before and after.
    pub residual: Residual,
    /// What the tracker's readings are like.
    pub tracker: TrackerEvidence,
    /// How the tracker's clock stands against the camera's.
    pub clock: ClockEvidence,
    /// The camera on the handset.
    pub hand_eye: HandEyeEvidence,
    /// What the scan could determine; `None` in live revisions until enough was seen.
    pub observed: Option<Observed>,
    /// What was noticed on the way, in the order of its weight.
    pub notices: Vec<Notice>,
    /// Frames that are given out.
    pub frames_kept: usize,
    /// Frames that fit nowhere.
    pub dropped: Vec<DroppedFrame>,
    /// Frames with points that got no pose, because the tracker was silent.
    pub frames_without_pose: usize,
    /// What was refused on the way in.
    pub refused: Vec<RefusedInput>,
    /// Points left out because other strokes looked through where they hang; 0 in live revisions.
    pub seen_through: usize,
    /// Frames that saw the flat table on which the thing stands, and agree by it; 0 without one, and in live revisions.
    pub frames_on_table: usize,
    /// Each frame that was kept.
    pub frames: Vec<FrameEvidence>,
}

impl Evidence {
    /// The stamp of the last frame that it tells of, kept or left out.
    pub fn last_frame_nanos(&self) -> Option<i64> {
        let kept = self.frames.last().map(|frame| frame.stamp_nanos);
        kept.max(self.dropped.last().map(|frame| frame.stamp_nanos))
    }
}

/// 1.4826 times the median distance of points from the quadrics through their neighbourhoods.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Residual {
    /// With the smoothed tracker alone.
    pub before_mm: f64,
    /// With the refined way.
    pub after_mm: f64,
}

/// The tracker, as its own readings and the surface show it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TrackerEvidence {
    /// White noise of a reading, along one axis.
    pub white_position_mm: f64,
    /// White noise of a reading, about one axis.
    pub white_rotation_deg: f64,
    /// How large the fast correction is beside what white noise allows; above 0.55 the noise is not white. `None` when the
    /// scan holds too little to tell.
    pub excess: Option<f64>,
    /// The tracker's readings were believed so many times less than their white noise allows.
    pub inflation: f64,
}

/// The clock offset.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ClockEvidence {
    /// To be subtracted from the rig's pose offset: the smoothed tracker was read so much later.
    pub tau_ms: f64,
    /// One standard deviation of it; `None` in live revisions.
    pub sigma_ms: Option<f64>,
    /// Orientations are older than the tracker says, apart from that offset; 0 where it was not asked for.
    pub rotation_lag_ms: f64,
    /// One standard deviation of it; `None` where it was not asked for.
    pub rotation_lag_sigma_ms: Option<f64>,
}

/// The correction of the hand-eye transform, in the frame of the body. It takes up whatever is constant on the handset, so it
/// makes the scan better without being a calibration.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct HandEyeEvidence {
    /// False when it was held fast.
    pub freed: bool,
    /// Along the axes of the body.
    pub shift_mm: [f64; 3],
    /// About the axes of the body.
    pub turn_deg: [f64; 3],
    /// One standard deviation of the shift, where shift and turn have traded.
    pub shift_sigma_mm: [f64; 3],
    /// One standard deviation of the turn.
    pub turn_sigma_deg: [f64; 3],
}

/// What the scan determines.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Observed {
    /// The share of the surface on which stripes cross by 30 degrees or more.
    pub crossing: f64,
    /// Along most stripes, in the world.
    pub stripes_along: [f64; 3],
    /// Of six motions of a rigid piece against the surface, so many are held; 3 on a plane.
    pub held_directions: usize,
}

/// A frame that is left out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DroppedFrame {
    /// Its stamp.
    pub stamp_nanos: i64,
    /// Why.
    pub reason: DropReason,
    /// Four in five of its points were closer to the surface; `None` when it met none at all.
    pub residual_mm: Option<f64>,
    /// How far its pose's error moves its points across the surface: one standard deviation.
    pub sigma_mm: f64,
}

/// Why a frame is left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum DropReason {
    /// Its points stand off the surface that all others agree on.
    FitsNowhere,
    /// Nothing else saw what it saw, so nothing says where it was.
    Unheld,
}

/// So many of one kind were refused.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct RefusedInput {
    /// Why.
    pub reason: String,
    /// How many.
    pub count: u64,
}

/// A frame that was kept.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FrameEvidence {
    /// Its stamp.
    pub stamp_nanos: i64,
    /// Four in five of its points are closer to the surface; `None` when no other frame saw it.
    pub residual_mm: Option<f64>,
    /// How far its pose's error moves its points across the surface: one standard deviation.
    pub sigma_mm: f64,
    /// How much of it lies on surface that other strokes saw, about 0 to 1.
    pub held: f64,
}

/// Something the operator should know.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Notice {
    /// Stripes hardly cross: the hand-eye transform was held fast, and sliding along the stripes is not held.
    StrokesDoNotCross {
        /// The share of the surface on which they cross.
        crossing: f64,
        /// What to do.
        advice: String,
    },
    /// The tracker's errors last longer than its noise: its readings were believed less.
    ColouredNoise {
        /// See [`TrackerEvidence::excess`].
        excess: f64,
    },
    /// The surface does not hold all motions.
    SurfaceHoldsLittle {
        /// Of six.
        held_directions: usize,
        /// What to do.
        advice: String,
    },
    /// What was seen before a moment and behind it does not fit together.
    ThingMoved {
        /// The moment.
        stamp_nanos: i64,
        /// How far they stand apart.
        apart_mm: f64,
    },
    /// A step made things worse and was taken back.
    StepTakenBack,
    /// Refinement made nothing better: the smoothed tracker is what is given out.
    KeptSmoothed,
    /// Too little was seen twice to refine anything: the smoothed tracker is what is given out.
    NothingSeenTwice,
    /// The estimated hand-eye correction left three standard deviations of what is believed, so it was held fast.
    HandEyeRanAway {
        /// Along the axes of the body.
        shift_mm: [f64; 3],
        /// About the axes of the body.
        turn_deg: [f64; 3],
    },
}
