//! Pruning: a conifer sways faster without its crown, but only when most of it is gone (Moore & Maguire 2004: some 80%).

use super::{SENSOR, modes, strongest};
use crate::{
    frame::of_tree::{chain, whole},
    report::Report,
    trees::shipped,
};
use bevy_windwood::tree::{Species, individual::grow, mechanics::tree_sway, skeleton::Skeleton};
use nalgebra::Vector3;

const CONIFERS: [&str; 3] = ["norway_spruce", "fir", "scots_pine"];
/// Shares of the crown's mass that are taken away, from below.
const SHARES: [f64; 3] = [0.2, 0.5, 0.8];
const SEED: u64 = 1;

/// Frequency over that of the whole tree, by the product and by finite elements.
pub fn measure(report: &mut Report) {
    println!("  pruned              crown gone   product   elements");
    let (mut least, mut least_of_elements, mut difference) = (f64::INFINITY, f64::INFINITY, 0.0_f64);
    for name in CONIFERS {
        let Ok(species) = shipped(name) else { continue };
        let skeleton = grow(&species, species.age.mature_years, SEED);
        let before = frequencies_hz(&species, &skeleton);
        for share in SHARES {
            let after = frequencies_hz(&species, &pruned(&species, &skeleton, share));
            let [ours, theirs] = [after[0] / before[0], after[1] / before[1]];
            println!("  {name:<18} {share:>11.1} {ours:>9.3} {theirs:>10.3}");
            difference = difference.max((ours / theirs - 1.0).abs());
            if share >= 0.8 {
                (least, least_of_elements) = (least.min(ours), least_of_elements.min(theirs));
            }
        }
    }
    report.at_least(
        "pruned_frequency_ratio",
        least,
        1.0,
        "four fifths of the crown gone, over whole: least of 3 conifers",
    );
    report.record("pruned_ratio_of_elements", least_of_elements, "the same by finite elements");
    report.record("pruned_ratio_difference", difference, "of the two, worst");
}

fn frequencies_hz(species: &Species, skeleton: &Skeleton) -> [f64; 2] {
    let tree = whole(species, skeleton, |_| 1.0);
    let sensor = tree.place(skeleton, &chain(skeleton, 0), SENSOR);
    let theirs = strongest(&modes(&tree, sensor.node, Vector3::x()));
    [f64::from(tree_sway(species, skeleton).frequency_hz), theirs[0].frequency_hz]
}

/// The tree without its lowest branches, up to the height at which `share` of the mass that the trunk bears is gone.
fn pruned(species: &Species, skeleton: &Skeleton, share: f64) -> Skeleton {
    let (mut low_m, mut high_m) = (0.0, skeleton.height_m());
    let trunk = chain(skeleton, 0);
    let mass_kg = |skeleton: &Skeleton| -> f64 {
        whole(species, skeleton, |_| 1.0).frame.lumps.iter().map(|lump| lump.mass_kg).sum()
    };
    let bare_kg = mass_kg(&without_below(skeleton, &trunk, f32::INFINITY));
    let crown_kg = mass_kg(skeleton) - bare_kg;
    for _ in 0..30 {
        let middle_m = (low_m + high_m) / 2.0;
        let left_kg = mass_kg(&without_below(skeleton, &trunk, middle_m)) - bare_kg;
        if left_kg > (1.0 - share) * crown_kg { low_m = middle_m } else { high_m = middle_m }
    }
    without_below(skeleton, &trunk, high_m)
}

/// The tree without what grows from its trunk below a height.
fn without_below(skeleton: &Skeleton, trunk: &[usize], height_m: f32) -> Skeleton {
    let mut places: Vec<Option<u32>> = Vec::with_capacity(skeleton.beams.len());
    let mut beams = Vec::new();
    for (index, beam) in skeleton.beams.iter().enumerate() {
        let parent = beam.parent.map(|parent| places[parent as usize]);
        let on_trunk = beam.parent.is_some_and(|parent| trunk.contains(&(parent as usize)));
        let stays = trunk.contains(&index) || (parent != Some(None) && !(on_trunk && beam.base.y < height_m));
        places.push(stays.then_some(beams.len() as u32));
        if stays {
            let mut beam = *beam;
            beam.parent = parent.flatten();
            beams.push(beam);
        }
    }
    let on_trunk = |beam: u32| trunk.contains(&(beam as usize));
    let clusters = skeleton.clusters.iter().filter(|cluster| !on_trunk(cluster.beam) || cluster.anchor.y >= height_m);
    let clusters = clusters.filter_map(|cluster| {
        let mut cluster = *cluster;
        cluster.beam = places[cluster.beam as usize]?;
        Some(cluster)
    });
    Skeleton { beams, clusters: clusters.collect(), envelope: skeleton.envelope, trunk: skeleton.trunk }
}
