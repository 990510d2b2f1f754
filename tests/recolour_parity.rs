//! Leaves have the same colours over the year in the shader that draws them and in Rust, which exports them. Needs a Vulkan driver.
//! Mesa's software one will do.

mod support;

use bevy::prelude::*;
use bevy_windwood::tree::{
    phenology::Phenology,
    recolour::{Recolouring, SeasonColour, leafness},
};
use std::time::Duration;
use support::{
    headless_app,
    probe::{self, ProbeSource},
};

/// A sample is two rows: a colour and the change; the tone. The result is the colour then, and how much of it is leaf.
const RECOLOUR_SHADER: &str = "
import bevy_windwood::render::shaders::season::{leafness, recoloured};
@group(0) @binding(0) var<storage, read> samples: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> colours: array<vec4<f32>>;
@compute @workgroup_size(64)
fn recolour(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&colours) {
        return;
    }
    let summer = samples[2u * id.x];
    let tone = samples[2u * id.x + 1u].x;
    // Nothing is known of a buffer that is all zeros: so 1 is added.
    colours[id.x] = vec4(recoloured(summer.rgb, summer.w, tone), 1.0 + leafness(summer.rgb));
}
";
/// Colour of leaves in summer, sRGB.
const SUMMER: [f32; 3] = [0.19, 0.33, 0.10];

/// Colours all over the cube, black and white among them, in all seasons.
fn samples() -> Vec<(Vec3, SeasonColour)> {
    let steps = [0.0, 0.02, 0.1, 0.35, 0.7, 1.0];
    let mut samples = Vec::new();
    for red in steps {
        for green in steps {
            for blue in steps {
                for (number, change) in [-1.0, -0.4, 0.0, 0.3, 1.0].into_iter().enumerate() {
                    let tone = (0.31 * (samples.len() + number) as f32).fract();
                    samples.push((Vec3::new(red, green, blue), SeasonColour { change, tone }));
                }
            }
        }
    }
    samples
}

#[test]
fn leaves_have_the_same_colours_in_rust_and_in_the_shader() {
    let samples = samples();
    let phenology = Phenology::default();
    let colours = Recolouring::new(&phenology, SUMMER);
    let there = on_gpu(&samples, &phenology);
    let mut changed = 0;
    for ((summer, season), there) in samples.iter().zip(there) {
        let here = colours.of(*summer, *season);
        let (error, leaf_error) = ((here - there.truncate()).length(), (1.0 + leafness(*summer) - there.w).abs());
        assert!(error < 1e-4 * (1.0 + here.length()) && leaf_error < 1e-4, "{summer} {season:?}: {here} and {there}");
        changed += usize::from(here.distance(*summer) > 0.05);
    }
    assert!(changed > samples.len() / 10, "{changed} colours of {} change", samples.len());
}

fn on_gpu(samples: &[(Vec3, SeasonColour)], phenology: &Phenology) -> Vec<Vec4> {
    let mut app = headless_app(Duration::ZERO, None);
    app.add_plugins(probe::plugin);
    app.finish();
    app.cleanup();
    let rows = samples
        .iter()
        .flat_map(|(summer, season)| [summer.extend(season.change), Vec4::new(season.tone, 0.0, 0.0, 0.0)])
        .collect();
    let light = |[red, green, blue]: [f32; 3]| Color::srgb(red, green, blue).to_linear().to_vec4();
    let luminance = light(SUMMER).truncate().dot(Vec3::new(0.2126, 0.7152, 0.0722));
    let [first, last] = phenology.autumn_colours.map(light);
    let spring = light(phenology.spring_colour).truncate().extend(luminance);
    let world = app.world_mut();
    // `Phenology` of the shader. The times of the year do not matter here.
    let phenology = probe::uniform(world, vec![Vec4::ZERO, Vec4::ZERO, spring, first, last]);
    let shader = ProbeSource { entry_point: "recolour", wesl: RECOLOUR_SHADER };
    let read = probe::install(world, shader, rows, [samples.len(), 1], [(107, phenology)]);
    probe::read_all(&mut app, &read, |colour| colour.w > 0.5).unwrap()
}
