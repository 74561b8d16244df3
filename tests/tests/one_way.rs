//! A hand that only goes around: what its sweep cannot tell is said, and nothing is made worse.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use system_tests::{limn, lost, number, report, succeed};

#[test]
fn the_missing_stroke_is_named_and_refinement_does_no_harm() {
    let folder = tempfile::tempdir().unwrap();
    let mut demo = limn();
    demo.args(["demo", "--headless", "--rig", "field", "--scene", "one_way", "--seconds", "40", "--out"])
        .arg(folder.path());
    let output = succeed(&mut demo);
    let table = String::from_utf8(output.stdout).unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    let notice = table.lines().find(|line| line.contains("NOTE") && line.contains("strokes cross on"));
    let notice = notice.unwrap_or_else(|| panic!("no word of strokes that do not cross:\n{table}"));
    assert!(notice.contains("sweep") || notice.contains("stroke"), "which stroke would help: {notice}");
    assert!(said.contains("strokes cross on"), "and while it runs: {said}");

    let told = report(folder.path());
    assert_eq!(lost(&told), 0);
    assert!(number(&told, "/refinement/observed/crossing") < 0.5, "{told:#}");
    let refined = number(&told, "/aligned/comparison/model_to_truth/rms_mm");
    // Where the tracker alone gives no surface at all, there is nothing to be worse than.
    if told.pointer("/refinement/without/comparison").is_some() {
        let smoothed = number(&told, "/refinement/without/comparison/model_to_truth/rms_mm");
        println!("{refined:.3} mm rms, {smoothed:.3} without refinement");
        assert!(refined <= smoothed, "{refined} mm rms, {smoothed} without refinement");
    }
}
