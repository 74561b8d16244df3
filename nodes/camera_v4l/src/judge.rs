//! What lit a picture, by the picture itself: commands to laser and lamp, and the shutter, each have their own delay.

use crate::look::{BANDS, LightConfig, Look};
use wire::{Light, Phase};

/// Between dark and bright by more than this share on either side: the lamp was switched during the exposure.
const SURE: f32 = 0.3;
/// What is known follows the hand by this share with each picture.
const FOLLOWS: f32 = 0.3;
/// Dark and bright approach each other by this share with each picture, so that one glare is forgotten in seconds.
const FORGETS: f32 = 0.005;
/// Texture under the lamp looks like a line in fewer rows than this share of those in which the line itself was seen.
const OF_USUAL: f32 = 0.5;
/// Under the lamp alone, as it should be in `colour`, so much of a line is needed to believe that the laser is on.
const STRONG_SHARE: f32 = 0.3;

/// Knows how bright pictures are with the lamp and without it, and how much of a line the laser shows.
#[derive(Debug, Clone, Default)]
pub struct LightJudge {
    levels: [Option<Levels>; BANDS],
    usual_share: f32,
}

impl LightJudge {
    /// What lit a picture. In `aim` and `shape` that is the laser, in `colour` the lamp unless a line is seen. In `both`
    /// each is looked for: lit by the lamp alone is what is bright from top to bottom and shows no line; a switch in the
    /// middle of an exposure counts as both (a line may be there, the colours are wrong), or, when no line is seen, as
    /// neither.
    pub fn judge(&mut self, phase: Phase, seen: &Look, config: &LightConfig) -> Light {
        let mut places = Vec::with_capacity(BANDS);
        for (level, &brightness) in self.levels.iter_mut().zip(&seen.brightness) {
            let level = level.get_or_insert(Levels { dark: brightness, bright: brightness });
            places.extend(level.place(brightness, config.lamp_contrast));
        }
        let is_dark = places.iter().all(|place| *place < SURE);
        let is_bright = !places.is_empty() && places.iter().all(|place| *place > 1.0 - SURE);
        if is_dark && phase != Phase::Colour {
            self.usual_share += FOLLOWS * (seen.stripe_share - self.usual_share);
        }
        let least_under_lamp = config.stripe_share.max(OF_USUAL * self.usual_share);
        match phase {
            Phase::End => Light { laser: false, lamp: false },
            Phase::Aim | Phase::Shape => Light { laser: true, lamp: false },
            Phase::Colour => {
                let laser = seen.stripe_share >= least_under_lamp.max(STRONG_SHARE);
                Light { laser, lamp: !laser }
            }
            Phase::Both => {
                let laser = seen.stripe_share >= if is_dark { config.stripe_share } else { least_under_lamp };
                Light { laser, lamp: if laser { !is_dark } else { is_bright } }
            }
        }
    }
}

/// Grey levels of one band.
#[derive(Debug, Clone, Copy)]
struct Levels {
    /// Without the lamp.
    dark: f32,
    /// With it.
    bright: f32,
}

impl Levels {
    /// Where between dark (0) and bright (1) a picture lies; none where the lamp makes no difference.
    fn place(&mut self, brightness: f32, least_contrast: f32) -> Option<f32> {
        let forgotten = FORGETS * (self.bright - self.dark);
        self.dark = (self.dark + forgotten).min(brightness);
        self.bright = (self.bright - forgotten).max(brightness);
        let contrast = self.bright - self.dark;
        if contrast < least_contrast {
            return None;
        }
        let place = (brightness - self.dark) / contrast;
        let side = if place > 0.5 { &mut self.bright } else { &mut self.dark };
        *side += FOLLOWS * (brightness - *side);
        Some(place)
    }
}
