//! By which clock cameras and trackers stamp.

use crate::plan::Plan;

/// Trackers whose stamps have nothing to do with those of a camera: no picture would find its pose.
pub(crate) fn warnings(plan: &Plan) -> Vec<String> {
    let cameras = plan.nodes.iter().filter_map(|node| match node.kind.as_str() {
        "camera_sim" => Some((&node.name, true, "from the beginning of the scan")),
        "camera_v4l" => Some((&node.name, false, "on the system clock")),
        _ => None,
    });
    let mut warnings = Vec::new();
    for (camera, wanted, stamps) in cameras {
        let says = |node: &&crate::planned::PlannedNode| node.config.get("scan_clock") == Some(&(!wanted).into());
        for tracker in plan.nodes.iter().filter(says).map(|node| &node.name) {
            warnings.push(format!(
                "{camera} stamps {stamps} and {tracker} does not, so no picture would find its pose: set \
                 {tracker}.scan_clock = {wanted}"
            ));
        }
    }
    warnings
}
