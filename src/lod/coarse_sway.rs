//! How the coarsest meshes of a tree sway: with its stems and limbs, which carry thinner branches and leaves along as they stand.
//!
//! There a bough sways by a pixel or two of its own, and most beams of a tree are boughs and twigs: that few are posed saves most of the
//! memory and the work that poses take. Generators grow one order of branches after the other, so stems and limbs come first among the
//! beams. Where some are scattered among thinner ones, all up to the last of them sway.

use crate::tree::skeleton::Skeleton;

/// The highest order of branches that sway by themselves: limbs.
const LAST_ORDER: u8 = 1;

/// How many beams sway, the first ones.
pub(crate) fn swaying_beams(skeleton: &Skeleton) -> u32 {
    let last = skeleton.beams.iter().rposition(|beam| beam.order <= LAST_ORDER);
    last.map_or(0, |last| last as u32 + 1)
}

/// Binds vertices on other beams to where these are carried. Each begins with a beam and a place on it.
pub(crate) fn bind_to_swaying(skeleton: &Skeleton, sway: &mut [[f32; 4]]) {
    let count = swaying_beams(skeleton) as usize;
    let mut carriers: Vec<[f32; 2]> = Vec::with_capacity(skeleton.beams.len() - count);
    for beam in &skeleton.beams[count..] {
        let parent = beam.parent.map_or(0, |parent| parent as usize);
        let of_parent = parent.checked_sub(count).and_then(|number| carriers.get(number)).copied();
        carriers.push(of_parent.unwrap_or([parent as f32, beam.attach]));
    }
    for vertex in sway {
        let carrier = (vertex[0] as usize).checked_sub(count).and_then(|number| carriers.get(number));
        if let Some([beam, at]) = carrier {
            (vertex[0], vertex[1]) = (*beam, *at);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::{Species, TreeModel};

    #[test]
    fn most_beams_of_an_oak_are_carried_by_others() {
        let skeleton = TreeModel::bake(&Species::default(), 60.0, 2).skeleton;
        let count = swaying_beams(&skeleton) as usize;
        let (swaying, carried) = skeleton.beams.split_at(count);
        assert!(3 * swaying.len() < skeleton.beams.len(), "{count} of {}", skeleton.beams.len());
        assert!(carried.iter().all(|beam| beam.order > LAST_ORDER));
    }

    #[test]
    fn vertices_are_bound_to_the_last_swaying_beam_below_them() {
        let skeleton = TreeModel::bake(&Species::default(), 60.0, 2).skeleton;
        let count = swaying_beams(&skeleton);
        let mut sway: Vec<[f32; 4]> = (0..skeleton.beams.len()).map(|beam| [beam as f32, 0.3, 0.7, 0.1]).collect();
        bind_to_swaying(&skeleton, &mut sway);
        for (index, vertex) in (0_u32..).zip(sway) {
            // Down from the beam to the first that sways.
            let (mut beam, mut at) = (index, 0.3);
            while beam >= count {
                let carried = &skeleton.beams[beam as usize];
                (beam, at) = (carried.parent.expect("stems sway"), carried.attach);
            }
            assert_eq!(vertex, [beam as f32, at, 0.7, 0.1], "beam {index}");
        }
    }
}
