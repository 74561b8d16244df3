//! What one scan brought.

use std::collections::BTreeMap;
use std::time::Instant;
use wire::{Health, InputHealth, Mesh, Model, Refinement, Scan, TrajectorySample};

/// Gathered from the bus.
#[derive(Default)]
pub struct Harvest {
    /// The last account of every node's present process.
    healths: BTreeMap<String, Health>,
    /// The accounts of its former ones, added up.
    former: BTreeMap<String, Health>,
    /// The worst median and 99th percentile of each node's latency while the hand moved.
    pub latencies: BTreeMap<String, [Vec<i64>; 2]>,
    /// When each node (kind/instance) had finished.
    pub finished: BTreeMap<String, Instant>,
    /// When the first measurement came.
    pub began: Option<Instant>,
    /// Registered points.
    pub points: u64,
    /// What register made of the scan, where something better came of it.
    pub placed: Vec<Scan>,
    /// What refinement says of itself.
    pub refinement: Option<Refinement>,
    /// Balls of the final cloud.
    pub balls: u64,
    /// The true way of the camera, when the world is known.
    pub truth: Vec<TrajectorySample>,
    /// The final surface.
    pub mesh: Option<Mesh>,
    /// The final model.
    pub model: Option<Model>,
}

impl Harvest {
    /// Takes note of a node's account. One whose numbers begin anew is that of a new process: what the former one had
    /// counted up to its last word stands.
    pub(super) fn note(&mut self, health: Health) {
        let node = health.node.clone();
        let Some(last) = self.healths.insert(node.clone(), health) else { return };
        if self.healths[&node].header.seq < last.header.seq {
            let sum = self.former.get(&node).map_or_else(|| last.clone(), |former| sum(former, &last));
            self.former.insert(node, sum);
        }
    }

    /// What each node has done, in all its processes.
    pub fn accounts(&self) -> impl Iterator<Item = Health> + '_ {
        self.healths.iter().map(|(node, last)| match self.former.get(node) {
            Some(former) => sum(former, last),
            None => last.clone(),
        })
    }

    /// Messages lost on the whole way.
    pub fn lost(&self) -> u64 {
        self.accounts().flat_map(|health| health.inputs).map(|input| input.lost).sum()
    }

    /// The median over the scan of one node's latency percentiles (50th, 99th), in nanoseconds.
    pub fn latency(&self, node: &str) -> [Option<i64>; 2] {
        let median = |values: &Vec<i64>| {
            let mut values = values.clone();
            values.sort_unstable();
            values.get(values.len() / 2).copied()
        };
        self.latencies.get(node).map_or([None; 2], |latencies| latencies.each_ref().map(median))
    }

    /// Seconds between two moments of the run; `None` unless both came.
    pub fn seconds(&self, from: Option<Instant>, to: Option<Instant>) -> Option<f64> {
        Some(to?.saturating_duration_since(from?).as_secs_f64())
    }
}

/// Two processes of one node as one account; latencies are the later one's.
fn sum(former: &Health, last: &Health) -> Health {
    let input = |key: &str| former.inputs.iter().find(|input| input.key == key);
    let inputs = last.inputs.iter().map(|now| match input(&now.key) {
        None => now.clone(),
        Some(before) => InputHealth {
            key: now.key.clone(),
            received: before.received + now.received,
            lost: before.lost + now.lost,
            refused: before.refused + now.refused,
        },
    });
    let mut refused = former.refused.clone();
    for refusal in &last.refused {
        match refused.iter_mut().find(|before| before.reason == refusal.reason) {
            Some(before) => before.count += refusal.count,
            None => refused.push(refusal.clone()),
        }
    }
    Health {
        inputs: inputs.collect(),
        refused,
        published: former.published + last.published,
        cpu_nanos: former.cpu_nanos + last.cpu_nanos,
        busy_nanos: former.busy_nanos + last.busy_nanos,
        ..last.clone()
    }
}
