//! What the nodes of a rig have told of themselves, through all their restarts.

use std::collections::BTreeMap;
use wire::{Health, InputHealth};

/// The accounts of all nodes.
#[derive(Debug, Default)]
pub struct Accounts {
    /// The last account of every node's present process.
    healths: BTreeMap<String, Health>,
    /// The accounts of its former ones, added up.
    former: BTreeMap<String, Health>,
}

impl Accounts {
    /// Takes note of a node's account. One whose numbers begin anew is that of a new process: what the former one had
    /// counted up to its last word stands.
    pub fn note(&mut self, health: Health) {
        let node = health.node.clone();
        let Some(last) = self.healths.insert(node.clone(), health) else { return };
        if self.healths[&node].header.seq < last.header.seq {
            let sum = self.former.get(&node).map_or_else(|| last.clone(), |former| sum(former, &last));
            self.former.insert(node, sum);
        }
    }

    /// What each node has done, in all its processes.
    pub fn all(&self) -> impl Iterator<Item = Health> + '_ {
        self.healths.iter().map(|(node, last)| match self.former.get(node) {
            Some(former) => sum(former, last),
            None => last.clone(),
        })
    }

    /// Messages lost on the whole way.
    pub fn lost(&self) -> u64 {
        self.all().flat_map(|health| health.inputs).map(|input| input.lost).sum()
    }
}

/// Two processes of one node as one account; the percentiles of its last second are the later one's.
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
    let mut latencies = former.latencies.clone();
    latencies.add(&last.latencies);
    Health {
        inputs: inputs.collect(),
        refused,
        latencies,
        published: former.published + last.published,
        cpu_nanos: former.cpu_nanos + last.cpu_nanos,
        busy_nanos: former.busy_nanos + last.busy_nanos,
        ..last.clone()
    }
}
