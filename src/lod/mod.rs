//! Levels of detail below the full tree, made of its meshes and textures; pure, and made once for each model.
//!
//! Setas, Gomes & Rebordão ("Dynamic simulation of natural environments in virtual reality", section 4.1.2) draw a tree
//! in three resolutions. The high one is the grown tree itself. Their two lower ones are here, one between, and one
//! that they could not have:
//!
//! - [`simplify`]: the tree's own meshes without thin branches, and with fewer but larger sprays of leaves.
//! - [`cylinder`]: the paper's *medium* level, a cone for the trunk and an envelope of leaves that wears a translucent
//!   cylindrical projection of the tree, ray-traced by a camera that turns around it ([`scene`]). It oscillates as the
//!   trunk does, and its texture is a sequence of images of the crown's sway.
//! - [`plain`]: the paper's *low* level, four plain polygons that stand still.
//! - [`views`]: an atlas of parallel projections from all over the upper hemisphere, three of which are mixed towards any
//!   eye; and how far such pictures lean in the wind ([`Lean`]).
//!
//! [`levels`] makes them all, in about a tenth of a second: not on the frame.

mod breeze;
mod chart;
pub mod cylinder;
mod film;
mod lean;
pub mod level;
mod paint;
pub mod plain;
pub mod profile;
mod projection;
pub mod scene;
pub mod settings;
pub mod simplify;
mod spin;
mod stem;
pub mod views;

#[cfg(test)]
mod tests;

pub use chart::{ViewWeight, view_direction, view_place, views_towards};
pub use cylinder::{CylinderLevel, EnvelopeVertices};
pub use lean::Lean;
pub use level::{Lens, Level, LevelDistances, LevelSwitches};
pub use plain::PlainVertices;
pub use profile::CrownProfile;
pub use scene::Scene;
pub use settings::{CylinderSettings, LevelSettings, Reduction, ViewSettings};
pub use simplify::ReducedMeshes;
pub use views::{ViewAtlas, ViewBasis, ViewFrame};

use crate::tree::{Species, TreeModel, painting::SpeciesTextures};

/// All lower levels of one model.
#[derive(Clone, Debug, PartialEq)]
pub struct TreeLevels {
    /// The tree's own meshes, thinned; one for each [`Reduction`] of the settings, in their order.
    pub reduced: Vec<ReducedMeshes>,
    /// The paper's medium level; none for a tree that has neither leaves nor branches.
    pub cylinder: Option<CylinderLevel>,
    /// The paper's low level.
    pub plain: PlainVertices,
    /// Views from all sides.
    pub views: ViewAtlas,
}

/// Makes all lower levels of a model of `species` that wears `textures`. The same input gives the same levels, byte by
/// byte. `settings` should be [valid](LevelSettings::validate).
#[must_use]
pub fn levels(
    species: &Species,
    model: &TreeModel,
    textures: &SpeciesTextures,
    settings: &LevelSettings,
) -> TreeLevels {
    let scene = Scene::new(species, model, textures);
    let cylinder = CylinderLevel::bake(&scene, species, model, &settings.cylinder);
    TreeLevels {
        reduced: settings.reductions.iter().map(|reduction| simplify::reduce(model, reduction)).collect(),
        plain: plain::plain(&scene, model, cylinder.as_ref()),
        views: ViewAtlas::bake(std::slice::from_ref(&scene), &settings.views),
        cylinder,
    }
}
