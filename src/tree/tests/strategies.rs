//! Random species of every generator, over the domains of their settings.

use crate::tree::{
    foliage::Foliage,
    generator::Growth,
    growth::{
        Phyllotaxis,
        aono_kunii::{AonoKunii, Branching, Shoot},
        damage::Damage,
        envelope::{Envelope, EnvelopeShape},
        reeves_blau::{BranchOrder, ReevesBlau},
        trunk::Trunk,
        zaharia::{Fir, Oak},
    },
    species::Species,
};
use proptest::prelude::*;

fn orders() -> impl Strategy<Value = BranchOrder> {
    let places = (0.0_f32..0.6, 0.6_f32..=1.0, 0.2_f32..3.0, 0.0_f32..=1.0, 1_u32..6);
    let angles = (0.0_f32..150.0, 0.0_f32..150.0, 0.0_f32..60.0, -360.0_f32..360.0, 0.0_f32..180.0);
    let lengths = (0.02_f32..3.0, 0.0_f32..=1.0, 0.0_f32..=1.0, 0.05_f32..=1.0, 0.0_f32..3.0);
    let habit = (1_u32..=6, 0.0_f32..60.0, -4.0_f32..4.0, -0.3_f32..0.3, 0.0_f32..=1.0);
    (places, angles, lengths, habit).prop_map(|(places, angles, lengths, habit)| BranchOrder {
        first_at: places.0,
        last_at: places.1,
        spacing_m: places.2,
        spacing_spread: places.3,
        per_node: places.4,
        first_angle_deg: angles.0,
        last_angle_deg: angles.1,
        angle_spread_deg: angles.2,
        roll_deg: angles.3,
        roll_spread_deg: angles.4,
        length: lengths.0,
        taper: lengths.1,
        length_spread: lengths.2,
        reach: lengths.3,
        light_seeking: lengths.4,
        segments: habit.0,
        crook_deg: habit.1,
        rise: habit.2,
        sag: habit.3,
        probability: habit.4,
    })
}

pub(in crate::tree) const SHAPES: [EnvelopeShape; 6] = [
    EnvelopeShape::Ellipsoid,
    EnvelopeShape::Cone,
    EnvelopeShape::Cylinder,
    EnvelopeShape::Dome,
    EnvelopeShape::InvertedCone,
    EnvelopeShape::Paraboloid,
];

pub(super) fn structures() -> impl Strategy<Value = AonoKunii> {
    let shoot = || {
        (0.0_f32..150.0, 0.1_f32..1.2, 0.1_f32..1.0).prop_map(|(angle_deg, length, diameter)| Shoot {
            angle_deg,
            length,
            diameter,
        })
    };
    let arrangements = prop::sample::select(vec![
        Phyllotaxis::Spiral,
        Phyllotaxis::Alternate,
        Phyllotaxis::Opposite,
        Phyllotaxis::Whorled(5),
    ]);
    let monopodial = (shoot(), shoot(), arrangements).prop_map(|(axis, lateral, arrangement)| Branching::Monopodial {
        axis,
        lateral,
        arrangement,
    });
    let dichotomous = ([shoot(), shoot()], -360.0_f32..360.0)
        .prop_map(|(shoots, turn_deg)| Branching::Dichotomous { shoots, turn_deg });
    let ternary = (shoot(), [-360.0_f32..360.0, -360.0_f32..360.0])
        .prop_map(|(shoot, turns_deg)| Branching::Ternary { shoot, turns_deg });
    let branching = prop_oneof![monopodial, dichotomous, ternary];
    (branching, 1_u32..=12, 0.0_f32..60.0, -1.0_f32..1.0, 0.0_f32..0.9).prop_map(
        |(branching, generations, deviation_deg, gravity, length_deviation)| AonoKunii {
            branching,
            generations,
            deviation_deg,
            gravity,
            length_deviation,
            ..AonoKunii::default()
        },
    )
}

prop_compose! {
    pub(super) fn species()(
        shape in prop::sample::select(SHAPES.to_vec()),
        (top_m, low, radius_m) in (0.5_f32..60.0, 0.0_f32..0.9, 0.1_f32..30.0),
        (height, trunk_radius_m, segments) in (0.1_f32..=1.0, 0.01_f32..2.0, 1_u32..=6),
        (lean_deg, crook_deg, buttresses, stems) in (0.0_f32..60.0, 0.0_f32..45.0, 0_u32..=9, 1_u32..=5),
        (dead, broken_trunks, broken_branches, remains) in
            (any::<bool>(), 0.0_f32..=1.0, 0.0_f32..=1.0, 0.02_f32..=1.0),
        orders in prop::collection::vec(orders(), 0..=3),
        (size_spread, shade_pruning, pipe_exponent) in (0.0_f32..0.8, 0.0_f32..=1.0, 1.5_f32..4.0),
        (first_order, spacing_m, size_m, droop) in (0_u8..=3, 0.05_f32..2.0, 0.05_f32..2.0, -2.0_f32..2.0),
    ) -> Species {
        let height_m = (height * top_m).max(0.5);
        Species {
            growth: Growth::ReevesBlau(ReevesBlau {
                envelope: Envelope { shape, base_m: low * top_m, top_m, radius_m },
                trunk: Trunk {
                    height_m, radius_m: trunk_radius_m, segments, stems, lean_deg, crook_deg, buttresses,
                    ..Trunk::default()
                },
                orders, size_spread, shade_pruning, pipe_exponent,
            }),
            damage: Damage { dead, broken_trunks, broken_branches, remains },
            foliage: Foliage { first_order, spacing_m, size_m, droop, ..Foliage::default() },
            ..Species::default()
        }
    }
}

prop_compose! {
    pub(super) fn zaharias_oak()(
        (height_m, radius_m, delta) in (0.5_f32..60.0, 0.01_f32..2.0, 0.0_f32..=1.0),
        (min_branch, more) in (0.0_f32..20.0, 0.0_f32..20.0),
        (min_age_years, span_years) in (0.0_f32..200.0, 1.0_f32..500.0),
        adjust_branch in prop::collection::vec(-1.0_f32..2.0, 0..=4),
        (first_at, shortest) in (0.0_f32..=0.95, 0.0_f32..=1.0),
        (first_angle_deg, last_angle_deg, angle_spread_deg) in (0.0_f32..150.0, 0.0_f32..150.0, 0.0_f32..60.0),
    ) -> Growth {
        Growth::Oak(Oak {
            trunk: Trunk { height_m, radius_m, ..Trunk::default() },
            delta_m: delta * height_m, min_branch, max_branch: min_branch + more,
            min_age_years, max_age_years: min_age_years + span_years,
            adjust_branch, first_at, shortest, first_angle_deg, last_angle_deg, angle_spread_deg,
            ..Oak::default()
        })
    }
}

prop_compose! {
    pub(super) fn zaharias_fir()(
        (height_m, radius_m, delta) in (0.5_f32..60.0, 0.01_f32..2.0, 0.0_f32..=1.0),
        (min_floors, more, branching_factor) in (0.0_f32..40.0, 0.0_f32..40.0, 1_u32..=12),
        (min_age_years, span_years) in (0.0_f32..200.0, 1.0_f32..500.0),
        (adjust_branch, side_pairs) in ([-1.0_f32..2.0, -1.0_f32..2.0], 0.0_f32..20.0),
        (first_at, shortest, sag) in (0.0_f32..=0.95, 0.0_f32..=1.0, -0.3_f32..0.3),
        (first_angle_deg, last_angle_deg, side_angle_deg) in (0.0_f32..150.0, 0.0_f32..150.0, 0.0_f32..150.0),
    ) -> Growth {
        Growth::Fir(Fir {
            trunk: Trunk { height_m, radius_m, ..Trunk::default() },
            delta_m: delta * height_m, min_floors, max_floors: min_floors + more, branching_factor,
            min_age_years, max_age_years: min_age_years + span_years,
            adjust_branch, side_pairs, first_at, shortest, sag, first_angle_deg, last_angle_deg, side_angle_deg,
            ..Fir::default()
        })
    }
}
