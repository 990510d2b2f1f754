//! What Zaharia's paper says about leaves and colours, on the shipped oak and fir.

use bevy::math::Vec3;

use super::{check_skeleton, check_vertices};
use crate::{
    texture::{MASK_CUT_OFF, fourier::Combination},
    tree::{
        ellipsoid::silhouette_alpha, individual::grow, leaf::LeafKind, leaf_mesh::leaves, skeleton::is_terminal,
        species::Species, textures::species_textures, wood_mesh::wood,
    },
};

fn oak() -> Species {
    Species::from_ron(include_str!("../../../assets/species/zaharia_oak.species.ron")).unwrap()
}

fn fir() -> Species {
    Species::from_ron(include_str!("../../../assets/species/zaharia_fir.species.ron")).unwrap()
}

#[test]
fn terminal_branches_of_the_oak_bear_five_to_ten_ellipsoids_by_their_length() {
    let species = oak();
    for (age_years, seed) in [(20.0, 1), (60.0, 2), (150.0, 3), (200.0, 4)] {
        let tree = grow(&species, age_years, seed);
        check_skeleton(&species, &tree);
        let mut borne = vec![0; tree.beams.len()];
        tree.clusters.iter().for_each(|cluster| borne[cluster.beam as usize] += 1);
        let mut by_length: Vec<(f32, i32)> = Vec::new();
        for ((beam, is_terminal), borne) in tree.beams.iter().zip(is_terminal(&tree.beams)).zip(borne) {
            assert!(
                if is_terminal { (5..=10).contains(&borne) } else { borne == 0 },
                "{borne} on order {}",
                beam.order
            );
            by_length.extend(is_terminal.then_some((beam.length_m, borne)));
        }
        by_length.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert!(by_length.windows(2).all(|pair| pair[0].1 <= pair[1].1), "longer branches bear no fewer");
        assert!(age_years < 100.0 || (by_length[0].1 == 5 && by_length[by_length.len() - 1].1 == 10));
    }
}

/// The surface is that of ellipsoids whose semi-axes are about as 3 to 1 to little, along the leaf, across and through it.
#[test]
fn leaves_of_the_oak_are_long_thin_ellipsoids() {
    let species = oak();
    let LeafKind::Ellipsoids(settings) = species.foliage.kind else { panic!("the paper's leaves") };
    assert_eq!((settings.semi_axes, settings.surface.texture.combination), ([3.0, 1.0, 0.0], Combination::Sum));
    let tree = grow(&species, 150.0, 5);
    let vertices = leaves(&species, &tree);
    check_vertices(&vertices.positions, &vertices.normals, &vertices.sway, &vertices.indices, tree.beams.len());
    let stride = (2 * settings.surface.facets as usize + 1).pow(2);
    assert_eq!(vertices.positions.len(), stride * tree.clusters.len());
    let mut sum = Vec3::ZERO;
    for (points, leaf) in vertices.positions.chunks_exact(stride).zip(&tree.clusters) {
        let centre = leaf.anchor + 0.5 * leaf.size_m * leaf.axis;
        let across = leaf.axis.cross(leaf.normal);
        let reach = [leaf.axis, across, leaf.normal]
            .map(|axis| points.iter().map(|&point| (Vec3::from(point) - centre).dot(axis).abs()).fold(0.0, f32::max));
        assert!((reach[0] - 0.5 * leaf.size_m).abs() < 1e-3, "from the anchor to the tip");
        sum += Vec3::from(reach) / (0.5 * species.foliage.size_m);
    }
    let mean = 3.0 * sum / tree.clusters.len() as f32;
    // |N(0, 0.4)| has the mean 0.32. Some leaves near the top are smaller than the others, none larger.
    assert!(
        (2.6..3.05).contains(&mean.x) && (0.85..1.02).contains(&mean.y) && (0.25..0.34).contains(&mean.z),
        "{mean}"
    );
}

/// His texture makes them translucent, and more so towards the outline.
#[test]
fn the_texture_of_the_oaks_leaves_is_translucent() {
    let species = oak();
    assert!(species.has_ellipsoids() && !fir().has_ellipsoids());
    let LeafKind::Ellipsoids(settings) = species.foliage.kind else { panic!("the paper's leaves") };
    let textures = species_textures(&species);
    assert!(textures.foliage_normal.is_none());
    let passing = |facing: f32| {
        let texels = textures.foliage.mips[0].chunks_exact(4);
        let count = texels.len() as f32;
        texels.filter(|t| f32::from(t[3]) / 255.0 * silhouette_alpha(facing) > MASK_CUT_OFF).count() as f32 / count
    };
    assert!((passing(1.0) - settings.surface.cover).abs() < 0.01);
    assert!((passing(0.05) - settings.surface.outline_cover).abs() < 0.01);
    assert!(settings.surface.outline_cover < 0.5 * settings.surface.cover && settings.surface.cover < 1.0);
}

/// "The last four levels of branches have greenish shades that are darker for smaller branch levels": two of wood, and two
/// in the texture of the sprays.
#[test]
fn the_last_levels_of_the_fir_are_green_and_darker_when_smaller() {
    let species = fir();
    let tree = grow(&species, species.age.mature_years, 3);
    let wood = wood(&species, &tree);
    let mut found = [0; 3];
    for [beam, _, green, _] in &wood.sway {
        // A branch's foot may be bound to its parent.
        let (order, expected) = (tree.beams[*beam as usize].order, [0.0, 1.0, 0.8]);
        let level = expected.iter().position(|shade| (shade - green).abs() < 1e-5).expect("one of these shades");
        assert!((order..=order + 1).contains(&(level as u8)), "order {order} with the shade {green}");
        found[level] += 1;
    }
    assert!(found.iter().all(|count| *count > 100), "{found:?}");
    let [twig, shoots] = species.wood.green.of_spray(species.foliage.leaf.twig_colour);
    for colour in [species.wood.green.tint([1.0; 3]), twig, shoots] {
        assert!(colour[1] > colour[0] && colour[0] > colour[2], "greenish: {colour:?}");
    }
    assert!((twig[1] / shoots[1] - 1.5).abs() < 1e-4);
}
