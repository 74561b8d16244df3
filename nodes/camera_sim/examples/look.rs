//! A picture as the simulated camera sends it:
//! `cargo run --release -p camera_sim --no-default-features --example look -- RIG.toml SECONDS NUMBER OUT.png`

use camera_sim::{CameraSim, Config};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [rig, seconds, number, out] = arguments.as_slice() else {
        return Err("say RIG.toml SECONDS NUMBER OUT.png".into());
    };
    let config = Config { rig: rig.into(), seconds: seconds.parse()?, ..Config::default() };
    let frame = CameraSim::open(&config)?.frame(number.parse()?);
    println!("laser {}, lamp {}, gain {}", frame.light.laser, frame.light.lamp, frame.gain);
    formats::image_file::write_frame(out.as_ref(), &frame)?;
    Ok(())
}
