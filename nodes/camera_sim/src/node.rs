//! The wiring: pictures of the known world, in their time.

use crate::CameraSim;
use kit::{Go, Node, Pictures};
use std::sync::mpsc;
use wire::{Bulk, Frame, Header, Phase, Trajectory, topic};
use world::Setup;

/// Batches of pictures that are rendered ahead.
const BATCHES_AHEAD: usize = 1;
/// Pictures of a batch for each core: one takes longer than another, and no core shall wait for long.
const PICTURES_PER_CORE: u64 = 6;

/// Sends the pictures of one scan after the other until it is told to stop.
pub fn run(mut node: Node) -> anyhow::Result<()> {
    let setup: Setup = node.spec().config()?;
    let sim = CameraSim::new(&setup.open()?)?;
    let camera = node.instance().to_owned();
    let mut pictures = node.pictures(&camera)?;
    let mut truth = node.output(&topic::truth_trajectory(&camera))?;
    node.ready()?;
    let mut scanned = None;
    while let Some(go) = node.wait_for_go(scanned)? {
        scanned = Some(go.scan);
        let last = scan(&mut node, &sim, &go, &mut pictures)?;
        truth.send(Trajectory {
            header: Header { scan: go.scan, ..sim.truth().header },
            samples: sim.truth().samples,
        })?;
        let header = Header { scan: go.scan, phase: Phase::End, stamp_nanos: last, ..Header::default() };
        pictures.send(Frame { header, data: Bulk::default(), ..sim.blank() })?;
        node.finished(&header)?;
        tracing::info!("the hand has put the handset down");
    }
    node.close()
}

/// Renders ahead on all cores, and sends each picture when its turn has come. Returns the stamp of the end.
fn scan(node: &mut Node, sim: &CameraSim, go: &Go, pictures: &mut Pictures) -> anyhow::Result<i64> {
    let (sender, batches) = mpsc::sync_channel(BATCHES_AHEAD);
    std::thread::scope(|scope| {
        scope.spawn(move || {
            let step = PICTURES_PER_CORE * rayon::current_num_threads() as u64;
            for first in (0..sim.frames()).step_by(step as usize) {
                let batch = sim.batch(first..sim.frames().min(first + step));
                if sender.send(batch).is_err() {
                    return;
                }
            }
        });
        let mut last = 0;
        for mut frame in batches.iter().flatten() {
            last = frame.header.stamp_nanos;
            if !node.wait_for_turn(go, last) {
                break;
            }
            frame.header.scan = go.scan;
            let header = frame.header;
            pictures.send(frame)?;
            node.finished(&header)?;
        }
        drop(batches);
        Ok(last + 1)
    })
}
