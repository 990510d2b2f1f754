//! The trees that the graphics processor poses: which rows of the shared tables are whose.
//!
//! A stand of trees has one table of beams (those of each model once), one of trees, and one of poses (a range for each
//! tree). Rows are written when a tree comes, moves or goes; nothing here runs for a tree that stands.

use super::{
    draw::Worn,
    rows::{BeamRow, POSE_BYTES, TreeRow},
};
use crate::tree::{Tree, TreeModel};
use bevy::{platform::collections::HashMap, prelude::*};

/// A tree's row in the stand. Taking the component away, or the entity, gives the row back.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
#[component(immutable)]
pub(super) struct Standing {
    pub row: u32,
}

/// The tables of the stand, as they are on the processor.
#[derive(Resource, Default)]
pub(super) struct Stand {
    rows: Vec<TreeRow>,
    /// Beams of each row's tree, whether it is posed or not.
    beams_of: Vec<u32>,
    row_places: Ranges,
    beams: Vec<BeamRow>,
    beam_places: Ranges,
    models: HashMap<AssetId<TreeModel>, ModelRows>,
    poses: Ranges,
    /// Whether `rows` or `beams` have changed since they were last sent.
    pub rows_changed: bool,
    pub beams_changed: bool,
}

#[derive(Clone, Copy)]
struct ModelRows {
    first: u32,
    count: u32,
}

impl Stand {
    /// Adds the beams of a model, once.
    pub fn add_model(&mut self, id: AssetId<TreeModel>, beams: impl ExactSizeIterator<Item = BeamRow>) {
        let count = beams.len() as u32;
        if self.models.contains_key(&id) || count == 0 {
            return;
        }
        let first = self.beam_places.take(count);
        self.beams.resize(self.beam_places.end as usize, BeamRow::default());
        for (row, beam) in self.beams[first as usize..].iter_mut().zip(beams) {
            *row = beam;
        }
        self.models.insert(id, ModelRows { first, count });
        self.beams_changed = true;
    }

    /// Gives the beams of a model back, once no tree has it.
    pub fn remove_model(&mut self, id: AssetId<TreeModel>) {
        if let Some(model) = self.models.remove(&id) {
            self.beam_places.give_back(model.first, model.count);
        }
    }

    /// Gives a tree of that model a row, or none if `pose_limit` poses are taken or the model is not there.
    pub fn admit(&mut self, id: AssetId<TreeModel>, pose_limit: u32) -> Option<Standing> {
        let model = *self.models.get(&id)?;
        // One pose more holds the wind at the tree.
        let length = model.count + 1;
        if !self.poses.has_room(length, pose_limit) || !self.row_places.has_room(1, ROW_LIMIT) {
            return None;
        }
        let first_pose = self.poses.take(length);
        let row = self.row_places.take(1);
        self.rows.resize(self.row_places.end as usize, TreeRow::default());
        self.beams_of.resize(self.row_places.end as usize, 0);
        self.beams_of[row as usize] = model.count;
        self.rows[row as usize] = TreeRow { first_beam: model.first, beam_count: model.count, first_pose, ..default() };
        self.rows_changed = true;
        Some(Standing { row })
    }

    /// Writes where a tree stands, how far it is ahead of the season, years, and its height while its scale is 1, m.
    pub fn place(&mut self, standing: Standing, at: &GlobalTransform, season_shift: f32, height_m: f32) {
        let (scale, rotation, translation) = at.to_scale_rotation_translation();
        let Some(row) = self.rows.get_mut(standing.row as usize) else { return };
        row.rotation = rotation.to_array();
        row.position = translation.to_array();
        row.scale = scale.y.max(f32::MIN_POSITIVE);
        row.season_and_height = TreeRow::season_and_height(season_shift, height_m * row.scale);
        self.rows_changed = true;
    }

    /// Has a tree posed, or no longer: nobody sees it.
    fn wake(&mut self, standing: Standing, awake: bool) {
        let Some(row) = self.rows.get_mut(standing.row as usize) else { return };
        // A row without beams is skipped by the shaders.
        let beam_count = if awake { self.beams_of[standing.row as usize] } else { 0 };
        if row.beam_count != beam_count {
            row.beam_count = beam_count;
            self.rows_changed = true;
        }
    }

    fn dismiss(&mut self, standing: Standing) {
        let Some(row) = self.rows.get_mut(standing.row as usize) else { return };
        self.poses.give_back(row.first_pose, self.beams_of[standing.row as usize] + 1);
        *row = TreeRow::default();
        self.row_places.give_back(standing.row, 1);
        self.rows_changed = true;
    }

    pub fn rows(&self) -> &[TreeRow] {
        &self.rows
    }

    pub fn beams(&self) -> &[BeamRow] {
        &self.beams
    }

    /// What its tables have on the graphics processor, bytes: both halves of the poses, with their reserve.
    pub fn bytes(&self) -> usize {
        let poses = 2 * (self.poses.end + self.poses.end / 2) as usize * POSE_BYTES;
        size_of_val(self.rows.as_slice()) + size_of_val(self.beams.as_slice()) + poses
    }

    /// Poses that are in use, or have been.
    pub fn pose_count(&self) -> u32 {
        self.poses.end
    }

    /// Beams of the largest model.
    pub fn most_beams(&self) -> u32 {
        self.models.values().map(|model| model.count).max().unwrap_or(0)
    }
}

/// Trees that one dispatch can hold in its second dimension (the least that WebGPU guarantees).
const ROW_LIMIT: u32 = 65_535;

/// Hands out ranges of a table, and again what was given back. Trees of a model need ranges of one length, so a range is
/// only ever used for its own length, and nothing is ever moved.
#[derive(Default)]
struct Ranges {
    end: u32,
    free: HashMap<u32, Vec<u32>>,
}

impl Ranges {
    fn has_room(&self, length: u32, limit: u32) -> bool {
        let reusable = self.free.get(&length).is_some_and(|free| !free.is_empty());
        reusable || self.end.checked_add(length).is_some_and(|end| end <= limit)
    }

    fn take(&mut self, length: u32) -> u32 {
        if let Some(first) = self.free.get_mut(&length).and_then(Vec::pop) {
            return first;
        }
        let first = self.end;
        self.end += length;
        first
    }

    fn give_back(&mut self, first: u32, length: u32) {
        self.free.entry(length).or_default().push(first);
    }
}

pub(super) fn dismiss_tree(removed: On<Remove, Standing>, trees: Query<&Standing>, mut stand: ResMut<Stand>) {
    if let Ok(standing) = trees.get(removed.entity) {
        stand.dismiss(*standing);
    }
}

/// Writes the places of trees that are new, were changed or have moved.
pub(super) fn place_trees(
    mut stand: ResMut<Stand>,
    trees: Query<
        (&Standing, &Worn, &Tree, &GlobalTransform),
        Or<(Changed<GlobalTransform>, Changed<Tree>, Added<Standing>)>,
    >,
) {
    for (standing, worn, tree, at) in &trees {
        stand.place(*standing, at, tree.season_shift(), worn.height_m);
    }
}

/// Has trees posed that come into sight, and no longer those that go: hidden ones, in cells that nobody sees, or with a card
/// in their place.
pub(super) fn wake_trees(
    mut stand: ResMut<Stand>,
    trees: Query<(&Standing, &InheritedVisibility), Or<(Changed<InheritedVisibility>, Added<Standing>)>>,
) {
    let stand = stand.bypass_change_detection();
    for (standing, visibility) in &trees {
        stand.wake(*standing, visibility.get());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_that_were_given_back_are_used_again_for_their_length() {
        let mut ranges = Ranges::default();
        let (a, b) = (ranges.take(10), ranges.take(4));
        assert_eq!((a, b, ranges.end), (0, 10, 14));
        ranges.give_back(a, 10);
        assert_eq!(ranges.take(4), 14);
        assert_eq!(ranges.take(10), 0);
        assert!(!ranges.has_room(10, 20) && ranges.has_room(2, 20));
    }

    #[test]
    fn trees_that_come_and_go_leave_the_tables_as_they_were() {
        let mut stand = Stand::default();
        let id = AssetId::<TreeModel>::default();
        stand.add_model(id, std::iter::repeat_n(BeamRow::default(), 7));
        let mut poses = 0;
        for round in 0..10 {
            let standing: Vec<Standing> = (0..100).filter_map(|_| stand.admit(id, u32::MAX)).collect();
            assert_eq!(standing.len(), 100);
            if round == 0 {
                poses = stand.pose_count();
            }
            standing.into_iter().for_each(|tree| stand.dismiss(tree));
        }
        assert_eq!((stand.pose_count(), stand.rows().len()), (poses, 100));
        assert!(stand.rows().iter().all(|row| row.beam_count == 0));
    }

    #[test]
    fn who_sleeps_gives_back_what_it_had() {
        let mut stand = Stand::default();
        let id = AssetId::<TreeModel>::default();
        stand.add_model(id, std::iter::repeat_n(BeamRow::default(), 7));
        let tree = stand.admit(id, u32::MAX).unwrap();
        stand.wake(tree, false);
        assert_eq!(stand.rows()[0].beam_count, 0);
        stand.dismiss(tree);
        let next = stand.admit(id, u32::MAX).unwrap();
        assert_eq!((stand.rows()[next.row as usize].beam_count, stand.pose_count()), (7, 8));
    }

    #[test]
    fn no_more_trees_are_admitted_than_there_are_poses() {
        let mut stand = Stand::default();
        let id = AssetId::<TreeModel>::default();
        stand.add_model(id, std::iter::repeat_n(BeamRow::default(), 7));
        let admitted = (0..10).filter(|_| stand.admit(id, 40).is_some()).count();
        assert_eq!(admitted, 5);
    }
}
