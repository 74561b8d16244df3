//! How the page is laid out before the operator moves anything.

use rerun::blueprint::components::PanelState;
use rerun::blueprint::{
    Blueprint, BlueprintPanel, Horizontal, SelectionPanel, Spatial2DView, Spatial3DView, Tabs, TextDocumentView,
    TextLogView, TimePanel, TimeSeriesView, Vertical,
};

/// The thing on the left, and behind it how refinement goes; the camera, the plots and the log on the right.
pub(crate) fn blueprint() -> Blueprint {
    let plots = Tabs::new([
        TimeSeriesView::new("Latency, ms").with_origin("plots/latency_ms").into(),
        TimeSeriesView::new("Rates, 1/s").with_origin("plots/rate").into(),
        TimeSeriesView::new("Lost").with_origin("plots/lost").into(),
    ]);
    let right = Vertical::new([
        Spatial2DView::new("Camera").with_origin("world/camera/picture").into(),
        plots.into(),
        TextLogView::new("Log").with_origin("log").into(),
    ])
    .with_row_shares([3.0, 2.0, 1.5]);
    let world = Tabs::new([Spatial3DView::new("The thing").with_origin("world").into(), refinement().into()]);
    Blueprint::new(Horizontal::new([world.into(), right.into()]).with_column_shares([3.0, 2.0]))
        .with_blueprint_panel(BlueprintPanel::from_state(PanelState::Collapsed))
        .with_selection_panel(SelectionPanel::from_state(PanelState::Collapsed))
        .with_time_panel(TimePanel::new().with_state(PanelState::Collapsed))
}

/// The hand's way as the tracker had it and as it is now, and what the refinement rests on.
fn refinement() -> Horizontal {
    let plot = |name: &str, of: &str| TimeSeriesView::new(name).with_origin(format!("refine/{of}"));
    let plots = Tabs::new([
        plot("Each picture, mm", "frames").into(),
        plot("Off the surface, mm", "fit").into(),
        plot("Pose offset, ms", "offset").into(),
        plot("Left out", "left_out").into(),
        plot("Crossed and held, of 1", "observed").into(),
    ]);
    let facts = TextDocumentView::new("What it rests on").with_origin("refine/facts");
    let told = Vertical::new([facts.into(), plots.into()]).with_row_shares([3.0, 2.0]);
    let way = Spatial3DView::new("The hand's way, by tracker and refined").with_origin("way");
    Horizontal::new([way.into(), told.into()]).with_column_shares([3.0, 2.0]).with_name("Refinement")
}
