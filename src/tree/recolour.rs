//! The colours of leaves over the year. `render/shaders/season.wesl` has the same formulas, and a test holds them equal.

use super::phenology::Phenology;
use crate::texture::linear;
use bevy::math::{FloatExt, Vec3};

/// Leaves are at most so many times as light as the mean colour of their species in spring.
const GREATEST_LIGHTNESS: f32 = 4.0;

/// How far the colour of leaves is from that of summer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SeasonColour {
    /// Youth (below 0) or autumn (above), -1 to 1.
    pub change: f32,
    /// Place between the two colours of autumn, 0 to 1.
    pub tone: f32,
}

/// The colours of a species over the year, as light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recolouring {
    spring: Vec3,
    autumn: [Vec3; 2],
    /// Luminance of a leaf in summer.
    summer_luminance: f32,
}

impl Recolouring {
    /// Of a species whose leaves have this mean colour (sRGB 0 to 1) in summer.
    #[must_use]
    pub fn new(phenology: &Phenology, summer: [f32; 3]) -> Self {
        let light = |colour| Vec3::from_array(linear(colour));
        Self {
            spring: light(phenology.spring_colour),
            autumn: phenology.autumn_colours.map(light),
            summer_luminance: luminance(light(summer)).max(1e-4),
        }
    }

    /// The colour (light) that leaf of a colour in summer (light) has then. Its brightness stays; twigs keep their colour.
    #[must_use]
    pub fn of(&self, summer: Vec3, season: SeasonColour) -> Vec3 {
        let [first, last] = self.autumn;
        let colour = if season.change > 0.0 { first.lerp(last, season.tone) } else { self.spring };
        let lightness = (luminance(summer) / self.summer_luminance).min(GREATEST_LIGHTNESS);
        summer.lerp(colour * lightness, season.change.abs() * leafness(summer))
    }
}

/// How much of a colour (light) is that of leaf and not of twig, 0 to 1: leaves are green.
#[must_use]
pub fn leafness(light: Vec3) -> f32 {
    let sum = light.element_sum().max(1e-5);
    (5.0 * (light.y - 0.5 * (light.x + light.z)) / sum).saturate()
}

fn luminance(light: Vec3) -> f32 {
    light.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leaves_turn_and_twigs_do_not() {
        let oak = Phenology::default();
        let (leaf, twig) = (Vec3::new(0.05, 0.12, 0.02), Vec3::new(0.08, 0.06, 0.04));
        let colours = Recolouring::new(&oak, [0.25, 0.38, 0.15]);
        let autumn = SeasonColour { change: 1.0, tone: 0.0 };
        assert_eq!(colours.of(leaf, SeasonColour::default()), leaf);
        assert_eq!(colours.of(twig, autumn), twig);
        let turned = colours.of(leaf, autumn);
        let hue = Vec3::from_array(linear(oak.autumn_colours[0]));
        assert!(turned.cross(hue).length() < 1e-4 * turned.length() * hue.length() + 1e-6, "{turned} is not {hue}");
    }
}
