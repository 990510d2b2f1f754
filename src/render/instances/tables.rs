//! The tables of all trees that the GPU poses: which rows are whose.
//!
//! There is one table of beams (those of each model once), one of trees, and one of poses: a range for each tree that is visible, for
//! as long as it is. Rows are written when a tree comes, moves, becomes visible or hidden, or goes. Nothing here runs for a tree that
//! stands.

use super::{
    rows::{BeamRow, POSE_BYTES, TreeRow},
    tag::MAX_ROWS,
    workgroups::PoseWorkgroups,
};
use crate::{render::buffers::dirty_table::DirtyTable, tree::TreeModel, wind::Canopy};
use bevy::{platform::collections::HashMap, prelude::*};
use offset_allocator::{Allocation, Allocator};

/// Models that can have beams at once.
const MAX_MODELS: u32 = 16_384;

/// The tables on the CPU.
#[derive(Resource)]
pub(crate) struct InstanceTables {
    pub trees: DirtyTable<TreeRow>,
    pub beams: DirtyTable<BeamRow>,
    /// What the pose pass does.
    pub workgroups: PoseWorkgroups,
    /// What else is known of each row's tree.
    rows: Vec<RowState>,
    free_rows: Vec<u32>,
    models: HashMap<AssetId<TreeModel>, ModelBeams>,
    beam_ranges: Allocator,
    pose_ranges: Allocator,
    /// Poses that are in use, or have been.
    pose_end: u32,
    /// Poses that the GPU buffer holds, in all its halves.
    pub pose_capacity: u32,
    /// Whether a visible tree has no poses, and whether some were freed since.
    lacks_poses: bool,
    freed_poses: bool,
}

#[derive(Clone, Default)]
struct RowState {
    /// Of its tree, whether it is posed or not.
    beams: u32,
    /// Beams that are to be posed, the first ones: none while it is hidden.
    wanted: Option<u32>,
    posed: Option<PoseRange>,
    /// How many hold it beside its tree.
    keepers: u32,
}

#[derive(Clone)]
struct PoseRange {
    beams: u32,
    poses: Allocation,
    first_workgroup: u32,
}

/// Poses that beams of a tree need: one more, for the wind at the tree.
fn poses_of(beams: u32) -> u32 {
    beams + 1
}

struct ModelBeams {
    range: Allocation,
    count: u32,
}

impl Default for InstanceTables {
    fn default() -> Self {
        Self::new(0, 0)
    }
}

impl InstanceTables {
    /// Tables for so many poses and so many beams at most.
    pub fn new(max_poses: u32, max_beams: u32) -> Self {
        Self {
            trees: DirtyTable::default(),
            beams: DirtyTable::limited(max_beams),
            workgroups: PoseWorkgroups::default(),
            rows: Vec::new(),
            free_rows: Vec::new(),
            models: HashMap::default(),
            beam_ranges: Allocator::with_max_allocs(max_beams, MAX_MODELS),
            pose_ranges: Allocator::with_max_allocs(max_poses, MAX_ROWS),
            pose_end: 0,
            pose_capacity: 0,
            lacks_poses: false,
            freed_poses: false,
        }
    }

    /// Adds the beams of a model, once. A model for which there is no room has no rows.
    pub fn add_model(&mut self, id: AssetId<TreeModel>, beams: impl ExactSizeIterator<Item = BeamRow>) {
        let count = beams.len() as u32;
        if self.models.contains_key(&id) || count == 0 {
            return;
        }
        let Some(range) = self.beam_ranges.allocate(count) else { return };
        self.beams.grow_to(range.offset + count);
        for (row, beam) in (range.offset..).zip(beams) {
            self.beams.write(row, beam);
        }
        self.models.insert(id, ModelBeams { range, count });
    }

    /// Frees the beams of a model, once no tree has it.
    pub fn remove_model(&mut self, id: AssetId<TreeModel>) {
        if let Some(model) = self.models.remove(&id) {
            self.beam_ranges.free(model.range);
        }
    }

    /// A row for a tree of that model; none if there are too many trees or the model has no beams here.
    pub fn allocate_row(&mut self, id: AssetId<TreeModel>) -> Option<u32> {
        let model = self.models.get(&id)?;
        let (first_beam, beams) = (model.range.offset, model.count);
        let row = self.free_rows.pop().or_else(|| (self.trees.len() < MAX_ROWS).then_some(self.trees.len()))?;
        self.trees.grow_to(row + 1);
        self.rows.resize(self.trees.len() as usize, RowState::default());
        self.rows[row as usize] = RowState { beams, ..default() };
        self.trees.write(row, TreeRow::new(first_beam));
        Some(row)
    }

    /// Whether every row is in use.
    pub fn is_full(&self) -> bool {
        self.free_rows.is_empty() && self.trees.len() == MAX_ROWS
    }

    /// Writes where a tree stands, how far it is ahead of the season, years, and its height while its scale is 1, m. Of scales that
    /// differ by axis the nearest uniform one is taken.
    pub fn write_transform(&mut self, row: u32, at: &GlobalTransform, season_shift: f32, height_m: f32) {
        let Some(tree) = self.trees.get_mut(row) else { return };
        let (_, rotation, translation) = at.to_scale_rotation_translation();
        let scale = uniform_scale(at);
        tree.rotation = rotation.to_array();
        tree.position = translation.to_array();
        tree.scale = scale;
        tree.season_and_height = TreeRow::season_and_height(season_shift, height_m * scale.abs());
    }

    /// Writes in what stand a tree stands.
    pub fn write_canopy(&mut self, row: u32, canopy: &Canopy) {
        if let Some(tree) = self.trees.get_mut(row) {
            tree.set_canopy(canopy.pack());
        }
    }

    /// Writes from where on an impostor stands for a tree, m, and its height while the tree's scale is 1, m.
    pub fn write_impostor(&mut self, row: u32, at: &GlobalTransform, impostor: Option<(f32, f32)>) {
        if let Some(tree) = self.trees.get_mut(row) {
            let packed = |(from_m, height_m)| TreeRow::impostor(from_m, height_m * uniform_scale(at).abs());
            tree.impostor = impostor.map_or(TreeRow::NO_IMPOSTOR, packed);
        }
    }

    /// Beams of a row's tree, whether it is posed or not.
    pub fn beams_of(&self, row: u32) -> u32 {
        self.rows.get(row as usize).map_or(0, |state| state.beams)
    }

    /// Writes where the rows of a tree are that is awake, or that it sleeps.
    pub fn write_live(&mut self, row: u32, first: Option<u32>) {
        if let Some(tree) = self.trees.get_mut(row) {
            tree.live = first.map_or(0, |first| first + 1);
        }
    }

    /// Poses so many beams of a tree from now on, the first ones, as long as there are poses; or none any more.
    pub fn set_posed(&mut self, row: u32, beams: Option<u32>) {
        let Some(state) = self.rows.get_mut(row as usize) else { return };
        state.wanted = beams.map(|beams| beams.min(state.beams));
        let posed = state.posed.as_ref().map(|posed| posed.beams);
        if posed != state.wanted {
            self.free_poses(row);
            self.allocate_poses(row);
        }
    }

    fn allocate_poses(&mut self, row: u32) {
        let state = &mut self.rows[row as usize];
        let Some(beams) = state.wanted.filter(|_| state.posed.is_none()) else { return };
        let Some(poses) = self.pose_ranges.allocate(poses_of(beams)) else {
            self.lacks_poses = true;
            return;
        };
        let first_workgroup = self.workgroups.add(row, poses_of(beams));
        state.posed = Some(PoseRange { beams, poses, first_workgroup });
        self.pose_end = self.pose_end.max(poses.offset + poses_of(beams));
        if let Some(tree) = self.trees.get_mut(row) {
            tree.first_pose = poses.offset;
            tree.set_beams(beams);
        }
    }

    fn free_poses(&mut self, row: u32) {
        let Some(PoseRange { beams, poses, first_workgroup }) = self.rows[row as usize].posed.take() else { return };
        self.pose_ranges.free(poses);
        self.workgroups.remove(first_workgroup, poses_of(beams));
        self.freed_poses = true;
        if let Some(tree) = self.trees.get_mut(row) {
            tree.set_beams(0);
        }
    }

    /// Compacts the workgroups, once trees have come and gone.
    pub fn compact(&mut self) {
        let Self { workgroups, rows, .. } = self;
        workgroups.compact(|row, first_workgroup| {
            if let Some(posed) = &mut rows[row as usize].posed {
                posed.first_workgroup = first_workgroup;
            }
        });
    }

    /// The buffers have gone, with their device.
    pub fn forget_buffers(&mut self) {
        self.trees.forget_buffer();
        self.beams.forget_buffer();
        self.workgroups.table.forget_buffer();
    }

    /// Poses visible trees that had no poses before, if there are some now. Returns whether any is left without.
    pub fn retry_unposed(&mut self) -> bool {
        if self.lacks_poses && self.freed_poses {
            self.lacks_poses = false;
            (0..self.trees.len()).for_each(|row| self.allocate_poses(row));
        }
        self.freed_poses = false;
        self.lacks_poses
    }

    /// Writes how much is seen of a shape that comes or goes while its tree grows: see [`TreeRow::set_growth_fade`].
    pub fn write_growth_fade(&mut self, row: u32, fade: f32) {
        if let Some(tree) = self.trees.get_mut(row) {
            tree.set_growth_fade(fade);
        }
    }

    /// Keeps a row that is about to be freed, as it is: it has to be freed once more. It sleeps.
    pub fn keep_row(&mut self, row: u32) {
        if let Some(state) = self.rows.get_mut(row as usize) {
            state.keepers += 1;
            self.write_live(row, None);
        }
    }

    /// Frees a row and what it has.
    pub fn free_row(&mut self, row: u32) {
        let Some(state) = self.rows.get_mut(row as usize) else { return };
        if state.keepers > 0 {
            state.keepers -= 1;
            return;
        }
        self.free_poses(row);
        self.rows[row as usize] = RowState::default();
        self.trees.write(row, TreeRow::default());
        self.free_rows.push(row);
    }

    /// Size of the tables on the GPU, bytes.
    pub fn bytes(&self) -> usize {
        let poses = self.pose_capacity as usize * POSE_BYTES;
        self.trees.bytes() + self.beams.bytes() + self.workgroups.table.bytes() + poses
    }

    /// Poses that are in use, or have been.
    pub fn pose_count(&self) -> u32 {
        self.pose_end
    }
}

/// The uniform scale nearest to that of a transform: it keeps the volume. Negative for a mirror image.
fn uniform_scale(at: &GlobalTransform) -> f32 {
    let scale = at.affine().matrix3.determinant().cbrt();
    if scale.abs() > 0.0 { scale } else { f32::MIN_POSITIVE }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BEAMS: u32 = 7;

    /// Tables with room for so many poses, and a model.
    fn tables(max_poses: u32) -> (InstanceTables, AssetId<TreeModel>) {
        let (mut tables, id) = (InstanceTables::new(max_poses, 1000), AssetId::<TreeModel>::default());
        tables.add_model(id, std::iter::repeat_n(BeamRow::default(), BEAMS as usize));
        (tables, id)
    }

    fn posed(tables: &InstanceTables) -> usize {
        tables.trees.rows().iter().filter(|row| row.beams() == BEAMS).count()
    }

    #[test]
    fn trees_that_come_and_go_leave_the_tables_as_they_were() {
        let (mut tables, id) = tables(10_000);
        let mut poses = 0;
        for round in 0..10 {
            let rows: Vec<u32> = (0..100).filter_map(|_| tables.allocate_row(id)).collect();
            rows.iter().for_each(|row| tables.set_posed(*row, Some(BEAMS)));
            assert_eq!((rows.len(), posed(&tables)), (100, 100));
            if round == 0 {
                poses = tables.pose_count();
            }
            rows.into_iter().for_each(|row| tables.free_row(row));
        }
        assert_eq!((tables.pose_count(), tables.trees.rows().len()), (poses, 100));
        assert!(tables.trees.rows().iter().all(|row| row.beams() == 0));
    }

    #[test]
    fn a_row_is_free_once_all_who_hold_it_have_freed_it() {
        let (mut tables, id) = tables(100);
        let row = tables.allocate_row(id).expect("there is room");
        (0..2).for_each(|_| tables.keep_row(row));
        for _ in 0..2 {
            tables.free_row(row);
            let other = tables.allocate_row(id).expect("there is room");
            assert_ne!(other, row);
            tables.free_row(other);
        }
        tables.free_row(row);
        assert_eq!([(); 2].map(|()| tables.allocate_row(id)), [Some(row), Some(row + 1)]);
    }

    #[test]
    fn hidden_trees_free_poses_for_visible_ones() {
        let (mut tables, id) = tables(5 * (BEAMS + 1));
        let rows: Vec<u32> = (0..8).filter_map(|_| tables.allocate_row(id)).collect();
        assert_eq!(posed(&tables), 0);
        rows.iter().for_each(|row| tables.set_posed(*row, Some(BEAMS)));
        assert!(tables.retry_unposed());
        assert_eq!(posed(&tables), 5);
        rows[..2].iter().for_each(|row| tables.set_posed(*row, None));
        assert!(tables.retry_unposed());
        assert_eq!(posed(&tables), 5);
        tables.free_row(rows[2]);
        assert!(!tables.retry_unposed());
        assert_eq!(posed(&tables), 5);
        assert!(tables.pose_count() <= 5 * (BEAMS + 1));
    }

    #[test]
    fn pose_ranges_do_not_overlap() {
        let (mut tables, id) = tables(10_000);
        let other = AssetId::Uuid { uuid: bevy::asset::uuid::Uuid::from_u128(1) };
        tables.add_model(other, std::iter::repeat_n(BeamRow::default(), 20));
        let rows: Vec<u32> =
            (0..300).filter_map(|tree| tables.allocate_row(if tree % 3 == 0 { other } else { id })).collect();
        for round in 0..7 {
            for (number, row) in rows.iter().enumerate() {
                let beams = [None, Some(u32::MAX), Some(3), Some(BEAMS)][(number + round) % 4];
                tables.set_posed(*row, beams);
            }
        }
        let mut taken: Vec<(u32, u32)> = tables
            .trees
            .rows()
            .iter()
            .filter(|row| row.beams() > 0)
            .map(|row| (row.first_pose, row.beams() + 1))
            .collect();
        taken.sort_unstable();
        assert_eq!(taken.len(), 225);
        assert!(taken.windows(2).all(|pair| pair[0].0 + pair[0].1 <= pair[1].0));
        assert!(taken.last().is_some_and(|(first, length)| first + length <= tables.pose_count()));
    }

    #[test]
    fn models_reuse_the_beams_of_removed_models_of_other_lengths() {
        let id = |number| AssetId::<TreeModel>::Uuid { uuid: bevy::asset::uuid::Uuid::from_u128(number) };
        let mut tables = InstanceTables::new(0, 100);
        for number in 0..1000_u32 {
            let beams = 20 + (number % 40) as usize;
            tables.add_model(id(number.into()), std::iter::repeat_n(BeamRow::default(), beams));
            assert!(tables.allocate_row(id(number.into())).is_some(), "model {number} found no room");
            tables.remove_model(id(number.into()));
        }
    }

    #[test]
    fn scales_are_the_nearest_uniform_ones_and_keep_mirror_images() {
        let scale = |x, y, z| uniform_scale(&Transform::from_scale(Vec3::new(x, y, z)).into());
        assert!((scale(2.0, 2.0, 2.0) - 2.0).abs() < 1e-6 && (scale(1.0, 2.0, 4.0) - 2.0).abs() < 1e-6);
        assert!((scale(-2.0, 2.0, 2.0) + 2.0).abs() < 1e-6 && (scale(-2.0, -2.0, -2.0) + 2.0).abs() < 1e-6);
        assert!(scale(0.0, 1.0, 1.0) > 0.0);
    }
}
