//! Impostor atlases: their textures, the way from an eye to a tile, and how impostors sway.

use super::{coverage, grown, small, view_of};
use crate::{
    lod::{
        ImpostorAtlas, ImpostorFrame, ImpostorSettings, ImpostorSway, Scene,
        bake::{
            rasterise::ViewBasis,
            texels::{Alpha, Sample, TexelGrid},
        },
        impostor::{
            frame::view_basis,
            octahedral::{view_direction, view_place, views_towards},
            sway::bent,
        },
    },
    texture::linear,
    tree::TreeModel,
};
use bevy::math::{UVec2, Vec2, Vec3};

/// Mean light, normal and translucency of what is seen on a tile.
fn mean([colours, surfaces]: &[Vec<[u8; 4]>; 2]) -> [Vec3; 3] {
    let share = |bytes: [u8; 4]| bytes.map(|byte| f32::from(byte) / 255.0);
    let (mut sums, mut whole) = ([Vec3::ZERO; 3], 0.0);
    for (&colour, &surface) in colours.iter().zip(surfaces) {
        let ([r, g, b, alpha], [x, y, z, leaf]) = (share(colour), share(surface));
        sums[0] += alpha * Vec3::from_array(linear([r, g, b]));
        sums[1] += alpha * (2.0 * Vec3::new(x, y, z) - 1.0);
        sums[2] += alpha * leaf;
        whole += alpha;
    }
    sums.map(|sum| sum / whole)
}

fn views_of(atlas: &ImpostorAtlas) -> impl Iterator<Item = (u32, UVec2)> {
    let across = atlas.views_per_side;
    (0..atlas.trees * across * across)
        .map(move |tile| (tile / across / across, UVec2::new(tile % across, tile / across % across)))
}

/// Where a tree-local point is seen on the tile of a view, 0 to 1 each way from the upper left, and its depth, 0 to 1.
pub(super) fn place_on_tile(frame: &ImpostorFrame, basis: &ViewBasis, point: Vec3) -> Vec3 {
    let from = point - frame.centre;
    let seen = Vec3::new(from.dot(basis.right), -from.dot(basis.up), from.dot(basis.forward));
    0.5 + 0.5 * seen / frame.half_m(basis)
}

/// Place in the atlas, 0 to 1 each way, of a place on the tile of a view of a tree; as it is in winter, if the atlas's
/// number of trees is added to the tree's.
fn place_in_atlas(atlas: &ImpostorAtlas, tree: u32, view: UVec2, place: Vec2) -> Vec2 {
    let tile = (view + UVec2::new(0, tree * atlas.views_per_side)).as_vec2() + place.clamp(Vec2::ZERO, Vec2::ONE);
    tile / UVec2::new(atlas.views_per_side, atlas.views_per_side * atlas.view_grids()).as_vec2()
}

/// The view nearest to a direction from the tree to the eye.
fn nearest_view(atlas: &ImpostorAtlas, to_eye: Vec3) -> UVec2 {
    let last = atlas.views_per_side - 1;
    (view_place(to_eye) * last as f32).round().as_uvec2().min(UVec2::splat(last))
}

#[test]
fn mips_keep_the_mean_of_a_tile_and_tiles_have_a_free_rim() {
    for (name, size) in [("birch", UVec2::new(32, 64)), ("poplar", UVec2::new(16, 64)), ("hazel", UVec2::new(64, 64))] {
        let (species, model, textures) = grown(name, 1.0);
        let scene = Scene::new(&species, &model, &textures);
        let atlas = ImpostorAtlas::bake(&[scene], &ImpostorSettings { views_per_side: 4, tile_texels: 64, rays: 1 });
        assert_eq!(atlas.tile_texels, size, "{name}");
        let mips = size.min_element().ilog2() as usize;
        assert_eq!([atlas.colour.mips.len(), atlas.surface.mips.len()], [mips; 2], "{name}: to 2 texels");
        for (tree, view) in views_of(&atlas) {
            let finest = view_of(&atlas, tree, view, 0);
            let (seen, means) = (coverage(&finest), mean(&finest));
            assert!(seen > 0.1, "{name} {view}: {seen}");
            for mip in 1..mips {
                let coarser = view_of(&atlas, tree, view, mip);
                assert!((coverage(&coarser) - seen).abs() < 0.5 / 255.0, "{name} {view} {mip}: {}", coverage(&coarser));
                // Half a step of all bytes: of dark colours, where the steps of sRGB are finest, and of normals.
                for (mean, finest) in mean(&coarser).into_iter().zip(means) {
                    assert!(mean.distance(finest) < 2.0 / 255.0, "{name} {view} {mip}: {mean} for {finest}");
                }
            }
            let (width, height) = (size.x as usize, size.y as usize);
            for (index, texel) in finest[0].iter().enumerate() {
                let (x, y) = (index % width, index / width);
                let is_rim = x == 0 || y == 0 || x == width - 1 || y == height - 1;
                assert!(!is_rim || texel[3] < 128, "{name} {view}: {} at {x} {y}", texel[3]);
            }
        }
    }
}

#[test]
fn normals_that_differ_have_a_short_mean() {
    let sample = |normal| Sample { colour: [0.5; 3], normal, translucency: 1.0, depth: 0.0 };
    let mut grid = TexelGrid::new(4, 4);
    grid.texels[0].add(&sample(Vec3::X), 0.5);
    grid.texels[0].add(&sample(Vec3::Z), 0.5);
    grid.texels[1].add(&sample(Vec3::NEG_Y), 0.25);
    let surface = grid.with_mips([4, 4], 2, Alpha::Coverage).surface_texture();
    let normal = |mip: usize, index: usize| {
        let [x, y, z] = std::array::from_fn(|channel| f32::from(surface.mips[mip][4 * index + channel]) / 127.5 - 1.0);
        Vec3::new(x, y, z)
    };
    for (mip, index, expected) in
        [(0, 0, Vec3::new(0.5, 0.0, 0.5)), (0, 1, Vec3::NEG_Y), (1, 0, Vec3::new(0.4, -0.2, 0.4))]
    {
        assert!(normal(mip, index).distance(expected) < 0.01, "{mip} {index}: {}", normal(mip, index));
    }
}

#[test]
fn trees_share_an_atlas_without_mixing() {
    let (species, model, textures) = grown("birch", 0.5);
    let other = TreeModel::bake(&species, 0.5 * species.age.mature_years, 2);
    let scenes = [&model, &other, &model].map(|model| Scene::new(&species, model, &textures));
    let atlas = ImpostorAtlas::bake(&scenes, &small().impostor);
    let tall = scenes.iter().flat_map(|scene| &scene.vertices).map(|vertex| vertex.position.y).fold(0.0, f32::max);
    assert!((atlas.frame.centre.y + atlas.frame.half_height_m) > tall);
    assert_eq!(atlas.colour.height, 2 * 3 * 4 * atlas.tile_texels.y);
    for view in views_of(&atlas).filter(|(tree, _)| *tree == 0).map(|(_, view)| view) {
        let [one, other, again] = [0, 1, 2].map(|tree| view_of(&atlas, tree, view, 0));
        assert!(one == again && one != other, "{view}");
    }
    let place = place_in_atlas(&atlas, 1, UVec2::new(2, 3), Vec2::new(0.5, 0.25));
    assert!(place.distance(Vec2::new(2.5 / 4.0, 7.25 / 24.0)) < 1e-6, "{place}");
}

#[test]
fn deciduous_trees_have_views_without_leaves() {
    let (species, model, textures) = grown("birch", 1.0);
    let atlas = ImpostorAtlas::bake(&[Scene::new(&species, &model, &textures)], &small().impostor);
    assert!(atlas.has_bare && atlas.view_grids() == 2);
    for (_, view) in views_of(&atlas) {
        let [leafy, bare] = [0, 1].map(|tree| view_of(&atlas, tree, view, 0));
        assert!(coverage(&bare) > 0.0 && coverage(&bare) < 0.7 * coverage(&leafy), "{view}: {}", coverage(&bare));
        let seen = bare[0].iter().zip(&bare[1]).filter(|(colour, _)| colour[3] > 0);
        assert!(seen.clone().count() > 20 && seen.clone().all(|(_, surface)| surface[3] == 0), "{view}: leaves");
        // A ray that hits wood alone hits the tree. Bare twigs are drawn a little wider than those between leaves.
        let beyond = bare[0].iter().zip(&leafy[0]).map(|(bare, leafy)| f32::from(bare[3].saturating_sub(leafy[3])));
        let all = bare[0].iter().map(|bare| f32::from(bare[3])).sum::<f32>();
        let share = beyond.sum::<f32>() / all;
        assert!(share < 0.15, "{view}: {share} of the bare tree lies beyond its leaves");
    }
    let (fir, model, textures) = grown("fir", 0.3);
    let evergreen = ImpostorAtlas::bake(&[Scene::new(&fir, &model, &textures)], &small().impostor);
    assert!(!evergreen.has_bare && evergreen.view_grids() == 1);
}

#[test]
fn vertices_lie_on_the_tiles_of_the_views_around_an_eye() {
    let (species, model, textures) = grown("fir", 0.3);
    let scene = Scene::new(&species, &model, &textures);
    let vertices = scene.vertices.clone();
    let atlas = ImpostorAtlas::bake(&[scene], &small().impostor);
    for vertex in vertices.iter().step_by(7) {
        for view in views_towards(Vec3::new(0.3, 0.5, -0.8), atlas.views_per_side).map(|one| one.view) {
            let basis = view_basis(view, atlas.views_per_side);
            let place = place_on_tile(&atlas.frame, &basis, vertex.position);
            assert!(place.cmpge(Vec3::ZERO).all() && place.cmple(Vec3::ONE).all(), "{place}");
            let texel = place_in_atlas(&atlas, 0, view, place.truncate()) * atlas.views_per_side as f32;
            assert_eq!(texel.floor().as_uvec2(), view);
            assert!((basis.right.cross(basis.up) + basis.forward).length() < 1e-5);
        }
    }
    let own = view_direction(Vec2::new(1.0, 2.0) / 3.0);
    assert_eq!(nearest_view(&atlas, own), UVec2::new(1, 2));
}

#[test]
fn fine_coverage_has_the_mean_of_the_colours_alpha() {
    let (species, model, textures) = grown("birch", 0.5);
    for rays in [1, 2] {
        let settings = ImpostorSettings { rays, ..small().impostor };
        let atlas = ImpostorAtlas::bake(&[Scene::new(&species, &model, &textures)], &settings);
        let (fine, coarse) = (&atlas.coverage, &atlas.colour);
        assert_eq!((fine.width, fine.height), (2 * coarse.width, 2 * coarse.height));
        assert_eq!(fine.mips.len(), coarse.mips.len() + 1);
        let (across, width) = (fine.width as usize, coarse.width as usize);
        for (index, texel) in coarse.mips[0].chunks_exact(4).enumerate() {
            let first = 2 * (index / width) * across + 2 * (index % width);
            let four = [0, 1, across, across + 1].map(|step| f32::from(fine.mips[0][first + step]));
            let mean = four.iter().sum::<f32>() / 4.0;
            assert!((mean - f32::from(texel[3])).abs() <= 1.0, "{rays} {index}: {mean} for {}", texel[3]);
        }
    }
}

#[test]
fn an_impostor_leans_to_where_the_tree_bends() {
    // Slender trees bend as a whole, though more towards the tip. Of an oak the branches move, of a birch the hanging twigs, which an
    // impostor does not show.
    for (name, most) in [("fir", 0.15), ("norway_spruce", 0.15), ("birch", 0.25), ("oak", 1.0)] {
        let (species, model, textures) = grown(name, 1.0);
        let scene = Scene::new(&species, &model, &textures);
        let sway = ImpostorSway::of(&scene, &model);
        // As the impostor shader does, in a fresh breeze of 9.4 m/s.
        let free = sway.in_leaf.open_country_gain() * 9.4 * 9.4;
        let sine = free / (1.0 + (free / 1.1_f32.sin()).powi(2)).sqrt();
        let bent = bent(&scene, &model, Vec3::X);
        let off = |sine: f32| {
            let leaning = |p: Vec3| Vec3::new(p.x + p.y * sine, p.y * (1.0 - sine * sine).sqrt(), p.z);
            let pairs = scene.vertices.iter().zip(&bent.vertices);
            pairs.map(|(rest, bent)| leaning(rest.position).distance_squared(bent.position)).sum::<f32>()
        };
        assert!(sine > 1e-3 && off(sine) < most * off(0.0), "{name}: {sine}, {}", off(sine) / off(0.0));
        assert!(off(sine) < off(0.8 * sine) && off(sine) < off(1.2 * sine), "{name}: {sine} is not the nearest");
        assert_eq!(sway.in_leaf.class, model.beams[0].in_leaf.class, "{name}");
    }
    let (species, mut model, textures) = grown("birch", 0.1);
    model.beams.clear();
    assert_eq!(ImpostorSway::of(&Scene::new(&species, &model, &textures), &model), ImpostorSway::default());
}
