//! The node's state: the cloud as it stands, and its surface.

use crate::clean::clean;
use crate::grid::KeyHash;
use crate::ground::Ground;
use crate::holes;
use crate::model::Model;
use crate::sample::{Refused, Sample};
use crate::scale::Scale;
use crate::sheet::Sheet;
use crate::{Config, ConfigError};
use std::cmp::Ordering;
use std::collections::{BTreeMap, HashMap};
use wire::{Cloud, Extent, Header, Mesh, Phase, Refusal, TablePlane};

/// Keeps a cloud and its surface up to date.
#[derive(Debug, Clone)]
pub struct Surfer {
    config: Config,
    header: Header,
    samples: Vec<Sample>,
    places: HashMap<u32, u32, KeyHash>,
    refused: BTreeMap<Refused, u64>,
    model: Option<Model>,
    /// On which the thing stands, when somebody found it.
    table: Option<TablePlane>,
    /// Samples when the scale was last looked at.
    scaled_at: usize,
}

/// While it grows, the cloud is measured again whenever it has so many times the samples of the last time.
const MEASURE_AGAIN: f64 = 1.5;

impl Surfer {
    /// Nothing seen yet.
    pub fn new(config: Config) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            config,
            header: Header::default(),
            samples: Vec::new(),
            places: HashMap::default(),
            refused: BTreeMap::new(),
            model: None,
            table: None,
            scaled_at: 0,
        })
    }

    /// Takes in a cloud or its changes, and marks what they touch. A later scan, and a whole cloud, start afresh; an earlier
    /// scan or revision is refused.
    pub fn update(&mut self, cloud: &Cloud) {
        let standing = |header: &Header| (header.scan, header.revision);
        match standing(&cloud.header).cmp(&standing(&self.header)) {
            Ordering::Less => return self.refuse(Refused::Old, cloud.points.len() as u64),
            Ordering::Greater if cloud.header.scan > self.header.scan => self.forget(),
            _ if cloud.extent == Extent::Whole => self.forget(),
            _ => {}
        }
        self.header = cloud.header;
        self.table = cloud.table.or(self.table);
        for point in cloud.points.iter() {
            if cloud.extent == Extent::Changes && point.count == 0 {
                self.remove(point.id);
                continue;
            }
            match Sample::new(point.id, point.position_m, point.normal, point.sigma_m) {
                Ok(sample) => self.put(sample),
                Err(reason) => self.refuse(reason, 1),
            }
        }
    }

    /// The surface as far as it is known, not cleaned: for the eye. Only what changed is computed again.
    pub fn live_mesh(&mut self) -> Mesh {
        if self.model.is_none() || self.samples.len() as f64 > MEASURE_AGAIN * self.scaled_at as f64 {
            self.measure();
        }
        self.sew().into_mesh(self.header.derived())
    }

    /// The surface, cleaned and, if it is wanted so, closed; its phase is `End`. It depends on the points alone, not on how
    /// they came.
    pub fn final_mesh(&mut self) -> Mesh {
        self.measure();
        let mut sheet = self.sew();
        if let Some(model) = &self.model {
            let cell_m = model.grid().cell_m();
            let ground = self.table.and_then(|table| Ground::new(&table, self.config.standing_m()));
            clean(&mut sheet, &self.config, cell_m, ground.as_ref());
            if self.config.close {
                sheet.measured = Some(sheet.triangles.len());
                self.refuse(Refused::Hole, holes::close(&mut sheet, ground.as_ref()));
                sheet.complete_normals();
            }
        }
        sheet.into_mesh(Header { phase: Phase::End, ..self.header.derived() })
    }

    /// How many points the surface stands on.
    pub fn samples(&self) -> usize {
        self.samples.len()
    }

    /// Edge of a grid cell in metres, once there is a surface.
    pub fn cell_m(&self) -> Option<f64> {
        self.model.as_ref().map(|model| f64::from(model.grid().cell_m()))
    }

    /// Radius of the neighbourhoods in metres, once there is a surface.
    pub fn radius_m(&self) -> Option<f64> {
        self.model.as_ref().map(|model| f64::from(model.grid().radius_m))
    }

    /// Points that were refused since the start, by reason.
    pub fn refused(&self) -> Vec<Refusal> {
        self.refused.iter().map(|(reason, &count)| Refusal { reason: reason.to_string(), count }).collect()
    }

    fn refuse(&mut self, reason: Refused, count: u64) {
        if count == 0 {
            return;
        }
        *self.refused.entry(reason).or_default() += count;
    }

    fn forget(&mut self) {
        self.table = None;
        self.samples.clear();
        self.places.clear();
        self.model = None;
    }

    fn put(&mut self, sample: Sample) {
        let next = self.samples.len() as u32;
        let place = *self.places.entry(sample.id).or_insert(next);
        if place == next {
            self.samples.push(sample);
            if let Some(model) = &mut self.model {
                model.insert(place, &sample);
            }
            return;
        }
        let old = std::mem::replace(&mut self.samples[place as usize], sample);
        if let (Some(model), true) = (&mut self.model, old != sample) {
            model.replace(place, &old, &sample);
        }
    }

    /// A point is no longer part of the cloud.
    fn remove(&mut self, id: u32) {
        let Some(place) = self.places.remove(&id) else { return };
        let gone = self.samples.swap_remove(place as usize);
        let moved = self.samples.get(place as usize);
        if let Some(model) = &mut self.model {
            model.remove(place, &gone);
            if let Some(last) = moved {
                model.remove(self.samples.len() as u32, last);
                model.insert(place, last);
            }
        }
        if let Some(last) = moved {
            self.places.insert(last.id, place);
        }
    }

    /// Looks at the cloud, and begins the surface anew when its grid is no longer the right one.
    fn measure(&mut self) {
        self.scaled_at = self.samples.len();
        let mut in_order = self.samples.clone();
        in_order.sort_by_key(|sample| sample.id);
        let Some(scale) = Scale::of(&in_order) else {
            self.model = None;
            return;
        };
        let grid = scale.grid(&self.config);
        let fits = |model: &Model| *model.grid() == grid && model.typical_variance() == scale.typical_variance;
        if !self.model.as_ref().is_some_and(fits) {
            let mut model = Model::new(grid, scale.typical_variance);
            for (place, sample) in (0..).zip(&self.samples) {
                model.insert(place, sample);
            }
            self.model = Some(model);
        }
    }

    fn sew(&mut self) -> Sheet {
        let Some(model) = &mut self.model else { return Sheet::default() };
        model.refresh(&self.samples);
        Sheet::sew(model.patches())
    }
}

/// The surface of a cloud that is all there: `limn surface CLOUD -o MESH`. Both in metres; `normals`, one for each point,
/// tell the side and need not be exact. Also returns what was refused.
pub fn surface_from_points(
    points: &[[f32; 3]],
    normals: Option<&[[f32; 3]]>,
    config: Config,
) -> Result<(Mesh, Vec<Refusal>), ConfigError> {
    let mut surfer = Surfer::new(config)?;
    for (id, &position) in (0..).zip(points) {
        let normal = normals.and_then(|normals| normals.get(id as usize)).copied().unwrap_or_default();
        match Sample::new(id, position, normal, 0.0) {
            Ok(sample) => surfer.put(sample),
            Err(reason) => surfer.refuse(reason, 1),
        }
    }
    Ok((surfer.final_mesh(), surfer.refused()))
}
