//! The page that proves the result: what came out beside what is true, how far apart they are, and what it took.
//!
//! **In**: a [`Report`] of plain numbers, and the surfaces as [`Exhibits`]. **Out**: report.json
//! ([`Report::write_json`]) and report.html ([`Report::write_html`]), one file that needs no network: pictures from four
//! sides, the error as colours on the model, its histogram, tables of times, losses and refusals.
//!
//! The numbers come from [`geometry::compare`] (shape), [`colour_error`] (colours), [`border_error`] (their borders) and
//! [`seen_mask`] (what of the truth the camera could see at all). Lengths are metres, world frame, z up; millimetres on the
//! page. A scan whose truth nobody knows is told by what it says of itself: residuals, sigmas, what it determines. The same
//! input gives the same bytes.
//!
//! ```
//! use report::{Exhibits, Report};
//! let folder = tempfile::tempdir().unwrap();
//! let report = Report { title: "A scan of nothing".into(), ..Report::default() };
//! report.write_json(&folder.path().join("report.json")).unwrap();
//! report.write_html(&folder.path().join("report.html"), &Exhibits::default()).unwrap();
//! let page = std::fs::read_to_string(folder.path().join("report.html")).unwrap();
//! assert!(page.contains("<h1>A scan of nothing</h1>"));
//! ```

mod albedo;
mod border;
mod closed;
mod colour;
mod data_uri;
mod error_map;
mod page;
mod render;
mod seen;
mod stated;
mod summary;
mod view;
mod write;

pub use albedo::{albedo, painted};
pub use border::{BorderError, border_error};
pub use closed::{Closed, caps, closed};
pub use colour::{ColourError, ColourErrorReason, colour_error};
pub use render::render;
pub use seen::{Gate, seen_mask};
pub use stated::{StatedError, stated_error};
pub use summary::{
    Aligned, Counts, FrameError, Machine, Observed, Refined, Refused, Report, Run, Stage, Time, TrackerNoise,
};
pub use view::{View, four_views, four_views_from_below};
pub use write::{Exhibits, PageError};
