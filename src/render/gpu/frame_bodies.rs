//! What a game blows and pushes, as the shaders of grass and fire read it in the values of the frame.

use crate::{
    render::instances::rows::{FrameRow, MOST_PUSHERS, MOST_SOURCES, MOST_TRAILS, PusherRow, SourceRow, TrailRow},
    sway::Pushers,
    wind::WindSources,
};
use bevy::math::Vec3;

/// Writes the sources, the pushers and their trails of now and of one frame ago: of more than there are rows, those nearest to the viewers.
/// `distance_m` is that of a place from them.
pub(super) fn write_bodies(
    row: &mut FrameRow,
    sources: &WindSources,
    pushers: &Pushers,
    distance_m: impl Fn(Vec3) -> f32,
) {
    let halves =
        [(sources.now(), pushers.now(), pushers.trail()), (sources.before(), pushers.before(), pushers.trail_before())];
    for (half, (flows, bodies, trail)) in halves.into_iter().enumerate() {
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
        let pieces = trail.iter().map(|piece| {
            let [[from_a, from_b], [to_a, to_b]] = piece.ends;
            let ends = [(from_a, piece.radius_m), (from_b, piece.ages_s[0]), (to_a, piece.ages_s[1]), (to_b, 0.0)];
            (from_a.midpoint(to_b), TrailRow(ends.map(|(place, number)| place.extend(number).to_array())))
        });
        row.trail_counts[half] =
            write_nearest(&mut row.trails[half * MOST_TRAILS..][..MOST_TRAILS], pieces, &distance_m);
    }
}

/// No kind has more rows.
const MOST_ROWS: usize = MOST_TRAILS;
const _: () = assert!(MOST_SOURCES <= MOST_ROWS && MOST_PUSHERS <= MOST_ROWS);

/// Writes rows, [`MOST_ROWS`] at most: all of them, in their order, or those that are nearest, the nearest first. Returns how many.
fn write_nearest<T: Copy>(
    rows: &mut [T],
    from: impl ExactSizeIterator<Item = (Vec3, T)>,
    distance_m: impl Fn(Vec3) -> f32,
) -> u32 {
    let has_room = from.len() <= rows.len();
    let mut distances_m = [0.0_f32; MOST_ROWS];
    let mut count = 0;
    for (place, value) in from {
        let own_m = if has_room { 0.0 } else { distance_m(place) };
        let at = distances_m[..count].partition_point(|other| other.total_cmp(&own_m).is_le());
        if at >= rows.len() {
            continue;
        }
        // What is farther moves on, and the farthest of a full list out of it.
        count = (count + 1).min(rows.len());
        distances_m[at..count].rotate_right(1);
        rows[at..count].rotate_right(1);
        (distances_m[at], rows[at]) = (own_m, value);
    }
    count as u32
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
        // Of those that are as far, the first come first.
        let alike = (0..9_u8).map(|k| (Vec3::X * f32::from(k / 6), k));
        let mut rows = [0; 4];
        assert_eq!(write_nearest(&mut rows, alike, Vec3::length), 4);
        assert_eq!(rows, [0, 1, 2, 3]);
    }
}
