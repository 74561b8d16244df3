//! Format, size and rate, set and read back.

use crate::config::Config;
use crate::controls::{self, Controls};
use crate::granted::Granted;
use crate::trouble::Trouble;
use crate::v4l_device::{calmly, guarded};
use crate::writes::{GAIN, WHITE_BALANCE};
use std::collections::BTreeMap;
use v4l::format::{Colorspace, Quantization};
use v4l::video::Capture as _;
use v4l::video::capture::Parameters;
use v4l::{Format, FourCC, Fraction};

/// Size and format first: setting them changes the rate.
pub(crate) fn set_mode(config: &Config, device: &v4l::Device) -> Result<(), Trouble> {
    // A format that was read back carries the stride of another width.
    let format = Format::new(config.width, config.height, FourCC::new(&config.format.fourcc()));
    guarded(config, "setting the format", || device.set_format(&format))?;
    let whole = config.rate_hz.fract() == 0.0;
    let (numerator, scale) = if whole { (1, 1.0) } else { (1000, 1000.0) };
    let interval = Fraction::new(numerator, (config.rate_hz * scale).round() as u32);
    // A camera with one rate refuses; what it has is read back and compared.
    let _ = calmly(|| device.set_params(&Parameters::new(interval)));
    Ok(())
}

/// What the driver says it has set.
pub(crate) fn read_back(config: &Config, device: &v4l::Device, controls: &Controls) -> Result<Granted, Trouble> {
    let format = guarded(config, "reading the format back", || device.format())?;
    let rate = |interval: Fraction| f64::from(interval.denominator) / f64::from(interval.numerator.max(1));
    let rate_hz = calmly(|| device.params()).ok().map(|params| rate(params.interval)).filter(|rate| *rate > 0.0);
    Ok(Granted {
        driver: calmly(|| device.query_caps()).map(|caps| caps.driver).unwrap_or_default(),
        fourcc: format.fourcc.repr,
        full_range: is_full_range(&format),
        other_colours: other_colours(&format),
        width: format.width,
        height: format.height,
        stride: format.stride,
        rate_hz,
        exposure_us: controls::exposure_us(device),
        gain: controls::read(device, GAIN),
        white_balance_k: controls::read(device, WHITE_BALANCE),
        controls: controls.values(device, config.controls.keys()),
        automatics: controls::automatic_values(config, device),
        refused: BTreeMap::new(),
    })
}

/// Without a word of the driver Y'CbCr is of the limited range, but for JPEG's (V4L2_MAP_QUANTIZATION_DEFAULT).
fn is_full_range(format: &Format) -> bool {
    match format.quantization {
        Quantization::FullRange => true,
        Quantization::LimitedRange => false,
        Quantization::Default => matches!(format.colorspace, Colorspace::JPEG),
    }
}

/// The colour spaces whose Y'CbCr is not BT.601 (V4L2_MAP_YCBCR_ENC_DEFAULT). What a driver says beyond that, in
/// `ycbcr_enc`, the crate does not tell.
fn other_colours(format: &Format) -> Option<String> {
    use Colorspace::{DCIP3, Rec709, Rec2020, SMPTE240M};
    matches!(format.colorspace, DCIP3 | Rec709 | Rec2020 | SMPTE240M).then(|| format.colorspace.to_string())
}
