//! Tells listeners of gusts, and of leaves that rustle.

use super::canopy_wind::WindInTrees;
use crate::{
    query::{
        components::WindListener,
        rustle::{Follow, LeafSound, gust_share, level_db, share_of_level, speed_m_s},
    },
    sway::InCanopy,
    tree::{Grown, Season, SpeciesModels, Tree, TreeModel, TreePlaces},
    wind::WindClock,
};
use bevy::{ecs::system::SystemParam, prelude::*};

/// Trees that are nearer than this are heard, m: those of a closed wood beyond add some two decibels.
const HEARD_M: f32 = 32.0;
/// Leaves that show less than this share of a full circle about the listener are not heard, m²/m².
const LEAST_SHARE: f32 = 1e-3;

const GUSTS: Follow = Follow { rise_s: 0.2, fall_s: 1.0 };
const RUSTLE: Follow = Follow { rise_s: 0.1, fall_s: 0.4 };

/// The leaves that may be heard.
#[derive(SystemParam)]
pub(in crate::query) struct Leaves<'w, 's> {
    places: Res<'w, TreePlaces>,
    models: Res<'w, Assets<TreeModel>>,
    species: Res<'w, SpeciesModels>,
    season: Res<'w, Season>,
    trees: Query<'w, 's, (&'static Tree, &'static Grown, &'static GlobalTransform, Option<&'static InCanopy>)>,
}

impl Leaves<'_, '_> {
    /// Intensity of their sound at a place, by that of 0 dB.
    fn intensity(&self, ear: Vec3, wind: &WindInTrees) -> f32 {
        let mut sum = 0.0;
        self.places.within(ear.xz(), HEARD_M, |tree, _| {
            let Ok((tree, grown, at, canopy)) = self.trees.get(tree) else { return };
            let (Some(model), Some(baked)) = (self.models.get(&grown.model), self.species.get(tree.species.id()))
            else {
                return;
            };
            let scale = at.affine().matrix3.determinant().abs().cbrt();
            let crown = &model.body.crown;
            let middle = at.transform_point(Vec3::Y * crown.middle_m());
            let distance_m = middle.distance(ear);
            let leaf_share = model.leaf_season.share(self.season.wrapped() + tree.season_shift());
            let area_m2 = crown.leaf_area_m2() * scale * scale * leaf_share;
            // What is no number is not heard either.
            let share = area_m2 / (distance_m * distance_m);
            if share.is_nan() || share <= LEAST_SHARE {
                return;
            }
            let canopy = canopy.copied().unwrap_or_default();
            let speed_m_s = wind.speed_in_crown(at.translation(), middle.y - at.translation().y, &canopy);
            let is_needle = baked.species.foliage.leaf.shape.is_needle();
            let sound = if is_needle { LeafSound::Needles } else { LeafSound::Broad };
            sum += sound.intensity(area_m2, distance_m, speed_m_s);
        });
        sum
    }
}

/// Tells every listener what it hears.
pub(in crate::query) fn tell_listeners(
    clock: Res<WindClock>,
    wind: WindInTrees,
    leaves: Leaves,
    mut listeners: Query<(&mut WindListener, &GlobalTransform)>,
) {
    let delta_s = clock.time_s - clock.previous_s;
    for (mut listener, at) in &mut listeners {
        let place = at.translation();
        let heard = *listener;
        let now = wind.at(place, heard.ground_m);
        let gust_m_s = speed_m_s(now.velocity) - now.mean_m_s;
        let rustle = share_of_level(level_db(leaves.intensity(place, &wind)));
        listener.set_if_neq(WindListener {
            ground_m: heard.ground_m,
            velocity: now.velocity,
            mean_m_s: now.mean_m_s,
            gust_m_s,
            gust_level: GUSTS.step(heard.gust_level, gust_share(gust_m_s, now.deviation_m_s), delta_s),
            rustle_level: RUSTLE.step(heard.rustle_level, rustle, delta_s),
        });
    }
}
