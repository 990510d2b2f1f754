//! The textures of sprays, for every shape of leaf.

use super::*;
use crate::{
    texture::test_masks::drawn_share,
    tree::{
        green_wood::GreenWood,
        leaf::{LeafArrangement, LeafMargin, LeafShape, outline},
    },
};

const SHAPES: [LeafShape; 11] = [
    LeafShape::Lobed,
    LeafShape::Ovate,
    LeafShape::Triangular,
    LeafShape::Lanceolate,
    LeafShape::Palmate,
    LeafShape::Digitate,
    LeafShape::Deltoid,
    LeafShape::Obovate,
    LeafShape::Needle,
    LeafShape::NeedlePair,
    LeafShape::NeedleRosette,
];
const MARGINS: [LeafMargin; 4] = [LeafMargin::Entire, LeafMargin::Wavy, LeafMargin::Serrate, LeafMargin::DoublySerrate];

fn foliage(shape: LeafShape) -> Foliage {
    let leaf = match shape {
        LeafShape::Needle => Leaf {
            shape,
            length: 0.06,
            width: 0.1,
            shoots: 20,
            spacing: 0.15,
            stalk: 0.0,
            bare: 0.0,
            ..Leaf::default()
        },
        LeafShape::NeedlePair => {
            Leaf { shape, length: 0.15, width: 0.045, shoots: 12, spacing: 0.06, ..Leaf::default() }
        }
        LeafShape::NeedleRosette => {
            Leaf { shape, length: 0.07, width: 0.09, shoots: 14, spacing: 0.8, bare: 0.0, ..Leaf::default() }
        }
        LeafShape::Lanceolate => Leaf { shape, width: 0.2, spacing: 0.25, ..Leaf::default() },
        _ => Leaf { shape, ..Leaf::default() },
    };
    leaf.validate().unwrap();
    Foliage { leaf, ..Foliage::default() }
}

/// A bare spray is some lines, and from afar as much of them is there as from near by.
#[test]
fn bare_sprays_keep_the_coverage_of_their_twigs() {
    for shape in SHAPES {
        let foliage = foliage(shape);
        let leafy = drawn_share(&leaf_textures(&foliage, &GreenWood::default(), 4).base_colour, 0);
        let bare = bare_spray_texture(&foliage, &GreenWood::default(), 4);
        let full = drawn_share(&bare, 0);
        assert!((0.01..0.7 * leafy).contains(&full), "{shape:?}: {full} of {leafy}");
        // Down to 16 x 16 texels, of which the last line has some.
        for (mip, limit) in [(1, 0.1), (2, 0.1), (3, 0.1), (4, 0.15), (5, 0.15)] {
            let share = drawn_share(&bare, mip);
            assert!((share / full - 1.0).abs() < limit, "{shape:?}: {share} of {full} in mip {mip}");
        }
    }
}

#[test]
fn mips_keep_the_coverage_of_leaves() {
    for shape in SHAPES {
        let texture = leaf_textures(&foliage(shape), &GreenWood::default(), 4).base_colour;
        let full = drawn_share(&texture, 0);
        assert!((0.15..0.85).contains(&full), "{shape:?}: {full} of the card is leaf");
        // Down to 16 x 16 texels.
        for mip in 1..6 {
            let share = drawn_share(&texture, mip);
            assert!((share - full).abs() < 0.03, "{shape:?}: {share} against {full} in mip {mip}");
        }
    }
}

#[test]
fn no_leaf_is_cut_by_the_square_except_the_twig_at_its_root() {
    for shape in SHAPES {
        let texture = leaf_textures(&foliage(shape), &GreenWood::default(), 4).base_colour;
        let drawn = |x: usize, y: usize| texture.mips[0][4 * (y * SIZE + x) + 3] > 127;
        let edge = (0..SIZE).flat_map(|k| [(k, 0), (SIZE - 1, k), (0, k), (k, SIZE - 1)]);
        let cut = edge.filter(|&(x, y)| drawn(x, y) && !(x < 12 && y > SIZE - 12)).count();
        assert_eq!(cut, 0, "{shape:?}");
    }
}

#[test]
fn a_spray_is_determined_by_its_seed() {
    let foliage = foliage(LeafShape::Ovate);
    assert_eq!(leaf_textures(&foliage, &GreenWood::default(), 1), leaf_textures(&foliage, &GreenWood::default(), 1));
    assert_ne!(leaf_textures(&foliage, &GreenWood::default(), 1), leaf_textures(&foliage, &GreenWood::default(), 2));
}

#[test]
fn opposite_and_whorled_leaves_cover_more_than_alternate_ones() {
    let share = |arrangement| {
        let leaf = Leaf { arrangement, spacing: 0.8, ..Leaf::default() };
        drawn_share(&leaf_textures(&Foliage { leaf, ..Foliage::default() }, &GreenWood::default(), 3).base_colour, 0)
    };
    let [alternate, opposite, whorled] =
        [LeafArrangement::Alternate, LeafArrangement::Opposite, LeafArrangement::Whorled].map(share);
    assert!(alternate < opposite && opposite < whorled, "{alternate} {opposite} {whorled}");
}

#[test]
fn margins_are_closed_and_as_wide_as_the_leaf_is_stated_to_be() {
    for shape in SHAPES {
        for margin in MARGINS {
            let leaf = Leaf { shape, margin, ..Leaf::default() };
            let margin = outline::outline(&leaf);
            assert!(margin.iter().all(|point| point.is_finite()), "{shape:?}");
            let (low, high) =
                margin.iter().fold((Vec2::MAX, Vec2::MIN), |(low, high), &point| (low.min(point), high.max(point)));
            // Teeth and waves stand out by at most an eighth; lobes lean forward.
            assert!((high.x - 1.0).abs() < 0.06 && low.x > -0.06, "{shape:?}: {low} to {high}");
            let width = high.y - low.y;
            assert!((0.7..1.3).contains(&(width / leaf.width)), "{shape:?}: {width}");
            assert!((high.y + low.y).abs() < 1e-5, "{shape:?} is symmetric");
        }
    }
}

#[test]
fn the_distance_to_a_square_is_exact() {
    let square = [Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0), Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0)];
    for (point, expected) in
        [(Vec2::ZERO, 1.0), (Vec2::new(0.75, 0.2), 0.25), (Vec2::new(2.0, 0.0), -1.0), (Vec2::new(4.0, 5.0), -5.0)]
    {
        assert!((outline::distance(&square, point) - expected).abs() < 1e-6, "{point}");
    }
}

#[test]
fn extreme_leaves_have_textures() {
    for (length, shoots, spacing, width, stalk) in [(0.6, 0, 2.0, 1.2, 1.0), (0.01, 40, 0.3, 0.02, 0.0)] {
        for shape in [LeafShape::Lobed, LeafShape::Palmate, LeafShape::NeedleRosette] {
            let leaf =
                Leaf { shape, length, shoots, spacing, width, stalk, curl: 1.0, vein_pairs: 24, ..Leaf::default() };
            leaf.validate().unwrap();
            let textures = leaf_textures(&Foliage { leaf, ..Foliage::default() }, &GreenWood::default(), 1);
            assert_eq!((textures.base_colour.mips.len(), textures.normal.mips.len()), (10, 10));
        }
    }
}
