//! The octahedral chart of the sphere, which has no pole (Praun & Hoppe 2003).
//!
//! A sphere is charted by the octahedron that is unfolded onto the unit square, its upper half the diamond in the
//! middle, its lower half the four corners: with `d / (|x| + |y| + |z|) = (x, y, z)`,
//!
//! ```text
//! (u, v) = (x, z)                                      for y >= 0
//! (u, v) = ((1 - |z|) sign x, (1 - |x|) sign z)        below,             both brought from -1..1 to 0..1
//! ```

use bevy::math::{Vec2, Vec3};

/// Direction of a place on the chart.
pub(super) fn unfolded(uv: Vec2) -> Vec3 {
    let [x, z] = [2.0 * uv.x - 1.0, 2.0 * uv.y - 1.0];
    let y = 1.0 - x.abs() - z.abs();
    let fold = |along: f32, across: f32| if y < 0.0 { (1.0 - across.abs()) * 1.0_f32.copysign(along) } else { along };
    Vec3::new(fold(x, z), y, fold(z, x)).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

    /// The chart's other way, straight from the formulas.
    fn folded(direction: Vec3) -> Vec2 {
        let d = direction / direction.abs().element_sum();
        let flat = if d.y >= 0.0 {
            Vec2::new(d.x, d.z)
        } else {
            Vec2::new((1.0 - d.z.abs()) * d.x.signum(), (1.0 - d.x.abs()) * d.z.signum())
        };
        0.5 * flat + 0.5
    }

    #[test]
    fn the_chart_is_a_bijection() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
        for _ in 0..2000 {
            let uv = Vec2::new(random.random(), random.random());
            assert!((folded(unfolded(uv)) - uv).length() < 1e-4, "{uv}");
        }
    }

    #[test]
    fn the_chart_distorts_no_part_of_the_sphere_much() {
        let area = |uv: Vec2| {
            let step = 1e-3;
            let [a, b, c] = [uv, uv + Vec2::X * step, uv + Vec2::Y * step].map(unfolded);
            (b - a).cross(c - a).length() / (step * step)
        };
        let areas: Vec<f32> =
            (0..400).map(|n| area(Vec2::new((n % 20) as f32 + 0.4, (n / 20) as f32 + 0.45) / 20.0)).collect();
        let (least, greatest) = areas.iter().fold((f32::MAX, 0.0_f32), |(l, g), &a| (l.min(a), g.max(a)));
        // The density of the octahedral chart runs from 4 at its corners to 4 3^(3/2) in the middle of its faces.
        assert!(least > 3.5 && greatest < 22.0, "{least} to {greatest}");
    }
}
