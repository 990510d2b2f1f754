//! What a game blows and pushes, as the shaders of grass and fire read it in the values of the frame.

use crate::{
    render::instances::rows::{FrameRow, MOST_PUSHERS, MOST_SOURCES, PusherRow, SourceRow},
    sway::Pushers,
    wind::WindSources,
};
use bevy::math::Vec3;

/// Writes the sources and pushers of now and of one frame ago: of more than there are rows, those nearest to the viewers. `distance_m`
/// is that of a place from them.
pub(super) fn write_bodies(
    row: &mut FrameRow,
    sources: &WindSources,
    pushers: &Pushers,
    distance_m: impl Fn(Vec3) -> f32,
) {
    let halves = [(sources.now(), pushers.now()), (sources.before(), pushers.before())];
    for (half, (flows, bodies)) in halves.into_iter().enumerate() {
        let flows = flows.iter().map(|flow| (flow.place, SourceRow(flow.to_rows())));
        row.source_counts[half] =
            write_nearest(&mut row.sources[half * MOST_SOURCES..][..MOST_SOURCES], flows, &distance_m);
        let bodies = bodies.iter().map(|body| {
            let [a, b] = body.capsule.ends;
            let radius_m = body.capsule.radius_m;
            (a.midpoint(b), PusherRow([a.extend(radius_m).to_array(), b.extend(radius_m).to_array()]))
        });
        row.pusher_counts[half] =
            write_nearest(&mut row.pushers[half * MOST_PUSHERS..][..MOST_PUSHERS], bodies, &distance_m);
    }
}

/// Writes rows: all of them, or those that are nearest. Returns how many.
fn write_nearest<T: Copy>(
    rows: &mut [T],
    from: impl Iterator<Item = (Vec3, T)>,
    distance_m: impl Fn(Vec3) -> f32,
) -> u32 {
    let mut found: Vec<(Vec3, T)> = from.collect();
    if found.len() > rows.len() {
        found.sort_by(|(a, _), (b, _)| distance_m(*a).total_cmp(&distance_m(*b)));
    }
    rows.iter_mut().zip(&found).for_each(|(row, (_, value))| *row = *value);
    found.len().min(rows.len()) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_too_many_the_nearest_are_written() {
        let places = (0..9).map(|k| Vec3::X * ((k * 4 % 9) as f32)).map(|place| (place, place.x));
        let mut rows = [0.0; 4];
        assert_eq!(write_nearest(&mut rows, places.clone().take(3), Vec3::length), 3);
        assert_eq!(rows, [0.0, 4.0, 8.0, 0.0], "in their own order while there is room");
        assert_eq!(write_nearest(&mut rows, places, |place| (place - Vec3::X * 8.0).length()), 4);
        assert_eq!(rows, [8.0, 7.0, 6.0, 5.0]);
    }
}
