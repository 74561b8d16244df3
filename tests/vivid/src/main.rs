//! Runs inside the machine that `tests/vivid/run` boots: the camera node and its parts before the kernel's driver of test
//! pictures, vivid. `v4l2-ctl` is the independent hand that turns vivid's knobs.
//!
//! What is not asserted, because vivid does not keep to it under emulation: exact rates, and numbers without gaps.

mod bench;
mod faults;
mod node;
mod pictures;
mod rig;
mod settings;

use bench::Bench;

type Proof = fn(&Bench) -> anyhow::Result<()>;

const PROOFS: &[(&str, Proof)] = &[
    ("the camera is listed with its formats, rates and controls", settings::is_listed),
    ("what the driver replaces in silence is refused", settings::substitutes_are_refused),
    ("what is no camera, and what is not there, is named", settings::what_is_no_camera),
    ("a camera that streams is busy for others", settings::is_busy),
    ("the pixels are the test picture's, in every format", pictures::are_the_pattern),
    ("levels of YUYV are read as the driver says, full range or limited", pictures::are_of_the_drivers_range),
    ("stamps are the middle of exposure on the system clock", pictures::are_stamped),
    ("the newest picture is held, however slow the node is", pictures::are_fresh),
    ("dropped and damaged buffers are counted", faults::dropped_and_damaged),
    ("a stream that breaks is started again", faults::broken_stream),
    ("an unplugged camera is opened again by its name, and set again", faults::unplugged),
    ("the node sends its pictures on a bus, and goes on behind an unplugging", node::sends_its_pictures),
    (
        "the node counts what is lost and damaged, and goes on behind a broken stream and signals",
        node::goes_on_whatever_happens,
    ),
];

fn main() -> anyhow::Result<()> {
    if std::env::args().nth(1).as_deref() == Some("node") {
        return node::run();
    }
    let bench = Bench::new()?;
    for (claim, proof) in PROOFS {
        proof(&bench).map_err(|error| error.context(format!("NOT PROVEN: {claim}")))?;
        println!("proven: {claim}");
    }
    Ok(())
}
