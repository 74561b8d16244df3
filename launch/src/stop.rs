//! The ladder by which nodes are stopped, each rung with its time: end the scan, close standard input, SIGTERM, SIGKILL.

use crate::board::{Board, Status};
use crate::plan::Run;
use std::time::Duration;
use tokio::sync::{Notify, watch};

/// How far down the ladder the nodes are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rung {
    /// They work; who fails is started again.
    Run,
    /// They finish the scan; who fails stays down.
    Finish,
    /// Their standard input is closed: they put their things away and end.
    Close,
    /// SIGTERM.
    Term,
    /// SIGKILL.
    Kill,
}

/// What the kernel may need to bury a killed process.
const BURIAL: Duration = Duration::from_secs(10);

/// Goes down from `Finish` until no node of this launcher lives. `hurry` skips the rest of a rung's time. Returns the
/// rung on which the last node went.
pub(crate) async fn descend(
    run: &Run,
    board: &Board,
    rung: &watch::Sender<Rung>,
    hurry: &Notify,
    scanning: bool,
) -> Rung {
    let gone = |status: &Status| !status.nodes.values().any(crate::board::NodeStatus::is_alive);
    let finish = if scanning { run.end } else { Duration::ZERO };
    let rungs = [(Rung::Finish, finish), (Rung::Close, run.close), (Rung::Term, run.term), (Rung::Kill, BURIAL)];
    for (next, time) in rungs {
        rung.send_replace(next);
        let mut status = board.watch();
        let done = |status: &Status| gone(status) || (next == Rung::Finish && status.all_finished());
        tokio::select! {
            _ = tokio::time::timeout(time, status.wait_for(done)) => {}
            () = hurry.notified() => {}
        }
        if gone(&board.status()) {
            return next;
        }
    }
    Rung::Kill
}
