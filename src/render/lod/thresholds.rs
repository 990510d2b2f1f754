//! The distances at which trees change their LOD level.
//!
//! A tree's level follows from its size on screen. Where a level fades into the next, the meshes of both are drawn, and the shaders
//! dither between them by the distance to the camera (`render/shaders/cross_fade.wesl`), in the main pass, the prepass and the shadows
//! alike. Meshes are swapped only where the level that goes is all hidden and the one that comes has not begun, so no swap is seen.
//! Only a viewer who jumps sees levels change at once.

use crate::{
    lod::{Lens, MOST_LEVELS},
    render::settings::{LevelOfDetail, LevelStyle},
};
use bevy::prelude::*;

/// Farther than anything, m.
const NEVER_M: f32 = 1e30;
/// The meshes of both levels are there for so much longer than the fade itself, m, since viewers move on before the swap: a share of
/// the distance, and no less than a fast viewer makes between two selections.
const SLACK_M: [f32; 2] = [1.0, 3.0];
const SLACK_SHARE: f32 = 0.05;
/// A tree fades so much later than its impostor comes, as a factor of the distance: the heights that both go by are rounded, and no pixel may
/// be left to neither.
pub(crate) const FADE_LAG: f32 = 1.01;

/// Which LOD levels of a tree are drawn.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[component(clone_behavior = Ignore)]
pub(crate) struct LodSelection {
    pub lod: u8,
    /// Whether it fades into the level after it, which is drawn as well.
    pub is_fading: bool,
    /// Whether the impostor alone stands for the tree, and nothing of it is drawn or posed.
    pub is_impostor: bool,
    /// Whether its impostor alone casts its shadow.
    pub is_shadow_impostor: bool,
}

/// How far a tree is from the nearest viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LodDistance {
    /// In the world, m.
    pub m: f32,
    /// As the lens of the thresholds would see it as large, m.
    pub scaled_m: f32,
}

/// Where the LOD levels of trees end, for one lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LodThresholds {
    /// Of each level, per metre of the tree's height; the last has no end, unless an impostor follows it.
    pub ends: [f32; MOST_LEVELS],
    pub fade: f32,
    pub impostor_fade: f32,
    /// From here on impostors cast the shadows of trees in the maps of suns, per metre of their height.
    pub shadow_end: f32,
    /// From here on trees with an impostor cast no shadow themselves, per metre of their height.
    caster_end: f32,
    margin: f32,
}

impl LodThresholds {
    pub fn new(settings: &LevelOfDetail, lens: Lens) -> Self {
        let [high, middle, medium] = settings.screen_sizes.distances_of_three_m(1.0, lens);
        let ends = match settings.style {
            LevelStyle::Thinned => [high, middle, medium],
            LevelStyle::Paper => [high, medium, NEVER_M],
            LevelStyle::Full => [NEVER_M; MOST_LEVELS],
        };
        let shadow_end = match settings.style {
            LevelStyle::Thinned => settings.shadow_impostors_from_heights,
            LevelStyle::Paper | LevelStyle::Full => NEVER_M,
        };
        let margin = settings.screen_sizes.margin;
        Self {
            ends,
            fade: settings.fade,
            impostor_fade: settings.impostor_fade,
            shadow_end,
            caster_end: shadow_end,
            margin,
        }
    }

    /// The same where lamps have shadow maps, in which impostors stand for no tree.
    pub fn with_lamps(self) -> Self {
        Self { caster_end: NEVER_M, ..self }
    }

    /// The selection for a tree of a height, m, with `count` levels, after the selection before.
    pub fn select(&self, distance_m: f32, height_m: f32, count: u8, before: Option<LodSelection>) -> LodSelection {
        let last = count.saturating_sub(1).min(MOST_LEVELS as u8 - 1);
        for lod in 0..last {
            let end_m = self.ends[usize::from(lod)] * height_m;
            let fading = LodSelection { lod, is_fading: true, ..default() };
            let margin = if before == Some(fading) { self.margin } else { 0.0 };
            if distance_m < (end_m * (1.0 - self.fade) - slack_m(end_m)) * (1.0 - margin) {
                return LodSelection { lod, ..default() };
            }
            if distance_m < (end_m * (1.0 + self.fade) + slack_m(end_m)) * (1.0 + margin) {
                return fading;
            }
        }
        LodSelection { lod: last, ..default() }
    }

    /// The same for a tree with an impostor of a height, m, which stands no nearer than `from_m`.
    pub fn select_before_impostor(
        &self,
        distance: LodDistance,
        height_m: f32,
        count: u8,
        (from_m, impostor_height_m): (f32, f32),
        before: Option<LodSelection>,
    ) -> LodSelection {
        let selection = self.select(distance.scaled_m, height_m, count, before);
        // A tree goes later than it comes back, and it is back before its impostor begins to fade.
        let margin_of = |is_drawn: bool| if is_drawn { self.margin } else { 0.0 };
        let is_beyond = |distance_m: f32, end_m: f32, fade: f32, margin: f32| {
            distance_m > (end_m * (1.0 + fade) + slack_m(end_m)) * (1.0 + margin)
        };
        let lagging_m = impostor_height_m * FADE_LAG;
        let margin = margin_of(before.is_some_and(|before| !before.is_impostor));
        let is_impostor = is_beyond(distance.m, from_m * FADE_LAG, self.impostor_fade, margin)
            || is_beyond(distance.scaled_m, self.ends[MOST_LEVELS - 1] * lagging_m, self.impostor_fade, margin);
        let margin = margin_of(before.is_some_and(|before| !before.is_shadow_impostor));
        let is_shadow_impostor = is_beyond(distance.scaled_m, self.caster_end * lagging_m, self.fade, margin);
        LodSelection { is_impostor, is_shadow_impostor, ..selection }
    }

    /// The selection for a tree whose material cannot fade: one level at a time, and no impostor.
    pub fn select_without_fade(
        &self,
        distance_m: f32,
        height_m: f32,
        count: u8,
        before: Option<LodSelection>,
    ) -> LodSelection {
        let LodSelection { lod, is_fading, .. } = self.select(distance_m, height_m, count, before);
        let lod = before.map_or(lod, |before| before.lod.clamp(lod, lod + u8::from(is_fading)));
        LodSelection { lod, ..default() }
    }
}

fn slack_m(end_m: f32) -> f32 {
    let [least, most] = SLACK_M;
    (SLACK_SHARE * end_m).clamp(least, most)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const IMPOSTOR_FROM_M: f32 = 200.0;
    const LENS: Lens = Lens { fov_rad: std::f32::consts::FRAC_PI_4, picture_px: 1080.0 };

    fn thresholds() -> LodThresholds {
        LodThresholds::new(&LevelOfDetail::default(), LENS)
    }

    #[test]
    fn large_trees_keep_their_level_farther_than_small_ones() {
        let lod = |height_m| thresholds().select(60.0, height_m, 3, None).lod;
        assert_eq!((lod(30.0), lod(4.0)), (0, 2));
    }

    proptest! {
        /// On any way, every level that a shader shows in part is drawn, and none that it does not show at all.
        #[test]
        fn levels_that_fade_are_drawn(height_m in 1.0..40.0_f32, way in prop::collection::vec(0.0..900.0_f32, 1..40)) {
            let thresholds = thresholds();
            let mut selection = None;
            for distance_m in way {
                let next = thresholds.select(distance_m, height_m, 3, selection);
                selection = Some(next);
                for end in 0..2_u8 {
                    let end_m = thresholds.ends[usize::from(end)] * height_m;
                    let fades = (distance_m / end_m - 1.0).abs() < thresholds.fade;
                    let others = |other: u8| {
                        let other_m = thresholds.ends[usize::from(other)] * height_m;
                        other != end && (distance_m / other_m - 1.0).abs() < thresholds.fade + 0.3
                    };
                    if fades && !(0..2).any(others) {
                        prop_assert_eq!(next, LodSelection { lod: end, is_fading: true, ..default() });
                    }
                }
            }
        }

        #[test]
        fn small_movements_at_a_border_change_the_selection_once_at_most(
            start_m in 5.0..600.0_f32, height_m in 5.0..40.0_f32, steps in prop::collection::vec(-0.5..0.5_f32, 30),
        ) {
            let thresholds = thresholds();
            let mut selection = thresholds.select(start_m, height_m, 3, None);
            let mut changes = 0;
            for step in steps {
                let next = thresholds.select(start_m + step, height_m, 3, Some(selection));
                changes += usize::from(next != selection);
                selection = next;
            }
            prop_assert!(changes <= 1, "{} changes", changes);
        }
    }

    #[test]
    fn trees_are_dropped_only_where_their_impostor_is_complete() {
        let thresholds = thresholds();
        let is_impostor = |m, before| {
            let distance = LodDistance { m, scaled_m: m };
            thresholds.select_before_impostor(distance, 20.0, 3, (IMPOSTOR_FROM_M, 20.0), before).is_impostor
        };
        // Here the tree is all gone, and a little farther it is dropped.
        let faded_m = IMPOSTOR_FROM_M * (1.0 + thresholds.impostor_fade) * FADE_LAG;
        let dropped_m = faded_m + 1.01 * slack_m(faded_m);
        assert!(!is_impostor(faded_m, None) && is_impostor(dropped_m, None));
        let before = LodSelection { lod: 2, is_impostor: true, ..default() };
        assert!(is_impostor(dropped_m, Some(before)));
        // Where an impostor begins to fade, its tree is back.
        assert!(!is_impostor(faded_m, Some(before)));
        let drawn = LodSelection { lod: 2, ..default() };
        assert!(
            !is_impostor(dropped_m, Some(drawn)) && is_impostor(1.05 * dropped_m, Some(drawn)),
            "it goes later than it comes back"
        );
        assert!(!thresholds.select(1e6, 20.0, 3, None).is_impostor);
    }

    #[test]
    fn trees_cast_no_shadow_themselves_where_their_impostor_does_but_for_lamps() {
        let at = |thresholds: LodThresholds, heights: f32| {
            let distance = LodDistance { m: 20.0 * heights, scaled_m: 20.0 * heights };
            thresholds.select_before_impostor(distance, 20.0, 3, (IMPOSTOR_FROM_M, 20.0), None).is_shadow_impostor
        };
        let thresholds = thresholds();
        let hidden_from = thresholds.shadow_end * FADE_LAG * (1.0 + thresholds.fade);
        assert!(!at(thresholds, hidden_from) && at(thresholds, hidden_from + 0.3));
        assert!(!at(thresholds.with_lamps(), 9.0), "a lamp's map would lack it");
        assert!(!thresholds.select(180.0, 20.0, 3, None).is_shadow_impostor, "it has no impostor");
    }

    #[test]
    fn a_lens_moves_levels_but_not_the_border_of_the_entities() {
        let select = |m, scaled_m| {
            let distance = LodDistance { m, scaled_m };
            thresholds().select_before_impostor(distance, 20.0, 3, (IMPOSTOR_FROM_M, 20.0), None)
        };
        let telephoto = select(150.0, 15.0);
        assert_eq!(telephoto, LodSelection::default());
        assert!(select(260.0, 26.0).is_impostor, "no tree stands there as an entity");
    }

    #[test]
    fn one_level_is_selected_at_any_distance() {
        assert_eq!(thresholds().select(1e6, 20.0, 1, None), LodSelection::default());
        assert_eq!(thresholds().select(f32::NAN, 20.0, 3, None).lod, 2);
    }
}
