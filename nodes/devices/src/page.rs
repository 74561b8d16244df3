//! The listing as a page.

use crate::camera::{Camera, Control, Mode, Size};
use crate::listing::Listing;
use crate::port::Port;
use std::fmt;

impl fmt::Display for Listing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.cameras.is_empty() {
            writeln!(f, "No camera. (`dmesg | tail` after plugging one in says what became of it.)")?;
        }
        self.cameras.iter().try_for_each(|camera| camera.fmt(f))?;
        if self.ports.is_empty() {
            writeln!(f, "No serial port.")?;
        }
        self.ports.iter().try_for_each(|port| port.fmt(f))
    }
}

impl fmt::Display for Camera {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Camera {}", self.name)?;
        names(f, &self.path, &self.node)?;
        if let Some(missing) = &self.missing {
            return writeln!(f, "    may not be used: {missing}");
        }
        match &self.details {
            Err(reason) => writeln!(f, "    {reason}"),
            Ok(details) => {
                writeln!(f, "    driver {}", details.driver)?;
                details.modes.iter().try_for_each(|mode| mode.fmt(f))?;
                details.controls.iter().try_for_each(|control| control.fmt(f))
            }
        }
    }
}

fn names(f: &mut fmt::Formatter<'_>, path: &std::path::Path, node: &std::path::Path) -> fmt::Result {
    writeln!(f, "    {}", path.display())?;
    if path == node { Ok(()) } else { writeln!(f, "    (now {})", node.display()) }
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = match self.size {
            Size::Fixed(width, height) => format!("{width}x{height}"),
            Size::Between { least: (w, h), most: (width, height) } => format!("{w}x{h} to {width}x{height}"),
        };
        write!(f, "    {} {size:<12}", self.format)?;
        let rates: Vec<String> =
            self.rates_hz.iter().map(|rate| format!("{}", (rate * 100.0).round() / 100.0)).collect();
        if rates.is_empty() { writeln!(f) } else { writeln!(f, " {} Hz", rates.join(", ")) }
    }
}

impl fmt::Display for Control {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { key, least, most, step, default, .. } = self;
        write!(f, "    {key:<32} {least} to {most}")?;
        if *step > 1 {
            write!(f, " by {step}")?;
        }
        write!(f, ", default {default}")?;
        if let Some(value) = self.value {
            write!(f, ", now {value}")?;
        }
        if self.inactive {
            write!(f, " (held by an automatic)")?;
        }
        let items: Vec<String> = self.items.iter().map(|(value, text)| format!("{value} = {text}")).collect();
        if items.is_empty() { writeln!(f) } else { writeln!(f, "; {}", items.join(", ")) }
    }
}

impl fmt::Display for Port {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Serial port {}", self.usb_name.as_deref().unwrap_or("(built in)"))?;
        names(f, &self.path, &self.node)?;
        self.missing.iter().try_for_each(|missing| writeln!(f, "    may not be used: {missing}"))
    }
}
