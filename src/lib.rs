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
//! The guide in `docs/guide` has a chapter on each part. Begin with [`Wind`](wind::Wind), [`Tree`](tree::Tree),
//! [`Forest`](forest::Forest) and [`Terrain`](terrain::Terrain).
//!
//! # How it works
//! - **Once per wind**, in the background: a periodic field of turbulent wind is synthesised from measured spectra
//!   ([`wind`]). From it the response of unit cantilever beams is computed, for some twenty natural frequencies, for each
//!   place across the wind and each moment ([`dynamics`]). [`sway`] keeps these tables and fades between those of two winds.
//! - **Once per species**, in the background: trees are grown and baked into models ([`tree`]). Every branch of a model
//!   knows its frequency and its exposure to the wind. [`lod`] makes the lower levels of detail.
//! - **When a game touches a tree**, on the CPU: its beams get oscillators of their own for as long as they move ([`sway::LiveSway`]), by
//!   winds that a game makes ([`wind::WindSource`]), bodies ([`sway::Pusher`]) and blows ([`sway::TreeImpulse`]).
//! - **In every frame**, on the GPU (`render`): a compute pass poses every branch of every tree in view. For each branch it
//!   fetches one interpolated row of the table and multiplies a few numbers. The vertex shader moves vertices with their
//!   branches. On the CPU there is work only for what changes.
//!
//! # Rooms
//! Each folder of `src` is a room. A room imports only those that it may know; `tests/architecture.rs` checks it.
//!
//! | room | what | knows |
//! |---|---|---|
//! | [`wind`] | spectra, field, gusts, [`Wind`](wind::Wind), [`WindCell`](wind::WindCell), [`WindSource`](wind::WindSource) | none |
//! | [`dynamics`] | cantilevers, load bases, response tables, poses; no ECS | none |
//! | [`texture`] | images with mips, Fourier textures | none |
//! | [`scatter`] | point patterns and forest plans: where plants stand | none |
//! | [`tree`] | species, growth, meshes, [`Tree`](tree::Tree), [`Season`](tree::Season) | dynamics, texture |
//! | [`lod`] | lower levels of detail of a baked tree: decimated meshes, impostors, envelopes | tree, texture, dynamics |
//! | [`sway`] | how trees answer the wind: response tables, fades, articulated trees, trees that are touched; no rendering | tree, wind, dynamics |
//! | `render` | how trees are drawn: prepared species, instances, LOD selection, shaders, impostors | sway, lod, tree, wind, dynamics, texture |
//! | [`query`] | what games ask: rays, colliders, the wind among trees, [`WindListener`](query::WindListener) | sway, tree, wind, dynamics |
//! | `export` | trees and stands as files: glTF, OBJ, impostors; no ECS | sway, lod, tree, texture, dynamics |
//! | [`grass`] | meadows that bend in the wind, [`GrassPatch`](grass::GrassPatch) | dynamics, sway, render |
//! | [`fire`] | fires that lean with it and give light, [`Fire`](fire::Fire) | sway, wind, render |
//! | [`terrain`] | random fields with the covariance of real ground, maps, splines; [`Terrain`](terrain::Terrain) | texture, render |
//! | [`cells`] | the grid of a forest: what to plant, what is seen, stems by place; no ECS | scatter |
//! | [`forest`] | forests that grow from plans around the viewers, [`Forest`](forest::Forest) | scatter, cells, terrain, tree, lod, sway, wind, render |
//! | `editor` | panels that edit all of it while the program runs | forest, scatter, terrain, tree, lod, sway, wind, render, dynamics, texture |
//!
//! What all rooms may use lies beside `lib.rs`: [`Ground`], [`Viewpoint`], [`SettingError`] and their like.
//!
//! Order your own systems against the sets of [`WindwoodSystems`].
//!
//! # Features
//! `render` (on by default) holds all drawing. Without it, [`WindwoodMinimalPlugins`] moves the same trees on a server or in
//! a test. `picking` makes trees pickable by Bevy's pointers, `avian` makes their colliders bodies of `avian3d`. `export` writes trees and
//! stands as files for other programs. `editor` adds the workbench: panels that edit species, woods, ground, wind and levels.

#![forbid(unsafe_code)]

mod background;
mod constants;
#[cfg(any(feature = "editor", feature = "export"))]
mod file_write;
mod ground;
mod interpolation;
mod mixing;
mod plugin_checks;
mod removal;
mod ron_loader;
mod ron_text;
mod schedule;
mod sequence;
mod setting;
mod timing;
mod viewpoint;

pub mod cells;
pub mod dynamics;
#[cfg(feature = "editor")]
pub mod editor;
#[cfg(feature = "export")]
pub mod export;
pub mod fire;
pub mod forest;
pub mod grass;
pub mod lod;
pub mod query;
#[cfg(feature = "render")]
pub mod render;
pub mod scatter;
pub mod sway;
pub mod terrain;
pub mod texture;
pub mod tree;
pub mod wind;

pub use ground::{Ground, LevelGround};
pub use ron_loader::RonLoadError;
pub use ron_text::SyntaxError;
pub use schedule::WindwoodSystems;
pub use setting::SettingError;
pub use timing::SystemTimes;
pub use viewpoint::Viewpoint;

use bevy::app::{PluginGroup, PluginGroupBuilder};

/// What a game needs: `use bevy_windwood::prelude::*;`.
pub mod prelude {
    #[cfg(feature = "render")]
    pub use crate::render::{LevelOfDetail, LevelStyle, TreeLighting, TreeMeshes};
    pub use crate::{
        Ground, Viewpoint, WindwoodMinimalPlugins, WindwoodPlugins, WindwoodSystems,
        fire::{Fire, FireLook, FireShape},
        forest::{
            FallenTree, FallingTree, Forest, ForestChanges, ForestEditor, ForestGround, ForestSettings, NewStem,
            StemId, Stump,
        },
        grass::{GrassField, GrassGround, GrassLook, GrassPatch, GrassResponse, GrassShade, Sward, Tuft},
        query::{TreeColliderSettings, TreeColliders, TreeRays, WindInTrees, WindListener},
        sway::{ActiveSway, InCanopy, LiveSettings, LiveSway, Pusher, PusherShape, SwaySettings, TreeImpulse},
        terrain::{GroundLook, Terrain, TerrainFile, TerrainSettings},
        tree::{Articulated, Beam, BeamOf, Grown, Leaf, LeafOf, Season, Species, Tree, TreeBeams, TreeLeaves},
        wind::{ActiveWind, Canopy, SourceKind, Wind, WindCell, WindClock, WindSource, WindSources},
    };
}

/// Everything: add it after `DefaultPlugins`.
pub struct WindwoodPlugins;

impl PluginGroup for WindwoodPlugins {
    fn build(self) -> PluginGroupBuilder {
        let group = PluginGroupBuilder::start::<Self>().add_group(WindwoodMinimalPlugins);
        #[cfg(feature = "render")]
        let group = group
            .add(render::TreeRenderPlugin)
            .add(grass::GrassDrawPlugin)
            .add(fire::FireDrawPlugin)
            .add(terrain::TerrainDrawPlugin)
            .add(forest::ForestRenderPlugin)
            .add(wind::WindGizmoPlugin);
        #[cfg(feature = "picking")]
        let group = group.add(query::TreePickingPlugin);
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
            .add(terrain::TerrainPlugin)
            .add(sway::SwayPlugin)
            .add(query::TreeQueryPlugin)
            .add(grass::GrassPlugin)
            .add(fire::FirePlugin)
            .add(forest::ForestPlugin)
    }
}

/// The code blocks of the readme and the guide, compiled by `cargo test --doc`.
#[cfg(all(doctest, feature = "render"))]
mod guide {
    #[doc = include_str!("../README.md")]
    struct Readme;
    #[doc = include_str!("../docs/guide/wind.md")]
    struct Wind;
    #[doc = include_str!("../docs/guide/live.md")]
    struct Live;
    #[doc = include_str!("../docs/guide/trees.md")]
    struct Trees;
    #[doc = include_str!("../docs/guide/forests.md")]
    struct Forests;
    #[doc = include_str!("../docs/guide/ground.md")]
    struct Ground;
    #[doc = include_str!("../docs/guide/grass_and_fire.md")]
    struct GrassAndFire;
    #[doc = include_str!("../docs/guide/lod.md")]
    struct Lod;
    #[doc = include_str!("../docs/guide/species.md")]
    struct Species;
    #[doc = include_str!("../docs/guide/servers.md")]
    struct Servers;
    #[doc = include_str!("../docs/guide/shaders.md")]
    struct Shaders;
    #[doc = include_str!("../docs/guide/queries.md")]
    struct Queries;
    #[cfg(feature = "export")]
    #[doc = include_str!("../docs/guide/export.md")]
    struct Export;
    #[cfg(feature = "editor")]
    #[doc = include_str!("../docs/guide/workbench.md")]
    struct Workbench;
}
