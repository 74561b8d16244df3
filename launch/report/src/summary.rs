//! What is told of a run: plain numbers, as they stand in report.json.

use crate::{BorderError, Closed, ColourError, StatedError};
use geometry::Comparison;
use serde::{Deserialize, Serialize};

/// All that is told of a run. What is not known is empty or `None` and leaves no trace on the page.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Report {
    /// The heading of the page.
    pub title: String,
    /// How the run was made.
    pub run: Run,
    /// The machine that computed it.
    pub machine: Machine,
    /// How much of everything there was.
    pub counts: Counts,
    /// Wall times, in the order of the run.
    pub times: Vec<Time>,
    /// The nodes, in the order of the data.
    pub stages: Vec<Stage>,
    /// The surface against the truth, where it came to stand in the world.
    pub comparison: Option<Comparison>,
    /// The surface against the truth after it was laid onto it: what is left is its shape.
    pub aligned: Option<Aligned>,
    /// What closes the surface, where nobody saw anything: not part of the comparisons above.
    pub closed: Option<Closed>,
    /// What refinement has done.
    pub refinement: Option<Refined>,
    /// What the surface says of its own error, against the error that it has.
    pub stated: Option<StatedError>,
    /// The colours against the truth's albedo.
    pub colour: Option<ColourError>,
    /// Where the borders between colours lie, against the truth's.
    pub borders: Option<BorderError>,
    /// What failed, in sentences.
    pub failures: Vec<String>,
}

/// A comparison after a rigid motion of the model onto the truth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Aligned {
    /// How far the model's middle was moved.
    pub moved_mm: f64,
    /// By how much it was turned.
    pub turned_deg: f64,
    /// What is left.
    pub comparison: Comparison,
}

/// What refinement has done. Sigmas are one standard deviation.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Refined {
    /// The surface without it, laid onto the truth.
    pub without: Option<Aligned>,
    /// How far points stood off their common surface.
    pub residual_before_mm: f64,
    /// How far they do now.
    pub residual_after_mm: f64,
    /// The rig's pose offset was found so much too large, with its sigma.
    pub offset_error_ms: [f64; 2],
    /// Orientations were found so much older than the tracker says, with its sigma; that is 0 where nobody asked.
    pub rotation_lag_ms: [f64; 2],
    /// What the tracker's readings are like.
    pub tracker: TrackerNoise,
    /// False when the hand-eye transform was held fast.
    pub hand_eye_freed: bool,
    /// Correction of the hand-eye shift: its length.
    pub hand_eye_shift_mm: f64,
    /// How well that is known.
    pub hand_eye_shift_sigma_mm: f64,
    /// Correction of the hand-eye rotation: its angle.
    pub hand_eye_turn_deg: f64,
    /// How well that is known.
    pub hand_eye_turn_sigma_deg: f64,
    /// What the scan determines.
    pub observed: Option<Observed>,
    /// Median over the frames of what a pose's error moves their points along the ray.
    pub frame_sigma_mm: f64,
    /// Frames left out.
    pub frames_dropped: u64,
    /// Of these, so many because nothing else saw what they saw; the others fit nowhere.
    pub frames_unheld: u64,
    /// All frames in the order of their stamps: for the plot, too many for the JSON.
    #[serde(skip)]
    pub frames: Vec<FrameError>,
    /// What the operator should know.
    pub notices: Vec<String>,
}

/// The readings of a tracker, as they and the surface show them.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct TrackerNoise {
    /// White noise of a reading, along one axis: one standard deviation.
    pub position_mm: f64,
    /// The same about one axis.
    pub rotation_deg: f64,
    /// How large the fast correction is beside what white noise allows; above 0.55 the noise is not white. `None` when too little was seen to tell.
    pub excess: Option<f64>,
    /// The variance that a reading was given, in units of its white noise.
    pub inflation: f64,
}

/// What a scan determines, whatever its tracker.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Observed {
    /// The share of the surface on which stripes cross by 30 degrees or more, 0..1.
    pub crossing: f64,
    /// The direction of most stripes, in the world.
    pub stripes_along: [f64; 3],
    /// Of the six motions of a rigid piece against the surface, so many are held; 3 on a plane.
    pub held_directions: u32,
}

/// How well one laser-lit picture is known to stand where it does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameError {
    /// Since the first of them.
    pub at_s: f64,
    /// How far its pose's error moves its points: one standard deviation.
    pub sigma_mm: f64,
    /// Four in five of its points are closer to the common surface; `None` when it met none.
    pub residual_mm: Option<f64>,
    /// True for one that is not part of the model.
    pub left_out: bool,
}

/// How a run was made: enough to make it again.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Run {
    /// The file or name of what was scanned.
    pub object: String,
    /// The scene file.
    pub scene: String,
    /// The rig file.
    pub rig: String,
    /// The seed of everything random.
    pub seed: Option<u64>,
    /// "real" or "fast".
    pub pace: String,
    /// How long the hand swept, in the time of the scan.
    pub sweep_s: Option<f64>,
    /// The command line.
    pub command: String,
    /// Version of the program.
    pub version: String,
    /// When, as a person writes it.
    pub date: String,
}

/// The machine.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Machine {
    /// Its processor.
    pub processor: String,
    /// How many of them the program could use.
    pub cores: usize,
    /// Operating system and architecture.
    pub system: String,
}

/// How much of everything there was.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Counts {
    /// Pictures.
    pub frames: u64,
    /// Tracker readings.
    pub poses: u64,
    /// Measured points.
    pub points: u64,
    /// Points of the thinned cloud.
    pub cloud_points: u64,
    /// Triangles of the surface.
    pub triangles: u64,
    /// Texture cells that were seen.
    pub texture_cells: u64,
    /// Area of the surface.
    pub area_mm2: f64,
}

/// A part of the run and how long it took.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Time {
    /// What took it.
    pub what: String,
    /// On the wall's clock.
    pub seconds: f64,
}

/// What one node did. Times are seconds unless the name says otherwise.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Stage {
    /// kind/instance.
    pub node: String,
    /// Messages taken in, on all inputs.
    pub received: u64,
    /// Messages sent.
    pub published: u64,
    /// Messages sent a second while it worked.
    pub rate_hz: Option<f64>,
    /// Wall time spent on messages.
    pub busy_s: f64,
    /// Processor time.
    pub cpu_s: f64,
    /// Median of the time from a measurement's stamp to its result on the bus, over all results.
    pub latency_p50_ms: Option<f64>,
    /// 99th percentile of the same.
    pub latency_p99_ms: Option<f64>,
    /// Messages that never came.
    pub lost: u64,
    /// What it refused.
    pub refused: Vec<Refused>,
}

/// How many items a node refused for one reason.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Refused {
    /// Why.
    pub reason: String,
    /// How many.
    pub count: u64,
}

impl Report {
    /// How good the shape is: laid onto the truth when that was done, else as it stands.
    pub fn shape(&self) -> Option<&Comparison> {
        self.aligned.as_ref().map(|aligned| &aligned.comparison).or(self.comparison.as_ref())
    }

    /// Messages lost on the whole way. Must be 0.
    pub fn lost(&self) -> u64 {
        self.stages.iter().map(|stage| stage.lost).sum()
    }

    /// True when nothing failed and nothing was lost.
    pub fn is_good(&self) -> bool {
        self.failures.is_empty() && self.lost() == 0
    }
}

impl Machine {
    /// The machine that this runs on; what the system does not tell is left empty.
    pub fn here() -> Self {
        let processors = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let model = processors.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
        Self {
            processor: model.map(|(_, name)| name.trim().to_owned()).unwrap_or_default(),
            cores: std::thread::available_parallelism().map_or(0, std::num::NonZero::get),
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
        }
    }
}
