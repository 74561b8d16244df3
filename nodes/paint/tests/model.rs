//! Models of nothing, of broken surfaces; the same bytes every time; pictures that wait.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod scene;

use paint::{Config, ConfigError, FrameRefusal, FrameStore, Painter, PainterError, SurfaceError};
use proptest::prelude::*;
use scene::*;
use wire::{CameraIntrinsics, Frame, codec};

const SPHERE: Shape = Shape::Sphere { centre: nalgebra::Point3::new(0.0, 0.0, 0.0), radius: 0.03 };

fn painter() -> Painter {
    Painter::new(Config::default(), &calibration(&CAMERA)).unwrap()
}

fn views() -> Vec<(Frame, nalgebra::Isometry3<f64>)> {
    let world = World::of(vec![(SPHERE, checker)]);
    let eye = |i: u64| {
        let turn = 0.35 * i as f64;
        look_at([0.23 * turn.cos(), 0.23 * turn.sin(), 0.05], [0.0; 3])
    };
    (0..18).map(|i| (world.frame(&CAMERA, &eye(i), i), eye(i))).collect()
}

#[test]
fn without_a_surface_the_model_is_empty() {
    let mut painter = painter();
    let (frame, pose) = (frame_of(&CAMERA, vec![90; 3 * 640 * 512], 0), look_at([0.0, 0.0, 0.2], [0.0; 3]));
    assert_eq!(painter.frame(&frame, &pose), Err(FrameRefusal::NoSurface));
    let (model, evidence) = painter.model();
    assert!(model.texture.is_empty() && model.mesh.triangles.is_empty());
    assert_eq!(evidence, paint::Evidence::default());
    assert!(painter.preview_colours().is_empty());
}

#[test]
fn without_a_frame_the_model_is_grey() {
    let mut painter = painter();
    painter.mesh(&sphere_mesh([0.0; 3], 0.03, 10)).unwrap();
    let (model, evidence) = painter.model();
    assert!(model.texture.iter().all(|texel| *texel == [128, 128, 128, 0]));
    assert_eq!((evidence.seen, evidence.filled, evidence.grey), (0, 0, evidence.cells));
    assert!(evidence.cells > 10_000);
    assert_eq!(model.texture.len(), (model.texture_width * model.texture_height) as usize);
    assert!(model.texture_width.is_multiple_of(4) && model.texture_height.is_multiple_of(4));
    assert_eq!(model.mesh.normals.len(), model.mesh.vertices_m.len());
    assert_eq!(model.uv.len(), model.mesh.vertices_m.len());
}

#[test]
fn a_broken_surface_is_refused_and_the_one_before_stays() {
    let mut painter = painter();
    let good = sphere_mesh([0.0; 3], 0.03, 4);
    painter.mesh(&good).unwrap();
    assert!(matches!(painter.mesh(&mesh_of(vec![], vec![])), Err(SurfaceError::Mesh(_))));
    assert!(matches!(painter.mesh(&mesh_of(vec![[0.0; 3]], vec![[0, 0, 7]])), Err(SurfaceError::Mesh(_))));
    let mut bad = good.clone();
    bad.vertices_m[3][1] = f32::NAN;
    assert!(matches!(painter.mesh(&bad), Err(SurfaceError::Mesh(_))));
    bad.vertices_m[3][1] = 1e9;
    assert!(matches!(painter.mesh(&bad), Err(SurfaceError::Far { index: 3, .. })));
    assert_eq!(painter.model().0.mesh.triangles.len(), good.triangles.len());
    // Normals that are none are made anew.
    bad = good.clone();
    bad.normals = vec![[f32::NAN; 3]; good.vertices_m.len()].into();
    painter.mesh(&bad).unwrap();
    assert!(painter.model().0.mesh.normals.iter().flatten().all(|c| c.is_finite()));
}

#[test]
fn triangles_without_area_are_carried_along() {
    let mut mesh = sphere_mesh([0.0; 3], 0.03, 6);
    mesh.triangles.extend([[0, 0, 0], [0, 1, 1], [5, 6, 5]]);
    let mut painter = painter();
    painter.mesh(&mesh).unwrap();
    for (frame, pose) in &views()[..2] {
        painter.frame(frame, pose).unwrap();
    }
    let (model, _) = painter.model();
    assert_eq!(model.mesh.triangles.len(), mesh.triangles.len());
    assert!(model.uv.iter().flatten().all(|c| (0.0..=1.0).contains(c)));
}

#[test]
fn the_same_bytes_on_any_number_of_threads_and_in_any_order() {
    let (views, mesh) = (views(), sphere_mesh([0.0; 3], 0.03, 24));
    let run = |threads: usize, backwards: bool| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut painter = painter();
            painter.mesh(&mesh).unwrap();
            let mut order: Vec<_> = views.iter().collect();
            if backwards {
                order.reverse();
            }
            for (frame, pose) in order {
                painter.frame(frame, pose).unwrap();
            }
            let (model, evidence) = painter.model();
            (codec::encode(&model), evidence)
        })
    };
    let once = run(1, false);
    assert!(once.1.seen > 3000);
    assert!(once == run(3, false));
    assert!(once == run(2, true));
}

#[test]
fn stored_pictures_paint_as_live_ones_do() {
    let (views, mesh) = (views(), sphere_mesh([0.0; 3], 0.03, 12));
    let (mut live, mut late, mut store) = (painter(), painter(), FrameStore::new(1 << 30));
    live.mesh(&mesh).unwrap();
    for (frame, pose) in &views {
        live.frame(frame, pose).unwrap();
        store.push(late.crop(frame).unwrap());
    }
    late.mesh(&mesh).unwrap();
    for (picture, (_, pose)) in store.pictures().zip(&views) {
        late.picture(picture, pose).unwrap();
    }
    assert!(live.model() == late.model());
    let preview = live.preview_colours();
    assert_eq!(preview.len(), mesh.vertices_m.len());
    assert!(preview.iter().filter(|c| c[3] == 255).count() > preview.len() / 5);
}

#[test]
fn a_full_store_thins_out_evenly() {
    let mut painter = painter();
    let frame = frame_of(&CAMERA, vec![90; 3 * 640 * 512], 0);
    let one = std::mem::size_of_val(painter.crop(&frame).unwrap().pixels.as_slice());
    assert!(one < 640 * 512 * 3 / 2, "only the working region is kept: {one} bytes");
    let mut store = FrameStore::new(10 * one);
    for seq in 0..100 {
        let mut picture = painter.crop(&frame).unwrap();
        picture.header.seq = seq;
        store.push(picture);
        assert!(store.bytes() <= 10 * one);
    }
    let kept: Vec<u64> = store.pictures().map(|p| p.header.seq).collect();
    assert_eq!(kept, [0, 16, 32, 48, 64, 80, 96]);
    assert_eq!(store.thinned(), 93);
    assert_eq!(store.spread(3).map(|p| p.header.seq).collect::<Vec<_>>(), [0, 48, 96]);
    store.clear();
    assert_eq!((store.pictures().len(), store.thinned(), store.bytes()), (0, 0, 0));
}

#[test]
fn settings_that_cannot_be_are_named() {
    let refused = |config: Config| match Painter::new(config, &calibration(&CAMERA)) {
        Err(PainterError::Config(ConfigError { key, .. })) => key,
        other => panic!("{other:?}"),
    };
    assert_eq!(refused(Config { cell_mm: f64::NAN, ..Config::default() }), "cell_mm");
    assert_eq!(refused(Config { samples_per_cell: 0, ..Config::default() }), "samples_per_cell");
    assert_eq!(refused(Config { ambient: Some([0.0, -1.0, 0.0]), ..Config::default() }), "ambient");
    let mut rig = calibration(&CAMERA);
    rig.camera = CameraIntrinsics { cx: 1e5, ..rig.camera };
    assert!(matches!(
        Painter::new(Config::default(), &rig),
        Err(PainterError::Region(_)) | Err(PainterError::Camera(_))
    ));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn no_frame_panics(
        (width, height, stride) in (0u32..700, 0u32..600, 0u32..3000),
        data in prop::collection::vec(any::<u8>(), 0..64),
        repeat in 0usize..20_000,
        (gain, gamma) in (any::<f32>(), any::<f32>()),
        eye in prop::array::uniform3(-0.3f64..0.3),
    ) {
        let mut painter = painter();
        painter.mesh(&sphere_mesh([0.0; 3], 0.03, 4)).unwrap();
        let whole = frame_of(&CAMERA, data.repeat(repeat), 1);
        let pose = look_at(eye, [0.0, 0.0, 0.01]);
        let _ = painter.frame(&Frame { width, height, stride, gain, gamma, ..whole.clone() }, &pose);
        let mut whole = whole;
        whole.data.resize(3 * 640 * 512, 7);
        let _ = painter.frame(&Frame { gain, gamma, ..whole }, &pose);
        let (model, _) = painter.model();
        prop_assert!(model.uv.iter().flatten().all(|c| c.is_finite()));
    }
}
