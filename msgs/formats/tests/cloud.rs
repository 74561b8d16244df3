//! Points there and back, and as others write them.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use formats::cloud;
use proptest::prelude::*;
use wire::CloudPoint;

fn read(name: &str, text: &str) -> Result<Vec<CloudPoint>, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    cloud::read(&path).map_err(|e| e.to_string())
}

prop_compose! {
    fn any_point()(
        position_m in prop::array::uniform3(-10_f32..10.0),
        normal in prop::array::uniform3(-1_f32..1.0),
        spread_m in 0_f32..1.0,
        sigma_m in 0_f32..1.0,
        count in any::<u32>(),
        id in any::<u32>(),
        colour in prop_oneof![Just([0; 4]), prop::array::uniform3(any::<u8>()).prop_map(|[r, g, b]| [r, g, b, 255])],
    ) -> CloudPoint {
        CloudPoint { position_m, normal, spread_m, sigma_m, count, id, colour }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn nothing_is_lost_on_the_way(points in prop::collection::vec(any_point(), 1..50)) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cloud.ply");
        cloud::write_ply(&path, &points).unwrap();
        prop_assert_eq!(cloud::read(&path).unwrap(), points);
    }
}

#[test]
fn bare_points_of_others() {
    let bare = CloudPoint { position_m: [1.0, 2.0, 3.0], count: 1, ..CloudPoint::default() };
    assert_eq!(read("p.xyz", "# x y z\n1 2 3\n").unwrap(), [bare]);
    let whole = CloudPoint { normal: [0.0, 0.0, 1.0], colour: [9, 8, 7, 255], ..bare };
    assert_eq!(read("p.xyz", "1 2 3 0 0 1 9 8 7\n").unwrap(), [whole]);
    let csv = "z,y,x,intensity,nz,sigma_m\n3,2,1,99,1,0.5\n";
    assert_eq!(read("p.csv", csv).unwrap(), [CloudPoint { normal: [0.0, 0.0, 1.0], sigma_m: 0.5, ..bare }]);
}

#[test]
fn faults_are_named() {
    for (name, text, wanted) in [
        ("p.xyz", "1 2 3\n4 5\n", "line 2: 2 numbers, where 3, 6 or 9 are understood"),
        ("p.xyz", "1 2 three\n", "line 1: \"three\" is no number"),
        ("p.xyz", "1 2 inf\n", "point 0 is not finite"),
        ("p.xyz", "", "holds no points"),
        ("p.csv", "x,y\n1,2\n", "column \"z\" is missing"),
        ("p.pcd", "", "\"pcd\" is not understood; known are ply, xyz, csv"),
    ] {
        let complaint = read(name, text).unwrap_err();
        assert!(complaint.contains(wanted), "{complaint:?} does not say {wanted:?}");
    }
    let error = cloud::write_ply(std::path::Path::new("/tmp/empty.ply"), &[]).unwrap_err();
    assert_eq!(error.to_string(), "/tmp/empty.ply: not written, because the cloud has no points");
}
