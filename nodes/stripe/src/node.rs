//! The wiring: a frame comes, its stripe goes.

use crate::{Config, StripeDetector};
use kit::Node;
use wire::{Frame, Light, Stripe, topic};

/// Frames that may wait: at 60 a second, half a second.
const DEPTH: usize = 32;

/// Finds the stripe in every frame of a camera until it is told to stop.
pub fn run(mut node: Node) -> anyhow::Result<()> {
    let config: Config = node.spec().config()?;
    config.check()?;
    let mut frames = node.stream(&topic::frame(node.spec().source_of("camera")), DEPTH)?;
    let mut stripes = node.output(&topic::stripe(node.instance()))?;
    let rig = node.spec().source_of("rig").to_owned();
    let calibration = node.calibration(&rig)?;
    let mut detector = StripeDetector::new(config, &calibration.laser)?;
    node.ready()?;
    while node.wait() {
        while let Some(frame) = frames.next() {
            if frame.header.is_end() {
                stripes.send(end(&frame))?;
            } else {
                match detector.process(&frame) {
                    Ok(stripe) => {
                        stripe.refused.iter().for_each(|refusal| node.refuse(&refusal.reason, refusal.count));
                        stripes.send(stripe)?;
                    }
                    Err(error) => {
                        tracing::error!("frame {} refused: {error}", frame.header.seq);
                        node.refuse("frame whose bytes contradict its header", 1);
                    }
                }
            }
            node.finished(&frame.header)?;
        }
    }
    node.close()
}

fn end(frame: &Frame) -> Stripe {
    Stripe {
        header: frame.header.derived(),
        width: frame.width,
        height: frame.height,
        light: Light { laser: false, lamp: false },
        peaks: wire::Bulk::default(),
        refused: Vec::new(),
    }
}
