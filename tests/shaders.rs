//! The shaders say what the code says.

use bevy_windwood::dynamics::pose::{MODE_SHAPE, SLOPE_TIP, TIP_ANGLE_LIMIT};

const BEAM: &str = include_str!("../src/sway/shaders/beam.wgsl");

/// The numbers of a constant of the shader.
fn constant(name: &str) -> Vec<f32> {
    let line = BEAM.lines().find(|line| line.starts_with(&format!("const {name}:"))).expect("the shader has it");
    let value = line.split('=').nth(1).expect("it has a value").trim().trim_start_matches("vec4(");
    value.trim_end_matches([')', ';']).split(',').map(|number| number.trim().parse().expect("a number")).collect()
}

#[test]
fn the_mode_shape_is_the_same_in_both_languages() {
    for (k, row) in MODE_SHAPE.iter().enumerate() {
        assert_eq!(constant(&format!("MODE_SHAPE_{k}")), row);
    }
    assert_eq!(constant("SLOPE_TIP"), [SLOPE_TIP]);
    assert_eq!(constant("TIP_ANGLE_LIMIT"), [TIP_ANGLE_LIMIT]);
}

#[test]
fn the_cells_that_stand_near_are_a_square_of_one_size_in_both_languages() {
    let number = |text: &str, name: &str| -> f32 {
        let line = text.lines().find(|line| line.contains(&format!("const {name}:"))).expect("it is there");
        line.split('=').nth(1).expect("it has a value").trim().trim_end_matches(';').parse().expect("a number")
    };
    let shader = include_str!("../src/forest/far/shaders/far_card.wgsl");
    assert_eq!(number(include_str!("../src/forest/far/near.rs"), "SIDE"), number(shader, "NEAR_SIDE"));
    let mesh = include_str!("../src/forest/far/mesh.rs");
    assert_eq!(number(mesh, "GREATEST_SIZE"), number(shader, "GREATEST_SIZE"));
    let leans = format!("leans: array<vec4<f32>, {}>", number(mesh, "MOST_TREES"));
    assert!(include_str!("../src/forest/far/shaders/far.wgsl").contains(&leans), "{leans}");
}

#[test]
fn the_times_of_a_leaf_are_the_same_in_both_languages() {
    let code = include_str!("../src/tree/phenology.rs");
    let shader = include_str!("../src/sway/shaders/season.wgsl");
    let value = |text: &str, name: &str| -> f32 {
        let line = text.lines().find(|line| line.starts_with(&format!("const {name}: f32"))).expect("it is there");
        line.split('=').nth(1).expect("it has a value").trim().trim_end_matches(';').parse().expect("a number")
    };
    for name in ["DROP", "YOUTH", "DRIFT", "FARTHEST_M"] {
        assert_eq!(value(code, name), value(shader, name));
    }
}

#[test]
fn the_ladder_of_ages_and_the_bits_of_a_tag_are_the_same_in_both_languages() {
    let value = |text: &str, name: &str| -> String {
        let line = text.lines().find(|line| line.starts_with(&format!("const {name}:"))).expect("it is there");
        let value = line.split('=').nth(1).expect("it has a value").trim().trim_end_matches(';');
        value.chars().filter(|c| *c != 'u').collect()
    };
    assert_eq!(value(include_str!("../src/sway/detail.rs"), "LADDER"), value(BEAM, "LADDER"));
    let (code, shader) = (include_str!("../src/sway/dress.rs"), include_str!("../src/sway/shaders/sway.wgsl"));
    for name in ["FADES_OUT", "FADES_IN", "CARDS_BEHIND"] {
        assert_eq!(value(code, name), value(shader, name));
    }
}
