//! Where the stems of a tree are at a height: the crown leans with them.

use super::limbs::Limbs;
use bevy::math::Vec3;

/// A place on a stem: the number of its limb, where on that, and where at rest, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StemPlace {
    pub limb: usize,
    pub s: f32,
    pub rest: Vec3,
}

/// Where stems are at a height, m; above them all the top of the highest, and below the foot of the lowest.
pub(super) fn stem_places(limbs: &Limbs, height_m: f32) -> Vec<StemPlace> {
    let stems = || limbs.limbs().iter().enumerate().filter(|(_, limb)| limb.order == 0);
    let at = |limb: usize, s: f32| {
        let [root, middle, tip] = limbs.limbs()[limb].axis;
        let axis = if s < 0.5 { root.lerp(middle, 2.0 * s) } else { middle.lerp(tip, 2.0 * s - 1.0) };
        StemPlace { limb, s, rest: axis.with_y(height_m) }
    };
    let crossing = stems().filter_map(|(index, limb)| {
        let [root, _, tip] = limb.axis;
        (root.y <= height_m && height_m < tip.y).then(|| at(index, (height_m - root.y) / (tip.y - root.y)))
    });
    let crossing: Vec<_> = crossing.collect();
    if !crossing.is_empty() {
        return crossing;
    }
    let highest = stems().max_by(|(_, a), (_, b)| a.axis[2].y.total_cmp(&b.axis[2].y));
    let Some((highest, limb)) = highest else { return Vec::new() };
    if height_m >= limb.axis[2].y {
        return vec![at(highest, 1.0)];
    }
    let lowest = stems().min_by(|(_, a), (_, b)| a.axis[0].y.total_cmp(&b.axis[0].y));
    lowest.map(|(lowest, _)| at(lowest, 0.0)).into_iter().collect()
}
