//! The wiring: profiles and poses come, points in the world and the camera's way go.

use crate::{Config, Register};
use kit::{Node, Output, STREAM_HISTORY};
use wire::{Bulk, Header, Scan, Trajectory, topic};

/// Registers the profiles of a camera by the poses of a tracker until it is told to stop.
pub fn run(mut node: Node) -> anyhow::Result<()> {
    let config: Config = node.spec().config()?;
    config.check()?;
    let mut poses = node.stream(&topic::pose(node.spec().source_of("tracker")), STREAM_HISTORY)?;
    let mut profiles = node.stream(&topic::profile(node.spec().source_of("camera")), STREAM_HISTORY)?;
    let mut scans = node.output(&topic::scan(node.instance()))?;
    let mut trajectories = node.output(&topic::trajectory(node.instance()))?;
    let rig = node.spec().source_of("rig").to_owned();
    let calibration = node.calibration(&rig)?;
    let mut register = Register::new(config, &calibration)?;
    node.ready()?;
    let mut ends: [Option<Header>; 2] = [None; 2];
    while node.wait() {
        while let Some(pose) = poses.next() {
            if pose.header.is_end() {
                ends[0] = Some(pose.header);
            } else {
                register.pose(&pose);
            }
        }
        while let Some(profile) = profiles.next() {
            if profile.header.is_end() {
                ends[1] = Some(profile.header);
            } else {
                register.profile(profile);
            }
        }
        let ended = match ends {
            [Some(_), Some(profiles)] => {
                register.finish().iter().for_each(|refusal| node.refuse(&refusal.reason, refusal.count));
                Some(profiles)
            }
            _ => None,
        };
        send(&mut node, &mut register, &mut scans)?;
        while let Some(trajectory) = register.trajectory() {
            trajectories.send(trajectory)?;
        }
        if let Some(end) = ended {
            ends = [None; 2];
            trajectories.send(Trajectory { header: end.derived(), samples: Bulk::default() })?;
            scans.send(Scan::none(end.derived()))?;
            node.finished(&end)?;
        }
    }
    node.close()
}

fn send(node: &mut Node, register: &mut Register, scans: &mut Output<Scan>) -> anyhow::Result<()> {
    let mut ready: Vec<Scan> = register.drain().collect();
    ready.extend(register.without_pose());
    for scan in ready {
        let header = scan.header;
        scan.refused.iter().for_each(|refusal| node.refuse(&refusal.reason, refusal.count));
        scans.send(scan)?;
        node.finished(&header)?;
    }
    Ok(())
}
