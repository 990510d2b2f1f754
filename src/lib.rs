//! Forests that move in a physically synthesised wind, for Bevy.
//!
//! ```no_run
//! use bevy::prelude::*;
//! use bevy_windwood::prelude::*;
//!
//! App::new()
//!     .add_plugins((DefaultPlugins, WindwoodPlugins))
//!     .insert_resource(Wind { speed: 8.0, direction: Dir2::X, ..default() }) // m/s at 10 m above ground
//!     .add_systems(Startup, |mut commands: Commands, assets: Res<AssetServer>| {
//!         commands.spawn((Tree::new(assets.load("species/oak.species.ron")), Transform::default()));
//!     })
//!     .run();
//! ```
//!
//! # How it works
//! Once per wind, off the frame: a periodic field of turbulent wind is synthesised from measured spectra
//! ([`wind`]); from it the response of unit cantilever beams is computed exactly, for a ladder of natural frequencies,
//! for each lateral place and each moment ([`dynamics`]). Once per species: trees are grown and baked into models whose
//! every branch knows its frequency and its exposure ([`tree`]). Then each frame a branch, of any tree, costs one
//! interpolated fetch from that table and a few multiplications, in the vertex shader ([`sway`]).
//!
//! # Rooms
//! | room | what | knows |
//! |---|---|---|
//! | [`wind`] | spectra, field, gusts, [`Wind`](wind::Wind), [`WindCell`](wind::WindCell) | nobody |
//! | [`dynamics`] | cantilevers, oscillators, load bases, response tables, poses; no ECS | nobody |
//! | [`texture`] | the canvas with its mips, Fourier textures | nobody |
//! | [`tree`] | species, growth, meshes, [`Tree`](tree::Tree), [`Season`](tree::Season) | dynamics, texture |
//! | [`sway`] | trees in the wind, at all levels of detail, on the processor and in shaders | tree, wind, dynamics, texture, lod |
//! | [`lod`] | lower levels of detail of a baked tree: reduced meshes, envelopes, views | tree, texture, dynamics |
//! | [`grass`] | meadows that bend in the wind, [`GrassPatch`](grass::GrassPatch) | sway |
//! | [`fire`] | fires that lean with it and give light, [`Fire`](fire::Fire) | sway, wind |
//! | [`terrain`] | random fields with the covariance of real ground, maps, splines; [`Terrain`](terrain::Terrain) | texture |
//! | [`scatter`] | point patterns and forest plans: where plants stand | nobody |
//! | [`forest`] | forests that grow from plans about the viewers, [`Forest`](forest::Forest) | scatter, cells, terrain, tree, lod, sway, wind |
//! | [`cells`] | the forest's voxel grid: what is seen, at which level, what to plant, who stands where; no ECS | scatter, lod |

mod retire;
mod schedule;
mod setting;
#[cfg(feature = "render")]
mod shading;
mod timing;
mod viewpoint;

pub mod cells;
pub mod dynamics;
pub mod fire;
pub mod forest;
pub mod grass;
pub mod lod;
#[cfg(feature = "render")]
mod render;
pub mod scatter;
pub mod sway;
pub mod terrain;
pub mod texture;
pub mod tree;
pub mod wind;

pub use schedule::WindwoodSystems;
pub use setting::SettingError;
pub use timing::SystemTimes;
pub use viewpoint::Viewpoint;

use bevy::app::{PluginGroup, PluginGroupBuilder};

/// What a game needs: `use bevy_windwood::prelude::*;`.
pub mod prelude {
    #[cfg(feature = "render")]
    pub use crate::sway::{LevelOfDetail, LevelStyle, TreeLighting};
    pub use crate::{
        Viewpoint, WindwoodMinimalPlugins, WindwoodPlugins, WindwoodSystems,
        fire::{Fire, FireLook, FireShape},
        forest::{Forest, ForestGround, ForestSettings},
        grass::{GrassGround, GrassLook, GrassPatch, GrassResponse, Sward, Tuft},
        sway::{ActiveSway, SwaySettings},
        terrain::{GroundLook, Heightfield, Terrain, TerrainSettings},
        tree::{Articulated, Beam, BeamOf, Grown, Leaf, LeafOf, Season, Species, Tree, TreeBeams, TreeLeaves},
        wind::{ActiveWind, Wind, WindCell, WindClock},
    };
}

/// Everything: add it after `DefaultPlugins`.
pub struct WindwoodPlugins;

impl PluginGroup for WindwoodPlugins {
    fn build(self) -> PluginGroupBuilder {
        let group = PluginGroupBuilder::start::<Self>().add_group(WindwoodMinimalPlugins);
        #[cfg(feature = "render")]
        let group = group
            .add(sway::SwayDrawPlugin)
            .add(grass::GrassDrawPlugin)
            .add(fire::FireDrawPlugin)
            .add(terrain::TerrainDrawPlugin)
            .add(forest::ForestDrawPlugin)
            .add(wind::WindGizmoPlugin);
        group
    }
}

/// The wind, the trees and their motion without any drawing: for servers and tests. It needs Bevy's
/// `MinimalPlugins`, `AssetPlugin` and `TransformPlugin`.
pub struct WindwoodMinimalPlugins;

impl PluginGroup for WindwoodMinimalPlugins {
    fn build(self) -> PluginGroupBuilder {
        PluginGroupBuilder::start::<Self>()
            .add(wind::WindPlugin)
            .add(tree::TreePlugin)
            .add(sway::SwayPlugin)
            .add(grass::GrassPlugin)
            .add(fire::FirePlugin)
            .add(forest::ForestPlugin)
    }
}
