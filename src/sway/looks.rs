//! What a species looks like to the renderer: meshes, materials and beam rows, prepared off the frame.

use super::{
    cut::{Cut, LevelCut, Piece, VariantCut, cut},
    detail::{LevelStyle, Sight},
    exposure::Exposure,
    outfits::{Dyer, Outfit, SpeciesOutfits},
    rows::BeamRow,
    stand::Stand,
};
use crate::tree::{Grove, Species, SpeciesBaked, TreeModel, phenology::Phenology};
use bevy::{
    camera::primitives::Aabb,
    ecs::system::SystemParam,
    platform::collections::HashMap,
    prelude::*,
    tasks::{AsyncComputeTaskPool, Task, block_on, poll_once},
};
use std::collections::VecDeque;

/// What the species look like, as far as they have been prepared.
#[derive(Resource, Default)]
pub(super) struct Wardrobe {
    looks: HashMap<AssetId<Species>, SpeciesLooks>,
}

/// A species, ready to be put on trees.
struct SpeciesLooks {
    /// Which of the species' generations the outfits are of.
    generation: u64,
    phenology: Phenology,
    outfits: SpeciesOutfits,
    variants: HashMap<AssetId<TreeModel>, VariantLook>,
}

/// One variant of a species at one age.
pub(super) struct VariantLook {
    /// The age.
    pub step: i32,
    /// From the finest to the coarsest: at least one.
    pub levels: Vec<LevelLook>,
    /// Around all that it does in the winds that blow.
    pub bounds: Aabb,
    pub height_m: f32,
}

/// One level of a variant.
pub(super) struct LevelLook {
    pub wood: Garment,
    pub leaves: Option<Garment>,
    /// Whether its wood is part of that of the level before.
    pub nested: bool,
}

/// A mesh with its material.
pub(super) struct Garment {
    pub mesh: Handle<Mesh>,
    pub outfit: Outfit,
    /// Whether its shader can show it in part.
    pub fades: bool,
}

/// Message: the looks of a species at one age are there.
#[derive(Message, Clone, Copy)]
pub(super) struct StageDressed {
    pub species: AssetId<Species>,
    /// See [`VariantLook::step`].
    pub step: i32,
    /// Whether there were others before, which are gone.
    pub is_anew: bool,
}

struct Tailored {
    species: AssetId<Species>,
    step: i32,
    generation: u64,
    task: Task<Cut>,
}

/// Looks that are being prepared.
#[derive(Resource, Default)]
pub(super) struct Tailoring {
    /// Stages that wait to be begun.
    due: VecDeque<(AssetId<Species>, i32)>,
    tasks: Vec<Tailored>,
    style: LevelStyle,
}

impl Wardrobe {
    pub fn variant(&self, species: AssetId<Species>, model: AssetId<TreeModel>) -> Option<&VariantLook> {
        self.looks.get(&species)?.variants.get(&model)
    }

    /// Gives every variant the room that it needs now, and says whether that is another for any.
    pub fn fit_boxes(&mut self, models: &Assets<TreeModel>, exposure: &Exposure) -> bool {
        let mut is_any = false;
        for SpeciesLooks { phenology, variants, .. } in self.looks.values_mut() {
            for (id, variant) in variants {
                let bounds = models.get(*id).map_or(variant.bounds, |model| exposure.aabb(model, phenology));
                is_any |= std::mem::replace(&mut variant.bounds, bounds) != bounds;
            }
        }
        is_any
    }
}

/// Starts preparing the looks of stages that were baked, or of all when the style of levels is another, one a frame; and
/// forgets those of species that are gone.
pub(super) fn start_tailoring(
    mut baked: MessageReader<SpeciesBaked>,
    mut events: MessageReader<AssetEvent<Species>>,
    grove: Res<Grove>,
    models: Res<Assets<TreeModel>>,
    sight: Res<Sight>,
    mut tailoring: ResMut<Tailoring>,
    mut wardrobe: ResMut<Wardrobe>,
    mut stand: ResMut<Stand>,
) {
    let Tailoring { due, tasks, style } = tailoring.bypass_change_detection();
    due.extend(baked.read().map(|&SpeciesBaked { species, step }| (species, step)));
    if *style != sight.style() {
        *style = sight.style();
        due.clear();
        due.extend(grove.stages());
        due.make_contiguous().sort_unstable();
    }
    if let Some((id, step)) = due.pop_front()
        && let Some(entry) = grove.get(id)
        && let Some(stage) = entry.stages.get(&step)
    {
        let (species, style, generation) = (entry.species.clone(), *style, stage.generation);
        let variants: Vec<TreeModel> = stage.models.iter().filter_map(|model| models.get(model).cloned()).collect();
        tasks.retain(|other| (other.species, other.step) != (id, step));
        let painted = wardrobe.looks.get(&id).is_some_and(|looks| looks.generation == generation)
            || tasks.iter().any(|other| (other.species, other.generation) == (id, generation));
        let task = AsyncComputeTaskPool::get().spawn(async move { cut(&species, !painted, variants, style) });
        tasks.push(Tailored { species: id, step, generation, task });
    }
    for event in events.read() {
        if let AssetEvent::Removed { id } = event {
            tasks.retain(|other| other.species != *id);
            if let Some(looks) = wardrobe.looks.remove(id) {
                looks.variants.into_keys().for_each(|model| stand.remove_model(model));
            }
        }
    }
}

/// Makes assets of looks that are prepared.
#[derive(SystemParam)]
pub(super) struct Atelier<'w> {
    meshes: ResMut<'w, Assets<Mesh>>,
    models: Res<'w, Assets<TreeModel>>,
    exposure: Res<'w, Exposure>,
    stand: ResMut<'w, Stand>,
    dyer: Dyer<'w>,
}

/// Takes over looks that are prepared, one stage a frame.
pub(super) fn finish_tailoring(
    mut tailoring: ResMut<Tailoring>,
    grove: Res<Grove>,
    mut wardrobe: ResMut<Wardrobe>,
    mut atelier: Atelier,
    mut dressed: MessageWriter<StageDressed>,
) {
    let tasks = &tailoring.tasks;
    // The first of a species brings the textures for all.
    let is_first = |number: usize| tasks[..number].iter().all(|other| other.species != tasks[number].species);
    let ready = (0..tasks.len()).find(|&number| is_first(number) && tasks[number].task.is_finished());
    let Some(number) = ready else { return };
    let Tailored { species, step, generation, mut task } = tailoring.tasks.remove(number);
    let Some(cut) = block_on(poll_once(&mut task)) else { return };
    let Some(entry) = grove.get(species) else { return };
    let Some(stage) = entry.stages.get(&step).filter(|stage| stage.generation == generation) else { return };
    if let Some(painted) = cut.painted {
        let outfits = atelier.dyer.outfits(&entry.species, painted);
        let variants = wardrobe.looks.remove(&species).map(|old| old.variants).unwrap_or_default();
        let phenology = entry.species.phenology;
        wardrobe.looks.insert(species, SpeciesLooks { generation, phenology, outfits, variants });
    }
    let Some(looks) = wardrobe.looks.get_mut(&species) else { return };
    let is_anew = looks.variants.values().any(|variant| variant.step == step);
    atelier.sew(looks, step, &stage.models, cut.variants);
    dressed.write(StageDressed { species, step, is_anew });
}

impl Atelier<'_> {
    /// Makes the looks of one age, in place of those that were there.
    fn sew(&mut self, looks: &mut SpeciesLooks, step: i32, models: &[Handle<TreeModel>], variants: Vec<VariantCut>) {
        looks.variants.retain(|id, variant| {
            let stays = variant.step != step;
            if !stays && models.iter().all(|model| model.id() != *id) {
                self.stand.remove_model(*id);
            }
            stays
        });
        for (handle, VariantCut { levels, height_m }) in models.iter().zip(variants) {
            let Some(model) = self.models.get(handle) else { continue };
            self.stand.add_model(handle.id(), model.beams.iter().map(BeamRow::from));
            let bounds = self.exposure.aabb(model, &looks.phenology);
            let levels = levels.into_iter().map(|level| self.level(level, &looks.outfits)).collect();
            looks.variants.insert(handle.id(), VariantLook { step, levels, bounds, height_m });
        }
    }

    fn level(&mut self, LevelCut { wood, leaves, nested }: LevelCut, outfits: &SpeciesOutfits) -> LevelLook {
        let mut garment = |Piece { mesh, cloth }: Piece| Garment {
            mesh: self.meshes.add(mesh),
            fades: cloth.fades(),
            outfit: self.dyer.of(cloth, outfits),
        };
        LevelLook { wood: garment(wood), leaves: leaves.map(garment), nested }
    }
}
