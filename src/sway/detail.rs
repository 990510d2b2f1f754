//! How much of each tree is drawn: its level of detail by its size on screen.
//!
//! Which levels a tree wears follows from its distance to the nearest viewer; where a level fades into the next it wears
//! both, and the shaders dither between them by the distance to whoever looks (`render/shaders/cross_fade.wesl`), in the main pass, the
//! prepass and the shadows alike. So a change of clothes is never seen: the level that goes is all gone by then, the one
//! that comes has not begun. Only a viewer who leaps sees levels change at once.

use crate::{
    lod::{Lens, LevelDistances},
    setting::{SettingError, require},
    viewpoint::Viewpoints,
};
use bevy::prelude::*;
use serde::{Deserialize, Serialize};

/// How much of a tree is drawn at which size on screen.
#[derive(Resource, Reflect, Clone, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Resource, Default)]
#[serde(default, deny_unknown_fields)]
pub struct LevelOfDetail {
    /// What the levels are.
    pub style: LevelStyle,
    /// Where they end, and the quality in one number.
    pub distances: LevelDistances,
    /// Over this share of a distance, to either side, one level fades into the next. domain: \[0.02, 0.3\].
    pub fade: f32,
    /// Trees that change their level in a frame, at most, and half as many that get their first; each takes some microseconds.
    /// domain: \[1, 1000000\].
    pub changes_per_frame: u32,
}

/// What stands for a tree that is too small on screen to be drawn in full.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum LevelStyle {
    /// Its own meshes, thinned twice, and in a [`Forest`](crate::forest) views of it on cards beyond.
    #[default]
    Thinned,
    /// Setas, Gomes & Rebordão's: a trunk and an envelope of leaves, beyond it four plain polygons.
    Paper,
    /// Nothing: it is drawn in full as far as it is an entity.
    Full,
}

impl Default for LevelOfDetail {
    fn default() -> Self {
        Self { style: LevelStyle::default(), distances: LevelDistances::default(), fade: 0.1, changes_per_frame: 128 }
    }
}

impl LevelOfDetail {
    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        self.distances.validate().map_err(|error| error.inside("distances"))?;
        require("fade", self.fade, 0.02..=0.3)?;
        require("changes_per_frame", self.changes_per_frame as f32, 1.0..=1e6)
    }
}

/// The most levels that one tree has.
pub(super) const MOST_LEVELS: usize = 3;
/// A distance that nothing reaches, m.
pub(super) const NOWHERE_M: f32 = 1e30;
/// Levels are looked over again when a viewer has moved so far, m.
const STEP_M: f32 = 0.5;
/// By so much more than the fade itself a tree wears both levels, m, for viewers move on before it changes: a share of the
/// distance, and no less than a fast one makes between two looks.
const SLACK_M: [f32; 2] = [1.0, 3.0];
const SLACK_SHARE: f32 = 0.05;
/// Models are grown for ages in steps, impostors for any: the heights of a tree and its impostor differ by less than this factor.
pub(super) const LADDER: f32 = 1.17;
/// The lens that is assumed where there is no camera.
const COMMON_LENS: Lens = Lens { fov_rad: std::f32::consts::FRAC_PI_4, picture_px: 1080.0 };

/// Where the levels of a tree end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ladder {
    /// Of each level, per metre of the tree's height; the last has no end, unless cards stand behind it.
    pub ends: [f32; MOST_LEVELS],
    pub fade: f32,
    margin: f32,
    /// Where cards begin, m.
    pub cards_from_m: f32,
}

/// The levels that a tree wears.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Levels {
    pub first: u8,
    /// Whether the level after it is worn as well.
    pub both: bool,
    /// Whether a card stands for the tree, and nothing of it is drawn or posed.
    pub gone: bool,
}

impl Ladder {
    pub fn new(detail: &LevelOfDetail, lens: Lens, cards: CardRange) -> Self {
        let [high, medium, _] = detail.distances.switches(1.0, lens).at_m();
        let ends = match detail.style {
            // The second thinning begins half way, as the eye sees distances.
            LevelStyle::Thinned => [high, (high * medium).sqrt(), medium],
            LevelStyle::Paper => [high, medium, NOWHERE_M],
            LevelStyle::Full => [NOWHERE_M; MOST_LEVELS],
        };
        let cards_from_m = cards.from_m.unwrap_or(NOWHERE_M);
        Self { ends, fade: detail.fade, margin: detail.distances.margin, cards_from_m }
    }

    /// What a tree of a height, m, that has `count` levels wears at a distance, m, after what it has worn before.
    pub fn choose(&self, distance_m: f32, height_m: f32, count: u8, before: Option<Levels>) -> Levels {
        let last = count.saturating_sub(1).min(MOST_LEVELS as u8 - 1);
        for first in 0..last {
            let end_m = self.ends[usize::from(first)] * height_m;
            let both = Levels { first, both: true, gone: false };
            let margin = if before == Some(both) { self.margin } else { 0.0 };
            if distance_m < (end_m * (1.0 - self.fade) - slack_m(end_m)) * (1.0 - margin) {
                return Levels { first, ..Levels::default() };
            }
            if distance_m < (end_m * (1.0 + self.fade) + slack_m(end_m)) * (1.0 + margin) {
                return both;
            }
        }
        Levels { first: last, ..Levels::default() }
    }

    /// The same for a tree with a card behind it.
    pub fn choose_before_card(&self, distance_m: f32, height_m: f32, count: u8, before: Option<Levels>) -> Levels {
        let levels = self.choose(distance_m, height_m, count, before);
        let end_m = self.cards_from_m.min(self.ends[MOST_LEVELS - 1] * height_m * LADDER);
        let margin = if before.is_some_and(|before| before.gone) { -self.margin } else { 0.0 };
        Levels { gone: distance_m > (end_m * (1.0 + self.fade) + slack_m(end_m)) * (1.0 + margin), ..levels }
    }
}

fn slack_m(end_m: f32) -> f32 {
    let [least, most] = SLACK_M;
    (SLACK_SHARE * end_m).clamp(least, most)
}

/// From where trees are looked at, and where their levels end.
#[derive(Resource)]
pub(super) struct Sight {
    pub ladder: Ladder,
    eyes: Vec<Vec3>,
    looked_from: Vec<Vec3>,
    /// Whether levels have to be looked over.
    pub is_due: bool,
    in_force: LevelOfDetail,
}

impl Default for Sight {
    fn default() -> Self {
        let in_force = LevelOfDetail::default();
        let ladder = Ladder::new(&in_force, COMMON_LENS, CardRange { from_m: None });
        Self { ladder, eyes: Vec::new(), looked_from: Vec::new(), is_due: false, in_force }
    }
}

impl Sight {
    /// From the nearest viewer, m; where nobody looks, 0.
    pub fn distance_m(&self, place: Vec3) -> f32 {
        self.eyes.iter().map(|eye| eye.distance(place)).reduce(f32::min).unwrap_or(0.0)
    }

    pub fn changes_per_frame(&self) -> usize {
        self.in_force.changes_per_frame as usize
    }

    pub fn style(&self) -> LevelStyle {
        self.in_force.style
    }
}

/// Where the cards of far trees begin: written by whoever draws them.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub(crate) struct CardRange {
    /// Nowhere nearer than this do cards stand for trees, m; none while there are no cards.
    pub from_m: Option<f32>,
}

/// Takes changed settings over, and notes where the viewers are.
pub(super) fn look_about(
    wanted: Res<LevelOfDetail>,
    viewpoints: Viewpoints,
    cameras: Query<(&Camera, &Projection)>,
    cards: Res<CardRange>,
    mut sight: ResMut<Sight>,
) {
    let sight = sight.bypass_change_detection();
    if wanted.is_changed() {
        match wanted.validate() {
            Ok(()) => sight.in_force = wanted.clone(),
            Err(error) => warn!("level of detail: {error}; {:?} stays", sight.in_force),
        }
    }
    let pixels_at_1_m = |lens: &Lens| lens.picture_px / (0.5 * lens.fov_rad).tan();
    let lens = cameras.iter().filter(|(camera, _)| camera.is_active).filter_map(lens_of);
    let lens = lens.max_by(|a, b| pixels_at_1_m(a).total_cmp(&pixels_at_1_m(b))).unwrap_or(COMMON_LENS);
    let ladder = Ladder::new(&sight.in_force, lens, *cards);
    sight.eyes.clear();
    sight.eyes.extend(viewpoints.iter());
    let rests = |(now, then): (&Vec3, &Vec3)| now.distance(*then) < STEP_M;
    let all_rest = sight.eyes.len() == sight.looked_from.len() && sight.eyes.iter().zip(&sight.looked_from).all(rests);
    if !all_rest || ladder != sight.ladder {
        sight.ladder = ladder;
        sight.looked_from.clone_from(&sight.eyes);
        sight.is_due = true;
    }
}

fn lens_of((camera, projection): (&Camera, &Projection)) -> Option<Lens> {
    let Projection::Perspective(perspective) = projection else { return None };
    let picture_px = camera.physical_viewport_size()?.y as f32;
    Some(Lens { fov_rad: perspective.fov, picture_px }).filter(|lens| lens.picture_px > 0.0 && lens.fov_rad > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn ladder() -> Ladder {
        Ladder::new(&LevelOfDetail::default(), COMMON_LENS, CardRange { from_m: Some(200.0) })
    }

    #[test]
    fn the_defaults_are_valid_and_slips_are_named() {
        LevelOfDetail::default().validate().unwrap();
        let error = LevelOfDetail { fade: 0.9, ..default() }.validate().unwrap_err().to_string();
        assert_eq!(error, "`fade` is 0.9, but must be 0.02 to 0.3");
        let distances = LevelDistances { quality: 0.0, ..default() };
        let error = LevelOfDetail { distances, ..default() }.validate().unwrap_err().to_string();
        assert!(error.starts_with("`distances.quality` is 0"), "{error}");
    }

    #[test]
    fn a_large_tree_keeps_its_level_farther_than_a_small_one() {
        let first = |height_m| ladder().choose(60.0, height_m, 3, None).first;
        assert_eq!((first(30.0), first(4.0)), (0, 2));
    }

    proptest! {
        /// Whatever the way, every level that a shader shows in part is worn, and none that it does not show at all.
        #[test]
        fn what_is_seen_is_worn(height_m in 1.0..40.0_f32, way in prop::collection::vec(0.0..900.0_f32, 1..40)) {
            let ladder = ladder();
            let mut worn = None;
            for distance_m in way {
                let levels = ladder.choose(distance_m, height_m, 3, worn);
                worn = Some(levels);
                for end in 0..2_u8 {
                    let end_m = ladder.ends[usize::from(end)] * height_m;
                    let fades = (distance_m / end_m - 1.0).abs() < ladder.fade;
                    let others = |other: u8| other != end && (distance_m / (ladder.ends[usize::from(other)] * height_m) - 1.0).abs() < ladder.fade + 0.3;
                    if fades && !(0..2).any(others) {
                        prop_assert_eq!(levels, Levels { first: end, both: true, gone: false });
                    }
                }
            }
        }

        #[test]
        fn who_trembles_at_a_border_changes_no_clothes(seed_m in 5.0..600.0_f32, height_m in 5.0..40.0_f32, steps in prop::collection::vec(-0.5..0.5_f32, 30)) {
            let ladder = ladder();
            let mut worn = ladder.choose(seed_m, height_m, 3, None);
            let mut changes = 0;
            for step in steps {
                let next = ladder.choose(seed_m + step, height_m, 3, Some(worn));
                changes += usize::from(next != worn);
                worn = next;
            }
            prop_assert!(changes <= 1, "{} changes", changes);
        }
    }

    #[test]
    fn a_tree_is_gone_only_where_its_card_is_whole() {
        let ladder = ladder();
        let gone = |distance_m, before| ladder.choose_before_card(distance_m, 20.0, 3, before).gone;
        // Cards begin at 200 m, and are whole there.
        assert!(!gone(200.0 * (1.0 + ladder.fade), None) && gone(230.0, None));
        let before = Levels { first: 2, both: false, gone: true };
        assert!(gone(220.0, Some(before)) && !gone(200.0, Some(before)));
        assert!(!ladder.choose(1e6, 20.0, 3, None).gone);
    }

    #[test]
    fn one_level_is_worn_at_any_distance() {
        assert_eq!(ladder().choose(1e6, 20.0, 1, None), Levels::default());
        assert_eq!(ladder().choose(f32::NAN, 20.0, 3, None).first, 2);
    }
}
