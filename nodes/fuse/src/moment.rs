//! One moment: who has a say, and what comes of it.

use crate::Fuse;
use crate::agree::agree;
use crate::solve::Sighting;
use crate::tell::{self, Remarks};
use crate::track::{Listening, Track, Waiting};
use geometry::{NoPose, TimedPose};
use nalgebra::Isometry3;
use wire::{Header, Pose};

impl Fuse {
    /// Decides all readings of which every receiver has told.
    pub(crate) fn serve(&mut self) {
        while let Some((receiver, oldest)) = self.oldest() {
            if self.awaited(oldest.header.stamp_nanos).next().is_some() {
                return;
            }
            self.tracks[receiver].waiting.pop_front();
            self.decide(receiver, oldest);
        }
    }

    /// A reading is a moment of the body when its receiver is the first that tells a pose there. When nobody does, the
    /// first that speaks says so.
    fn decide(&mut self, receiver: usize, reading: Waiting) {
        let (stamp_nanos, gap_nanos) = (reading.header.stamp_nanos, self.config.most_gap_nanos());
        match self.last_nanos() {
            Some(last) if stamp_nanos < last => return self.refuse_of(receiver, "pose that came too late"),
            Some(last) if stamp_nanos == last => return,
            _ => {}
        }
        let told: Vec<_> = self.tracks.iter().map(|track| track.at(stamp_nanos, gap_nanos)).collect();
        let speaks = |track: &Track| track.listening != Listening::Silent && track.heard() >= Some(stamp_nanos);
        let first_to_speak = self.tracks.iter().position(speaks);
        let pose = match told.iter().position(Result::is_ok) {
            Some(first) if first == receiver && reading.usable => self.fuse(reading.header, &told),
            None if first_to_speak == Some(receiver) => {
                let remarks = self.remarks(stamp_nanos, &told);
                Some(tell::nobody(reading.header, &remarks))
            }
            _ => None,
        };
        let (Some(pose), Some(scan)) = (pose, &mut self.scan) else { return };
        scan.evidence.note(&pose);
        scan.last_nanos = Some(stamp_nanos);
        self.fused.push_back(pose);
        self.tracks.iter_mut().for_each(|track| track.forget_before(stamp_nanos));
    }

    fn fuse(&mut self, header: Header, told: &[Result<TimedPose, NoPose>]) -> Option<Pose> {
        let present: Vec<usize> = (0..told.len()).filter(|&index| told[index].is_ok()).collect();
        // Alone, a receiver is apart from nobody.
        let apart = if present.len() > 1 { self.config.apart() } else { [0.0; 2] };
        let sighting = |(pose, mount): (&TimedPose, &Isometry3<f64>)| Sighting {
            body_from_receiver: *mount,
            world_from_receiver: pose.pose,
            position_sigma_m: pose.position_sigma_m.hypot(apart[0]),
            rotation_sigma_rad: pose.rotation_sigma_rad.hypot(apart[1]),
        };
        let poses = told.iter().zip(&self.mounts).filter_map(|(pose, mount)| Some((pose.as_ref().ok()?, mount)));
        let sightings: Vec<Sighting> = poses.map(sighting).collect();
        match agree(&sightings, self.config.outlier_sigmas) {
            Some(Ok(agreement)) => {
                let mut remarks = self.remarks(header.stamp_nanos, told);
                for &outlier in &agreement.outliers {
                    let receiver = present[outlier];
                    remarks.add(self.name(receiver), format_args!("{}", tell::off(&sightings[outlier], &agreement)));
                    self.refuse_of(receiver, "moment at which it is an outlier");
                }
                if let Some(scan) = &mut self.scan {
                    scan.evidence.agree(&agreement);
                }
                Some(tell::agreed(header, &agreement, remarks))
            }
            Some(Err(contradiction)) => {
                let names: Vec<&str> = present.iter().map(|&receiver| self.name(receiver)).collect();
                let pose = tell::contradicted(header, &names, contradiction);
                self.refuse("moment at which the receivers contradict each other".to_owned());
                Some(pose)
            }
            None => {
                self.refuse("moment whose numbers overflow".to_owned());
                None
            }
        }
    }

    /// Who is missing or not well at a moment; the former are counted.
    fn remarks(&mut self, stamp_nanos: i64, told: &[Result<TimedPose, NoPose>]) -> Remarks {
        let mut remarks = Remarks::default();
        for (receiver, pose) in told.iter().enumerate() {
            let track = &self.tracks[receiver];
            match pose {
                Err(why) => {
                    let absence = tell::absence(track.listening, *why);
                    remarks.add(self.name(receiver), format_args!("{absence}"));
                    self.refuse_of(receiver, &format!("moment without it: it {absence}"));
                }
                Ok(_) => {
                    if let Some(reason) = track.degraded(stamp_nanos, self.config.most_gap_nanos()) {
                        remarks.add(self.name(receiver), format_args!("is degraded: {reason}"));
                    }
                }
            }
        }
        remarks
    }
}
