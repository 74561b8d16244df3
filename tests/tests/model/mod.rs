//! A model that was made with a tracker that is played, and its poses, against what is known of them.

use std::path::Path;
use std::sync::OnceLock;
use system_tests::emulated::{one_at_a_time, simulated, simulated_at_other_moments};
use system_tests::rig::Rig;
use system_tests::{limn, number, repository, succeed};
use wire::{Pose, Quality};

/// How long the hand sweeps for a model.
pub const SECONDS: f64 = 8.0;

/// How far the surface that was played is from the one that is known: the median in millimetres, and which share of it is
/// within 0.25 mm. Where a busy machine let the tracker measure nothing, it is not.
pub fn apart(played: &Path, known: &Path) -> (f64, f64) {
    let compare = |model: &Path, truth: &Path| -> serde_json::Value {
        let meshes = [model, truth].map(|out| out.join("mesh.ply"));
        serde_json::from_slice(&succeed(limn().arg("compare").args(meshes).arg("--json")).stdout).unwrap()
    };
    // Shares are told of the truth alone, so each is the truth once.
    let (there, back) = (compare(played, known), compare(known, played));
    assert_eq!(number(&back, "/truth_to_model/within/0/distance_mm"), 0.25);
    (number(&there, "/model_to_truth/median_mm"), number(&back, "/truth_to_model/within/0/share"))
}

/// The model of the simulated tracker, and which share of another one is within 0.25 mm of it that is made of the same sweep
/// with the same tracker, but for its noise.
pub struct Known {
    /// The bytes of its mesh.ply.
    pub mesh: Vec<u8>,
    pub alike: f64,
}

pub fn known() -> &'static Known {
    static KNOWN: OnceLock<Known> = OnceLock::new();
    KNOWN.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let _alone = one_at_a_time();
        for mut up in [
            simulated(&folder.path().join("known"), SECONDS),
            simulated_at_other_moments(&folder.path().join("other"), SECONDS),
        ] {
            let (status, said) = Rig::start(&mut up).end();
            assert!(status.success(), "{said}");
        }
        let (median, alike) = apart(&folder.path().join("other"), &folder.path().join("known"));
        println!("noise alone sets two models {median:.4} mm apart in the median; {alike:.3} are within 0.25 mm");
        assert!(median > 0.0, "both are the same scan");
        Known { mesh: std::fs::read(folder.path().join("known/mesh.ply")).unwrap(), alike }
    })
}

/// From the receiver to the surface.
pub const LEVER_MM: f64 = 250.0;
/// The noise of the rig `quick`, root mean square of the whole vector.
pub const NOISE_MM: f64 = 0.05;
pub const NOISE_DEG: f64 = 0.02;

/// The poses of a sweep against the hand.
pub struct Judged {
    /// Half of the positions are no more wrong than this.
    pub median_mm: f64,
    /// The share of all moments, those without a pose as well, at which the pose puts the surface within 0.25 mm of its place.
    pub near: f64,
    /// Root mean square of the hand's speed.
    pub speed_mm_per_s: f64,
}

/// At the moments that the stamps and the rig's calibration say.
pub fn judged(out: &Path, seconds: f64, poses: &[Pose]) -> Judged {
    let (scene, rig) = (repository("config/scenes/cow.toml"), out.join("quick.toml"));
    let known = world::Setup { scene, rig, seconds, ..world::Setup::default() }.open().unwrap();
    let (mut off, mut near, mut lost, mut square) = (Vec::new(), 0, 0, 0.0);
    for pose in poses {
        let t_s = pose.header.stamp_nanos as f64 * 1e-9 + known.rig.clock.pose_offset_s;
        if pose.header.is_end() || !(0.3..seconds).contains(&t_s) {
            continue;
        }
        if pose.quality == Quality::Lost {
            lost += 1;
            continue;
        }
        let said = geometry::rigid_from_wire(&pose.world_from_body).unwrap();
        let at = |t_s| known.hand.world_from_body(t_s);
        let truth = at(t_s).translation.vector;
        let off_mm = (said.translation.vector - truth).norm() * 1e3;
        let turned = at(t_s - pose.rotation_lag_nanos as f64 * 1e-9).rotation.angle_to(&said.rotation);
        near += u32::from(off_mm.hypot(turned * LEVER_MM) < 0.25);
        square += ((at(t_s + 0.001).translation.vector - truth).norm() * 1e6).powi(2);
        off.push(off_mm);
    }
    off.sort_by(f64::total_cmp);
    let (count, near) = (off.len() as f64, f64::from(near) / (off.len() + lost) as f64);
    println!("{count} moments with a pose, {lost} without");
    Judged { median_mm: off[off.len() / 2], near, speed_mm_per_s: (square / count).sqrt() }
}
