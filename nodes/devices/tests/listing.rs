//! Machines that are folders.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use devices::{Control, Details, Facts, Mode, Size, advice, facts, list, not_built_in};
use std::fs;
use std::os::unix::fs::{PermissionsExt as _, symlink};
use std::path::Path;

fn file(root: &Path, path: &str, text: &str) {
    let path = root.join(path);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, text).unwrap();
}

fn link(root: &Path, path: &str, to: &str) {
    let path = root.join(path);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    symlink(to, path).unwrap();
}

fn machine() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    for k in [0, 1, 10] {
        file(root, &format!("dev/video{k}"), "");
        file(root, &format!("sys/class/video4linux/video{k}/name"), "HD Pro Webcam C920\n");
    }
    file(root, "sys/class/video4linux/v4l-subdev0/name", "sensor\n");
    link(root, "dev/v4l/by-id/usb-046d_HD_Pro_Webcam_C920-video-index0", "../../video0");
    // An Arduino, a built-in port, a built-in port that is not there, and a console.
    for name in ["ttyACM0", "ttyS0", "ttyS1", "tty7"] {
        file(root, &format!("dev/{name}"), "");
        fs::create_dir_all(root.join("sys/class/tty").join(name)).unwrap();
    }
    file(root, "sys/class/tty/ttyS0/type", "4\n");
    file(root, "sys/class/tty/ttyS1/type", "0\n");
    file(root, "sys/devices/usb1/1-2/product", "Uno\n");
    file(root, "sys/devices/usb1/1-2/manufacturer", "Arduino\n");
    fs::create_dir_all(root.join("sys/devices/usb1/1-2/1-2:1.0")).unwrap();
    link(root, "sys/class/tty/ttyACM0/device", "../../../devices/usb1/1-2/1-2:1.0");
    link(root, "dev/serial/by-id/usb-Arduino_Uno-if00", "../../ttyACM0");
    folder
}

fn webcam() -> Details {
    Details {
        driver: "uvcvideo".to_owned(),
        modes: vec![Mode { format: "YUYV".to_owned(), size: Size::Fixed(640, 480), rates_hz: vec![30.0, 7.5] }],
        controls: vec![Control {
            key: "exposure_time_absolute".to_owned(),
            least: 3,
            most: 2047,
            step: 1,
            default: 250,
            value: Some(50),
            items: Vec::new(),
            inactive: true,
        }],
    }
}

#[test]
fn cameras_and_ports_are_listed_by_names_that_last() {
    let machine = machine();
    let root = machine.path();
    // The second node of the webcam is none.
    let listing = list(root, |node| (!node.ends_with("video1")).then(|| Ok(webcam())));
    let paths: Vec<_> = listing.cameras.iter().map(|camera| camera.path.strip_prefix(root).unwrap()).collect();
    assert_eq!(paths, [Path::new("dev/v4l/by-id/usb-046d_HD_Pro_Webcam_C920-video-index0"), Path::new("dev/video10")]);
    assert_eq!(listing.cameras[0].node, root.join("dev/video0"));
    let ports: Vec<_> = listing.ports.iter().map(|port| (port.node.file_name().unwrap(), &port.usb_name)).collect();
    assert_eq!(ports, [("ttyACM0".as_ref(), &Some("Arduino Uno".to_owned())), ("ttyS0".as_ref(), &None)]);
    assert_eq!(listing.ports[0].path, root.join("dev/serial/by-id/usb-Arduino_Uno-if00"));
    let page = listing.to_string();
    for line in [
        "Camera HD Pro Webcam C920",
        "    YUYV 640x480      30, 7.5 Hz",
        "    exposure_time_absolute           3 to 2047, default 250, now 50 (held by an automatic)",
        "Serial port Arduino Uno",
        "Serial port (built in)",
    ] {
        assert!(page.lines().any(|l| l == line), "{line:?} in\n{page}");
    }
}

#[test]
fn what_is_missing_is_named_with_what_to_do() {
    let group = || "video".to_owned();
    let stranger = advice(&Facts { group: group(), group_may: true, is_member: false });
    assert!(stranger.contains("sudo usermod -aG video $USER"), "{stranger}");
    let newcomer = advice(&Facts { group: group(), group_may: true, is_member: true });
    assert!(newcomer.contains("log out and in again") && !newcomer.contains("usermod"), "{newcomer}");
    assert!(advice(&Facts { group: group(), group_may: false, is_member: true }).contains("udev"));
    let machine = machine();
    let node = machine.path().join("dev/video0");
    fs::set_permissions(&node, fs::Permissions::from_mode(0o000)).unwrap();
    // Root may do everything, whatever the mode says.
    if fs::File::open(&node).is_err() {
        let listing = list(machine.path(), |_| panic!("it may not be opened"));
        assert!(listing.cameras[0].missing.is_some());
    } else {
        println!("skipped in part: this user may open everything");
    }
}

#[test]
fn a_user_is_a_member_of_its_own_group_and_of_those_that_list_it() {
    let users =
        "root:x:0:0:root:/root:/bin/sh\nann:x:1000:44:Ann:/home/ann:/bin/sh\nbob:x:1001:1001::/home/bob:/bin/sh\n";
    let groups = "dialout:x:20:ann,bob\nvideo:x:44:\nbroken\nbob:x:1001:\n";
    let of = |user, group| facts([0o660, group], user, users, groups);
    assert_eq!(of(1000, 44), Facts { group: "video".to_owned(), group_may: true, is_member: true }, "her own");
    assert_eq!(of(1001, 44), Facts { group: "video".to_owned(), group_may: true, is_member: false });
    assert!(of(1000, 20).is_member && of(1001, 20).is_member, "listed");
    assert_eq!(of(1000, 77), Facts { group: "unknown".to_owned(), group_may: true, is_member: false });
    assert!(!of(4711, 20).is_member && !facts([0o640, 20], 1000, users, groups).group_may);
}

#[test]
fn a_machine_without_devices_and_a_program_without_cameras_say_so() {
    let folder = tempfile::tempdir().unwrap();
    let page = list(folder.path(), not_built_in).to_string();
    assert!(page.contains("No camera.") && page.contains("No serial port."), "{page}");
    let machine = machine();
    let page = list(machine.path(), not_built_in).to_string();
    assert!(page.contains("--features v4l"), "{page}");
}
