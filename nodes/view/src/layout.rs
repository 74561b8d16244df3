//! How the page is laid out before the operator moves anything.

use rerun::blueprint::components::PanelState;
use rerun::blueprint::{
    Blueprint, BlueprintPanel, Horizontal, SelectionPanel, Spatial2DView, Spatial3DView, Tabs, TextLogView, TimePanel,
    TimeSeriesView, Vertical,
};

/// The thing on the left, and behind it how the hand went; the camera, the plots and the log on the right.
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
    let world = Tabs::new([
        Spatial3DView::new("The thing").with_origin("world").into(),
        Spatial3DView::new("The hand's way, by tracker and refined").with_origin("way").into(),
    ]);
    Blueprint::new(Horizontal::new([world.into(), right.into()]).with_column_shares([3.0, 2.0]))
        .with_blueprint_panel(BlueprintPanel::from_state(PanelState::Collapsed))
        .with_selection_panel(SelectionPanel::from_state(PanelState::Collapsed))
        .with_time_panel(TimePanel::new().with_state(PanelState::Collapsed))
}
