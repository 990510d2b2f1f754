//! Where pushers have been in the last moments: the grass there is still swinging back.

use crate::dynamics::{Capsule, SweptCapsule};
use bevy::prelude::*;
use std::collections::{BTreeMap, VecDeque};

/// Grass has come to rest after this time, s.
const TRAIL_S: f32 = 2.0;
/// A body's place is noted so often, s. In between it went straight on.
const STEP_S: f32 = 0.25;
/// Nearer than this it has stayed where it was, m.
const STANDS_M: f32 = 0.02;
/// A body that is faster than this has not gone there, m/s.
const FASTEST_M_S: f32 = 100.0;

/// A place where a body was.
#[derive(Clone, Copy, Debug)]
struct Placement {
    ends: [Vec3; 2],
    age_s: f32,
}

impl Placement {
    fn is_at(&self, ends: [Vec3; 2]) -> bool {
        self.farthest_m(ends) < STANDS_M
    }

    fn farthest_m(&self, [a, b]: [Vec3; 2]) -> f32 {
        self.ends[0].distance(a).max(self.ends[1].distance(b))
    }
}

/// The way of a body, the oldest place first.
#[derive(Debug, Default)]
struct Trail {
    placements: VecDeque<Placement>,
    radius_m: f32,
    /// Where the body is now, if it is still there.
    now: Option<[Vec3; 2]>,
}

impl Trail {
    /// Lets a frame pass, after which the body is nowhere.
    fn age(&mut self, frame_s: f32) {
        self.now = None;
        self.placements.iter_mut().for_each(|placement| placement.age_s += frame_s);
        // The first ends the stretch that began earlier: it goes when the second has grown too old.
        while self.placements.get(1).or(self.placements.front()).is_some_and(|it| it.age_s > TRAIL_S) {
            self.placements.pop_front();
        }
    }

    /// Notes where the body is.
    fn follow(&mut self, capsule: Capsule, frame_s: f32) {
        let ends = capsule.ends;
        self.now = Some(ends);
        self.radius_m = capsule.radius_m;
        let here = Placement { ends, age_s: 0.0 };
        let before = self.placements.iter().rev().nth(1).copied();
        let Some(last) = self.placements.back_mut() else {
            self.placements.push_back(here);
            return;
        };
        if last.farthest_m(ends) > FASTEST_M_S * (last.age_s + frame_s) {
            self.placements.clear();
            self.placements.push_back(here);
        } else if !last.is_at(ends) {
            if last.age_s >= STEP_S {
                self.placements.push_back(here);
            }
        } else if before.is_none_or(|before| before.is_at(last.ends)) {
            // It stands: it leaves this place only now.
            last.age_s = 0.0;
        } else {
            self.placements.push_back(here);
        }
    }

    fn pieces(&self) -> impl Iterator<Item = SweptCapsule> {
        let now = self.now.map(|ends| Placement { ends, age_s: 0.0 });
        let ends = self.placements.iter().copied().skip(1).chain(now);
        self.placements.iter().zip(ends).filter(|(from, to)| !from.is_at(to.ends)).map(|(from, to)| SweptCapsule {
            ends: [from.ends, to.ends],
            radius_m: self.radius_m,
            ages_s: [from.age_s, to.age_s],
        })
    }
}

/// The ways of all bodies, in a fixed order.
#[derive(Debug, Default)]
pub(in crate::sway) struct Trails(BTreeMap<Entity, Trail>);

impl Trails {
    /// Lets a frame pass, and writes where bodies have been, and are now.
    pub fn follow(
        &mut self,
        bodies: impl Iterator<Item = (Entity, Capsule)>,
        frame_s: f32,
        pieces: &mut Vec<SweptCapsule>,
    ) {
        self.0.values_mut().for_each(|trail| trail.age(frame_s));
        for (entity, body) in bodies {
            self.0.entry(entity).or_default().follow(body, frame_s);
        }
        self.0.retain(|_, trail| trail.now.is_some() || !trail.placements.is_empty());
        pieces.clear();
        pieces.extend(self.0.values().flat_map(Trail::pieces));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME_S: f32 = 0.02;

    /// The pieces after each frame of a body that is at those places.
    fn follow(places: impl Iterator<Item = Option<Vec3>>) -> Vec<Vec<SweptCapsule>> {
        let (mut trails, entity) = (Trails::default(), Entity::from_raw_u32(1).expect("it is a number"));
        let frame = |place: Option<Vec3>| {
            let capsule = place.map(|place| Capsule { ends: [place; 2], radius_m: 0.5 });
            let mut pieces = Vec::new();
            trails.follow(capsule.map(|capsule| (entity, capsule)).into_iter(), FRAME_S, &mut pieces);
            pieces
        };
        places.map(frame).collect()
    }

    #[test]
    fn a_walker_s_trail_tells_when_he_was_where() {
        let speed_m_s = 1.5;
        let walk = follow((0..300).map(|frame| Some(Vec3::X * (speed_m_s * FRAME_S * frame as f32))));
        for (frame, pieces) in walk.iter().enumerate().skip(1) {
            let here_m = speed_m_s * FRAME_S * frame as f32;
            let (first, last) = (pieces.first().expect("there is one"), pieces.last().expect("there is one"));
            assert_eq!((last.ends[1][0].x, last.ages_s[1]), (here_m, 0.0), "it ends with him");
            assert!(pieces.windows(2).all(|pair| pair[0].ends[1] == pair[1].ends[0]), "without a gap");
            for piece in pieces {
                for (ends, age_s) in piece.ends.iter().zip(piece.ages_s) {
                    assert!((ends[0].x - (here_m - speed_m_s * age_s)).abs() < 1e-3, "{piece:?} in frame {frame}");
                }
            }
            let reach_s = (frame as f32 * FRAME_S).min(TRAIL_S);
            assert!((reach_s - 1e-3..TRAIL_S + STEP_S + 2.0 * FRAME_S).contains(&first.ages_s[0]), "{first:?}");
            assert!(pieces.len() <= (TRAIL_S / STEP_S) as usize + 2);
        }
    }

    #[test]
    fn who_stands_leaves_his_place_only_when_he_goes() {
        let place =
            |frame: usize| Vec3::X * (0.03 * frame.clamp(20, 100) as f32 + 0.03 * frame.saturating_sub(200) as f32);
        let frames = follow((0..220).map(|frame| Some(place(frame))));
        assert!(frames[..20].iter().all(Vec::is_empty), "he has not gone anywhere");
        // What he passed grows old while he stands, and then is forgotten.
        assert!(frames[150].iter().all(|piece| piece.ages_s[0] > 50.0 * FRAME_S - 1e-3));
        assert!(frames[200].iter().map(|piece| piece.ages_s[0]).fold(0.0, f32::max) > 0.99 * TRAIL_S);
        let gone: Vec<_> = frames[203].iter().filter(|piece| piece.ends[1][0].x > place(200).x).collect();
        let [gone] = &gone[..] else { panic!("{gone:?}") };
        assert!((gone.ages_s[0] - 3.0 * FRAME_S).abs() < 1e-3 && gone.ages_s[1] == 0.0, "{gone:?}");
    }

    #[test]
    fn a_jump_leaves_no_trail_and_one_who_is_gone_leaves_his_for_a_while() {
        let frames = follow((0..250).map(|frame| match frame {
            0..40 => Some(Vec3::X * (0.03 * frame as f32)),
            40..60 => Some(Vec3::X * (500.0 + 0.03 * frame as f32)),
            _ => None,
        }));
        assert!(frames[40].is_empty() && frames[45].iter().all(|piece| piece.ends[0][0].x > 400.0));
        assert!(!frames[61].is_empty());
        let kept = (TRAIL_S / FRAME_S) as usize;
        assert!(!frames[60 + kept - 20].is_empty() && frames[60 + kept + 20].is_empty());
    }
}
