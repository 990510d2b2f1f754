//! How much of the sky is seen among trees. The shaders have the same formulas (`shaders/sky_share.wesl`); this is what they are held to.
//!
//! Light from the sky falls through a stand by Beer's law (Monsi & Saeki 1953): below the leaf area `L` a share `exp(-K L)` of it is left.
//! `K` is some 0.7 to 0.8 for light from all the sky and leaves that lie at random, and times a clumping of 0.6 to 0.8 (Chen et al.
//! 2005, Remote Sens. Environ. 97, 447; from memory, so unconfirmed) about a half for woods. Under closed broadleaves of `L = 5` that leaves 8%;
//! 2 to 10% are told.
//!
//! A stand is known by how it stops the wind ([`Canopy`](crate::wind::Canopy)), and so by its displacement height `d`: `1 - d/h = (1 -
//! exp(-s)) / s` with `s^2 = 15 lambda`. One step from `s = 1 / (1 - d/h)` solves that to 2% where a stand is closed, and the leaf area
//! index is `2 lambda = 2/15 s^2`.
//!
//! Leaves are distributed over the upper part of the height, most of them in its middle. Near the edge of a stand light comes from the side: there a share
//! as open as the mean of all sides is seen as if there were no trees.

#![cfg(test)]

use crate::wind::{Canopy, PackedCanopy, exposure_direction};

const EXTINCTION: f32 = 0.5;
/// Of the leaf area index by `s^2`.
const INDEX_BY_SQUARE: f32 = 0.13333333;
const LEAST_GAP: f32 = 0.01;
/// Below this share of its height a stand has no leaves. Chosen; crowns of closed stands are a third to two thirds of the height.
const LOWEST_LEAVES: f32 = 0.35;

fn sky_share(canopy: PackedCanopy, height_m: f32) -> f32 {
    let profile = canopy.profile();
    let gap = (1.0 - profile.displacement_share).max(LEAST_GAP);
    let drag = (1.0 - (-1.0 / gap).exp()) / gap;
    let openness = (0..8).map(|number| canopy.exposure_to(exposure_direction(number))).sum::<f32>() / 8.0;
    let share = height_m / profile.height_m.max(0.01);
    let below = ((1.0 - share) / (1.0 - LOWEST_LEAVES)).clamp(0.0, 1.0);
    let leaves_above = below * below * (3.0 - 2.0 * below) * INDEX_BY_SQUARE * drag * drag;
    let through = (-EXTINCTION * leaves_above).exp();
    through + (1.0 - through) * openness
}

fn inside(leaf_area_index: f32) -> PackedCanopy {
    Canopy { height_m: 20.0, frontal_area_index: 0.5 * leaf_area_index, exposure: [0.0; 8] }.pack()
}

#[test]
fn constants_are_those_of_the_shader() {
    let shader = include_str!("shaders/sky_share.wesl");
    for (name, value) in [
        ("EXTINCTION", EXTINCTION),
        ("INDEX_BY_SQUARE", INDEX_BY_SQUARE),
        ("LEAST_GAP", LEAST_GAP),
        ("LOWEST_LEAVES", LOWEST_LEAVES),
    ] {
        assert!(shader.contains(&format!("const {name}: f32 = {value};")), "{name}");
    }
}

/// By Beer's law with the leaf area itself, from open woods to the densest.
#[test]
fn the_floor_of_a_wood_has_the_light_of_its_leaf_area() {
    for leaf_area_index in [1.0, 2.0, 4.0, 6.0] {
        let expected = (-EXTINCTION * leaf_area_index).exp();
        let share = sky_share(inside(leaf_area_index), 0.0);
        assert!((share.ln() / expected.ln() - 1.0).abs() < 0.12, "{leaf_area_index}: {share} and not {expected}");
    }
}

#[test]
fn light_grows_with_height_and_is_whole_above_the_tops_and_in_the_open() {
    let shares: Vec<f32> = (0..=22).map(|height_m| sky_share(inside(5.0), height_m as f32)).collect();
    assert!(shares.is_sorted(), "{shares:?}");
    assert_eq!(shares[22], 1.0);
    assert!(shares[0] < 0.1 && shares[7] < 0.1 && shares[14] > 0.3, "{shares:?}");
    assert_eq!(sky_share(Canopy::OPEN, 0.0), 1.0);
}

#[test]
fn the_edge_of_a_wood_is_lit_from_its_open_side() {
    let mut exposure = [0.0; 8];
    exposure[..4].fill(1.0);
    let edge = Canopy { height_m: 20.0, frontal_area_index: 2.5, exposure }.pack();
    let share = sky_share(edge, 1.0);
    assert!((share - 0.54).abs() < 0.03, "{share}");
}
