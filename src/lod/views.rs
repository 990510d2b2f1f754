//! Views of trees from all over the upper hemisphere, in one atlas; better than the paper's low levels, which know one
//! side of a tree only.
//!
//! A view is a parallel projection of the upright cylinder around the tree: `radius_m` to each side, and
//! `half_height_m cos e + radius_m sin e` up and down where the eye stands at the elevation `e`. Slender trees so fill
//! their tiles as well as round ones do. Tiles are about as slender as the tree: so texels are about square, and a mip has
//! as much detail one way as the other. Views lie on a grid over the unfolded hemisphere ([`view_place`]), so that three of
//! them surround any direction ([`views_towards`]).
//!
//! What a shader does, its eye in the direction `to_eye` (tree-local, from [`ViewFrame::centre`]) and `point` any place on
//! a rectangle that faces the eye: it draws lots for one of the three views, by weight; [`ViewFrame::place_in`] is where the
//! point lies on the tile, 0 to 1. There is a tree where the view's outline is above a half, as long as texels are as large
//! as pixels: stems are lines then. Where pixels are larger, a lot is drawn for that as well. To add up the three outlines
//! instead and to test the sum against a half would thin out what is sparse and thicken what is dense.

use bevy::math::{UVec2, Vec2, Vec3};

use super::{
    chart::{view_direction, view_place, views_towards},
    film::{Alpha, Developed, Film},
    projection::Projection,
    scene::{Scene, Sight},
    settings::ViewSettings,
};
use crate::texture::{Texels, TextureData, byte};

/// Tiles have at least so many texels each way in the coarsest mip.
const LEAST_TILE: usize = 2;
/// Tiles are at most so many times as long as they are wide.
const MOST_SLENDER: f32 = 4.0;
/// Texels of the outline across a texel of colour.
const FINER: usize = 2;
/// How many texels are left free around the tree in a tile.
const MARGIN_TEXELS: f32 = 1.0;

/// The views of one tree, or of several of a species, one tree's below another's; and below all of them, where leaves are
/// shed, once more each tree without any.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewAtlas {
    /// Number of trees.
    pub trees: u32,
    /// Whether the same trees follow as they are in winter.
    pub has_bare: bool,
    /// Views of a tree each way.
    pub across: u32,
    /// Width and height of a view in the first mip of its colours, texels.
    pub view_texels: UVec2,
    /// What the views are of.
    pub frame: ViewFrame,
    /// The share of rays that hit the tree, in texels half as large as those of colour: stems and gaps are thinner than what
    /// differs in colour. Mips end where a tile is 2 texels wide or high, in the other textures as well.
    pub outline: TextureData,
    /// Colour, sRGB, spread beyond the outline; in alpha the share of rays that hit the tree.
    pub colour: TextureData,
    /// Linear: in red, green and blue half the mean tree-local normal and a half (where normals differ, their mean is
    /// shorter than 1), in alpha the share of the species' translucency (0 for wood).
    pub surface: TextureData,
}

/// The upright cylinder that views are of: around all trees of an atlas, if they stood in one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewFrame {
    /// Its middle, tree-local, m.
    pub centre: Vec3,
    /// Its radius, m.
    pub radius_m: f32,
    /// Half its height, m.
    pub half_height_m: f32,
}

/// The axes of a view: unit vectors at right angles, tree-local.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewBasis {
    /// To the right in the picture; level.
    pub right: Vec3,
    /// Up in the picture.
    pub up: Vec3,
    /// Away from the eye.
    pub forward: Vec3,
}

impl ViewBasis {
    /// Of a view from the direction `to_eye`, a unit vector.
    #[must_use]
    pub fn towards(to_eye: Vec3) -> Self {
        // From above there is no level way to the right: +x is.
        let right = Vec3::new(to_eye.z, 0.0, -to_eye.x).try_normalize().unwrap_or(Vec3::X);
        Self { right, up: to_eye.cross(right), forward: -to_eye }
    }

    /// Of a view of an atlas of `across` x `across`.
    #[must_use]
    pub fn of_view(view: UVec2, across: u32) -> Self {
        Self::towards(view_direction(view.as_vec2() / (across - 1) as f32))
    }
}

impl ViewFrame {
    /// Around all corners of trees.
    fn around(scenes: &[Scene]) -> Self {
        let points = || scenes.iter().flat_map(|scene| &scene.corners).map(|corner| corner.position);
        let (min, max) =
            points().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(min, max), point| (min.min(point), max.max(point)));
        if min.cmpgt(max).any() {
            return Self { centre: Vec3::ZERO, radius_m: 0.01, half_height_m: 0.01 };
        }
        let centre = 0.5 * (min + max);
        let radius_m = points().map(|point| (point.x - centre.x).hypot(point.z - centre.z)).fold(0.01, f32::max);
        Self { centre, radius_m, half_height_m: (0.5 * (max.y - min.y)).max(0.01) }
    }

    /// The size of a view, texels: powers of two, the longer side given, and about as slender as the tree.
    fn tile(self, longer: u32) -> UVec2 {
        let slender = (self.half_height_m / self.radius_m).clamp(1.0 / MOST_SLENDER, MOST_SLENDER);
        let halvings = slender.log2().round() as i32;
        UVec2::new(longer >> halvings.max(0), longer >> (-halvings).max(0))
    }

    /// The same, with room for a rim that is free of the tree on tiles of a size, texels.
    fn with_margin(self, tile: UVec2) -> Self {
        let wider = |texels: u32| texels as f32 / (texels as f32 - 2.0 * MARGIN_TEXELS);
        // From above, the radius is what is seen in both directions.
        Self {
            radius_m: self.radius_m * wider(tile.min_element()),
            half_height_m: self.half_height_m * wider(tile.y),
            ..self
        }
    }

    /// Half the width, height and depth of a view, m.
    #[must_use]
    pub fn half_m(&self, basis: &ViewBasis) -> Vec3 {
        let sin = basis.forward.y.abs();
        let cos = basis.up.y.abs();
        Vec3::new(
            self.radius_m,
            self.half_height_m * cos + self.radius_m * sin,
            self.half_height_m * sin + self.radius_m * cos,
        )
    }

    /// Where a tree-local point is seen on the tile of a view, 0 to 1 each way from the upper left, and its depth, 0 to 1.
    #[must_use]
    pub fn place_in(&self, basis: &ViewBasis, point: Vec3) -> Vec3 {
        let from = point - self.centre;
        let seen = Vec3::new(from.dot(basis.right), -from.dot(basis.up), from.dot(basis.forward));
        0.5 + 0.5 * seen / self.half_m(basis)
    }
}

impl ViewAtlas {
    /// Looks at trees from all views.
    #[must_use]
    pub fn bake(scenes: &[Scene], settings: &ViewSettings) -> Self {
        let frame = ViewFrame::around(scenes);
        let view_texels = frame.tile(settings.view_texels);
        let frame = frame.with_margin(view_texels);
        let tile = [view_texels.x as usize, view_texels.y as usize];
        let has_bare = scenes.iter().any(Scene::sheds_leaves);
        let sights: &[Sight] = if has_bare { &[Sight::Tree, Sight::Wood] } else { &[Sight::Tree] };
        let width = settings.across * view_texels.x;
        let mut atlas = Self {
            trees: scenes.len() as u32,
            has_bare,
            across: settings.across,
            view_texels,
            frame,
            outline: TextureData::empty(width * FINER as u32, Texels::Share),
            colour: TextureData::empty(width, Texels::Colour),
            surface: TextureData::empty(width, Texels::Linear),
        };
        for (&sight, scene) in sights.iter().flat_map(|sight| scenes.iter().map(move |scene| (sight, scene))) {
            let (film, covers) = expose(scene, sight, settings, tile, &frame);
            let Developed { colour, surface } = film.developed(tile, LEAST_TILE, Alpha::Share);
            atlas.outline.add_below(&outline(covers, &colour));
            atlas.colour.add_below(&colour);
            atlas.surface.add_below(&surface);
        }
        atlas
    }

    /// The three views around a direction from the tree to the eye, with their axes and shares.
    #[must_use]
    pub fn towards(&self, to_eye: Vec3) -> [(ViewBasis, UVec2, f32); 3] {
        views_towards(to_eye, self.across).map(|one| (ViewBasis::of_view(one.view, self.across), one.view, one.weight))
    }

    /// How often there are views of a tree, one below another: twice as often as there are trees where they have bare ones.
    #[must_use]
    pub fn blocks(&self) -> u32 {
        self.trees * (1 + u32::from(self.has_bare))
    }

    /// Place in the atlas, 0 to 1 each way, of a place on the tile of a view of a tree; as it is in winter, if `trees` is
    /// added to its number.
    #[must_use]
    pub fn atlas_place(&self, tree: u32, view: UVec2, place: Vec2) -> Vec2 {
        let tile = (view + UVec2::new(0, tree * self.across)).as_vec2() + place.clamp(Vec2::ZERO, Vec2::ONE);
        tile / UVec2::new(self.across, self.across * self.blocks()).as_vec2()
    }

    /// The view nearest to a direction from the tree to the eye.
    #[must_use]
    pub fn nearest_view(&self, to_eye: Vec3) -> UVec2 {
        (view_place(to_eye) * (self.across - 1) as f32).round().as_uvec2().min(UVec2::splat(self.across - 1))
    }
}

/// All views of a tree, and what share of each texel of their outline is covered.
fn expose(
    scene: &Scene,
    sight: Sight,
    settings: &ViewSettings,
    tile: [usize; 2],
    frame: &ViewFrame,
) -> (Film, Vec<u8>) {
    let (across, per_outline) = (settings.across, settings.rays as usize);
    let per_texel = FINER * per_outline;
    let [width, height] = tile.map(|texels| across as usize * texels);
    let rays = tile.map(|texels| texels * per_texel);
    let mut film = Film::new(width, height);
    let mut hits = vec![0_u8; FINER * width * FINER * height];
    let mut projection = Projection::new(scene, rays);
    for (row, column) in (0..across).flat_map(|row| (0..across).map(move |column| (row, column))) {
        let basis = ViewBasis::of_view(UVec2::new(column, row), across);
        projection.look(&basis, frame.centre, frame.half_m(&basis), sight);
        let corner = [column as usize * tile[0], row as usize * tile[1]];
        film.record(corner, tile, per_texel, |x, y| projection.sample(x, y));
        for y in 0..rays[1] {
            let first = (FINER * corner[1] + y / per_outline) * FINER * width + FINER * corner[0];
            for x in 0..rays[0] {
                hits[first + x / per_outline] += u8::from(projection.hits(x, y));
            }
        }
    }
    let whole = (per_outline * per_outline) as f32;
    hits.iter_mut().for_each(|hits| *hits = byte(f32::from(*hits) / whole));
    (film, hits)
}

/// The texture of an outline. From its second mip on that is the alpha of the colours.
fn outline(covers: Vec<u8>, colour: &TextureData) -> TextureData {
    let coarser = colour.mips.iter().map(|mip| mip.iter().skip(3).step_by(4).copied().collect());
    let mips = std::iter::once(covers).chain(coarser).collect();
    let [width, height] = [colour.width, colour.height].map(|texels| texels * FINER as u32);
    TextureData { width, height, mips, texels: Texels::Share }
}
