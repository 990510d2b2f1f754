//! Constants that stand in Rust and in a shader are equal. (Sizes and bits are passed to the shaders as definitions.)

use bevy_windwood::dynamics::{MODE_SHAPE, SLOPE_TIP, TIP_ANGLE_LIMIT};

const BEAM: &str = include_str!("../src/render/shaders/beam.wesl");

/// The numbers of a constant of the shader.
fn constant(name: &str) -> Vec<f32> {
    let line = BEAM.lines().find(|line| line.starts_with(&format!("const {name}:"))).expect("the shader has it");
    let value = line.split('=').nth(1).expect("it has a value").trim().trim_start_matches("vec4(");
    value.trim_end_matches([')', ';']).split(',').map(|number| number.trim().parse().expect("a number")).collect()
}

#[test]
fn mode_shape_is_equal_in_rust_and_wesl() {
    for (k, row) in MODE_SHAPE.iter().enumerate() {
        assert_eq!(constant(&format!("MODE_SHAPE_{k}")), row);
    }
    assert_eq!(constant("SLOPE_TIP"), [SLOPE_TIP]);
    assert_eq!(constant("TIP_ANGLE_LIMIT"), [TIP_ANGLE_LIMIT]);
}

/// The number of a constant, in Rust or WESL.
fn value(text: &str, name: &str) -> f32 {
    let line = text.lines().find(|line| line.contains(&format!("const {name}:"))).expect("it is there");
    let value = line.split('=').nth(1).expect("it has a value").trim().trim_end_matches(';').trim_end_matches('u');
    value.replace('_', "").parse().expect("a number")
}

#[test]
fn leaf_phenology_constants_are_equal_in_rust_and_wesl() {
    let code = include_str!("../src/tree/phenology.rs");
    let shader = include_str!("../src/render/shaders/season.wesl");
    for name in ["DROP", "YOUTH", "DRIFT", "FARTHEST_M"] {
        assert_eq!(value(code, name), value(shader, name));
    }
}

#[test]
fn constants_of_the_sway_are_equal_in_rust_and_wesl() {
    let shader = include_str!("../src/render/shaders/beam_sway.wesl");
    for (code, names) in [
        (include_str!("../src/dynamics/beam.rs"), &["DRAG_SPEED_M_S", "FOLDING_SPEED_M_S"][..]),
        (include_str!("../src/dynamics/second_mode.rs"), &["MOST_OFFSET"]),
        (include_str!("../src/dynamics/oscillator_grid.rs"), &["SIZES", "DAMPINGS"]),
    ] {
        names.iter().for_each(|name| assert_eq!(value(code, name), value(shader, name), "{name}"));
    }
    let code = include_str!("../src/dynamics/pose/beam_group.rs");
    ["MOST_BEND", "LEAST_WAY"].into_iter().for_each(|name| assert_eq!(value(code, name), value(BEAM, name), "{name}"));
    let code = include_str!("../src/dynamics/pose.rs");
    let pose_pass = include_str!("../src/render/shaders/pose_pass.wesl");
    assert_eq!(value(code, "LEAST_WIND_M_S"), value(pose_pass, "LEAST_WIND_M_S"));
    let shader = include_str!("../src/render/shaders/wind.wesl");
    for (code, names) in [
        (include_str!("../src/sway/response.rs"), &["FAST_PERIODS_A_METRE"][..]),
        (
            include_str!("../src/wind/interpolation.rs"),
            &["HALF_ANGLE_RAD", "LINEAR_SHARE_ACROSS", "EVEN_SKEW", "ODD_SKEW", "CURVED_SKEW", "NEAR_SKEW"],
        ),
    ] {
        names.iter().for_each(|name| assert_eq!(value(code, name), value(shader, name), "{name}"));
    }
}

#[test]
fn constants_of_sources_and_bodies_are_equal_in_rust_and_wesl() {
    let sources = include_str!("../src/render/shaders/wind_sources.wesl");
    let blade = include_str!("../src/grass/shaders/blade.wesl");
    let frame = include_str!("../src/render/shaders/frame.wesl");
    for (code, shader, names) in [
        (include_str!("../src/wind/source.rs"), sources, &["FADES_FROM"][..]),
        (include_str!("../src/wind/source/blast.rs"), sources, &["SOUND_SPEED_M_S", "LEAST_SCALED_M"]),
        (include_str!("../src/wind/source/downwash.rs"), sources, &["LAYER_SHARE"]),
        (include_str!("../src/wind/source/vortex.rs"), sources, &["PEAK", "ENDS_FROM"]),
        (include_str!("../src/grass/spine.rs"), blade, &["TIP_WAY", "LEAST_M"]),
        (include_str!("../src/render/instances/rows.rs"), frame, &["MOST_SOURCES", "MOST_PUSHERS", "MOST_TRAILS"]),
    ] {
        names.iter().for_each(|name| assert_eq!(value(code, name), value(shader, name), "{name}"));
    }
}

#[test]
fn constants_of_the_wind_in_a_stand_are_equal_in_rust_and_wesl() {
    let shader = include_str!("../src/render/shaders/stand_wind.wesl");
    let stand_wind: &[&str] = &[
        "BLENDING_HEIGHT_M",
        "BLENDING_HEIGHTS",
        "GUSTS_AT_TOPS",
        "GUSTS_IN_OPEN",
        "GUST_ATTENUATION",
        "CONVECTION",
        "MEAN_LOAD_VARIANCE",
        "GUST_LOAD_VARIANCE",
        "PEAK_GUSTS",
        "LEAST_DEPTH_M",
        "LOW_SHARE",
        "LEAST_SHARE",
    ];
    let canopy: &[&str] = &["SUBLAYER", "MOST_HEIGHT_M", "MOST_SPEED_BY_FRICTION", "MOST_ATTENUATION"];
    for (code, names) in [
        (include_str!("../src/dynamics/stand_wind.rs"), stand_wind),
        (include_str!("../src/wind/canopy.rs"), canopy),
        (include_str!("../src/wind/profile.rs"), &["VON_KARMAN"]),
    ] {
        names.iter().for_each(|name| assert_eq!(value(code, name), value(shader, name), "{name}"));
    }
}
