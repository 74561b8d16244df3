//! The parts of a run, one behind the other, as the bar in the terminal and the table of times tell them.

use crate::plan::Plan;

/// From the end of the part before it to that of a node's work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// For people.
    pub name: &'static str,
    /// The node that it ends with.
    kind: &'static str,
}

/// In the order of the data. The hand rests when the last picture is in its place.
const ALL: [Part; 6] = [
    Part { name: "sweep", kind: "register" },
    Part { name: "refinement", kind: "refine" },
    Part { name: "cloud", kind: "cluster" },
    Part { name: "surface", kind: "surface" },
    Part { name: "colour", kind: "paint" },
    Part { name: "files", kind: "export" },
];

impl Part {
    /// Whether it ends with this node (kind/instance).
    pub fn ends_with(&self, node: &str) -> bool {
        node.split('/').next() == Some(self.kind)
    }
}

/// Those that a plan has.
pub fn of(plan: &Plan) -> impl Iterator<Item = Part> + '_ {
    ALL.into_iter().filter(|part| plan.nodes.iter().any(|node| node.kind == part.kind))
}

/// All that there may be.
pub fn all() -> impl Iterator<Item = Part> {
    ALL.into_iter()
}
