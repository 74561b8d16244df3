//! What lit a picture, by the picture itself: commands to laser and lamp, and the shutter, each have their own delay.

use crate::look::{BANDS, LightConfig, Look};
use wire::{Light, Phase};

type Bands = [f32; BANDS];

/// Between the levels without the lamp (0) and with it (1), a picture belongs to the nearer.
const MIDDLE: f32 = 0.5;
/// A band that is so much nearer to the other level was lit otherwise than the rest: the light was switched meanwhile.
const STRAYS: f32 = 0.25;
/// Levels follow the hand by this share with each picture.
const FOLLOWS: f32 = 0.6;
/// How much of a line is usual, by this share.
const USUAL_FOLLOWS: f32 = 0.1;
/// Under the lamp, so much of a line is needed to believe that the laser is on: texture shows pieces as well.
const STRONG_SHARE: f32 = 0.15;
/// The same as a share of what is usual under the laser.
const OF_USUAL: f32 = 0.5;

/// Knows how bright pictures are with the lamp and without it, and how much of a line the laser shows.
#[derive(Debug, Clone, Default)]
pub struct LightJudge {
    levels: Option<Levels>,
    usual_share: f32,
}

/// What the lamp does to a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Lamp {
    Off,
    On,
    /// In one part of it.
    Switched,
}

impl LightJudge {
    /// What lit a picture. In `aim` and `shape` that is the laser, in `colour` the lamp unless a strong line is seen. In
    /// `both`, where they take turns, it is the lamp where the picture is as bright as it is with the lamp, from top to
    /// bottom, and else the laser. A switch in the middle of an exposure counts as both (a line may be there, the colours
    /// are wrong), or, when no line is seen, as neither.
    pub fn judge(&mut self, phase: Phase, seen: &Look, config: &LightConfig) -> Light {
        let levels = self.levels.get_or_insert(Levels::starting(seen.brightness));
        let lamp = levels.lamp(&seen.brightness, config.lamp_stops);
        if lamp == Lamp::Off && phase != Phase::Colour {
            self.usual_share += USUAL_FOLLOWS * (seen.stripe_share - self.usual_share);
        }
        let strong = seen.stripe_share >= STRONG_SHARE.max(OF_USUAL * self.usual_share);
        let (laser, lamp) = match (phase, lamp) {
            (Phase::End, _) => (false, false),
            (Phase::Aim | Phase::Shape, _) | (Phase::Both, Lamp::Off) => (true, false),
            (Phase::Colour, _) => (strong, !strong),
            (Phase::Both, Lamp::On) => (strong, true),
            (Phase::Both, Lamp::Switched) => {
                let line = seen.stripe_share >= config.stripe_share;
                (line, line)
            }
        };
        Light { laser, lamp }
    }
}

/// A band that the lamp makes brighter by `contrast`, and that is brighter by `above` now; in stops.
struct Reached {
    above: f32,
    contrast: f32,
}

impl Reached {
    /// 0 without the lamp, 1 with it.
    fn place(&self) -> f32 {
        self.above / self.contrast
    }
}

/// Light of each band, in stops.
#[derive(Debug, Clone, Copy)]
struct Levels {
    /// Without the lamp.
    dark: Bands,
    /// With it; none before it was seen to make a difference.
    bright: Option<Bands>,
    /// The picture before, and whether it was taken for one with the lamp.
    before: (Bands, bool),
}

impl Levels {
    fn starting(now: Bands) -> Self {
        Self { dark: now, bright: None, before: (now, false) }
    }

    /// Compares a picture with the newest ones of either kind, and remembers it as one of them.
    fn lamp(&mut self, now: &Bands, least_stops: f32) -> Lamp {
        let reached = self.reached(now, least_stops);
        let is_on = self.by_jump(now, least_stops).unwrap_or_else(|| self.by_level(now, &reached));
        self.before = (*now, is_on);
        match is_on {
            true if reached.iter().all(|band| band.place() > STRAYS) => Lamp::On,
            false if reached.iter().all(|band| band.place() < 1.0 - STRAYS) => Lamp::Off,
            _ => Lamp::Switched,
        }
    }

    /// The bands that the lamp reaches; where it does not, a band says nothing.
    fn reached(&self, now: &Bands, least_stops: f32) -> Vec<Reached> {
        let bright = self.bright.unwrap_or(self.dark);
        let bands = (0..BANDS)
            .map(|band| Reached { above: now[band] - self.dark[band], contrast: bright[band] - self.dark[band] });
        bands.filter(|band| band.contrast >= least_stops).collect()
    }

    /// What jumps up has the lamp, and what jumps down shows that the one before had it, whatever was believed till now.
    fn by_jump(&mut self, now: &Bands, least_stops: f32) -> Option<bool> {
        let (last, last_on) = self.before;
        let contrast = self.bright.map_or(0.0, |bright| most(&bright, &self.dark));
        let enough = least_stops.max(MIDDLE * contrast);
        let brighter = now.iter().sum::<f32>() > last.iter().sum::<f32>();
        let is_on = if brighter && most(now, &last) >= enough && (last_on || self.bright.is_none()) {
            true
        } else if !brighter && most(&last, now) >= enough && !last_on {
            false
        } else {
            return None;
        };
        let (bright, dark) = if is_on { (*now, last) } else { (last, *now) };
        (self.bright, self.dark) = (Some(bright), dark);
        Some(is_on)
    }

    fn by_level(&mut self, now: &Bands, reached: &[Reached]) -> bool {
        let Some(bright) = self.bright.filter(|_| !reached.is_empty()) else {
            (self.bright, self.dark) = (None, *now);
            return false;
        };
        let sum = |of: fn(&Reached) -> f32| reached.iter().map(of).sum::<f32>();
        let is_on = sum(|band| band.above) > MIDDLE * sum(|band| band.contrast);
        self.follow(now, bright, is_on);
        is_on
    }

    fn follow(&mut self, now: &Bands, mut bright: Bands, is_on: bool) {
        for band in 0..BANDS {
            if is_on {
                bright[band] += FOLLOWS * (now[band] - bright[band]);
            } else {
                // What the lamp adds is added to what is there without it.
                let change = FOLLOWS * (now[band] - self.dark[band]);
                self.dark[band] += change;
                bright[band] += change;
            }
        }
        self.bright = Some(bright);
    }
}

/// The most by which a band is brighter than in another picture.
fn most(now: &Bands, than: &Bands) -> f32 {
    now.iter().zip(than).map(|(now, than)| now - than).fold(f32::MIN, f32::max)
}
