//! Tiles of impostors: of each tile of cells that is planted, one mesh a species.

use super::{
    species::ImpostorSpeciesLibrary,
    tile_canopies::{BlockCanopies, Renewal, block_canopies},
    tile_mesh::{ImpostorShape, TileMesh, tile_meshes},
};
use crate::{
    background::{Work, spawn_work},
    forest::cells::ForestCells,
    render::{
        RenderCapabilities,
        draw::layers::insert_layers_and_culling,
        impostors::near_mask::{MaskRange, NearMask, NearMasks},
    },
    tree::Species,
};
use bevy::{
    camera::visibility::{NoAutoAabb, RenderLayers},
    platform::collections::{HashMap, HashSet},
    prelude::*,
    tasks::{block_on, poll_once},
};
use std::sync::Arc;

/// The trees of a [`Forest`](crate::forest::Forest) that are drawn as impostors, tile by tile.
#[derive(Component)]
pub struct ForestImpostors {
    /// The forest's [`ForestCells::tiles_since`] that they are of.
    tiles_since: u64,
    /// Cells along a side of a tile.
    cells: i32,
    /// How many of the forest's species they lack, which cannot be loaded.
    lacking_species: usize,
    making: Vec<(IVec2, Work<MadeTile>)>,
    tiles: HashMap<IVec2, Tile>,
    /// The newest of the forest's stands that all tiles have, and those that are being worked out for some.
    stand_generation: u64,
    renewal: Option<Renewal>,
    is_complete: bool,
    /// The near cells that are marked in the masks of the tiles, and what these were last written for.
    marked: HashSet<IVec2>,
    marked_for: Option<(u64, MaskRange)>,
}

/// The meshes of a tile, the canopies of its blocks, and the generation of the forest's stand that these are of.
type MadeTile = (Vec<TileMesh>, BlockCanopies, u64);

struct Tile {
    /// One mesh a species.
    meshes: Vec<Entity>,
    mask: NearMask,
    stand_generation: u64,
    trees: usize,
    bytes: usize,
}

/// A mesh of a tile; a child of the forest.
#[derive(Component)]
pub(super) struct ImpostorTile;

impl ForestImpostors {
    fn new(forest: &ForestCells) -> Self {
        Self {
            tiles_since: forest.tiles_since(),
            cells: forest.tile_cells(),
            lacking_species: 0,
            making: Vec::new(),
            tiles: HashMap::default(),
            stand_generation: 0,
            renewal: None,
            is_complete: false,
            marked: HashSet::default(),
            marked_for: None,
        }
    }

    /// Whether every tile that is wanted from where the viewers are is drawn.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.is_complete
    }

    /// Trees that have impostors, near ones among them.
    #[must_use]
    pub fn trees(&self) -> usize {
        self.tiles.values().map(|tile| tile.trees).sum()
    }

    /// Size of their meshes on the GPU, bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.tiles.values().map(|tile| tile.bytes).sum()
    }

    /// The entities of all of its meshes.
    pub(in crate::forest) fn meshes(&self) -> impl Iterator<Item = Entity> {
        self.tiles.values().flat_map(|tile| tile.meshes.iter().copied())
    }

    /// Takes the masks out of all tiles.
    pub(super) fn take_masks(&mut self) -> impl Iterator<Item = NearMask> {
        self.tiles.values_mut().map(|tile| std::mem::take(&mut tile.mask))
    }

    /// Marks those near cells in the masks of their tiles that all of their trees are drawn of, and writes the distances of its forest,
    /// where that has changed.
    pub(super) fn mark_near_cells(&mut self, forest: &ForestCells, masks: &mut NearMasks) {
        let range = forest.mask_range();
        let wanted = Some((forest.near.drawn_changes(), range));
        if self.marked_for == wanted || self.tiles_since != forest.tiles_since() {
            return;
        }
        let Self { cells, tiles, marked, .. } = self;
        if self.marked_for.is_none_or(|(_, before)| before != range) {
            tiles.values().for_each(|tile| masks.set_range(&tile.mask, range));
        }
        self.marked_for = wanted;
        let mut set = |cell: IVec2, is_near| {
            let place = cell.div_euclid(IVec2::splat(*cells));
            if let Some(tile) = tiles.get(&place) {
                masks.set(&tile.mask, (cell - place * *cells).as_uvec2(), is_near);
            }
        };
        marked.retain(|cell| {
            let stays = forest.near.is_drawn(*cell);
            if !stays {
                set(*cell, false);
            }
            stays
        });
        for cell in forest.near.drawn_cells() {
            if marked.insert(cell) {
                set(cell, true);
            }
        }
    }
}

/// Makes the impostors of tiles that were planted, and removes those of tiles that are dropped.
pub(super) fn stream_impostor_tiles(
    mut commands: Commands,
    library: Res<ImpostorSpeciesLibrary>,
    capabilities: Res<RenderCapabilities>,
    assets: Res<AssetServer>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut masks: ResMut<NearMasks>,
    mut forests: Query<(Entity, &mut ForestCells, Option<&RenderLayers>, Option<&mut ForestImpostors>)>,
) {
    if !capabilities.sways {
        // Impostors read the season from a table.
        return;
    }
    for (entity, mut forest, layers, tiles) in &mut forests {
        let is_wanted = forest.settings().far_to_m > 0.0;
        forest.keep_tiles_for_impostors(is_wanted);
        let is_baked = forest.species().iter().all(|species| library.is_settled(species, &assets));
        let is_ready = is_baked && forest.stand.get().is_some();
        let mut tiles = match tiles {
            Some(tiles) if is_wanted && tiles.tiles_since == forest.tiles_since() => tiles,
            None if !is_wanted => continue,
            older => {
                if is_ready || !is_wanted {
                    older.iter().flat_map(|older| older.meshes()).for_each(|mesh| commands.entity(mesh).despawn());
                    begin(entity, &mut forest, is_wanted, &mut commands);
                }
                continue;
            }
        };
        let spawner = TileSpawner { forest: entity, layers, capabilities: *capabilities };
        tiles.drop_tiles(&forest, &mut commands, &mut masks);
        tiles.receive(&forest, &library, &spawner, &mut commands, (&mut meshes, &mut masks));
        if is_ready {
            tiles.make_tiles(&mut forest, &library);
            tiles.renew_canopies(&forest, &mut masks);
        }
        tiles.is_complete = forest.is_planted() && tiles.making.is_empty() && !forest.has_tiles_for_impostors();
    }
}

fn begin(entity: Entity, forest: &mut ForestCells, is_wanted: bool, commands: &mut Commands) {
    let mut forest_entity = commands.entity(entity);
    if is_wanted {
        forest.replant_lost_tiles();
        forest_entity.insert(ForestImpostors::new(forest));
    } else {
        forest_entity.try_remove::<ForestImpostors>();
    }
}

/// Spawns the meshes of a forest's tiles.
struct TileSpawner<'a> {
    forest: Entity,
    layers: Option<&'a RenderLayers>,
    capabilities: RenderCapabilities,
}

impl TileSpawner<'_> {
    fn spawn(&self, bundle: impl Bundle, commands: &mut Commands) -> Entity {
        let mut spawned =
            commands.spawn((ImpostorTile, ChildOf(self.forest), Visibility::default(), NoAutoAabb, bundle));
        insert_layers_and_culling(&mut spawned, self.layers, self.capabilities);
        spawned.id()
    }
}

impl ForestImpostors {
    fn drop_tiles(&mut self, forest: &ForestCells, commands: &mut Commands, masks: &mut NearMasks) {
        for dropped in forest.dropped_tiles().iter().filter_map(|tile| self.tiles.remove(tile)) {
            dropped.meshes.into_iter().for_each(|mesh| commands.entity(mesh).despawn());
            masks.remove(dropped.mask);
        }
    }

    /// Has the meshes of tiles made that have been planted. Where a species can be shown that could not be, all are made anew.
    fn make_tiles(&mut self, forest: &mut ForestCells, library: &ImpostorSpeciesLibrary) {
        let lacking = forest.species().iter().filter(|species| library.get(species.id()).is_none()).count();
        if lacking < std::mem::replace(&mut self.lacking_species, lacking) {
            forest.replant();
        }
        let room = (forest.settings().cells_at_once as usize).saturating_sub(self.making.len());
        if room == 0 || !forest.has_tiles_for_impostors() {
            return;
        }
        let Some(stands) = forest.stand.get().cloned() else { return };
        let (tile_m, generation) = (self.cells as f32 * forest.planter().cell_m(), forest.stand.generations().newest());
        let shape = |species: &Handle<Species>| library.get(species.id()).map(ImpostorShape::from);
        let shapes: Arc<[Option<ImpostorShape>]> = forest.species().iter().map(shape).collect();
        for (place, planted) in forest.take_tiles_for_impostors(room) {
            let (shapes, stands, corner) =
                (shapes.clone(), stands.clone(), forest.planter().corner_m(place * self.cells));
            let task = spawn_work(move || {
                (tile_meshes(&planted, corner.as_vec2(), &shapes), block_canopies(&stands, corner, tile_m), generation)
            });
            // What was planted before is out of date.
            self.making.retain(|(other, _)| *other != place);
            self.making.push((place, task));
        }
    }

    /// Has the canopies of tiles worked out again for which the forest has other stands.
    fn renew_canopies(&mut self, forest: &ForestCells, masks: &mut NearMasks) {
        if let Some(renewal) = &mut self.renewal {
            let Some((generation, renewed)) = renewal.finished() else { return };
            self.renewal = None;
            let Some(renewed) = renewed else {
                // The next time it would panic again.
                self.tiles.values_mut().for_each(|tile| tile.stand_generation = generation);
                return;
            };
            for (place, canopies) in renewed {
                let Some(tile) = self.tiles.get_mut(&place).filter(|tile| tile.stand_generation < generation) else {
                    continue;
                };
                masks.set_canopies(&tile.mask, &canopies);
                tile.stand_generation = generation;
            }
        }
        let (generations, planter) = (forest.stand.generations(), forest.planter());
        let generation = generations.newest();
        let Some(stands) = forest.stand.get().filter(|_| self.stand_generation != generation) else { return };
        let outdated = self.tiles.iter().filter(|(place, tile)| tile.stand_generation < generations.since(**place));
        let tiles: Vec<_> = outdated.map(|(place, _)| (*place, planter.corner_m(*place * self.cells))).collect();
        if self.making.is_empty() && tiles.is_empty() {
            self.stand_generation = generation;
        } else if !tiles.is_empty() {
            let tile_m = self.cells as f32 * planter.cell_m();
            self.renewal = Some(Renewal::start(generation, stands.clone(), tiles, tile_m));
        }
    }

    /// Takes over meshes that have been made. A tile that has other plants now shows them from the same frame on.
    fn receive(
        &mut self,
        forest: &ForestCells,
        library: &ImpostorSpeciesLibrary,
        spawner: &TileSpawner,
        commands: &mut Commands,
        (meshes, masks): (&mut Assets<Mesh>, &mut NearMasks),
    ) {
        let Self { making, tiles, cells, marked, .. } = self;
        making.retain_mut(|(place, task)| {
            let Some(made) = block_on(poll_once(task)) else { return true };
            let (made, canopies, stand_generation) = made.unwrap_or_else(|panic| {
                error_once!("forest: {panic}; there are no impostors where its workers do");
                Default::default()
            });
            if !forest.has_tile(*place) {
                return false;
            }
            let first = *place * *cells;
            let tile = tiles.entry(*place).or_insert_with(|| {
                let mask = masks.add(cells.cast_unsigned(), forest.mask_range());
                let is_inside = |cell: IVec2| cell.cmpge(IVec2::ZERO).all() && cell.cmplt(IVec2::splat(*cells)).all();
                for cell in marked.iter().map(|cell| cell - first).filter(|cell| is_inside(*cell)) {
                    masks.set(&mask, cell.as_uvec2(), true);
                }
                Tile { meshes: Vec::new(), mask, stand_generation, trees: 0, bytes: 0 }
            });
            masks.set_canopies(&tile.mask, &canopies);
            tile.stand_generation = stand_generation;
            tile.meshes.drain(..).for_each(|mesh| commands.entity(mesh).despawn());
            (tile.trees, tile.bytes) = (0, 0);
            let corner = forest.planter().corner_m(first).as_vec2();
            for TileMesh { species, mesh, bounds, trees } in made {
                let Some(species) = library.get(forest.species()[species].id()) else { continue };
                tile.trees += trees;
                tile.bytes += mesh.get_vertex_buffer_size() + mesh.get_index_buffer_bytes().map_or(0, <[u8]>::len);
                let drawn = (
                    Transform::from_xyz(corner.x, 0.0, corner.y),
                    Mesh3d(meshes.add(mesh)),
                    MeshMaterial3d(species.material.clone()),
                    tile.mask.tag(),
                    bounds,
                );
                tile.meshes.push(spawner.spawn(drawn, commands));
            }
            false
        });
    }
}
