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

/// The rows of trees that are awake: two with the wind of sources at the tree's top and lower
/// down, and one a beam, with its free angle.
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

    fn release(&mut self, tree: Entity) -> Option<u32> {
        let released = self.trees.remove(&tree)?;
        self.ranges.free(released.range);
        Some(released.row)
    }

    /// The rows of a tree; whether they are new.
    fn range(&mut self, tree: Entity, row: u32, rows: u32) -> Option<(u32, bool)> {
        if let Some(there) = self.trees.get(&tree).filter(|there| (there.row, there.rows) == (row, rows)) {
            return Some((there.range.offset, false));
        }
        self.release(tree);
        let range = self.ranges.allocate(rows)?;
        self.end = self.end.max(range.offset + rows);
        self.trees.insert(tree, LiveRange { row, rows, range });
        Some((range.offset, true))
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
    let mut awake: Vec<(u32, &LiveSway)> = Vec::new();
    for (entity, instance, sway) in &trees {
        // One with another model than is drawn waits for that.
        let Some(row) = instance.row.filter(|row| tables.beams_of(*row) as usize == sway.len()) else { continue };
        let Some((first, is_new)) = live.range(entity, row, sway.len() as u32 + 2) else { continue };
        if is_new {
            tables.write_live(row, Some(first));
            has_new = true;
        }
        awake.push((first, sway));
    }
    if live.end > live.capacity {
        live.capacity = with_reserve(live.end);
        uploads.replace(&live.buffer, 2 * u64::from(live.capacity) * ROW_BYTES);
    }
    live.rows.resize(live.end as usize, [0.0; 4]);
    let [now, before] = live.halves();
    if has_new {
        awake.iter().for_each(|(first, sway)| live.write(*first, sway.angles_before(), sway.wind_before()));
        live.upload(&mut uploads, before);
    }
    awake.iter().for_each(|(first, sway)| live.write(*first, sway.angles(), sway.wind()));
    live.upload(&mut uploads, now);
}

impl LiveUploads {
    fn upload(&self, uploads: &mut TableUploads, first: u32) {
        let size = 2 * u64::from(self.capacity) * ROW_BYTES;
        uploads.writes.write(&self.buffer, size, u64::from(first) * ROW_BYTES, bytemuck::cast_slice(&self.rows));
    }
}
