//! The prepared species: for each variant of a tree, the meshes and materials of its LOD levels.

use super::materials::{MeshMaterials, SpeciesMaterials};
use crate::{
    render::wind_exposure::WindExposure,
    tree::{Species, TreeModel, phenology::Phenology},
};
use bevy::{camera::primitives::Aabb, platform::collections::HashMap, prelude::*};

/// All species, as far as they have been prepared.
#[derive(Resource, Default)]
pub(crate) struct SpeciesLibrary {
    pub(super) species: HashMap<AssetId<Species>, PreparedSpecies>,
}

/// A species that is ready to be drawn.
pub(crate) struct PreparedSpecies {
    /// Which of the species' generations the materials are of.
    pub generation: u64,
    pub phenology: Phenology,
    pub materials: SpeciesMaterials,
    pub variants: HashMap<AssetId<TreeModel>, PreparedVariant>,
}

/// One variant of a species at one age.
pub(crate) struct PreparedVariant {
    /// The step of age.
    pub age_step: i32,
    /// From the finest to the coarsest: at least one.
    pub lods: Vec<PreparedLod>,
    /// Box around all its poses in the winds that blow, tree-local, m.
    pub bounds: Aabb,
    pub height_m: f32,
}

/// One LOD level of a variant.
pub(crate) struct PreparedLod {
    pub wood: PreparedMesh,
    /// What is drawn in its place while the tree is bare.
    pub bare_wood: Option<PreparedMesh>,
    pub leaves: Option<PreparedMesh>,
    /// Whether its wood is part of that of the level before.
    pub is_wood_nested: bool,
}

impl PreparedLod {
    /// The wood of a tree in leaf, or of a bare one.
    pub fn wood(&self, is_bare: bool) -> &PreparedMesh {
        self.bare_wood.as_ref().filter(|_| is_bare).unwrap_or(&self.wood)
    }
}

/// A mesh with its material.
pub(crate) struct PreparedMesh {
    pub mesh: Handle<Mesh>,
    pub materials: MeshMaterials,
    /// Those of a bare tree, where they are others.
    pub bare_materials: Option<MeshMaterials>,
    /// Whether its shader can draw it in part.
    pub can_fade: bool,
}

/// Message: a species is prepared at one age.
#[derive(Message, Clone, Copy)]
pub(crate) struct SpeciesPrepared {
    pub species: AssetId<Species>,
    /// See [`PreparedVariant::age_step`].
    pub age_step: i32,
    /// Whether others were prepared before, which are gone.
    pub is_replaced: bool,
}

/// Message: a variant is prepared no longer.
#[derive(Message, Clone, Copy)]
pub(crate) struct VariantRemoved(pub AssetId<TreeModel>);

impl SpeciesLibrary {
    pub fn variant(&self, species: AssetId<Species>, model: AssetId<TreeModel>) -> Option<&PreparedVariant> {
        self.species.get(&species)?.variants.get(&model)
    }

    /// Whether a tree of a species has no leaves at that time of its year.
    pub fn is_bare(&self, species: AssetId<Species>, year: f32) -> bool {
        self.species.get(&species).is_some_and(|species| species.phenology.is_bare(year.rem_euclid(1.0)))
    }

    /// Fits the bounds of every variant to the winds that blow. Returns whether any has changed.
    pub fn fit_bounds(&mut self, models: &Assets<TreeModel>, exposure: &WindExposure) -> bool {
        let mut has_changed = false;
        for PreparedSpecies { phenology, variants, .. } in self.species.values_mut() {
            for (id, variant) in variants {
                let bounds = models.get(*id).map_or(variant.bounds, |model| exposure.aabb(model, phenology));
                has_changed |= std::mem::replace(&mut variant.bounds, bounds) != bounds;
            }
        }
        has_changed
    }
}

impl PreparedMesh {
    /// The materials of a tree in leaf, or of a bare one.
    pub fn materials(&self, is_bare: bool) -> &MeshMaterials {
        self.bare_materials.as_ref().filter(|_| is_bare).unwrap_or(&self.materials)
    }
}
