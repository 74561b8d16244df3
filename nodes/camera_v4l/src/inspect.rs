//! What a camera can do, for `limn devices`.

use crate::controls::read;
use crate::trouble::Trouble;
use crate::v4l_device::{calmly, open};
use devices::{Control, Details, Mode, Size, control_key};
use std::path::Path;
use v4l::control::{Description, Flags, Type};
use v4l::format::FourCC;
use v4l::frameinterval::FrameIntervalEnum;
use v4l::framesize::FrameSizeEnum;
use v4l::video::Capture as _;

/// Opens a camera and asks; none for what is no camera. As `devices::list` wants it.
pub fn inspect(node: &Path) -> Option<Result<Details, String>> {
    let device = match open(node) {
        Ok(device) => device,
        Err(Trouble::NoCamera { .. }) => return None,
        Err(trouble) => return Some(Err(trouble.to_string())),
    };
    let driver = calmly(|| device.query_caps()).map(|caps| caps.driver).unwrap_or_default();
    let controls = calmly(|| device.query_controls()).unwrap_or_default();
    let controls = controls.iter().filter_map(|control| describe(&device, control)).collect();
    Some(Ok(Details { driver, modes: modes(&device), controls }))
}

/// Its formats, sizes and rates.
pub(crate) fn modes(device: &v4l::Device) -> Vec<Mode> {
    let mut modes = Vec::new();
    for format in calmly(|| device.enum_formats()).unwrap_or_default() {
        for size in calmly(|| device.enum_framesizes(format.fourcc)).unwrap_or_default() {
            let size = match size.size {
                FrameSizeEnum::Discrete(size) => Size::Fixed(size.width, size.height),
                FrameSizeEnum::Stepwise(s) => {
                    Size::Between { least: (s.min_width, s.min_height), most: (s.max_width, s.max_height) }
                }
            };
            let rates_hz = rates_hz(device, format.fourcc, size);
            modes.push(Mode { format: format.fourcc.to_string(), size, rates_hz });
        }
    }
    modes
}

fn rates_hz(device: &v4l::Device, fourcc: FourCC, size: Size) -> Vec<f64> {
    let (Size::Fixed(width, height) | Size::Between { most: (width, height), .. }) = size;
    let rate = |interval: v4l::Fraction| f64::from(interval.denominator) / f64::from(interval.numerator.max(1));
    let mut rates: Vec<f64> = calmly(|| device.enum_frameintervals(fourcc, width, height))
        .unwrap_or_default()
        .into_iter()
        .flat_map(|interval| match interval.interval {
            FrameIntervalEnum::Discrete(interval) => vec![rate(interval)],
            FrameIntervalEnum::Stepwise(steps) => vec![rate(steps.min), rate(steps.max)],
        })
        .collect();
    rates.sort_by(|a, b| b.total_cmp(a));
    rates.dedup();
    rates
}

/// Numbers, switches and menus; what is no number cannot be set from a launch file.
fn describe(device: &v4l::Device, control: &Description) -> Option<Control> {
    let settable = matches!(control.typ, Type::Integer | Type::Integer64 | Type::Boolean | Type::Menu);
    if !settable || control.flags.intersects(Flags::DISABLED | Flags::READ_ONLY) {
        return None;
    }
    let items = control.items.iter().flatten().map(|(value, item)| (i64::from(*value), item.to_string())).collect();
    Some(Control {
        key: control_key(&control.name),
        least: control.minimum,
        most: control.maximum,
        step: control.step,
        default: control.default,
        value: read(device, control.id),
        items,
        inactive: control.flags.contains(Flags::INACTIVE),
    })
}
