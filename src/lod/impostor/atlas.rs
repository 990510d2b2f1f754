//! The views of trees from all over the upper hemisphere, in one atlas.
//!
//! Views lie on a grid over the unfolded hemisphere ([`octahedral`](super::octahedral)), so that three of them surround any
//! direction. Their tiles are about as slender as the tree: so texels are about square, and a mip has as much detail one
//! way as the other.
//!
//! What a shader does for a point on a rectangle that faces the eye: it picks one of the three views at random, by weight,
//! and projects the point along that view to a place on its tile ([`frame`](super::frame)). The tree is there where the
//! view's coverage is above a half, as long as texels are as large as pixels: stems are lines then. Where pixels are
//! larger, that is decided at random as well. To add up the three coverages instead, and to test the sum against a half,
//! would thin out what is sparse and thicken what is dense.

use bevy::math::UVec2;

use super::frame::{ImpostorFrame, view_basis};
use crate::{
    lod::{
        bake::{
            rasterise::ParallelRaster,
            scene::{Scene, TreeParts},
            texels::{Alpha, TexelGrid},
        },
        settings::ImpostorSettings,
    },
    texture::{Texels, TextureData, byte},
};

/// Tiles have at least so many texels each way in the coarsest mip.
const LEAST_TILE: usize = 2;
/// Texels of the coverage across a texel of colour.
const FINER: usize = 2;

/// The views of one tree, or of several of a species: a grid of views for each, one below another. Where leaves are shed,
/// a grid of each bare tree follows.
#[derive(Clone, Debug, PartialEq)]
pub struct ImpostorAtlas {
    /// Number of trees.
    pub trees: u32,
    /// Whether the same trees follow as they are in winter.
    pub has_bare: bool,
    /// Views along a side of a grid.
    pub views_per_side: u32,
    /// Width and height of a view's tile in the first mip of its colours, texels.
    pub tile_texels: UVec2,
    /// What the views are of.
    pub frame: ImpostorFrame,
    /// The share of rays that hit the tree, in texels half as large as those of colour: stems and gaps are thinner than what
    /// differs in colour. Mips end where a tile is 2 texels wide or high, in the other textures as well.
    pub coverage: TextureData,
    /// Colour, sRGB, spread beyond what the tree covers; in alpha the share of rays that hit the tree.
    pub colour: TextureData,
    /// Linear: in red, green and blue half the mean tree-local normal and a half (where normals differ, their mean is
    /// shorter than 1), in alpha the share of the species' translucency (0 for wood).
    pub surface: TextureData,
}

impl ImpostorAtlas {
    /// Renders all views of trees.
    #[must_use]
    pub fn bake(scenes: &[Scene], settings: &ImpostorSettings) -> Self {
        let frame = ImpostorFrame::around(scenes);
        let tile_texels = frame.tile_texels(settings.tile_texels);
        let frame = frame.with_margin(tile_texels);
        let tile = [tile_texels.x as usize, tile_texels.y as usize];
        let has_bare = scenes.iter().any(Scene::sheds_leaves);
        let seasons: &[TreeParts] = if has_bare { &[TreeParts::All, TreeParts::Bare] } else { &[TreeParts::All] };
        let width = settings.views_per_side * tile_texels.x;
        let mut atlas = Self {
            trees: scenes.len() as u32,
            has_bare,
            views_per_side: settings.views_per_side,
            tile_texels,
            frame,
            coverage: TextureData::empty(width * FINER as u32, Texels::Share),
            colour: TextureData::empty(width, Texels::Colour),
            surface: TextureData::empty(width, Texels::Linear),
        };
        for (&parts, scene) in seasons.iter().flat_map(|parts| scenes.iter().map(move |scene| (parts, scene))) {
            let (texels, coverage) = render_views(scene, parts, settings, tile, &frame);
            let texels = texels.with_mips(tile, LEAST_TILE, Alpha::Coverage);
            let colour = texels.colour_texture();
            atlas.coverage.add_below(&coverage_texture(coverage, &colour));
            atlas.colour.add_below(&colour);
            atlas.surface.add_below(&texels.surface_texture());
        }
        atlas
    }

    /// How many grids of views lie one below another: one for each tree, two where it has a bare one.
    #[must_use]
    pub fn view_grids(&self) -> u32 {
        self.trees * (1 + u32::from(self.has_bare))
    }
}

/// All views of a tree, and what share of each texel of their coverage is covered.
fn render_views(
    scene: &Scene,
    parts: TreeParts,
    settings: &ImpostorSettings,
    tile: [usize; 2],
    frame: &ImpostorFrame,
) -> (TexelGrid, Vec<u8>) {
    let (per_side, per_fine_texel) = (settings.views_per_side, settings.rays as usize);
    let per_texel = FINER * per_fine_texel;
    let [width, height] = tile.map(|texels| per_side as usize * texels);
    let rays = tile.map(|texels| texels * per_texel);
    let mut texels = TexelGrid::new(width, height);
    let mut hits = vec![0_u8; FINER * width * FINER * height];
    let mut raster = ParallelRaster::new(scene, rays);
    for (row, column) in (0..per_side).flat_map(|row| (0..per_side).map(move |column| (row, column))) {
        let basis = view_basis(UVec2::new(column, row), per_side);
        raster.project(&basis, frame.centre, frame.half_m(&basis), parts);
        let corner = [column as usize * tile[0], row as usize * tile[1]];
        texels.add_rays(corner, tile, per_texel, |x, y| raster.sample(x, y));
        for y in 0..rays[1] {
            let first = (FINER * corner[1] + y / per_fine_texel) * FINER * width + FINER * corner[0];
            for x in 0..rays[0] {
                hits[first + x / per_fine_texel] += u8::from(raster.hits(x, y));
            }
        }
    }
    let whole = (per_fine_texel * per_fine_texel) as f32;
    hits.iter_mut().for_each(|hits| *hits = byte(f32::from(*hits) / whole));
    (texels, hits)
}

/// The texture of the coverage. From its second mip on that is the alpha of the colours.
fn coverage_texture(finest: Vec<u8>, colour: &TextureData) -> TextureData {
    let coarser = colour.mips.iter().map(|mip| mip.iter().skip(3).step_by(4).copied().collect());
    let mips = std::iter::once(finest).chain(coarser).collect();
    let [width, height] = [colour.width, colour.height].map(|texels| texels * FINER as u32);
    TextureData { width, height, mips, texels: Texels::Share }
}
