//! The prepared species: for each variant of a tree, the meshes and materials of its LOD levels.

use super::{
    lod_meshes::LevelRecipe,
    materials::{MeshMaterials, SpeciesMaterials},
    part_demand::PartDemand,
    part_set::{LevelPart, PartSet},
    tree_material::SwayMaterial,
};
use crate::{
    render::wind_exposure::WindExposure,
    tree::{Species, TreeModel, phenology::Phenology},
};
use bevy::{camera::primitives::Aabb, platform::collections::HashMap, prelude::*};
use std::{collections::BTreeMap, sync::Arc};

/// All species, as far as they have been prepared.
#[derive(Resource, Default)]
pub(crate) struct SpeciesLibrary {
    pub(super) species: HashMap<AssetId<Species>, PreparedSpecies>,
    /// Variants of which meshes are wanted that are not there, in the order in which they were asked for.
    pub(super) asked: Vec<(AssetId<Species>, AssetId<TreeModel>)>,
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
    /// Beams that move its coarsest level: the first ones.
    pub coarse_beams: u32,
    /// How its meshes are made again.
    pub recipe: Arc<LevelRecipe>,
    /// Meshes that stay on the GPU: those of the coarsest level, which stand for all others until these are there.
    pub kept: PartSet,
    /// Meshes that trees want.
    pub demand: PartDemand,
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
    /// The wood of a tree in leaf, or of a bare one, as far as that is on the GPU.
    pub fn wood(&self, is_bare: bool) -> &PreparedMesh {
        self.bare_wood.as_ref().filter(|wood| is_bare && wood.mesh.is_some()).unwrap_or(&self.wood)
    }

    fn part_mut(&mut self, part: LevelPart) -> Option<&mut PreparedMesh> {
        match part {
            LevelPart::Wood => Some(&mut self.wood),
            LevelPart::BareWood => self.bare_wood.as_mut(),
            LevelPart::Leaves => self.leaves.as_mut(),
        }
    }

    fn part(&self, part: LevelPart) -> Option<&PreparedMesh> {
        match part {
            LevelPart::Wood => Some(&self.wood),
            LevelPart::BareWood => self.bare_wood.as_ref(),
            LevelPart::Leaves => self.leaves.as_ref(),
        }
    }
}

/// A mesh with its material.
pub(crate) struct PreparedMesh {
    /// None while it is not on the GPU.
    pub mesh: Option<Handle<Mesh>>,
    pub materials: MeshMaterials,
    /// Those of a bare tree, where they are others.
    pub bare_materials: Option<MeshMaterials>,
    /// Whether its shader can draw it in part.
    pub can_fade: bool,
}

impl PreparedVariant {
    /// All meshes that it may have.
    pub fn all_parts(&self) -> PartSet {
        self.parts(|_| true)
    }

    /// Those that are on the GPU, or on their way.
    pub fn parts_there(&self) -> PartSet {
        self.parts(|mesh| mesh.mesh.is_some())
    }

    /// Those meshes.
    pub fn meshes(&self) -> impl Iterator<Item = &Handle<Mesh>> {
        let parts = self.lods.iter().flat_map(|lod| LevelPart::ALL.into_iter().filter_map(|part| lod.part(part)));
        parts.filter_map(|prepared| prepared.mesh.as_ref())
    }

    fn parts(&self, of: impl Fn(&PreparedMesh) -> bool) -> PartSet {
        let mut parts = PartSet::EMPTY;
        for (level, lod) in self.lods.iter().enumerate() {
            for part in LevelPart::ALL.into_iter().filter(|part| lod.part(*part).is_some_and(&of)) {
                parts = parts.and(PartSet::one(level, part));
            }
        }
        parts
    }

    /// What is drawn of a level.
    pub fn parts_of(&self, level: u8, is_bare: bool) -> PartSet {
        let level = usize::from(level);
        let Some(lod) = self.lods.get(level) else { return PartSet::EMPTY };
        let wood = if is_bare && lod.bare_wood.is_some() { LevelPart::BareWood } else { LevelPart::Wood };
        let leaves = if lod.leaves.is_some() { PartSet::one(level, LevelPart::Leaves) } else { PartSet::EMPTY };
        PartSet::one(level, wood).and(leaves)
    }

    /// The bark that can be drawn in part, for wood that otherwise is not: that of the coarsest level that has one.
    pub fn fading_bark(&self, is_bare: bool) -> Option<&Handle<SwayMaterial>> {
        let wood = self.lods.iter().rev().map(|lod| lod.wood(is_bare)).find(|wood| wood.can_fade)?;
        wood.materials(is_bare).swaying.as_ref()
    }

    /// Puts a mesh in its place, or none.
    pub fn set_mesh(&mut self, level: usize, part: LevelPart, mesh: Option<Handle<Mesh>>) {
        if let Some(prepared) = self.lods.get_mut(level).and_then(|lod| lod.part_mut(part)) {
            prepared.mesh = mesh;
        }
    }

    /// Ends a round of demand: frees what no tree has wanted for long.
    pub fn end_round(&mut self) {
        let unwanted = self.demand.end_round(self.parts_there()).without(self.kept);
        for level in (0..self.lods.len()).filter(|level| unwanted.has_level(*level)) {
            for part in LevelPart::ALL.into_iter().filter(|part| unwanted.contains(PartSet::one(level, *part))) {
                self.set_mesh(level, part, None);
            }
        }
    }
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

    pub fn variant_mut(
        &mut self,
        species: AssetId<Species>,
        model: AssetId<TreeModel>,
    ) -> Option<&mut PreparedVariant> {
        self.species.get_mut(&species)?.variants.get_mut(&model)
    }

    /// A tree wants meshes of a variant, now or soon. Those that are not there will be made.
    pub fn want(
        &mut self,
        species: AssetId<Species>,
        model: AssetId<TreeModel>,
        parts: impl FnOnce(&PreparedVariant) -> PartSet,
    ) {
        let Some(variant) = self.variant_mut(species, model) else { return };
        let (parts, there) = (parts(variant).common(variant.all_parts()), variant.parts_there());
        if variant.demand.want(parts, there) {
            self.asked.push((species, model));
        }
    }

    /// Takes all variants out, in the order of their models. Nothing is asked for any longer.
    pub fn take_all(&mut self) -> BTreeMap<AssetId<TreeModel>, PreparedVariant> {
        self.asked.clear();
        self.species.drain().flat_map(|(_, prepared)| prepared.variants).collect()
    }

    /// All variants of all species.
    pub fn variants_mut(&mut self) -> impl Iterator<Item = &mut PreparedVariant> {
        self.species.values_mut().flat_map(|prepared| prepared.variants.values_mut())
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
