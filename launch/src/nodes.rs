//! All nodes that are built into this program: the one table that `limn node`, launch files and `limn graph` read.

use crate::kind::{Inputs, Kind, check, defaults};
use serde_json::Value;
use wire::topic;

/// What most nodes have in common; each entry below says where it differs.
const PLAIN: Kind = Kind {
    name: "",
    about: "",
    source: false,
    paces: true,
    required: true,
    inputs: &[],
    paths: &[],
    takes: |_| Vec::new(),
    gives: |_| Vec::new(),
    takes_more: |_, _| Vec::new(),
    gives_more: |_, _| Vec::new(),
    defaults: || serde_json::Value::Null,
    check: |_| Ok(()),
    run: |_| Ok(()),
};

/// The kinds, sources first and then along the way of the data.
pub const KINDS: &[Kind] = &[
    Kind {
        name: "camera_sim",
        about: "pictures of a world that is known exactly",
        source: true,
        paths: &["scene", "object", "rig"],
        takes: |_| vec![topic::run_phase().key],
        gives: |node| {
            let (frame, colour) = (topic::frame(&node.instance).key, topic::colour(&node.instance).key);
            vec![frame, colour, topic::truth_trajectory(&node.instance).key]
        },
        defaults: defaults::<world::Setup>,
        check: |config| check(config, |_: &world::Setup| Ok::<_, String>(())),
        run: camera_sim::node::run,
        ..PLAIN
    },
    Kind {
        name: "tracker_sim",
        about: "where the simulated handset is, with an honest tracker's errors",
        source: true,
        paths: &["scene", "object", "rig"],
        takes: |_| vec![topic::run_phase().key],
        gives: |node| vec![topic::pose(&node.instance).key],
        defaults: defaults::<tracker_sim::Config>,
        check: |config| check(config, tracker_sim::Config::check),
        run: tracker_sim::node::run,
        ..PLAIN
    },
    Kind {
        name: "camera_v4l",
        about: "pictures from a camera on this machine, with the time of their exposure",
        source: true,
        inputs: &["rig", "stripe"],
        takes: |node| {
            let (calibration, stripe) = (topic::calibration(node.of("rig")).key, topic::stripe(node.of("stripe")).key);
            vec![topic::run_phase().key, calibration, stripe]
        },
        gives: |node| vec![topic::frame(&node.instance).key, topic::colour(&node.instance).key],
        defaults: defaults::<camera_v4l::Config>,
        check: |config| check(config, camera_v4l::Config::check),
        run: camera_v4l::node::run,
        ..PLAIN
    },
    Kind {
        name: "tracker_flock",
        about: "where the handset is, by an Ascension Flock of Birds on a serial port",
        source: true,
        takes: |_| vec![topic::run_phase().key],
        gives: |node| vec![topic::pose(&node.instance).key],
        gives_more: |node, config| further_sensors(node, config, "sensors"),
        defaults: defaults::<tracker_flock::Config>,
        check: |config| check(config, tracker_flock::Config::check),
        run: tracker_flock::node::run,
        ..PLAIN
    },
    Kind {
        name: "tracker_polhemus",
        about: "where the handset is, by a Polhemus Fastrak, Liberty or Patriot on a serial port",
        source: true,
        takes: |_| vec![topic::run_phase().key],
        gives: |node| vec![topic::pose(&node.instance).key],
        gives_more: |node, config| further_sensors(node, config, "stations"),
        defaults: defaults::<tracker_polhemus::Config>,
        check: |config| check(config, tracker_polhemus::Config::check),
        run: tracker_polhemus::node::run,
        ..PLAIN
    },
    Kind {
        name: "light",
        about: "laser and lamp on a serial port, switched as the phase wants them",
        source: true,
        paces: false,
        takes: |_| vec![topic::run_phase().key],
        defaults: defaults::<light::Config>,
        check: |config| check(config, light::Config::check),
        run: light::node::run,
        ..PLAIN
    },
    Kind {
        name: "replay",
        about: "plays a recording or a scan folder as if it were happening",
        source: true,
        inputs: &["camera", "tracker", "rig"],
        paths: &["file"],
        takes: |_| vec![topic::run_phase().key],
        gives: |node| {
            let camera = [topic::frame(node.of("camera")).key, topic::colour(node.of("camera")).key];
            let others = [topic::pose(node.of("tracker")).key, topic::calibration(node.of("rig")).key];
            camera.into_iter().chain(others).collect()
        },
        defaults: defaults::<replay::node::Config>,
        check: |config| check(config, replay_file),
        run: replay::node::run,
        ..PLAIN
    },
    Kind {
        name: "fuse",
        about: "several receivers on one handset made one pose, better turned than any of them",
        takes_more: |_, config| receivers(config),
        gives: |node| vec![topic::pose(&node.instance).key],
        defaults: defaults::<fuse::Config>,
        check: |config| check(config, fuse::Config::check),
        run: fuse::node::run,
        ..PLAIN
    },
    Kind {
        name: "stripe",
        about: "subpixel peaks of the laser line, each with its uncertainty",
        inputs: &["camera", "rig"],
        takes: |node| vec![topic::frame(node.of("camera")).key, topic::calibration(node.of("rig")).key],
        gives: |node| vec![topic::stripe(&node.instance).key],
        defaults: defaults::<stripe::Config>,
        check: |config| check(config, stripe::Config::check),
        run: stripe::node::run,
        ..PLAIN
    },
    Kind {
        name: "triangulate",
        about: "camera ray and laser sheet meet: lit points in the camera's frame",
        inputs: &["camera", "rig"],
        takes: |node| vec![topic::stripe(node.of("camera")).key, topic::calibration(node.of("rig")).key],
        gives: |node| vec![topic::profile(&node.instance).key],
        defaults: defaults::<triangulate::Config>,
        check: |config| check(config, triangulate::Config::check),
        run: triangulate::node::run,
        ..PLAIN
    },
    Kind {
        name: "register",
        about: "points and the camera's way in the world, by the tracker's poses",
        inputs: &["camera", "tracker", "rig"],
        takes: |node| {
            let (profile, pose) = (topic::profile(node.of("camera")).key, topic::pose(node.of("tracker")).key);
            vec![profile, pose, topic::calibration(node.of("rig")).key]
        },
        gives: |node| vec![topic::scan(&node.instance).key, topic::trajectory(&node.instance).key],
        defaults: defaults::<register::Config>,
        check: |config| check(config, register::Config::check),
        run: register::node::run,
        ..PLAIN
    },
    Kind {
        name: "refine",
        about: "the camera's way made consistent with the surface that it saw, and all points again on it",
        inputs: &["camera", "tracker", "world", "rig"],
        takes: |node| {
            let measured = [topic::profile(node.of("camera")).key, topic::pose(node.of("tracker")).key];
            let placed = [topic::scan(node.of("world")).key, topic::trajectory(node.of("world")).key];
            measured.into_iter().chain(placed).chain([topic::calibration(node.of("rig")).key]).collect()
        },
        gives: |node| {
            let placed = [topic::scan(&node.instance).key, topic::trajectory(&node.instance).key];
            placed.into_iter().chain([topic::refinement(&node.instance).key]).collect()
        },
        defaults: defaults::<refine::Config>,
        check: |config| check(config, refine::Config::check),
        run: refine::node::run,
        ..PLAIN
    },
    Kind {
        name: "cluster",
        about: "the paper's ball clustering: a thinned cloud, outliers gone",
        inputs: &["world"],
        takes: |node| vec![topic::scan(node.of("world")).key],
        gives: |_| vec![topic::cloud().key],
        defaults: defaults::<cluster::Config>,
        check: |config| check(config, cluster::Config::check),
        run: cluster::node::run,
        ..PLAIN
    },
    Kind {
        name: "surface",
        about: "the surface through the cloud: now and then a live one, and the clean one at the end",
        // Its messages are few and far between: a source that waited for them would wait for nothing.
        paces: false,
        takes: |_| vec![topic::cloud().key],
        gives: |_| vec![topic::mesh().key],
        defaults: defaults::<surface::Config>,
        check: |config| check(config, surface::Config::check),
        run: surface::node::run,
        ..PLAIN
    },
    Kind {
        name: "paint",
        about: "colour from the lamp-lit pictures onto the surface",
        inputs: &["camera", "world", "rig"],
        takes: |node| {
            let (camera, rig) = (node.of("camera"), node.of("rig"));
            vec![
                topic::colour(camera).key,
                topic::trajectory(node.of("world")).key,
                topic::mesh().key,
                topic::calibration(rig).key,
            ]
        },
        gives: |_| vec![topic::textured().key],
        defaults: defaults::<paint::Config>,
        check: |config| check(config, paint::Config::check),
        run: paint::node::run,
        ..PLAIN
    },
    Kind {
        name: "export",
        about: "writes cloud, surface and model as PLY, STL, OBJ and GLB",
        paces: false,
        takes: |_| vec![topic::cloud().key, topic::mesh().key, topic::textured().key],
        defaults: defaults::<export::Config>,
        check: |config| check(config, export::Config::check),
        run: export::node::run,
        ..PLAIN
    },
    Kind {
        name: "record",
        about: "keeps what cannot be computed again in an MCAP file",
        // What sources send, and the stripes: the rest can be computed again.
        takes: |_| {
            let sent = [topic::colour("*").key, topic::pose("*").key, topic::stripe("*").key];
            sent.into_iter().chain([topic::calibration("*").key, topic::run_phase().key]).collect()
        },
        defaults: defaults::<record::node::Config>,
        check: |config| check(config, record::node::check),
        run: record::node::run,
        ..PLAIN
    },
    #[cfg(feature = "view")]
    Kind {
        name: "view",
        about: "the operator's eyes: everything, live, in Rerun's web page",
        // A viewer that is stuck slows nobody, and one that dies ends nothing.
        paces: false,
        required: false,
        inputs: &["camera", "rig", "world"],
        takes: |node| {
            let (camera, rig, world) = (node.of("camera"), node.of("rig"), node.of("world"));
            let pictures = [topic::frame(camera).key, topic::colour(camera).key, topic::stripe(camera).key];
            let placed = [topic::scan(camera).key, topic::trajectory(camera).key, topic::calibration(rig).key];
            let refined = [topic::trajectory(world).key, topic::refinement(world).key];
            let made = [topic::cloud().key, topic::mesh().key, topic::textured().key];
            pictures.into_iter().chain(placed).chain(refined).chain(made).collect()
        },
        defaults: defaults::<view::Config>,
        check: |config| check(config, view::Config::check),
        run: |node| {
            let config: view::Config = node.spec().config()?;
            view::node::run(node, config)
        },
        ..PLAIN
    },
];

fn replay_file(config: &replay::node::Config) -> Result<(), &'static str> {
    if config.file.as_os_str().is_empty() {
        Err("file = \"\": name a recording (MCAP) or a scan folder")
    } else {
        Ok(())
    }
}

/// A tracker's first sensor goes by its instance, each other one by its number behind that (`serial_line::node::Source`).
fn further_sensors(node: &Inputs, config: &Value, key: &str) -> Vec<String> {
    let numbers = config[key].as_array().into_iter().flatten().filter_map(Value::as_u64);
    numbers.skip(1).map(|number| topic::pose(&format!("{}_{number}", node.instance)).key).collect()
}

fn receivers(config: &Value) -> Vec<String> {
    let trackers = config["receivers"].as_array().into_iter().flatten();
    trackers.filter_map(|receiver| Some(topic::pose(receiver["tracker"].as_str()?).key)).collect()
}

/// The kind of a name.
pub fn find(name: &str) -> Option<&'static Kind> {
    KINDS.iter().find(|kind| kind.name == name)
}
