//! What goes wrong while pictures come.

use crate::bench::Bench;
use anyhow::ensure;
use camera_v4l::{DriverFormat, News, Trouble};

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

/// vivid comes back by itself as soon as nobody has it open any more; the link that leads to it is taken away and put
/// back as udev does.
pub fn unplugged(bench: &Bench) -> anyhow::Result<()> {
    let stream = bench.stream(bench.config(DriverFormat::Yuyv));
    let before = stream.next()?;
    std::fs::remove_file(&bench.by_id)?;
    bench.turn("disconnect", 1)?;
    stream.hears("the unplugging", |news| matches!(news, News::Trouble(Trouble::Unplugged { .. })))?;
    stream.hears("the missing camera", |news| matches!(news, News::Trouble(Trouble::NotThere { .. })))?;
    bench.link()?;
    stream.hears("the camera again", |news| matches!(news, News::Streaming(_)))?;
    let after = stream.next()?;
    ensure!(after.layout == before.layout, "{:?} {:?}", before.layout, after.layout);
    Ok(())
}
