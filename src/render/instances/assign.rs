//! Gives trees their instances: a row in the tables, once their model is prepared.

use super::{
    components::{TreeGrows, TreeInstance},
    rows::BeamRow,
    tables::InstanceTables,
    tag::MAX_ROWS,
};
use crate::{
    render::{
        capabilities::RenderCapabilities,
        settings::ActiveLevelOfDetail,
        species::library::{PreparedVariant, SpeciesLibrary, SpeciesPrepared, VariantRemoved},
    },
    tree::{Grown, Tree, TreeModel},
};
use bevy::{ecs::system::SystemParam, prelude::*};

/// Assigns instances.
#[derive(SystemParam)]
pub(crate) struct Assigner<'w, 's> {
    commands: Commands<'w, 's>,
    library: ResMut<'w, SpeciesLibrary>,
    models: Res<'w, Assets<TreeModel>>,
    capabilities: Res<'w, RenderCapabilities>,
    tables: ResMut<'w, InstanceTables>,
    has_warned: Local<'s, bool>,
}

/// Gives an instance to every tree that has got a new model: to so many a frame of those that have none yet, and to the others at once,
/// for the meshes that they have may be gone; but a tree that grows keeps its meshes until those of the same levels are there.
pub(crate) fn assign_instances(
    settings: Res<ActiveLevelOfDetail>,
    mut prepared: MessageReader<SpeciesPrepared>,
    mut assigner: Assigner,
    new: Query<(Entity, &Tree, &Grown), Without<TreeInstance>>,
    assigned: Query<(Entity, &Tree, &Grown, &TreeInstance)>,
    regrown: Query<Entity, (Changed<Grown>, With<TreeInstance>)>,
    mut due: Local<Vec<Entity>>,
    mut waiting: Local<Vec<Entity>>,
) {
    due.clear();
    due.append(&mut waiting);
    due.extend(&regrown);
    let prepared: Vec<SpeciesPrepared> = prepared.read().copied().collect();
    if !prepared.is_empty() {
        let is_outdated = |(_, tree, grown, instance): &(Entity, &Tree, &Grown, &TreeInstance)| {
            instance.model != grown.model.id() || assigner.is_replaced(&prepared, tree, grown)
        };
        due.extend(assigned.iter().filter(is_outdated).map(|(entity, ..)| entity));
    }
    due.sort_unstable();
    due.dedup();
    for (entity, tree, grown, instance) in due.drain(..).filter_map(|tree| assigned.get(tree).ok()) {
        if assigner.has_levels_of_former(tree, grown, instance) {
            if assigner.has_grown(tree, grown, instance) {
                assigner.commands.trigger(TreeGrows { entity });
            }
            assigner.assign(entity, tree, grown);
        } else {
            waiting.push(entity);
        }
    }
    // The first meshes of a tree take twice as long as others.
    let mut left = settings.0.changes_per_frame.div_ceil(2);
    for (entity, tree, grown) in &new {
        if left == 0 {
            break;
        }
        left -= u32::from(assigner.assign(entity, tree, grown));
    }
}

impl Assigner<'_, '_> {
    fn is_replaced(&self, prepared: &[SpeciesPrepared], tree: &Tree, grown: &Grown) -> bool {
        let species = tree.species.id();
        let mut replaced = prepared.iter().filter(|it| it.is_replaced && it.species == species).peekable();
        let variant = replaced.peek().and_then(|_| self.library.variant(species, grown.model.id()));
        variant.is_some_and(|variant| replaced.any(|it| it.age_step == variant.age_step))
    }

    /// Whether the meshes that a tree's former model has on the GPU are there of its new one, too. From now on they are wanted.
    fn has_levels_of_former(&mut self, tree: &Tree, grown: &Grown, former: &TreeInstance) -> bool {
        let (species, model) = (tree.species.id(), grown.model.id());
        let library = self.library.bypass_change_detection();
        let there = library.variant(species, former.model).map(PreparedVariant::parts_there);
        let (Some(there), Some(next)) = (there, library.variant(species, model)) else { return true };
        let wanted = next.all_parts().common(there);
        let is_there = next.parts_there().contains(wanted);
        library.want(species, model, |_| wanted);
        is_there
    }

    /// Whether a tree that can be drawn is older or younger than it was, and not of a species that was changed: then its former variant is gone.
    fn has_grown(&self, tree: &Tree, grown: &Grown, former: &TreeInstance) -> bool {
        let is_prepared = |model| self.library.variant(tree.species.id(), model).is_some();
        former.model != grown.model.id() && is_prepared(former.model) && is_prepared(grown.model.id())
    }

    /// Gives a tree an instance, if its model is prepared. Returns whether it was. The row of an instance that it had before is freed
    /// when that component is replaced.
    fn assign(&mut self, entity: Entity, tree: &Tree, grown: &Grown) -> bool {
        let model = grown.model.id();
        let Some(variant) = self.library.variant(tree.species.id(), model) else { return false };
        let (lod_count, height_m) = (variant.lods.len() as u8, variant.height_m);
        let coarse_beams = variant.coarse_beams;
        let row = if self.capabilities.sways { self.allocate_row(model) } else { None };
        let tint = tree.tint_byte(grown.seed) as u8;
        self.commands.entity(entity).insert(TreeInstance { model, row, lod_count, coarse_beams, height_m, tint });
        true
    }

    fn allocate_row(&mut self, model: AssetId<TreeModel>) -> Option<u32> {
        if let Some(baked) = self.models.get(model) {
            self.tables.add_model(model, baked.beams.iter().map(|beam| BeamRow::new(beam, baked.leaf_season)));
        }
        let row = self.tables.allocate_row(model);
        if row.is_none() && self.tables.is_full() && !*self.has_warned {
            warn!("windwood: there are more than {MAX_ROWS} trees as entities; trees beyond that stand still");
            *self.has_warned = true;
        }
        row
    }
}

/// Frees the beams of variants that are prepared no longer.
pub(crate) fn remove_models(mut removed: MessageReader<VariantRemoved>, mut tables: ResMut<InstanceTables>) {
    removed.read().for_each(|VariantRemoved(model)| tables.remove_model(*model));
}

/// Frees the row of a tree whose instance goes or is replaced.
pub(crate) fn free_row(
    discarded: On<Discard<TreeInstance>>,
    trees: Query<&TreeInstance>,
    mut tables: ResMut<InstanceTables>,
) {
    if let Ok(TreeInstance { row: Some(row), .. }) = trees.get(discarded.entity) {
        tables.free_row(*row);
    }
}
