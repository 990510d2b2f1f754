//! Plants blocks of cells about the viewers in the background, and draws each as one mesh a species.

use super::{
    looks::{FarLook, FarLooks},
    mesh::{FarTree, block_mesh},
};
use crate::{
    cells::{CellStream, Orders, StreamSettings, Viewpoint},
    forest::cells::{ForestCells, reaching},
    scatter::Planted,
    setting::SettingError,
    sway::{CulledOnGpu, DrawPath},
    tree::{Tree, growth::age::Age},
    viewpoint::Viewpoints,
};
use bevy::{
    camera::{primitives::Aabb, visibility::NoAutoAabb},
    platform::collections::HashMap,
    prelude::*,
    tasks::{AsyncComputeTaskPool, Task, block_on, poll_once},
};

/// Cells along a side of a block, at least.
const LEAST_CELLS: i32 = 4;
/// No more blocks than this from a viewer to the border: a wide view has larger blocks, and not more draws.
const BLOCKS_TO_BORDER: f32 = 20.0;

/// The blocks of a [`Forest`](crate::forest::Forest), those of its trees that are no entities.
#[derive(Component)]
pub struct FarBlocks {
    /// The forest's generation that they are of.
    generation: u64,
    /// Cells along a side of a block: a power of two.
    cells: i32,
    stream: CellStream,
    orders: Orders,
    planting: Vec<(IVec2, Task<Vec<Drawn>>)>,
    blocks: HashMap<IVec2, Block>,
}

#[derive(Default)]
struct Block {
    /// One mesh a species.
    meshes: Vec<Entity>,
    trees: usize,
    bytes: usize,
}

/// The trees of one species in a block.
struct Drawn {
    species: usize,
    mesh: Mesh,
    bounds: Aabb,
    trees: usize,
}

/// A mesh of far trees; a child of the forest.
#[derive(Component)]
pub(super) struct FarBlock;

impl FarBlocks {
    fn new(forest: &ForestCells) -> Result<Self, SettingError> {
        let (planter, settings) = (forest.planter(), forest.settings());
        let mut cells = LEAST_CELLS;
        while settings.far_to_m > BLOCKS_TO_BORDER * cells as f32 * planter.cell_m() && cells < 64 {
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
            blocks: HashMap::default(),
        })
    }

    /// Whether every block that is wanted from where the viewers are is drawn.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.stream.is_complete()
    }

    /// Trees that are drawn as cards, near ones among them.
    #[must_use]
    pub fn trees(&self) -> usize {
        self.blocks.values().map(|block| block.trees).sum()
    }

    /// What their meshes have on the graphics processor, bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.blocks.values().map(|block| block.bytes).sum()
    }

    fn meshes(&self) -> impl Iterator<Item = Entity> {
        self.blocks.values().flat_map(|block| block.meshes.iter().copied())
    }
}

/// Finds out which blocks are wanted, clears those that no longer are, and makes what is missing.
pub(super) fn stream_far(
    mut commands: Commands,
    looks: Res<FarLooks>,
    path: Res<DrawPath>,
    viewpoints: Viewpoints,
    mut places: Local<Vec<Viewpoint>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut forests: Query<(Entity, &ForestCells, Option<&mut FarBlocks>)>,
) {
    if !path.sways {
        // Cards read the season from a table.
        return;
    }
    viewpoints.fill(&mut places);
    for (entity, forest, blocks) in &mut forests {
        let mut blocks = match blocks {
            Some(blocks) if blocks.generation == forest.generation() => blocks,
            older => {
                let dressed = forest.species().iter().all(|species| looks.get(species.id()).is_some());
                let wanted = forest.settings().far_to_m > 0.0;
                if dressed || !wanted {
                    older.iter().flat_map(|older| older.meshes()).for_each(|mesh| commands.entity(mesh).despawn());
                    begin(entity, forest, wanted, &mut commands);
                }
                continue;
            }
        };
        let blocks = &mut *blocks;
        blocks.receive(entity, forest, &looks, *path, &mut commands, &mut meshes);
        blocks.stream.step(&places, &blocks.blocks, &mut blocks.orders);
        for gone in blocks.orders.drop.iter().filter_map(|block| blocks.blocks.remove(block)) {
            gone.meshes.into_iter().for_each(|mesh| commands.entity(mesh).despawn());
        }
        for &block in &blocks.orders.plant {
            blocks.planting.push((block, plant_block(block, blocks.cells, forest, &looks)));
        }
    }
}

fn begin(entity: Entity, forest: &ForestCells, wanted: bool, commands: &mut Commands) {
    let mut forest_entity = commands.entity(entity);
    match FarBlocks::new(forest) {
        Ok(blocks) if wanted => {
            forest_entity.insert(blocks);
        }
        Ok(_) => {
            forest_entity.try_remove::<FarBlocks>();
        }
        Err(error) => {
            warn!("forest: {error}; there are no far trees");
            forest_entity.try_remove::<FarBlocks>();
        }
    }
}

fn plant_block(block: IVec2, cells: i32, forest: &ForestCells, looks: &FarLooks) -> Task<Vec<Drawn>> {
    let (planter, ground) = (forest.shared_planter(), forest.ground());
    let shapes: Vec<Shape> = forest.species().iter().filter_map(|id| looks.get(id.id())).map(Shape::from).collect();
    AsyncComputeTaskPool::get().spawn(async move {
        let corner = planter.corner_m(block * cells).as_vec2();
        let mut trees: Vec<Vec<FarTree>> = vec![Vec::new(); shapes.len()];
        let mut planted = Vec::new();
        for cell in (0..cells * cells).map(|cell| IVec2::new(cell % cells, cell / cells)) {
            planter.plant(block * cells + cell, &ground, &mut planted);
            for plant in &planted {
                let species = usize::from(plant.species);
                let Some(shape) = shapes.get(species) else { continue };
                trees[species].push(far_tree(plant, shape, corner));
            }
        }
        let drawn = |(species, trees): (usize, Vec<FarTree>)| {
            let (mesh, bounds) = block_mesh(&trees, shapes[species].reach_m);
            Drawn { species, mesh, bounds, trees: trees.len() }
        };
        trees.into_iter().enumerate().filter(|(_, trees)| !trees.is_empty()).map(drawn).collect()
    })
}

/// What a task needs of a [`FarLook`].
#[derive(Clone, Copy)]
struct Shape {
    age: Age,
    reach_m: f32,
    variants: u32,
    trees: u32,
}

impl From<&FarLook> for Shape {
    fn from(&FarLook { age, reach_m, variants, trees, .. }: &FarLook) -> Self {
        Self { age, reach_m, variants, trees }
    }
}

/// A plant as a card: as large as the tree that it would be near, and with its views if there are any.
fn far_tree(plant: &Planted, shape: &Shape, corner: Vec2) -> FarTree {
    FarTree {
        foot: plant.position - Vec3::new(corner.x, 0.0, corner.y),
        turn_rad: plant.turn_rad,
        size: shape.age.stage(plant.age_years).height * plant.vigour,
        tint: plant.tint,
        tree: Tree::variant_of(u64::from(plant.seed), shape.variants) % shape.trees.max(1),
    }
}

impl FarBlocks {
    /// Takes over blocks that have been planted.
    fn receive(
        &mut self,
        entity: Entity,
        forest: &ForestCells,
        looks: &FarLooks,
        path: DrawPath,
        commands: &mut Commands,
        meshes: &mut Assets<Mesh>,
    ) {
        let Self { planting, blocks, stream, cells, .. } = self;
        planting.retain_mut(|(place, task)| {
            let Some(drawn) = block_on(poll_once(task)) else { return true };
            if !stream.fulfil(*place) {
                return false;
            }
            let corner = forest.planter().corner_m(*place * *cells).as_vec2();
            let mut block = Block::default();
            for Drawn { species, mesh, bounds, trees } in drawn {
                let Some(look) = looks.get(forest.species()[species].id()) else { continue };
                block.trees += trees;
                block.bytes += mesh.get_vertex_buffer_size() + mesh.get_index_buffer_bytes().map_or(0, <[u8]>::len);
                let mut spawned = commands.spawn((
                    FarBlock,
                    ChildOf(entity),
                    Transform::from_xyz(corner.x, 0.0, corner.y),
                    Visibility::default(),
                    Mesh3d(meshes.add(mesh)),
                    MeshMaterial3d(look.material.clone()),
                    bounds,
                    NoAutoAabb,
                ));
                if path.culls_on_gpu {
                    spawned.insert(CulledOnGpu);
                }
                block.meshes.push(spawned.id());
            }
            blocks.insert(*place, block);
            false
        });
    }
}
