//! What goes wrong while pictures come.

use crate::bench::Bench;
use anyhow::ensure;
use camera_v4l::{Config, DriverFormat, News, Trouble};

pub fn dropped_and_damaged(bench: &Bench) -> anyhow::Result<()> {
    let stream = bench.stream(bench.config(DriverFormat::Grey));
    stream.next()?;
    bench.turn("percentage_of_dropped_buffers", 50)?;
    stream.until("lost pictures", |counts| counts.lost >= 8)?;
    bench.turn("percentage_of_dropped_buffers", 0)?;
    bench.turn("inject_v4l2_buf_flag_error", 1)?;
    stream.until("damaged pictures", |counts| counts.damaged >= 1)?;
    let pictures = stream.capture.counts().pictures;
    stream.until("pictures afterwards", |counts| counts.pictures > pictures + 5)?;
    println!("    {:?}", stream.capture.counts());
    Ok(())
}

pub fn broken_stream(bench: &Bench) -> anyhow::Result<()> {
    let stream = bench.stream(bench.config(DriverFormat::Grey));
    stream.next()?;
    bench.turn("inject_fatal_streaming_error", 1)?;
    stream.hears("the broken stream", |news| matches!(news, News::Trouble(Trouble::Stream { .. })))?;
    stream.hears("the new stream", |news| matches!(news, News::Streaming(_)))?;
    stream.next()?;
    ensure!(stream.capture.counts().starts == 2, "{:?}", stream.capture.counts());
    Ok(())
}

/// What is set here, and what somebody else sets while the camera is away.
const SET: [(&str, i64, i64); 3] = [("brightness", 77, 201), ("gain", 40, 90), ("gain_automatic", 0, 1)];

/// vivid comes back by itself as soon as nobody has it open any more; the link that leads to it is taken away and put
/// back as udev does.
pub fn unplugged(bench: &Bench) -> anyhow::Result<()> {
    let controls = [("brightness".to_owned(), 77)].into();
    let stream = bench.stream(Config { controls, gain: Some(40), ..bench.config(DriverFormat::Yuyv) });
    let before = stream.next()?;
    std::fs::remove_file(&bench.by_id)?;
    bench.turn("disconnect", 1)?;
    stream.hears("the unplugging", |news| matches!(news, News::Trouble(Trouble::Unplugged { .. })))?;
    stream.hears("the missing camera", |news| matches!(news, News::Trouble(Trouble::NotThere { .. })))?;
    are_set(bench)?;
    SET.iter().try_for_each(|(knob, _, disturbed)| bench.turn(knob, *disturbed))?;
    bench.link()?;
    stream.hears("the camera again", |news| matches!(news, News::Streaming(_)))?;
    let after = stream.next()?;
    ensure!(after.layout == before.layout, "{:?} {:?}", before.layout, after.layout);
    are_set(bench)?;
    drop(stream);
    bench.turn("brightness", 128)
}

fn are_set(bench: &Bench) -> anyhow::Result<()> {
    for (knob, set, _) in SET {
        let found = bench.read(knob)?;
        ensure!(found == set, "{knob} is {found}, not {set}");
    }
    Ok(())
}
