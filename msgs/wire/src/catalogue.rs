//! All messages, told in words: what stands in a recording beside the bytes.

use crate::codec::schema;
use crate::{
    Calibration, Cloud, Frame, Health, LogLine, Mesh, Message, Model, Pose, Profile, Progress, RunPhase, Scan, Stripe,
    Trajectory,
};
use std::collections::BTreeMap;

/// The fields of a message and of all that it is made of.
pub fn layout_text<M: Message>() -> String {
    let mut known = BTreeMap::new();
    let name = M::describe(&mut known);
    let first = known.remove(&name).unwrap_or_default();
    let others: String = known.into_values().collect();
    format!(
        "// bincode 2, standard configuration: integers are variable-length, little-endian, signed ones zigzag.\n\
         // Bulk<T> is a count and then the plain little-endian values, packed as in C.\n{first}{others}"
    )
}

/// Schema and layout of every message of this version.
pub fn catalogue() -> BTreeMap<String, String> {
    macro_rules! entries {
        ($($message:ty),* $(,)?) => { BTreeMap::from([$((schema::<$message>(), layout_text::<$message>())),*]) };
    }
    entries!(
        Calibration,
        Cloud,
        Frame,
        Health,
        LogLine,
        Mesh,
        Model,
        Pose,
        Profile,
        Progress,
        RunPhase,
        Scan,
        Stripe,
        Trajectory,
    )
}
