//! Uploads what is added to the angles of trees that are awake. All others have no part in it.

use crate::{
    dynamics::stand_wind::WindAtTree,
    render::{
        buffers::{dirty_table::with_reserve, sway_buffers::empty_buffer, table_uploads::TableUploads},
        instances::{components::TreeInstance, tables::InstanceTables},
    },
    sway::LiveSway,
};
use bevy::{ecs::entity::EntityHashMap, math::Vec3A, prelude::*, render::storage::ShaderBuffer};
use offset_allocator::{Allocation, Allocator};

/// Rows of all trees that are awake, at most: 64 MB in both halves.
const MOST_ROWS: u32 = 1 << 21;
/// Trees that are awake, at most.
const MOST_TREES: u32 = 1 << 16;
const ROW_BYTES: u64 = 16;

/// The rows of trees that are awake: two with the wind of sources at the tree's top and lower down, and one a beam, with its free angle.
/// There is a half for this frame and one for the last, which change places each frame.
#[derive(Resource)]
pub(crate) struct LiveUploads {
    pub buffer: Handle<ShaderBuffer>,
    ranges: Allocator,
    trees: EntityHashMap<LiveRange>,
    /// Rows that a half of the buffer holds, and rows that are in use.
    capacity: u32,
    end: u32,
    is_first_half: bool,
    rows: Vec<[f32; 4]>,
}

struct LiveRange {
    row: u32,
    rows: u32,
    range: Allocation,
}

impl FromWorld for LiveUploads {
    fn from_world(world: &mut World) -> Self {
        Self {
            buffer: empty_buffer(&mut world.resource_mut::<Assets<ShaderBuffer>>()),
            ranges: Allocator::with_max_allocs(MOST_ROWS, MOST_TREES),
            trees: EntityHashMap::default(),
            capacity: 0,
            end: 0,
            is_first_half: false,
            rows: Vec::new(),
        }
    }
}

impl LiveUploads {
    /// First rows of this frame's half and of the last frame's.
    pub fn halves(&self) -> [u32; 2] {
        if self.is_first_half { [0, self.capacity] } else { [self.capacity, 0] }
    }

    /// The buffer has gone, with its device.
    pub fn forget_buffer(&mut self) {
        self.capacity = 0;
    }

    fn release(&mut self, tree: Entity) -> Option<u32> {
        let released = self.trees.remove(&tree)?;
        self.ranges.free(released.range);
        Some(released.row)
    }

    /// The first of the rows that a tree has: the same ones as long as it has the same row and as many beams.
    fn first_row(&self, tree: Entity, row: u32, sway: &LiveSway) -> Option<u32> {
        let there = self.trees.get(&tree).filter(|there| (there.row, there.rows) == (row, rows_of(sway)))?;
        Some(there.range.offset)
    }

    /// Gives rows to a tree that has none, as long as there are any. The first of them.
    fn give_rows(&mut self, tree: Entity, row: u32, sway: &LiveSway) -> Option<u32> {
        if self.first_row(tree, row, sway).is_some() {
            return None;
        }
        self.release(tree);
        let rows = rows_of(sway);
        let range = self.ranges.allocate(rows)?;
        self.end = self.end.max(range.offset + rows);
        self.trees.insert(tree, LiveRange { row, rows, range });
        Some(range.offset)
    }

    fn write(&mut self, first: u32, angles: impl Iterator<Item = Vec3A>, wind: WindAtTree) {
        let winds = [wind.high, wind.low].map(Vec3A::from);
        let values = winds.into_iter().chain(angles).map(|value| value.extend(0.0).to_array());
        self.rows[first as usize..].iter_mut().zip(values).for_each(|(row, value)| *row = value);
    }
}

/// Uploads the angles of this frame, and those of the last where a tree has just woken up.
pub(crate) fn upload_live_trees(
    mut live: ResMut<LiveUploads>,
    mut tables: ResMut<InstanceTables>,
    mut uploads: TableUploads,
    mut slept: RemovedComponents<LiveSway>,
    instances: Query<&TreeInstance>,
    trees: Query<(Entity, &TreeInstance, &LiveSway)>,
) {
    let (live, tables) = (live.bypass_change_detection(), tables.bypass_change_detection());
    for tree in slept.read().filter(|tree| !trees.contains(*tree)) {
        let released = live.release(tree);
        let row = instances.get(tree).ok().and_then(|instance| instance.row);
        if let Some(row) = released.filter(|released| row == Some(*released)) {
            tables.write_live(row, None);
        }
    }
    if trees.is_empty() {
        live.end = if live.trees.is_empty() { 0 } else { live.end };
        return;
    }
    live.is_first_half = !live.is_first_half;
    let mut has_new = false;
    for (entity, instance, sway) in &trees {
        let Some(row) = drawn_row(tables, instance, sway) else { continue };
        if let Some(first) = live.give_rows(entity, row, sway) {
            tables.write_live(row, Some(first));
            has_new = true;
        }
    }
    if live.end > live.capacity {
        live.capacity = with_reserve(live.end);
        uploads.replace(&live.buffer, 2 * u64::from(live.capacity) * ROW_BYTES);
    }
    live.rows.resize(live.end as usize, [0.0; 4]);
    let [now, before] = live.halves();
    let first_of = |live: &LiveUploads, tree, instance, sway| {
        drawn_row(tables, instance, sway).and_then(|row| live.first_row(tree, row, sway))
    };
    if has_new {
        for (entity, instance, sway) in &trees {
            let Some(first) = first_of(live, entity, instance, sway) else { continue };
            live.write(first, sway.angles_before(), sway.wind_before());
        }
        live.upload(&mut uploads, before);
    }
    for (entity, instance, sway) in &trees {
        let Some(first) = first_of(live, entity, instance, sway) else { continue };
        live.write(first, sway.angles(), sway.wind());
    }
    live.upload(&mut uploads, now);
}

/// The row of a tree that is drawn with the model whose beams are awake. One that is drawn with another waits for that.
fn drawn_row(tables: &InstanceTables, instance: &TreeInstance, sway: &LiveSway) -> Option<u32> {
    instance.row.filter(|row| tables.beams_of(*row) as usize == sway.len())
}

/// A tree has a row a beam, and two with the wind.
fn rows_of(sway: &LiveSway) -> u32 {
    sway.len() as u32 + 2
}

impl LiveUploads {
    fn upload(&self, uploads: &mut TableUploads, first: u32) {
        let size = 2 * u64::from(self.capacity) * ROW_BYTES;
        uploads.writes.write(&self.buffer, size, u64::from(first) * ROW_BYTES, bytemuck::cast_slice(&self.rows));
    }
}
