//! The page and the JSON, as a reader meets them.

use formats::mesh::LoadedMesh;
use geometry::{TriangleMesh, compare, distances_to};
use nalgebra::Point3;
use report::{
    BorderError, Exhibits, Machine, PageError, Refined, Refused, Report, Stage, TrackerNoise, caps, closed, four_views,
    render,
};

/// A tetrahedron of 40 mm, moved by `shift_m` along x.
fn tetrahedron(shift_m: f32) -> LoadedMesh {
    let corners = [[0.0, 0.0, 0.0], [0.04, 0.0, 0.0], [0.0, 0.04, 0.0], [0.0, 0.0, 0.04]];
    let mesh = TriangleMesh {
        vertices: corners.map(|[x, y, z]| Point3::new(x + shift_m, y, z)).to_vec(),
        colours: vec![[200, 30, 30], [30, 200, 30], [30, 30, 200], [220, 220, 220]],
        triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        ..TriangleMesh::default()
    };
    LoadedMesh { mesh, texture: None }
}

fn full() -> Report {
    let comparison = compare(&tetrahedron(1e-4).mesh, &tetrahedron(0.0).mesh, None, 1).expect("two surfaces");
    let refused = vec![Refused { reason: "depth < gate & \"odd\"".into(), count: 7 }];
    Report {
        title: "<script>alert(1)</script>".into(),
        machine: Machine::here(),
        stages: vec![Stage { node: "triangulate/head".into(), received: 1234, refused, ..Stage::default() }],
        comparison: Some(comparison),
        ..Report::default()
    }
}

fn page(report: &Report, exhibits: &Exhibits<'_>) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("report.html");
    report.write_html(&path, exhibits).expect("a page");
    std::fs::read_to_string(path).expect("what was written")
}

#[test]
fn the_page_stands_alone_and_takes_no_markup_from_names() {
    let (model, truth) = (tetrahedron(1e-4), tetrahedron(0.0));
    let html = page(&full(), &Exhibits { model: Some(&model), truth: Some(&truth), ..Exhibits::default() });
    for outside in ["http://", "https://", "<script", "<link", "@import", "url(h"] {
        assert!(!html.contains(outside), "{outside}");
    }
    assert!(html.contains("&lt;script&gt;") && html.contains("depth &lt; gate &amp; &quot;odd&quot;"));
    assert_eq!(html.matches("data:image/png;base64,").count(), 16);
    assert!(html.contains("No message was lost.") && html.contains("1\u{202f}234"));
    assert_eq!(
        html,
        page(&full(), &Exhibits { model: Some(&model), truth: Some(&truth), ..Exhibits::default() }),
        "same input, same bytes"
    );
}

#[test]
fn borders_of_colour_are_told_on_the_page_and_in_the_json() {
    let borders = BorderError { places: 5023, lost: 2, unseen: 999, rms_mm: 0.0504, median_mm: 0.03, p95_mm: 0.088 };
    let report = Report { borders: Some(borders), ..full() };
    let html = page(&report, &Exhibits::default());
    for told in ["Borders between patches of colour", "0.050 mm", "5\u{202f}023", ">999<"] {
        assert!(html.contains(told), "{told}");
    }
    let json = serde_json::to_string(&report).expect("plain numbers");
    assert_eq!(serde_json::from_str::<Report>(&json).expect("its own words").borders, Some(borders));
    assert!(!page(&full(), &Exhibits::default()).contains("Borders between"));
}

#[test]
fn what_nobody_measured_is_told_apart_and_held_against_the_truth() {
    // Three of the four faces were measured; the fourth, which closes it, stands 0.1 mm off.
    let (model, truth) = (tetrahedron(1e-4), tetrahedron(0.0));
    let triangles = model.mesh.triangles.clone();
    let surface = wire::Mesh {
        header: wire::Header::default(),
        vertices_m: model.mesh.vertices.iter().map(|p| (*p).into()).collect(),
        normals: vec![].into(),
        sigma_m: vec![].into(),
        triangles: triangles.into(),
        measured: 3,
    };
    let told = closed(&surface).expect("a surface");
    // The slanted face has sqrt(3) / (3 + sqrt(3)) of the area, and stands 0.1 / sqrt(3) mm off.
    assert!(told.watertight && told.open_edges == 0 && (told.unmeasured_share - 0.3660).abs() < 1e-3, "{told:?}");
    let caps = distances_to(&caps(&surface), &truth.mesh, 1).expect("two surfaces");
    assert!((caps.rms_mm - 0.0577).abs() < 2e-3, "{caps:?}");
    let measured = compare(&TriangleMesh::from(&surface.without_caps()), &truth.mesh, None, 1).expect("two surfaces");
    let told = told.against(Some(caps), &measured.model_to_truth);
    let whole = compare(&model.mesh, &truth.mesh, None, 1).expect("two surfaces").model_to_truth.rms_mm;
    assert!((told.rms_mm.expect("it has a truth") - whole).abs() < 2e-3, "{told:?} {whole}");
    let report = Report { closed: Some(told), ..full() };
    let exhibits = Exhibits { model: Some(&model), measured: Some(3), truth: Some(&truth), ..Exhibits::default() };
    let html = page(&report, &exhibits);
    assert_eq!(html.matches("data:image/png;base64,").count(), 20, "a row more, from below");
    assert!(html.contains("every edge has two triangles") && html.contains("nobody measured"));
    let open = closed(&surface.without_caps()).expect("a surface");
    assert!(!open.watertight && open.open_edges == 3 && open.unmeasured_share == 0.0);
    assert!(page(&Report { closed: Some(open), ..full() }, &Exhibits::default()).contains("no: 3 edges are open"));
}

/// The row of pictures of this name.
fn figure<'a>(html: &'a str, name: &str) -> &'a str {
    let from = html.find(&format!("<b>{name}</b>")).unwrap_or_else(|| panic!("no row {name}"));
    html[from..].split("</figure>").next().expect("it ends")
}

#[test]
fn the_error_is_drawn_on_what_was_measured_as_the_expected_one_is() {
    let (closed, truth) = (tetrahedron(1e-4), tetrahedron(0.0));
    let mut open = closed.clone();
    open.mesh.triangles.truncate(3);
    let sigma_m = vec![1e-4; open.mesh.vertices.len()];
    let alone = Exhibits { model: Some(&open), truth: Some(&truth), ..Exhibits::default() };
    let capped = Exhibits { model: Some(&closed), measured: Some(3), ..alone };
    let stated = Exhibits { stated: Some((&open.mesh, &sigma_m)), ..capped };
    let all = Exhibits { measured: None, ..capped };
    let [alone, capped, stated, all] = [alone, capped, stated, all].map(|exhibits| page(&full(), &exhibits));
    assert_eq!(figure(&alone, "Error"), figure(&capped, "Error"));
    assert_eq!(figure(&alone, "Error"), figure(&stated, "Error"));
    assert_ne!(figure(&alone, "Error"), figure(&all, "Error"), "the cap is seen from one of the sides");
    assert_ne!(figure(&alone, "Shape"), figure(&capped, "Shape"), "the model itself is shown closed");
    assert!(figure(&stated, "Expected error").matches("data:image/png").count() == 4);
}

#[test]
fn what_refinement_held_fast_or_was_not_asked_is_no_zero() {
    let tracker = TrackerNoise { position_mm: 0.87, rotation_deg: 1.73, excess: Some(0.66), inflation: 30.0 };
    let asked = Refined {
        rotation_lag_ms: [4.25, 0.31],
        tracker,
        hand_eye_freed: true,
        hand_eye_turn_deg: 0.52,
        hand_eye_turn_sigma_deg: 0.11,
        frames_dropped: 7,
        frames_unheld: 2,
        ..Refined::default()
    };
    let of =
        |refinement: &Refined| page(&Report { refinement: Some(refinement.clone()), ..full() }, &Exhibits::default());
    let html = of(&asked);
    for told in [
        "4.25 \u{b1} 0.31 ms",
        "0.52 \u{b1} 0.11 degrees",
        "0.87 mm",
        "1.73 degrees",
        "0.66 times",
        "30.0 times less",
        "5 that fit nowhere, 2 that nothing held",
    ] {
        assert!(html.contains(told), "{told}");
    }
    let html = of(&Refined::default());
    for told in [">not asked<", ">held<", "too little was seen to tell", "as their noise allows"] {
        assert!(html.contains(told), "{told}");
    }
    let json = serde_json::to_string(&asked).expect("plain numbers");
    assert_eq!(serde_json::from_str::<Refined>(&json).expect("its own words"), asked);
}

#[test]
fn a_loss_or_a_failure_is_told_at_the_head() {
    let mut report = full();
    report.stages[0].lost = 3;
    report.failures = vec!["surface/all stopped: out of memory".into()];
    assert!(!report.is_good());
    let html = page(&report, &Exhibits::default());
    let head = html.split("<h2>").next().unwrap();
    assert!(head.contains("3 messages were lost.") && head.contains("surface/all stopped"));
}

#[test]
fn an_empty_report_is_a_short_page() {
    let html = page(&Report::default(), &Exhibits::default());
    assert!(html.contains("<h1>A scan</h1>") && !html.contains("<h2>"), "{html}");
    assert!(!html.contains("NaN"));
}

#[test]
fn the_json_comes_back_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("report.json");
    let report = full();
    report.write_json(&path).unwrap();
    let back: Report = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let mut expected = report;
    expected.comparison.as_mut().unwrap().signed_mm.clear();
    assert_eq!(back, expected);
}

#[test]
fn a_surface_that_cannot_be_shown_is_named() {
    let nothing = LoadedMesh { mesh: TriangleMesh::default(), texture: None };
    let exhibits = Exhibits { model: Some(&nothing), ..Exhibits::default() };
    let folder = tempfile::tempdir().unwrap();
    let refused = Report::default().write_html(&folder.path().join("report.html"), &exhibits);
    assert!(matches!(refused, Err(PageError::Surface(_))));
}

#[test]
fn every_view_holds_the_whole_thing_and_fills_the_picture() {
    let mesh = tetrahedron(0.0).mesh;
    let views = four_views(&mesh, 200, 160);
    assert_eq!(views.len(), 4);
    let mut largest = 0.0f64;
    for view in views {
        for p in &mesh.vertices {
            let pixel = view.camera.project(&(view.camera_from_world * p.map(f64::from))).unwrap();
            assert!(view.camera.contains(&pixel));
            largest = largest.max((pixel.x - 99.5).abs() / 100.0).max((pixel.y - 79.5).abs() / 80.0);
        }
        let picture = render(&mesh, &view, |_, _| [1.0, 0.0, 0.0]);
        let drawn = picture.pixels().filter(|p| p.0[3] == 255).count();
        assert!(drawn > 200 * 160 / 8, "{drawn} pixels");
        assert!(picture.pixels().all(|p| p.0[1] == 0 && p.0[2] == 0), "only the colour that was given");
        assert_eq!(picture.get_pixel(0, 0).0[3], 0, "nothing is transparent");
    }
    assert!(largest > 0.9 && largest < 0.95, "{largest}");
}
