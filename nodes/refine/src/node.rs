//! The wiring. What `register` made of a scan is relayed as it comes, so that all behind this node is live. On a better way
//! of the camera the next revision goes: once in a while what moved of the scan, and at its end all of it.

use crate::Config;
use crate::course::Course;
use crate::readers::Outputs;
use kit::{Input, Node};
use wire::{Pose, Profile, Scan, Trajectory, topic};

const PROFILES: usize = 1024;
const POSES: usize = 4096;
const PLACED: usize = 1 << 14;

/// Relays, gathers and refines one scan after the other until it is told to stop.
pub fn run(mut node: Node) -> anyhow::Result<()> {
    let config: Config = node.spec().config()?;
    config.check()?;
    let mut inputs = Inputs::open(&mut node)?;
    let instance = node.instance().to_owned();
    let outputs = Outputs {
        scans: node.output(&topic::scan(&instance))?,
        ways: node.output(&topic::trajectory(&instance))?,
        accounts: node.output(&topic::refinement(&instance))?,
    };
    let rig = node.spec().source_of("rig").to_owned();
    let calibration = node.calibration(&rig)?;
    let mut course = Course::new(config, calibration, outputs)?;
    node.ready()?;
    while node.wait() {
        inputs.hear(&mut node, &mut course)?;
        node.worked(course.worker.worked());
        while let Some(answer) = course.worker.answer()? {
            course.take(&mut node, answer)?;
        }
        course.refine()?;
    }
    node.close()
}

struct Inputs {
    poses: Input<Pose>,
    profiles: Input<Profile>,
    scans: Input<Scan>,
    ways: Input<Trajectory>,
}

impl Inputs {
    fn open(node: &mut Node) -> anyhow::Result<Self> {
        let [camera, tracker, world] =
            ["camera", "tracker", "world"].map(|input| node.spec().source_of(input).to_owned());
        Ok(Self {
            poses: node.stream(&topic::pose(&tracker), POSES)?,
            profiles: node.stream(&topic::profile(&camera), PROFILES)?,
            scans: node.stream(&topic::scan(&world), PLACED)?,
            ways: node.stream(&topic::trajectory(&world), PLACED)?,
        })
    }

    fn hear(&mut self, node: &mut Node, course: &mut Course) -> anyhow::Result<()> {
        while let Some(pose) = self.poses.next() {
            course.begin(&pose.header)?;
            if pose.header.is_end() {
                course.ends[0] = Some(pose.header);
            } else {
                course.worker.pose(pose)?;
            }
        }
        while let Some(profile) = self.profiles.next() {
            course.begin(&profile.header)?;
            if profile.header.is_end() {
                course.ends[1] = Some(profile.header);
            } else {
                course.worker.profile(profile)?;
            }
        }
        while let Some(scan) = self.scans.next() {
            course.begin(&scan.header)?;
            course.relay_scan(node, scan)?;
        }
        while let Some(way) = self.ways.next() {
            course.begin(&way.header)?;
            course.relay_way(way)?;
        }
        Ok(())
    }
}
