//! Tiles of impostors: blocks of cells about the viewers, planted in the background, each drawn as one mesh a species.

use super::species::{ImpostorSpecies, ImpostorSpeciesLibrary};
use crate::{
    cells::{CellStream, Orders, StreamSettings, ViewerPose},
    forest::{cells::ForestCells, reach::reaching},
    render::{
        RenderCapabilities,
        draw::layers::insert_layers_and_culling,
        impostors::mesh::{ImpostorInstance, impostor_mesh},
    },
    scatter::Planted,
    setting::SettingError,
    tree::{Tree, growth::age::Age},
    viewpoint::Viewpoints,
};
use bevy::{
    camera::{
        primitives::Aabb,
        visibility::{NoAutoAabb, RenderLayers},
    },
    platform::collections::HashMap,
    prelude::*,
    tasks::{AsyncComputeTaskPool, Task, block_on, poll_once},
};

/// Cells along a side of a tile, at least.
const MIN_CELLS: i32 = 4;
/// No more tiles than this from a viewer to the border: a wide view has larger tiles, not more draws.
const TILES_TO_BORDER: f32 = 20.0;

/// The trees of a [`Forest`](crate::forest::Forest) that are drawn as impostors, tile by tile.
#[derive(Component)]
pub struct ForestImpostors {
    /// The forest's generation that they are of.
    generation: u64,
    /// Cells along a side of a tile: a power of two.
    cells: i32,
    stream: CellStream,
    orders: Orders,
    planting: Vec<(IVec2, Task<Vec<TileMesh>>)>,
    tiles: HashMap<IVec2, Tile>,
}

#[derive(Default)]
struct Tile {
    /// One mesh a species.
    meshes: Vec<Entity>,
    trees: usize,
    bytes: usize,
}

/// The trees of one species in a tile.
struct TileMesh {
    species: usize,
    mesh: Mesh,
    bounds: Aabb,
    trees: usize,
}

/// A mesh of a tile; a child of the forest.
#[derive(Component)]
pub(super) struct ImpostorTile;

impl ForestImpostors {
    fn new(forest: &ForestCells) -> Result<Self, SettingError> {
        let (planter, settings) = (forest.planter(), forest.settings());
        let mut cells = MIN_CELLS;
        while settings.far_to_m > TILES_TO_BORDER * cells as f32 * planter.cell_m() && cells < 64 {
            cells *= 2;
        }
        let side_m = planter.cell_m() * cells as f32;
        let at_once = settings.cells_at_once;
        let stream = StreamSettings {
            plants_per_step: at_once,
            most_ordered: at_once,
            drops_per_step: 4,
            ..reaching(settings.far_to_m, side_m)
        };
        let bounds = planter.cells().map(|cell| cell.map(|cell| cell.div_euclid(IVec2::splat(cells))));
        Ok(Self {
            generation: forest.generation(),
            cells,
            stream: CellStream::new(stream, side_m, bounds)?,
            orders: Orders::default(),
            planting: Vec::new(),
            tiles: HashMap::default(),
        })
    }

    /// Whether every tile that is wanted from where the viewers are is drawn.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.stream.is_complete()
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

    fn meshes(&self) -> impl Iterator<Item = Entity> {
        self.tiles.values().flat_map(|tile| tile.meshes.iter().copied())
    }
}

/// Plants the tiles that are wanted from where the viewers are, and removes those that no longer are.
pub(super) fn stream_impostor_tiles(
    mut commands: Commands,
    library: Res<ImpostorSpeciesLibrary>,
    capabilities: Res<RenderCapabilities>,
    viewpoints: Viewpoints,
    mut places: Local<Vec<ViewerPose>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut forests: Query<(Entity, &ForestCells, Option<&RenderLayers>, Option<&mut ForestImpostors>)>,
) {
    if !capabilities.sways {
        // Impostors read the season from a table.
        return;
    }
    viewpoints.fill(&mut places);
    for (entity, forest, layers, tiles) in &mut forests {
        let is_wanted = forest.settings().far_to_m > 0.0;
        let mut tiles = match tiles {
            Some(tiles) if tiles.generation == forest.generation() => tiles,
            None if !is_wanted => continue,
            older => {
                let is_baked = forest.species().iter().all(|species| library.get(species.id()).is_some());
                if is_baked || !is_wanted {
                    older.iter().flat_map(|older| older.meshes()).for_each(|mesh| commands.entity(mesh).despawn());
                    begin(entity, forest, is_wanted, &mut commands);
                }
                continue;
            }
        };
        let tiles = &mut *tiles;
        let spawner = TileSpawner { forest: entity, layers, capabilities: *capabilities };
        tiles.receive(forest, &library, &spawner, &mut commands, &mut meshes);
        tiles.stream.step(&places, &tiles.tiles, &mut tiles.orders);
        for removed in tiles.orders.drop.iter().filter_map(|tile| tiles.tiles.remove(tile)) {
            removed.meshes.into_iter().for_each(|mesh| commands.entity(mesh).despawn());
        }
        for &tile in &tiles.orders.plant {
            tiles.planting.push((tile, plant_tile(tile, tiles.cells, forest, &library)));
        }
    }
}

fn begin(entity: Entity, forest: &ForestCells, is_wanted: bool, commands: &mut Commands) {
    let mut forest_entity = commands.entity(entity);
    match ForestImpostors::new(forest) {
        Ok(tiles) if is_wanted => {
            forest_entity.insert(tiles);
        }
        Ok(_) => {
            forest_entity.try_remove::<ForestImpostors>();
        }
        Err(error) => {
            warn!("forest: {error}; there are no impostors");
            forest_entity.try_remove::<ForestImpostors>();
        }
    }
}

fn plant_tile(tile: IVec2, cells: i32, forest: &ForestCells, library: &ImpostorSpeciesLibrary) -> Task<Vec<TileMesh>> {
    let (planter, ground) = (forest.shared_planter(), forest.ground());
    let shapes: Vec<Shape> =
        forest.species().iter().filter_map(|species| library.get(species.id())).map(Shape::from).collect();
    AsyncComputeTaskPool::get().spawn(async move {
        let corner = planter.corner_m(tile * cells).as_vec2();
        let mut trees: Vec<Vec<ImpostorInstance>> = vec![Vec::new(); shapes.len()];
        let mut planted = Vec::new();
        for cell in (0..cells * cells).map(|cell| IVec2::new(cell % cells, cell / cells)) {
            planter.plant(tile * cells + cell, &ground, &mut planted);
            for plant in &planted {
                let species = usize::from(plant.species);
                let Some(shape) = shapes.get(species) else { continue };
                trees[species].push(impostor_of(plant, shape, corner));
            }
        }
        let drawn = |(species, trees): (usize, Vec<ImpostorInstance>)| {
            let (mesh, bounds) = impostor_mesh(&trees, shapes[species].reach_m);
            TileMesh { species, mesh, bounds, trees: trees.len() }
        };
        trees.into_iter().enumerate().filter(|(_, trees)| !trees.is_empty()).map(drawn).collect()
    })
}

/// What a task needs of an [`ImpostorSpecies`].
#[derive(Clone, Copy)]
struct Shape {
    age: Age,
    reach_m: f32,
    variants: u32,
    shown_variants: u32,
}

impl From<&ImpostorSpecies> for Shape {
    fn from(species: &ImpostorSpecies) -> Self {
        let &ImpostorSpecies { age, reach_m, variants, shown_variants, .. } = species;
        Self { age, reach_m, variants, shown_variants }
    }
}

/// The impostor of a plant: as large as the tree that it would be near, and of its variant if the atlas shows that.
fn impostor_of(plant: &Planted, shape: &Shape, corner: Vec2) -> ImpostorInstance {
    ImpostorInstance {
        foot: plant.position - Vec3::new(corner.x, 0.0, corner.y),
        turn_rad: plant.turn_rad,
        size: shape.age.stage(plant.age_years).height * plant.vigour,
        tint: plant.tint,
        variant: Tree::variant_of(u64::from(plant.seed), shape.variants) % shape.shown_variants.max(1),
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
    /// Takes over tiles that have been planted.
    fn receive(
        &mut self,
        forest: &ForestCells,
        library: &ImpostorSpeciesLibrary,
        spawner: &TileSpawner,
        commands: &mut Commands,
        meshes: &mut Assets<Mesh>,
    ) {
        let Self { planting, tiles, stream, cells, .. } = self;
        planting.retain_mut(|(place, task)| {
            let Some(planted) = block_on(poll_once(task)) else { return true };
            if !stream.fulfil(*place) {
                return false;
            }
            let corner = forest.planter().corner_m(*place * *cells).as_vec2();
            let mut tile = Tile::default();
            for TileMesh { species, mesh, bounds, trees } in planted {
                let Some(species) = library.get(forest.species()[species].id()) else { continue };
                tile.trees += trees;
                tile.bytes += mesh.get_vertex_buffer_size() + mesh.get_index_buffer_bytes().map_or(0, <[u8]>::len);
                let drawn = (
                    Transform::from_xyz(corner.x, 0.0, corner.y),
                    Mesh3d(meshes.add(mesh)),
                    MeshMaterial3d(species.material.clone()),
                    bounds,
                );
                tile.meshes.push(spawner.spawn(drawn, commands));
            }
            tiles.insert(*place, tile);
            false
        });
    }
}
