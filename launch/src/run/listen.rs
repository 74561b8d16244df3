//! Listens to a scan without taking part in it.

use super::bars::Bars;
use super::harvest::Harvest;
use crate::plan::Plan;
use anyhow::Result;
use bus::{Bus, BusConfig, BusError, InputCounts, Subscriber};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use wire::{
    Cloud, Header, Health, InputHealth, Latencies, Mesh, Message, Model, Progress, Refinement, Scan, Trajectory, topic,
};

/// A thread that gathers until it is told to finish.
pub struct Listener {
    thread: JoinHandle<Harvest>,
    finish: Arc<AtomicBool>,
}

/// Silence of this length is the end of what was said ...
const NAP: Duration = Duration::from_millis(100);
/// ... and nodes that live on are heard no longer than this.
const LAST_WORDS: Duration = Duration::from_secs(3);

struct Ears {
    healths: Subscriber<Health>,
    progress: Subscriber<Progress>,
    scans: Subscriber<Scan>,
    refinements: Option<Subscriber<Refinement>>,
    clouds: Subscriber<Cloud>,
    meshes: Subscriber<Mesh>,
    models: Subscriber<Model>,
    truths: Subscriber<Trajectory>,
}

impl Listener {
    /// Joins the bus. Nothing that comes later is missed.
    pub fn start(config: &BusConfig, plan: &Plan, bars: Bars) -> Result<Self> {
        let instance = |kind: &str| plan.nodes.iter().find(|n| n.kind == kind).map(|n| n.inputs.instance.clone());
        let refined = instance("refine").map(|world| topic::refinement(&world));
        let bus = Bus::open(config)?;
        let mut ears = Ears {
            healths: bus.subscribe(&topic::health("**"), 1024)?,
            progress: bus.subscribe(&topic::progress("**"), 1 << 16)?,
            // A register that is started again sends the whole scan once more.
            scans: bus.subscribe(&topic::scan(&instance("register").unwrap_or_default()), 1 << 14)?.fresh_only(),
            // Of what is latched the newest counts.
            refinements: refined.map(|topic| Ok::<_, BusError>(bus.subscribe(&topic, 8)?.glimpses())).transpose()?,
            clouds: bus.subscribe(&topic::cloud(), 1 << 14)?,
            meshes: bus.subscribe(&topic::mesh(), 4)?.glimpses(),
            models: bus.subscribe(&topic::textured(), 4)?.glimpses(),
            truths: bus.subscribe(&topic::truth_trajectory("*"), 64)?.fresh_only(),
        };
        let finish = Arc::new(AtomicBool::new(false));
        let finishing = finish.clone();
        let thread = std::thread::spawn(move || {
            let (mut harvest, mut closing) = (Harvest::default(), None);
            // The nodes' last accounts come as they close: they may still be on the way.
            while bus.wait(NAP) || closing.is_none() {
                ears.hear(&mut harvest, &bars);
                if finishing.load(Ordering::SeqCst) && closing.get_or_insert_with(Instant::now).elapsed() > LAST_WORDS {
                    break;
                }
            }
            harvest.accounts.note(ears.account());
            harvest
        });
        Ok(Self { thread, finish })
    }

    /// What was gathered.
    pub fn finish(self) -> Harvest {
        self.finish.store(true, Ordering::SeqCst);
        self.thread.join().unwrap_or_default()
    }
}

/// The name of the launcher among the nodes that give account.
const LISTENER: &str = "limn/listener";

impl Ears {
    /// What this thread has heard and missed itself: the report rests on it as on any node's work.
    fn account(&self) -> Health {
        let mut inputs = vec![
            input(&self.healths),
            input(&self.progress),
            input(&self.scans),
            input(&self.clouds),
            input(&self.meshes),
            input(&self.models),
            input(&self.truths),
        ];
        inputs.extend(self.refinements.as_ref().map(input));
        Health {
            header: Header::default(),
            node: LISTENER.to_owned(),
            inputs,
            published: 0,
            refused: Vec::new(),
            latency_p50_nanos: 0,
            latency_p99_nanos: 0,
            latencies: Latencies::default(),
            cpu_nanos: 0,
            busy_nanos: 0,
        }
    }

    fn hear(&mut self, harvest: &mut Harvest, bars: &Bars) {
        while let Some(scan) = self.scans.next() {
            harvest.began.get_or_insert_with(Instant::now);
            harvest.points += scan.points.len() as u64;
            if self.refinements.is_some() {
                harvest.placed.push(scan);
            }
        }
        if let Some(refinements) = &mut self.refinements {
            harvest.refinement = refinements.newest().or(harvest.refinement.take());
        }
        while let Some(progress) = self.progress.next() {
            if progress.header.is_end() {
                harvest.finished.entry(progress.node.clone()).or_insert_with(Instant::now);
                bars.finished(&progress.node);
            } else if progress.node.starts_with("register/") {
                bars.swept(progress.header.stamp_nanos as f64 * 1e-9, harvest.points);
            }
        }
        while let Some(cloud) = self.clouds.next() {
            if cloud.header.is_end() {
                harvest.cloud = cloud.points.0;
            }
        }
        while let Some(mesh) = self.meshes.next() {
            if mesh.header.is_end() {
                harvest.mesh = Some(mesh.without_caps());
                harvest.closed = Some(mesh);
            }
        }
        while let Some(model) = self.models.next() {
            harvest.model = Some(model).filter(|model| model.header.is_end()).or(harvest.model.take());
        }
        while let Some(truth) = self.truths.next() {
            harvest.truth.extend_from_slice(&truth.samples);
        }
        while let Some(health) = self.healths.next() {
            harvest.accounts.note(health);
        }
    }
}

fn input<M: Message>(subscriber: &Subscriber<M>) -> InputHealth {
    let InputCounts { received, lost, repeated, refused, .. } = *subscriber.counts();
    InputHealth { key: subscriber.key().to_owned(), received, lost, refused: refused + repeated }
}
