//! Views of a tree from all over the upper hemisphere, in one atlas; better than the paper's low levels, which know one
//! side of a tree only.
//!
//! A view is a parallel projection of the upright cylinder around the tree: `radius_m` to each side, and
//! `half_height_m cos e + radius_m sin e` up and down where the eye stands at the elevation `e`. Slender trees so fill
//! their tiles as well as round ones do. Views lie on a grid over the unfolded hemisphere ([`view_place`]), so that three
//! of them surround any direction ([`views_towards`]).
//!
//! What a shader does, its eye in the direction `to_eye` (tree-local, from [`ViewFrame::centre`]) and `point` any place on
//! a rectangle that faces the eye: for each of the three views, [`ViewFrame::place_in`] is where the point lies on the
//! tile, 0 to 1; colours, normals and alphas are added by weight. Depth can shift the point along the view first.

use bevy::math::{UVec2, Vec2, Vec3};

use super::{
    chart::{view_direction, view_place, views_towards},
    film::Film,
    projection::Projection,
    scene::Scene,
    settings::ViewSettings,
};
use crate::texture::TextureData;

/// Tiles have at least so many texels in the coarsest mip.
const LEAST_TILE: usize = 4;
/// How many texels are left free around the tree in a tile.
const MARGIN_TEXELS: f32 = 1.0;

/// The views of one tree.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewAtlas {
    /// Views each way.
    pub across: u32,
    /// Side of a view in the first mip, texels.
    pub view_texels: u32,
    /// What the views are of.
    pub frame: ViewFrame,
    /// Colour, sRGB, spread beyond the outline; in alpha the coverage, which passes the cut-off of
    /// [a mask](crate::texture::MASK_CUT_OFF) on as many texels, in every mip, as rays hit the tree. Mips end where a tile
    /// has 4 texels.
    pub colour: TextureData,
    /// Linear: in red and green the [place](super::place_of_normal) of the tree-local normal, in blue the depth, 0 nearest
    /// to 1 farthest of [`ViewFrame::half_m`], in alpha the share of the species' translucency (0 for wood).
    pub surface: TextureData,
}

/// The upright cylinder that views are of.
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
    /// Around all corners of a tree.
    fn around(scene: &Scene) -> Self {
        let points = || scene.corners.iter().map(|corner| corner.position);
        let (min, max) =
            points().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(min, max), point| (min.min(point), max.max(point)));
        if min.cmpgt(max).any() {
            return Self { centre: Vec3::ZERO, radius_m: 0.01, half_height_m: 0.01 };
        }
        let centre = 0.5 * (min + max);
        let radius_m = points().map(|point| (point.x - centre.x).hypot(point.z - centre.z)).fold(0.01, f32::max);
        Self { centre, radius_m, half_height_m: (0.5 * (max.y - min.y)).max(0.01) }
    }

    /// The same, with `share` more on all sides.
    fn widened(self, share: f32) -> Self {
        Self { radius_m: self.radius_m * (1.0 + share), half_height_m: self.half_height_m * (1.0 + share), ..self }
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
    /// Looks at a tree from all views.
    #[must_use]
    pub fn bake(scene: &Scene, settings: &ViewSettings) -> Self {
        let (across, tile) = (settings.across, settings.view_texels as usize);
        let frame = ViewFrame::around(scene).widened(2.0 * MARGIN_TEXELS / (tile as f32 - 2.0 * MARGIN_TEXELS));
        let film = expose(scene, settings, &frame);
        let developed = film.developed(tile, tile, LEAST_TILE);
        Self { across, view_texels: settings.view_texels, frame, colour: developed.colour, surface: developed.surface }
    }

    /// The three views around a direction from the tree to the eye, with their axes and shares.
    #[must_use]
    pub fn towards(&self, to_eye: Vec3) -> [(ViewBasis, UVec2, f32); 3] {
        views_towards(to_eye, self.across).map(|one| (ViewBasis::of_view(one.view, self.across), one.view, one.weight))
    }

    /// Place in the atlas, 0 to 1 each way, of a place on the tile of a view.
    #[must_use]
    pub fn atlas_place(&self, view: UVec2, place: Vec2) -> Vec2 {
        (view.as_vec2() + place.clamp(Vec2::ZERO, Vec2::ONE)) / self.across as f32
    }

    /// The view nearest to a direction from the tree to the eye.
    #[must_use]
    pub fn nearest_view(&self, to_eye: Vec3) -> UVec2 {
        (view_place(to_eye) * (self.across - 1) as f32).round().as_uvec2().min(UVec2::splat(self.across - 1))
    }
}

pub(super) fn expose(scene: &Scene, settings: &ViewSettings, frame: &ViewFrame) -> Film {
    let (across, tile, per_texel) = (settings.across, settings.view_texels as usize, settings.rays as usize);
    let side = across as usize * tile;
    let mut film = Film::new(side, side);
    let mut projection = Projection::new(scene, tile * per_texel);
    for (row, column) in (0..across).flat_map(|row| (0..across).map(move |column| (row, column))) {
        let basis = ViewBasis::of_view(UVec2::new(column, row), across);
        projection.look(&basis, frame.centre, frame.half_m(&basis));
        let corner = [column as usize * tile, row as usize * tile];
        film.record(corner, [tile, tile], per_texel, |x, y| projection.sample(x, y));
    }
    film
}
