//! Grows the trunk of a tree, or the stems of a shrub.

use bevy::math::{Quat, Vec3};
use rand::{Rng, RngExt};

use super::{
    age::Stage,
    grower::{Branch, Bud, Grower},
    phyllotaxis::GOLDEN_ANGLE_DEG,
    trunk::Trunk,
};

/// Share of its mature height at which a shrub has all its stems.
const ALL_STEMS_AT: f32 = 0.5;

/// Grows the trunk, or the stems of a shrub, which spread from a circle and lean apart.
pub(super) fn stems<R: Rng>(grower: &mut Grower<R>, trunk: &Trunk, stage: &Stage) -> Vec<Branch> {
    let count = (trunk.stems as f32 * (stage.height / ALL_STEMS_AT).min(1.0)).ceil().max(1.0) as u32;
    let heading = grower.turn();
    (0..count)
        .map(|stem| {
            let lean_rad = trunk.lean_deg.to_radians() * grower.random.random::<f32>();
            let turned = Quat::from_rotation_y(heading + stem as f32 * GOLDEN_ANGLE_DEG.to_radians());
            let direction = turned * Quat::from_rotation_z(-lean_rad) * Vec3::Y;
            // Even over the circle: the sunflower's spiral (Vogel 1979).
            let off_m =
                if count == 1 { 0.0 } else { trunk.stem_spread_m * ((stem as f32 + 0.5) / count as f32).sqrt() };
            let shorter = if stem == 0 { 0.0 } else { trunk.stem_length_spread * grower.random.random::<f32>() };
            let bud = Bud { parent: None, attach: 0.0, base: turned * Vec3::X * off_m, direction, order: 0 };
            grower.run(bud, trunk.height_m * (1.0 - shorter), &trunk.habit(stage.height))
        })
        .collect()
}
