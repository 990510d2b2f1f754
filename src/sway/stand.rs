//! The trees that the graphics processor poses: which rows of the shared tables are whose.
//!
//! A stand of trees has one table of beams (those of each model once), one of trees, and one of poses: a range for each tree
//! that is seen, for as long as it is. Rows are written when a tree comes, moves, is seen, is seen no more, or goes; nothing
//! here runs for a tree that stands.

use super::{
    chunks::Chunks,
    draw::{DrawPath, Worn},
    ranges::Ranges,
    rows::{BeamRow, POSE_BYTES, TreeRow},
    table::{Table, with_reserve},
};
use crate::tree::{Tree, TreeModel};
use bevy::{platform::collections::HashMap, prelude::*};
use offset_allocator::{Allocation, Allocator};

/// A tree's row in the stand. Taking the component away, or the entity, gives the row back.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
#[component(immutable)]
pub(super) struct Standing {
    pub row: u32,
}

/// The tables of the stand, as they are on the processor.
#[derive(Resource)]
pub(super) struct Stand {
    pub trees: Table<TreeRow>,
    pub beams: Table<BeamRow>,
    /// What is posed.
    pub chunks: Chunks,
    /// What else is known of each row's tree.
    seats: Vec<Seat>,
    row_places: Ranges,
    beam_places: Ranges,
    models: HashMap<AssetId<TreeModel>, ModelRows>,
    poses: Allocator,
    /// Poses that are in use, or have been.
    pose_end: u32,
    /// Whether a tree that is seen stands still for want of poses, and whether some were given back since.
    is_short: bool,
    has_more: bool,
}

#[derive(Clone, Default)]
struct Seat {
    /// Of its tree, whether it is posed or not.
    beams: u32,
    is_seen: bool,
    posed: Option<Posed>,
}

#[derive(Clone)]
struct Posed {
    poses: Allocation,
    /// Where its chunks lie.
    first_chunk: u32,
}

impl Seat {
    /// Poses that its tree needs: one pose more holds the wind at the tree.
    fn poses(&self) -> u32 {
        self.beams + 1
    }
}

#[derive(Clone, Copy)]
struct ModelRows {
    first: u32,
    count: u32,
}

impl Default for Stand {
    fn default() -> Self {
        Self::new(0)
    }
}

impl Stand {
    /// A stand with room for so many poses at once.
    pub fn new(pose_limit: u32) -> Self {
        Self {
            trees: Table::default(),
            beams: Table::default(),
            chunks: Chunks::default(),
            seats: Vec::new(),
            row_places: Ranges::default(),
            beam_places: Ranges::default(),
            models: HashMap::default(),
            poses: Allocator::with_max_allocs(pose_limit, ROW_LIMIT),
            pose_end: 0,
            is_short: false,
            has_more: false,
        }
    }

    /// Adds the beams of a model, once.
    pub fn add_model(&mut self, id: AssetId<TreeModel>, beams: impl ExactSizeIterator<Item = BeamRow>) {
        let count = beams.len() as u32;
        if self.models.contains_key(&id) || count == 0 {
            return;
        }
        let first = self.beam_places.take(count);
        self.beams.reach(self.beam_places.end);
        for (row, beam) in (first..).zip(beams) {
            self.beams.write(row, beam);
        }
        self.models.insert(id, ModelRows { first, count });
    }

    /// Gives the beams of a model back, once no tree has it.
    pub fn remove_model(&mut self, id: AssetId<TreeModel>) {
        if let Some(model) = self.models.remove(&id) {
            self.beam_places.give_back(model.first, model.count);
        }
    }

    /// Gives a tree of that model a row, or none if there are too many trees or the model is not there.
    pub fn admit(&mut self, id: AssetId<TreeModel>) -> Option<Standing> {
        let model = *self.models.get(&id)?;
        if !self.row_places.has_room(1, ROW_LIMIT) {
            return None;
        }
        let row = self.row_places.take(1);
        self.trees.reach(self.row_places.end);
        self.seats.resize(self.row_places.end as usize, Seat::default());
        self.seats[row as usize] = Seat { beams: model.count, ..default() };
        self.trees.write(row, TreeRow { first_beam: model.first, ..default() });
        Some(Standing { row })
    }

    /// Writes where a tree stands, how far it is ahead of the season, years, and its height while its scale is 1, m.
    pub fn place(&mut self, standing: Standing, at: &GlobalTransform, season_shift: f32, height_m: f32) {
        let (scale, rotation, translation) = at.to_scale_rotation_translation();
        let Some(row) = self.trees.get_mut(standing.row) else { return };
        row.rotation = rotation.to_array();
        row.position = translation.to_array();
        row.scale = scale.y.max(f32::MIN_POSITIVE);
        row.season_and_height = TreeRow::season_and_height(season_shift, height_m * row.scale);
    }

    /// Has a tree posed that is seen, as long as there are poses, and no longer when it is not.
    fn see(&mut self, standing: Standing, is_seen: bool) {
        let Some(seat) = self.seats.get_mut(standing.row as usize) else { return };
        seat.is_seen = is_seen;
        if is_seen {
            self.pose(standing.row);
        } else {
            self.rest(standing.row);
        }
    }

    fn pose(&mut self, row: u32) {
        let seat = &mut self.seats[row as usize];
        if seat.posed.is_some() {
            return;
        }
        let Some(poses) = self.poses.allocate(seat.poses()) else {
            self.is_short = true;
            return;
        };
        seat.posed = Some(Posed { poses, first_chunk: self.chunks.add(row, seat.poses()) });
        self.pose_end = self.pose_end.max(poses.offset + seat.poses());
        if let Some(tree) = self.trees.get_mut(row) {
            (tree.first_pose, tree.beam_count) = (poses.offset, seat.beams);
        }
    }

    fn rest(&mut self, row: u32) {
        let seat = &mut self.seats[row as usize];
        let Some(Posed { poses, first_chunk }) = seat.posed.take() else { return };
        self.poses.free(poses);
        self.chunks.remove(first_chunk, seat.poses());
        self.has_more = true;
        if let Some(tree) = self.trees.get_mut(row) {
            tree.beam_count = 0;
        }
    }

    /// Keeps together what is posed, once trees have come and gone.
    pub fn tidy(&mut self) {
        let Self { chunks, seats, .. } = self;
        chunks.tidy(|row, first_chunk| {
            if let Some(posed) = &mut seats[row as usize].posed {
                posed.first_chunk = first_chunk;
            }
        });
    }

    /// Poses trees that are seen and for which there were no poses before, if there are now; says whether some still stand
    /// still.
    fn relieve(&mut self) -> bool {
        if self.is_short && self.has_more {
            self.is_short = false;
            for row in 0..self.trees.len() {
                if self.seats[row as usize].is_seen {
                    self.pose(row);
                }
            }
        }
        self.has_more = false;
        self.is_short
    }

    fn dismiss(&mut self, Standing { row }: Standing) {
        if row >= self.trees.len() {
            return;
        }
        self.rest(row);
        self.seats[row as usize] = Seat::default();
        self.trees.write(row, TreeRow::default());
        self.row_places.give_back(row, 1);
    }

    /// What its tables have on the graphics processor, bytes: both halves of the poses, with their reserve.
    pub fn bytes(&self) -> usize {
        let poses = 2 * with_reserve(self.pose_end) as usize * POSE_BYTES;
        self.trees.bytes() + self.beams.bytes() + self.chunks.table.bytes() + poses
    }

    /// Poses that are in use, or have been.
    pub fn pose_count(&self) -> u32 {
        self.pose_end
    }
}

/// Rows that the 16 bits of a tag, and of a chunk of poses, can name.
const ROW_LIMIT: u32 = 65_535;

pub(super) fn dismiss_tree(removed: On<Remove<Standing>>, trees: Query<&Standing>, mut stand: ResMut<Stand>) {
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
pub(super) fn see_trees(
    mut stand: ResMut<Stand>,
    path: Res<DrawPath>,
    mut warned: Local<bool>,
    trees: Query<(&Standing, &InheritedVisibility), Or<(Changed<InheritedVisibility>, Added<Standing>)>>,
) {
    let stand = stand.bypass_change_detection();
    for (standing, visibility) in &trees {
        stand.see(*standing, visibility.get());
    }
    if stand.relieve() && !*warned {
        warn!("windwood: this device can pose {} beams at once; trees beyond that stand still", path.pose_limit);
        *warned = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BEAMS: u32 = 7;

    /// A stand with room for so many poses, and a model in it.
    fn stand(pose_limit: u32) -> (Stand, AssetId<TreeModel>) {
        let (mut stand, id) = (Stand::new(pose_limit), AssetId::<TreeModel>::default());
        stand.add_model(id, std::iter::repeat_n(BeamRow::default(), BEAMS as usize));
        (stand, id)
    }

    fn posed(stand: &Stand) -> usize {
        stand.trees.rows().iter().filter(|row| row.beam_count == BEAMS).count()
    }

    #[test]
    fn trees_that_come_and_go_leave_the_tables_as_they_were() {
        let (mut stand, id) = stand(10_000);
        let mut poses = 0;
        for round in 0..10 {
            let standing: Vec<Standing> = (0..100).filter_map(|_| stand.admit(id)).collect();
            standing.iter().for_each(|tree| stand.see(*tree, true));
            assert_eq!((standing.len(), posed(&stand)), (100, 100));
            if round == 0 {
                poses = stand.pose_count();
            }
            standing.into_iter().for_each(|tree| stand.dismiss(tree));
        }
        assert_eq!((stand.pose_count(), stand.trees.rows().len()), (poses, 100));
        assert!(stand.trees.rows().iter().all(|row| row.beam_count == 0));
    }

    #[test]
    fn who_is_not_seen_gives_its_poses_to_who_is() {
        let (mut stand, id) = stand(5 * (BEAMS + 1));
        let trees: Vec<Standing> = (0..8).filter_map(|_| stand.admit(id)).collect();
        assert_eq!(posed(&stand), 0);
        trees.iter().for_each(|tree| stand.see(*tree, true));
        assert!(stand.relieve());
        assert_eq!(posed(&stand), 5);
        trees[..2].iter().for_each(|tree| stand.see(*tree, false));
        assert!(stand.relieve());
        assert_eq!(posed(&stand), 5);
        stand.dismiss(trees[2]);
        assert!(!stand.relieve());
        assert_eq!(posed(&stand), 5);
        assert!(stand.pose_count() <= 5 * (BEAMS + 1));
    }

    #[test]
    fn nobody_has_the_poses_of_another() {
        let (mut stand, id) = stand(10_000);
        let other = AssetId::Uuid { uuid: bevy::asset::uuid::Uuid::from_u128(1) };
        stand.add_model(other, std::iter::repeat_n(BeamRow::default(), 20));
        let trees: Vec<Standing> =
            (0..300).filter_map(|tree| stand.admit(if tree % 3 == 0 { other } else { id })).collect();
        for round in 0..7 {
            for (number, tree) in trees.iter().enumerate() {
                stand.see(*tree, (number + round) % 4 != 0);
            }
        }
        let mut taken: Vec<(u32, u32)> = stand
            .trees
            .rows()
            .iter()
            .filter(|row| row.beam_count > 0)
            .map(|row| (row.first_pose, row.beam_count + 1))
            .collect();
        taken.sort_unstable();
        assert_eq!(taken.len(), 225);
        assert!(taken.windows(2).all(|pair| pair[0].0 + pair[0].1 <= pair[1].0));
        assert!(taken.last().is_some_and(|(first, length)| first + length <= stand.pose_count()));
    }
}
