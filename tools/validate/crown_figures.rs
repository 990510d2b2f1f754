//! Leaf area, width and length of the crowns of shipped trees, measured on their meshes, beside what others have measured.

use crate::report::Report;
use bevy::math::{IVec2, Vec2, Vec3};
use bevy_windwood::{
    texture::{MASK_CUT_OFF, TextureData},
    tree::{Species, TreeModel, textures::species_textures},
};
use serde::Deserialize;
use std::collections::BTreeSet;

const CROWNS_BY_OTHERS: &str = include_str!("crowns_by_others.ron");
/// Variants of each species.
const SEEDS: u64 = 4;
/// Side of the squares of ground that a crown covers or not, m. Gaps that are narrower belong to the crown.
const CELL_M: f32 = 0.5;
/// Points of a leaf's triangle, each way, at which its mask is read.
const POINTS: usize = 6;
/// The crown's base is the height below which this share of its leaves hangs: a lone low branch is not its base.
const BELOW_BASE: f32 = 0.03;

/// A figure of a crown.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
enum Quantity {
    /// One-sided area of leaves over the ground that the crown covers.
    LeafAreaIndex,
    WidthByHeight,
    /// Length of the crown over the tree's height.
    LiveCrownRatio,
}

/// A range that others have published.
#[derive(Deserialize)]
struct Published {
    species: String,
    what: Quantity,
    low: f32,
    high: f32,
    source: String,
}

/// The figures of a crown, means over variants.
#[derive(Default)]
struct CrownFigures {
    leaf_area_index: f32,
    width_by_height: f32,
    live_crown_ratio: f32,
}

/// Adds the figures to those of the topic `trees`. All ranges are from memory, so no limit stands on them.
pub fn run(report: &mut Report, shipped: impl Fn(&str) -> Result<Species, String>) {
    let published = match ron::from_str::<Vec<Published>>(CROWNS_BY_OTHERS) {
        Ok(published) => published,
        Err(error) => return eprintln!("crowns_by_others.ron: {error}"),
    };
    let names: BTreeSet<&str> = published.iter().map(|range| range.species.as_str()).collect();
    let mut outside = 0;
    println!("  crown            figure          ours   told");
    for name in names {
        let figures = match shipped(name) {
            Ok(species) => CrownFigures::of(&species),
            Err(error) => return eprintln!("{error}"),
        };
        for Published { what, low, high, source, .. } in published.iter().filter(|range| range.species == name) {
            let value = figures.figure(*what);
            let is_inside = (*low..=*high).contains(&value);
            let mark = if is_inside { "" } else { "  OUTSIDE" };
            println!("  {name:<16} {:<15} {value:>5.2}   {low} to {high} ({source}){mark}", format!("{what:?}"));
            outside += i32::from(!is_inside);
        }
    }
    report.record("crowns_outside_unconfirmed_ranges", outside.into(), "leaf area, width and length of mature crowns");
    report.record("crown_figures", published.len() as f64, "so many of them were compared");
}

impl CrownFigures {
    fn of(species: &Species) -> Self {
        let mask = species_textures(species).foliage;
        let mut mean = Self::default();
        for seed in 0..SEEDS {
            let model = TreeModel::bake(species, species.age.mature_years, seed);
            let crown = Crown::of(&model, &mask);
            let height_m = model.height_m();
            mean.leaf_area_index += crown.leaf_area_m2 / crown.ground_m2() / SEEDS as f32;
            mean.width_by_height += crown.width_m() / height_m / SEEDS as f32;
            mean.live_crown_ratio += (height_m - crown.base_m()) / height_m / SEEDS as f32;
        }
        mean
    }

    fn figure(&self, what: Quantity) -> f32 {
        match what {
            Quantity::LeafAreaIndex => self.leaf_area_index,
            Quantity::WidthByHeight => self.width_by_height,
            Quantity::LiveCrownRatio => self.live_crown_ratio,
        }
    }
}

/// What the leaves of a tree cover.
#[derive(Default)]
struct Crown {
    leaf_area_m2: f32,
    /// Squares of ground below leaves.
    covered: BTreeSet<(i32, i32)>,
    /// Height and area of leaves.
    leaves: Vec<(f32, f32)>,
}

impl Crown {
    /// Reads the mask at points of each triangle: what of it is leaf, and where that is.
    fn of(model: &TreeModel, mask: &TextureData) -> Self {
        let mut crown = Self::default();
        let leaves = &model.leaves;
        for corners in leaves.indices.chunks_exact(3) {
            let at = |corner: usize| Vec3::from_array(leaves.positions[corners[corner] as usize]);
            let uv = |corner: usize| Vec2::from_array(leaves.uvs[corners[corner] as usize]);
            let [a, b, c] = [0, 1, 2].map(at);
            let area_m2 = 0.5 * (b - a).cross(c - a).length();
            let points = inner_points();
            for [second, third] in &points {
                let first = 1.0 - second - third;
                if !is_leaf(mask, first * uv(0) + second * uv(1) + third * uv(2)) {
                    continue;
                }
                let place = first * a + second * b + third * c;
                let share_m2 = area_m2 / points.len() as f32;
                crown.leaf_area_m2 += share_m2;
                crown.leaves.push((place.y, share_m2));
                let cell = IVec2::new((place.x / CELL_M).floor() as i32, (place.z / CELL_M).floor() as i32);
                crown.covered.insert((cell.x, cell.y));
            }
        }
        crown
    }

    fn ground_m2(&self) -> f32 {
        self.covered.len() as f32 * CELL_M * CELL_M
    }

    /// That of a disc which covers as much.
    fn width_m(&self) -> f32 {
        2.0 * (self.ground_m2() / std::f32::consts::PI).sqrt()
    }

    fn base_m(&self) -> f32 {
        let mut leaves = self.leaves.clone();
        leaves.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut below_m2 = 0.0;
        let is_above = |(_, area_m2): &&(f32, f32)| {
            below_m2 += area_m2;
            below_m2 > BELOW_BASE * self.leaf_area_m2
        };
        leaves.iter().find(is_above).map_or(0.0, |(height_m, _)| *height_m)
    }
}

/// Places all over a triangle: the shares of its second and third corner.
fn inner_points() -> Vec<[f32; 2]> {
    let step = 1.0 / POINTS as f32;
    let square = (0..POINTS).flat_map(|row| (0..POINTS).map(move |column| [column, row]));
    let points = square.map(|place| place.map(|index| (index as f32 + 0.5) * step));
    // The other half of the square, turned over, lies on the triangle.
    points.map(|[s, t]| if s + t > 1.0 { [1.0 - s, 1.0 - t] } else { [s, t] }).collect()
}

fn is_leaf(mask: &TextureData, uv: Vec2) -> bool {
    let texel = |share: f32, size: u32| ((share.clamp(0.0, 1.0) * size as f32) as u32).min(size - 1);
    let index = texel(uv.y, mask.height) * mask.width + texel(uv.x, mask.width);
    f32::from(mask.mips[0][4 * index as usize + 3]) / 255.0 > MASK_CUT_OFF
}
