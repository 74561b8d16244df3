//! Who feeds whom.

use crate::plan::Plan;
use crate::planned::PlannedNode;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use wire::topic;

/// True when a key matches an expression: `*` is one chunk, `**` any number; neither sees a chunk that begins with `@`.
pub fn matches(expression: &str, key: &str) -> bool {
    fn rest(expression: &[&str], key: &[&str]) -> bool {
        match (expression.split_first(), key.split_first()) {
            (None, None) => true,
            (Some((&"**", below)), None) => rest(below, key),
            (Some((&"**", below)), Some((chunk, after))) => {
                rest(below, key) || (!chunk.starts_with('@') && rest(expression, after))
            }
            (Some((&"*", below)), Some((chunk, after))) => !chunk.starts_with('@') && rest(below, after),
            (Some((word, below)), Some((chunk, after))) => word == chunk && rest(below, after),
            _ => false,
        }
    }
    rest(&expression.split('/').collect::<Vec<_>>(), &key.split('/').collect::<Vec<_>>())
}

/// The nodes that a topic reaches.
pub fn readers<'a>(nodes: &'a [PlannedNode], key: &str) -> Vec<&'a PlannedNode> {
    nodes.iter().filter(|node| node.takes.iter().any(|taken| matches(taken, key))).collect()
}

/// What the launcher itself publishes.
pub fn launcher_gives(plan: &Plan) -> Vec<String> {
    let calibration = plan.rig_file.is_some().then(|| topic::calibration(&plan.rig_instance).key);
    [topic::run_phase().key].into_iter().chain(calibration).collect()
}

/// The nodes behind a source, near and far, whose progress it waits for when it is not bound to real time.
pub fn consumers(nodes: &[PlannedNode], source: &PlannedNode) -> Vec<String> {
    let mut reached = BTreeSet::from([source.address()]);
    let mut open = vec![source];
    while let Some(node) = open.pop() {
        for reader in node.gives.iter().flat_map(|key| readers(nodes, key)) {
            if reached.insert(reader.address()) {
                open.push(reader);
            }
        }
    }
    nodes
        .iter()
        .filter(|node| node.paces && !node.source && reached.contains(&node.address()))
        .map(PlannedNode::address)
        .collect()
}

/// Topics that somebody takes and nobody gives.
pub fn warnings(plan: &Plan) -> Vec<String> {
    let launcher = launcher_gives(plan);
    let given =
        |taken: &str| plan.nodes.iter().flat_map(|node| &node.gives).chain(&launcher).any(|k| matches(taken, k));
    plan.nodes
        .iter()
        .flat_map(|node| node.takes.iter().map(move |key| (node, key)))
        .filter(|(_, key)| !key.contains('*') && !given(key))
        .map(|(node, key)| format!("{} takes {key}, which no node of this rig gives", node.name))
        .collect()
}

/// As text: each node, and below it each topic that it gives, with who takes it.
pub fn text(plan: &Plan) -> String {
    let mut text = String::from("limn (the launcher)\n");
    let gives = |text: &mut String, key: &str| {
        let names: Vec<&str> = readers(&plan.nodes, key).iter().map(|reader| reader.name.as_str()).collect();
        let names = if names.is_empty() { "nobody".to_owned() } else { names.join(", ") };
        let _ = writeln!(text, "    {key} -> {names}");
    };
    launcher_gives(plan).iter().for_each(|key| gives(&mut text, key));
    for node in in_flow_order(&plan.nodes) {
        let place = node.machine.as_ref().map_or(String::new(), |machine| format!(" on {machine}"));
        let source = if node.source { ", a source" } else { "" };
        let _ = writeln!(text, "{} ({}{source}){place}", node.name, node.address());
        node.gives.iter().for_each(|key| gives(&mut text, key));
    }
    text
}

/// For Graphviz: `limn graph FILE --dot | dot -Tsvg`.
pub fn dot(plan: &Plan) -> String {
    let mut text = String::from("digraph limn {\n  rankdir = LR;\n  node [shape = box];\n");
    for node in &plan.nodes {
        let style = if node.source { ", style = bold" } else { "" };
        let _ =
            writeln!(text, "  {:?} [label = {:?}{style}];", node.name, format!("{}\n{}", node.name, node.address()));
    }
    for node in &plan.nodes {
        for key in &node.gives {
            for reader in readers(&plan.nodes, key).iter().filter(|reader| reader.name != node.name) {
                let _ = writeln!(text, "  {:?} -> {:?} [label = {key:?}];", node.name, reader.name);
            }
        }
    }
    text.push_str("}\n");
    text
}

/// Each node behind those that feed it, as far as there are no circles.
pub fn in_flow_order(nodes: &[PlannedNode]) -> Vec<&PlannedNode> {
    let feeds = |feeder: &PlannedNode, node: &PlannedNode| {
        feeder.name != node.name && feeder.gives.iter().any(|key| node.takes.iter().any(|taken| matches(taken, key)))
    };
    let mut waiting: Vec<&PlannedNode> = nodes.iter().collect();
    let mut ordered = Vec::new();
    while !waiting.is_empty() {
        let free = |node: &&PlannedNode| !waiting.iter().any(|feeder| feeds(feeder, node));
        let next = waiting.iter().position(free).or(waiting.iter().position(|node| node.source));
        ordered.push(waiting.remove(next.unwrap_or(0)));
    }
    ordered
}
