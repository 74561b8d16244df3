//! Which cameras and serial ports there are, and what keeps this user from them: what `limn devices` prints.
//!
//! In: the names under `/dev` and what the kernel tells of them under `/sys`. Nothing is opened: opening a serial port
//! moves its modem lines, which resets an Arduino, or a Flock of Birds. What a camera can do is asked by whoever may open
//! cameras (`camera_v4l::inspect`) and comes in through a function. Out: plain data, and the page that shows it.
//!
//! Each device has a name that stays the same when it is plugged in again (`/dev/v4l/by-id`, `/dev/serial/by-id`), where
//! the system gives one: that is the name for a launch file.
//!
//! ```
//! let folder = std::env::temp_dir().join("a machine without devices");
//! let listing = devices::list(&folder, devices::not_built_in);
//! assert!(listing.to_string().starts_with("No camera."));
//! ```

mod access;
mod camera;
mod listing;
mod page;
mod port;

pub use access::{Facts, advice, facts, missing};
pub use camera::{Camera, Control, Details, Mode, Size, control_key};
pub use listing::{Listing, list, not_built_in};
pub use port::Port;
