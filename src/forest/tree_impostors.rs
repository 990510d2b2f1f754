//! What the trees of a forest know of their impostors.

use crate::{render::instances::components::HasImpostor, scatter::Planted, tree::growth::age::Age};
use std::sync::Arc;

/// How large the impostors of a species are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ImpostorSize {
    /// How the species ages.
    pub age: Age,
    /// Height of a mature tree's impostor, m.
    pub mature_m: f32,
}

/// The impostors that stand for the trees of a forest.
pub(super) struct TreeImpostors {
    /// From where on they do, m; none until they are drawn.
    pub from_m: Option<f32>,
    /// By number of the species; none for those that have no impostors.
    pub sizes: Arc<[Option<ImpostorSize>]>,
}

impl TreeImpostors {
    /// That of a plant. Where its species has none it stands nowhere.
    pub fn of(&self, plant: &Planted) -> HasImpostor {
        let size = self.sizes.get(usize::from(plant.species)).copied().flatten();
        let height_m = size.map_or(0.0, |size| size.mature_m * size.age.stage(plant.age_years).height);
        HasImpostor { from_m: self.from_m.filter(|_| size.is_some()), height_m }
    }
}
