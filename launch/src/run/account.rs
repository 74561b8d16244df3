//! What one scan brought, as numbers for its report.

use super::{Harvest, parts};
use geometry::TriangleMesh;
use report::{Counts, Refused, Stage, Time};
use std::time::Instant;
use wire::{Health, InputHealth};

impl Harvest {
    /// How much of everything there was.
    pub fn counts(&self) -> Counts {
        let received = |kind: &str, stream: &str| {
            let nodes = self.accounts.all().filter(|health| health.node.starts_with(kind));
            let inputs = nodes.flat_map(|health| health.inputs).filter(|input| input.key.ends_with(stream));
            inputs.map(|input| input.received).sum()
        };
        let mesh = self.mesh.as_ref().map(TriangleMesh::from);
        Counts {
            frames: received("stripe/", "/frame"),
            poses: received("register/", "/pose"),
            points: self.points,
            cloud_points: self.cloud.len() as u64,
            triangles: mesh.as_ref().map_or(0, |mesh| mesh.triangles.len() as u64),
            texture_cells: self.model.as_ref().map_or(0, |m| m.texture.iter().filter(|t| t[3] == 255).count() as u64),
            area_mm2: mesh.as_ref().map_or(0.0, |mesh| mesh.area() * 1e6),
        }
    }

    /// Why there is no point at all; `None` when there are some.
    pub fn emptiness(&self) -> Option<String> {
        if self.points > 0 {
            return None;
        }
        let pictures = self.counts().frames;
        let triangulated = self.accounts.all().filter(|health| health.node.starts_with("triangulate/"));
        let refused = triangulated.flat_map(|health| health.refused);
        let reasons: Vec<String> = refused.map(|refusal| format!("{} x {}", refusal.count, refusal.reason)).collect();
        Some(match reasons.as_slice() {
            [] => format!(
                "the scan is empty: no stripe was seen in {pictures} pictures; is the laser on, and brighter than stripe.min_amplitude?"
            ),
            _ => format!("the scan is empty: no point came of {pictures} pictures; refused: {}", reasons.join(", ")),
        })
    }

    /// What each node did.
    pub fn stages(&self) -> Vec<Stage> {
        self.accounts.all().map(|health| self.stage(&health)).collect()
    }

    fn stage(&self, health: &Health) -> Stage {
        let latency_ms = |share| health.latencies.percentile(share).map(|nanos| nanos as f64 * 1e-6);
        let finished = self.finished.get(&health.node).copied();
        let wall_s = self.seconds(self.began, finished).filter(|seconds| *seconds > 0.0);
        Stage {
            node: health.node.clone(),
            received: health.inputs.iter().map(|input| input.received).sum(),
            published: health.published,
            rate_hz: wall_s.map(|seconds| health.published as f64 / seconds),
            busy_s: health.busy_nanos as f64 * 1e-9,
            cpu_s: health.cpu_nanos as f64 * 1e-9,
            latency_p50_ms: latency_ms(0.5),
            latency_p99_ms: latency_ms(0.99),
            lost: health.inputs.iter().map(|input| input.lost).sum(),
            refused: refused(health),
        }
    }

    /// The parts of the run, from one node's end to the next one's, and all of it until now.
    pub fn times(&self, started: Instant) -> Vec<Time> {
        let time = |what: &str, from: Option<Instant>, to: Option<Instant>| {
            Some(Time { what: what.to_owned(), seconds: self.seconds(from, to)? })
        };
        let mut times: Vec<Time> = time("start", Some(started), self.began).into_iter().collect();
        let mut before = self.began;
        for part in parts::all() {
            let end = self.finished.iter().find(|(node, _)| part.ends_with(node)).map(|(_, at)| *at);
            if end.is_some() {
                times.extend(time(part.name, before, end));
                before = end;
            }
        }
        times.extend(time("all", Some(started), Some(Instant::now())));
        times
    }
}

/// What a node refused of the messages' contents, and the messages that it could not take at all.
fn refused(health: &Health) -> Vec<Refused> {
    let contents = health.refused.iter().map(|r| Refused { reason: r.reason.clone(), count: r.count });
    let inputs = health.inputs.iter().filter(|input| input.refused > 0);
    let whole = |input: &InputHealth| Refused {
        reason: format!("message on {} that could not be read, or came again", input.key),
        count: input.refused,
    };
    contents.chain(inputs.map(whole)).collect()
}
