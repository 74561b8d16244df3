//! From a planned node to the command that starts it and the line that it reads.

use crate::graph;
use crate::plan::{Machine, Plan};
use crate::planned::PlannedNode;
use crate::process::Start;
use bus::BusConfig;
use std::path::Path;

/// How to start a node of the plan whose bus is at `bus`.
pub(crate) fn start(plan: &Plan, node: &PlannedNode, bus: &BusConfig, executable: &Path) -> Start {
    let machine = node.machine.as_deref().and_then(|name| plan.machines.get(name));
    let program = match (&node.exec, machine) {
        (Some(exec), _) => exec.program.to_string_lossy().into_owned(),
        (None, Some(machine)) if machine.ssh.is_some() => machine.limn.clone(),
        (None, _) => executable.to_string_lossy().into_owned(),
    };
    let mut command = vec![program];
    command.extend(node.exec.iter().flat_map(|exec| exec.args.iter().cloned()));
    command.extend(["node", &node.kind, "--instance", &node.inputs.instance].map(str::to_owned));
    Start {
        name: node.name.clone(),
        command: machine
            .and_then(|machine| machine.ssh.as_ref())
            .map_or(command.clone(), |host| over_ssh(host, &command)),
        spec: spec(plan, node, &reached_from(bus, machine)),
    }
}

fn spec(plan: &Plan, node: &PlannedNode, bus: &BusConfig) -> kit::NodeSpec {
    let others = plan.nodes.iter().filter(|other| other.required && !other.source);
    kit::NodeSpec {
        kind: node.kind.clone(),
        instance: node.inputs.instance.clone(),
        bus: BusConfig { onlooker: !node.required && !node.paces, ..bus.clone() },
        pace: plan.run.pace,
        window_ms: plan.run.window_ms,
        consumers: if node.source { graph::consumers(&plan.nodes, node) } else { Vec::new() },
        wait_for: if node.source { others.map(PlannedNode::address).collect() } else { Vec::new() },
        inputs: node.inputs.bound.clone(),
        config: node.config.clone(),
        next_seq: None,
        log: plan.run.log.clone(),
    }
}

/// Another machine may know the bus under another name.
fn reached_from(bus: &BusConfig, machine: Option<&Machine>) -> BusConfig {
    let endpoint = machine.and_then(|machine| machine.endpoint.clone()).unwrap_or_else(|| bus.endpoint.clone());
    BusConfig { endpoint, ..bus.clone() }
}

/// The same line on another machine. ssh passes standard input on, so the lifeline holds there too.
fn over_ssh(host: &str, command: &[String]) -> Vec<String> {
    let options = ["ssh", "-o", "BatchMode=yes", "-o", "ServerAliveInterval=5", host, "--"];
    // The shell over there takes the line apart again.
    let line = command.iter().map(|word| format!("'{}'", word.replace('\'', r"'\''"))).collect::<Vec<_>>().join(" ");
    options.into_iter().map(str::to_owned).chain([line]).collect()
}
