//! Forest plans of different size, for `validate` and the benchmarks.

use bevy_windwood::scatter::{
    ForestPlan,
    plan::{Area, KeepOut, Shape},
};

/// The shipped forest.
pub fn shipped() -> ForestPlan {
    ForestPlan::from_ron(include_str!("../../assets/forests/mixed.forest.ron")).expect("the shipped forest is valid")
}

/// The shipped forest with 2,000 more areas and 2,000 paths.
pub fn shipped_with_many_areas() -> ForestPlan {
    let mut plan = shipped();
    for number in 0..2000_u16 {
        let [x, z] = [number % 50, number / 50].map(|step| 1000.0 + 1200.0 * f32::from(step));
        let shape = Shape::Rectangle { min_m: [x, z], max_m: [x + 900.0, z + 900.0] };
        plan.areas.push(Area { shape, ..Area::default() });
        let points_m = (0..10_u8).map(|point| [x + 50.0 * f32::from(point), z + 30.0]).collect();
        plan.keep_out.push(KeepOut::Path { points_m, width_m: 4.0 });
    }
    plan
}
