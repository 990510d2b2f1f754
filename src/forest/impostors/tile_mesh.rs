//! The meshes of a tile: its plants as impostors, species by species.

use super::species::ImpostorSpecies;
use crate::{
    forest::planted_tile::PlantedTile,
    render::impostors::mesh::{ImpostorInstance, impostor_mesh},
    scatter::Planted,
    tree::{Tree, growth::age::Age},
};
use bevy::{camera::primitives::Aabb, prelude::*};

/// The trees of one species in a tile.
pub(super) struct TileMesh {
    /// Number of the species in the forest.
    pub species: usize,
    pub mesh: Mesh,
    pub bounds: Aabb,
    pub trees: usize,
}

/// What impostors follow from, of an [`ImpostorSpecies`].
#[derive(Clone, Copy)]
pub(super) struct ImpostorShape {
    age: Age,
    reach_m: f32,
    variants: u32,
    shown_variants: u32,
}

impl From<&ImpostorSpecies> for ImpostorShape {
    fn from(species: &ImpostorSpecies) -> Self {
        let &ImpostorSpecies { age, reach_m, variants, shown_variants, .. } = species;
        Self { age, reach_m, variants, shown_variants }
    }
}

/// The meshes of a tile whose least corner (x, z) is given, m. Plants of species without a shape have no impostors.
pub(super) fn tile_meshes(tile: &PlantedTile, corner: Vec2, shapes: &[Option<ImpostorShape>]) -> Vec<TileMesh> {
    let mut trees: Vec<Vec<ImpostorInstance>> = vec![Vec::new(); shapes.len()];
    for plant in tile.plants() {
        let species = usize::from(plant.species);
        if let Some(Some(shape)) = shapes.get(species) {
            trees[species].push(impostor_of(plant, shape, corner));
        }
    }
    let drawn = |(species, (trees, shape)): (usize, (Vec<ImpostorInstance>, &Option<ImpostorShape>))| {
        let shape = shape.filter(|_| !trees.is_empty())?;
        let (mesh, bounds) = impostor_mesh(&trees, shape.reach_m);
        Some(TileMesh { species, mesh, bounds, trees: trees.len() })
    };
    trees.into_iter().zip(shapes).enumerate().filter_map(drawn).collect()
}

/// The impostor of a plant: as large as the tree that it would be near, and of its variant if the atlas shows that.
fn impostor_of(plant: &Planted, shape: &ImpostorShape, corner: Vec2) -> ImpostorInstance {
    ImpostorInstance {
        foot: plant.position - Vec3::new(corner.x, 0.0, corner.y),
        turn_rad: plant.turn_rad,
        size: shape.age.stage(plant.age_years).height * plant.vigour,
        tint: plant.tint,
        variant: Tree::variant_of(u64::from(plant.seed), shape.variants) % shape.shown_variants.max(1),
    }
}
