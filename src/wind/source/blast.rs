//! The wind of an explosion in air.
//!
//! At `Z = r / W^(1/3)` (m/kg^(1/3), `W` the mass of TNT in kg) the shock has, in atmospheres, the peak overpressure `p` and its
//! positive phase lasts `t_d` (Kinney & Graham, *Explosive Shocks in Air*, 2nd ed. 1985, fits to their table XI):
//!
//! ```text
//! p   = 808 [1 + (Z/4.5)^2] / sqrt([1 + (Z/0.048)^2] [1 + (Z/0.32)^2] [1 + (Z/1.35)^2])
//! t_d = 0.98 s W^(1/3) [1 + (Z/0.54)^10] / ([1 + (Z/0.02)^3] [1 + (Z/0.74)^6] sqrt(1 + (Z/6.9)^2))
//! ```
//!
//! By the Rankine-Hugoniot relations of air the front runs at `c sqrt(1 + 6p/7)`, and the air behind it at
//! `u = (5p/7) c / sqrt(1 + 6p/7)`. Then it follows Friedlander's wave,
//!
//! ```text
//! u(t) = u (1 - t/t_d) exp(-t/t_d)
//! ```
//!
//! of the decay of a weak wave, with which the air comes back to where it was. `t` is the time since the front has passed,
//! `(R - r) / c` with `R` the radius of the front. The burning gas itself, and what the ground reflects, are left out.
//!
//! Numbers: radius of the front, m; `W^(1/3)`; factor on the speed; radius of the front one frame ago.

use bevy::math::Vec3;

/// Speed of sound in air at 15 degrees C, m/s.
pub(super) const SOUND_SPEED_M_S: f32 = 340.3;
/// Nearer, in m/kg^(1/3), there is the fireball: the wind counts as there.
const LEAST_SCALED_M: f32 = 0.5;
/// Farther it is a sound.
const MOST_SCALED_M: f32 = 500.0;
/// The wave has passed after so many of its positive phases: 2e-3 of its peak are left.
const PHASES: f32 = 8.0;
/// A pulse is looked at so often in a positive phase, and at most so often in a frame.
const SAMPLES_A_PHASE: f32 = 6.0;
const MOST_SAMPLES: f32 = 48.0;

/// Overpressure of the front, atmospheres.
pub(super) fn overpressure_atm(scaled_m: f32) -> f32 {
    let square = |scale: f32| 1.0 + (scaled_m / scale).powi(2);
    808.0 * square(4.5) / (square(0.048) * square(0.32) * square(1.35)).sqrt()
}

/// Length of the positive phase by the root of the charge, s/kg^(1/3).
pub(super) fn positive_phase_s(scaled_m: f32) -> f32 {
    let power = |scale: f32, exponent: i32| 1.0 + (scaled_m / scale).powi(exponent);
    0.98 * power(0.54, 10) / (power(0.02, 3) * power(0.74, 6) * power(6.9, 2).sqrt())
}

/// Speed of the front by that of sound.
fn mach(scaled_m: f32) -> f32 {
    (1.0 + 6.0 / 7.0 * overpressure_atm(scaled_m)).sqrt()
}

/// Speed of the air behind the front, m/s; where it would be faster than sound, as fast.
pub(super) fn peak_m_s(scaled_m: f32) -> f32 {
    let over = 5.0 / 7.0 * overpressure_atm(scaled_m) * SOUND_SPEED_M_S / mach(scaled_m);
    over.min(SOUND_SPEED_M_S)
}

/// Radius of the front after a time, both by the root of the charge.
pub(super) fn front_scaled_m(mut time_s: f32) -> f32 {
    let mut scaled_m = 0.0_f32;
    while scaled_m < 50.0 {
        let step_m = 0.02 + 0.05 * scaled_m;
        let step_s = step_m / (SOUND_SPEED_M_S * mach(scaled_m + 0.5 * step_m));
        if step_s >= time_s {
            return scaled_m + step_m * time_s / step_s;
        }
        time_s -= step_s;
        scaled_m += step_m;
    }
    // By now it is a sound.
    scaled_m + SOUND_SPEED_M_S * time_s
}

/// The numbers of a charge at its age now and one frame ago, s.
pub(super) fn numbers(charge_kg: f32, [age_s, before_s]: [f32; 2], strength: f32) -> [f32; 4] {
    let root = charge_kg.cbrt();
    let front_m = |age_s: f32| root * front_scaled_m(age_s.max(0.0) / root);
    [front_m(age_s), root, strength, front_m(before_s)]
}

/// How far its wind is felt at most, m.
pub(super) fn most_reach_m(numbers: &[f32; 4]) -> f32 {
    MOST_SCALED_M * numbers[1]
}

/// Whether all of the wave has left a ball about the charge.
pub(super) fn has_passed(numbers: &[f32; 4], radius_m: f32) -> bool {
    numbers[3] >= radius_m + length_m(numbers, radius_m)
}

/// How far behind the front the wave reaches at a distance, m.
fn length_m(numbers: &[f32; 4], distance_m: f32) -> f32 {
    let root = numbers[1];
    PHASES * SOUND_SPEED_M_S * root * positive_phase_s((distance_m / root).max(LEAST_SCALED_M))
}

pub(super) fn velocity(&[front_m, root, strength, _]: &[f32; 4], from: Vec3) -> Vec3 {
    let distance_m = from.length();
    let scaled_m = (distance_m / root).max(LEAST_SCALED_M);
    let phase = (front_m - distance_m) / (SOUND_SPEED_M_S * root * positive_phase_s(scaled_m));
    if phase <= 0.0 {
        return Vec3::ZERO;
    }
    from.normalize_or_zero() * (strength * peak_m_s(scaled_m) * (1.0 - phase) * (-phase).exp())
}

/// The same blast while its front was elsewhere.
pub(super) fn with_front(&[_, root, strength, before_m]: &[f32; 4], front_m: f32) -> [f32; 4] {
    [front_m, root, strength, before_m]
}

/// Where the front was in even steps of that part of its way in a frame that lay beyond a distance, and what share of the frame it took for
/// each; none if the wave was not there in it.
pub(super) fn fronts(numbers: &[f32; 4], distance_m: f32, frame_s: f32) -> impl Iterator<Item = (f32, f32)> + use<> {
    let &[now_m, root, _, before_m] = numbers;
    let length_m = length_m(numbers, distance_m);
    let was_there = now_m > distance_m && before_m < distance_m + length_m;
    let from_m = before_m.max(distance_m);
    let parts = (SAMPLES_A_PHASE * PHASES * (now_m - from_m) / length_m).ceil().clamp(1.0, MOST_SAMPLES);
    let count = if was_there && frame_s > 0.0 { parts as u32 } else { 0 };
    let step_m = (now_m - from_m) / parts;
    (0..count).map(move |part| {
        let front_m = from_m + step_m * (part as f32 + 0.5);
        (front_m, step_m / (SOUND_SPEED_M_S * mach(front_m / root) * frame_s))
    })
}

/// Whether the wave was in a ball in this frame, and is as strong as that there.
pub(super) fn touches(numbers: &[f32; 4], distance_m: f32, radius_m: f32, least_m_s: f32) -> bool {
    let &[now_m, root, strength, before_m] = numbers;
    let nearest_m = (distance_m - radius_m).max(0.0);
    let farthest_m = distance_m + radius_m;
    now_m > nearest_m
        && before_m < farthest_m + length_m(numbers, farthest_m)
        && strength * peak_m_s((nearest_m / root).max(LEAST_SCALED_M)) >= least_m_s
}
