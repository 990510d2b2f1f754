//! Plants blocks of cells about the viewers in the background, and draws each as one mesh a species.

use super::{
    looks::FarLooks,
    mesh::{FarTree, block_mesh},
};
use crate::{
    forest::stream::{ForestCells, distance_to_square_m},
    scatter::Planted,
    sway::DrawPath,
    tree::growth::age::Age,
    viewpoint::Viewpoints,
};
use bevy::{
    camera::{
        primitives::Aabb,
        visibility::{NoAutoAabb, NoCpuCulling},
    },
    platform::collections::HashMap,
    prelude::*,
    tasks::{AsyncComputeTaskPool, Task, block_on, poll_once},
};

/// Cells along a side of a block.
const BLOCK_CELLS: i32 = 4;
/// As for cells: who walks to and fro makes nobody plant and clear.
const HYSTERESIS: f32 = 1.1;

/// The blocks of a [`Forest`](crate::forest::Forest), those of its trees that are no entities.
#[derive(Component)]
pub struct FarBlocks {
    /// The forest's generation that they are of.
    generation: u64,
    blocks: HashMap<IVec2, Vec<Entity>>,
    planting: Vec<(IVec2, Task<Vec<Drawn>>)>,
    /// Blocks that are wanted and not there, the nearest last.
    queue: Vec<IVec2>,
    eyes: Vec<Vec2>,
    looked_from: Vec<Vec2>,
    trees: usize,
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
    fn new(generation: u64) -> Self {
        Self {
            generation,
            blocks: HashMap::default(),
            planting: Vec::new(),
            queue: Vec::new(),
            eyes: Vec::new(),
            looked_from: Vec::new(),
            trees: 0,
        }
    }

    /// Whether every block that is wanted from where the viewers are is drawn.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        !self.looked_from.is_empty() && self.queue.is_empty() && self.planting.is_empty()
    }

    /// Trees that have been made so far.
    #[must_use]
    pub fn trees(&self) -> usize {
        self.trees
    }
}

/// Finds out which blocks are wanted, clears those that no longer are, and makes what is missing.
pub(super) fn stream_far(
    mut commands: Commands,
    looks: Res<FarLooks>,
    path: Res<DrawPath>,
    viewpoints: Viewpoints,
    mut meshes: ResMut<Assets<Mesh>>,
    mut forests: Query<(Entity, &ForestCells, Option<&mut FarBlocks>)>,
) {
    if !path.sways {
        // Cards read the season from a table.
        return;
    }
    for (entity, forest, blocks) in &mut forests {
        let dressed = forest.species().iter().all(|species| looks.get(species.id()).is_some());
        let mut blocks = match blocks {
            Some(blocks) if blocks.generation == forest.generation() => blocks,
            older => {
                if dressed && forest.far_to_m() > 0.0 {
                    let meshes = older.iter().flat_map(|older| older.blocks.values().flatten());
                    meshes.for_each(|mesh| commands.entity(*mesh).despawn());
                    commands.entity(entity).insert(FarBlocks::new(forest.generation()));
                }
                continue;
            }
        };
        let blocks = &mut *blocks;
        blocks.look(forest, &viewpoints, &mut commands);
        blocks.receive(entity, forest, &looks, *path, &mut commands, &mut meshes);
        while blocks.planting.len() < forest.cells_at_once() {
            let Some(block) = blocks.queue.pop() else { break };
            blocks.planting.push((block, plant_block(block, forest, &looks)));
        }
    }
}

fn plant_block(block: IVec2, forest: &ForestCells, looks: &FarLooks) -> Task<Vec<Drawn>> {
    let (planter, ground) = (forest.shared_planter(), forest.ground());
    let shapes: Vec<(Age, f32)> =
        forest.species().iter().filter_map(|id| looks.get(id.id())).map(|look| (look.age, look.reach_m)).collect();
    AsyncComputeTaskPool::get().spawn(async move {
        let corner = planter.corner_m(block * BLOCK_CELLS).as_vec2();
        let mut trees: Vec<Vec<FarTree>> = vec![Vec::new(); shapes.len()];
        let mut planted = Vec::new();
        for cell in (0..BLOCK_CELLS * BLOCK_CELLS).map(|cell| IVec2::new(cell % BLOCK_CELLS, cell / BLOCK_CELLS)) {
            planter.plant(block * BLOCK_CELLS + cell, &ground, &mut planted);
            for plant in &planted {
                let species = usize::from(plant.species);
                let Some((age, _)) = shapes.get(species) else { continue };
                trees[species].push(far_tree(plant, age, corner));
            }
        }
        let drawn = |(species, trees): (usize, Vec<FarTree>)| {
            let (mesh, bounds) = block_mesh(&trees, shapes[species].1);
            Drawn { species, mesh, bounds, trees: trees.len() }
        };
        trees.into_iter().enumerate().filter(|(_, trees)| !trees.is_empty()).map(drawn).collect()
    })
}

/// A plant as a card: as large as the tree that it would be near.
fn far_tree(plant: &Planted, age: &Age, corner: Vec2) -> FarTree {
    FarTree {
        foot: plant.position - Vec3::new(corner.x, 0.0, corner.y),
        turn_rad: plant.turn_rad,
        size: age.stage(plant.age_years).height * plant.vigour,
        tint: plant.tint,
    }
}

impl FarBlocks {
    /// Looks again when a viewer has moved by a quarter of a block.
    fn look(&mut self, forest: &ForestCells, viewpoints: &Viewpoints, commands: &mut Commands) {
        let planter = forest.planter();
        let side_m = planter.cell_m() * BLOCK_CELLS as f32;
        self.eyes.clear();
        self.eyes.extend(viewpoints.iter().map(Vec3::xz));
        let rests = |(now, then): (&Vec2, &Vec2)| now.distance(*then) < 0.25 * side_m;
        let nobody = self.eyes.is_empty();
        if nobody || self.eyes.len() == self.looked_from.len() && self.eyes.iter().zip(&self.looked_from).all(rests) {
            return;
        }
        self.looked_from.clone_from(&self.eyes);
        let eyes = std::mem::take(&mut self.eyes);
        let distance_m =
            |block: IVec2| distance_to_square_m(planter.corner_m(block * BLOCK_CELLS).as_vec2(), side_m, &eyes);
        let far_m = forest.far_to_m();
        let is_near = |block: &IVec2| distance_m(*block) <= HYSTERESIS * far_m;
        self.planting.retain(|(block, _)| is_near(block));
        self.blocks.retain(|block, meshes| {
            let stays = is_near(block);
            if !stays {
                meshes.iter().for_each(|mesh| commands.entity(*mesh).despawn());
            }
            stays
        });
        self.queue.clear();
        let Some([least, greatest]) = planter.cells() else { return };
        let of_cell = |cell: IVec2| cell.div_euclid(IVec2::splat(BLOCK_CELLS));
        let (least, greatest) = (of_cell(least), of_cell(greatest));
        for eye in &eyes {
            let (from, to) =
                (of_cell(planter.cell_at(eye - far_m)).max(least), of_cell(planter.cell_at(eye + far_m)).min(greatest));
            for block in (from.y..=to.y).flat_map(|row| (from.x..=to.x).map(move |column| IVec2::new(column, row))) {
                let is_there =
                    self.blocks.contains_key(&block) || self.planting.iter().any(|(other, _)| *other == block);
                if !is_there && distance_m(block) <= far_m {
                    self.queue.push(block);
                }
            }
        }
        self.queue.sort_by_cached_key(|block| (std::cmp::Reverse(distance_m(*block) as u32), block.x, block.y));
        self.queue.dedup();
        self.eyes = eyes;
    }

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
        let Self { planting, blocks, trees, .. } = self;
        planting.retain_mut(|(block, task)| {
            let Some(drawn) = block_on(poll_once(task)) else { return true };
            let corner = forest.planter().corner_m(*block * BLOCK_CELLS).as_vec2();
            let mut entities = Vec::with_capacity(drawn.len());
            for Drawn { species, mesh, bounds, trees: count } in drawn {
                let Some(look) = looks.get(forest.species()[species].id()) else { continue };
                *trees += count;
                let mut mesh = commands.spawn((
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
                    mesh.insert(NoCpuCulling);
                }
                entities.push(mesh.id());
            }
            blocks.insert(*block, entities);
            false
        });
    }
}
