//! What is baked of a time of the year.

use super::{Grown, OAK, glb_reader::Reader};
use crate::export::ExportSettings;
use image::GenericImageView;

fn at(grown: &Grown, year: f32) -> Reader {
    Reader::new(&grown.glb(&ExportSettings { year, ..ExportSettings::default() }))
}

/// Mean sRGB of the opaque texels of the picture of a material.
fn mean_colour(reader: &Reader, material: &str) -> [f32; 3] {
    let material = reader.gltf.materials().find(|it| it.name() == Some(material)).unwrap();
    let texture = material.pbr_metallic_roughness().base_color_texture().unwrap().texture();
    let gltf::image::Source::View { view, .. } = texture.source().source() else { panic!("it is in the file") };
    let picture = image::load_from_memory(&reader.blob()[view.offset()..view.offset() + view.length()]).unwrap();
    let opaque: Vec<[u8; 4]> = picture.pixels().map(|(_, _, texel)| texel.0).filter(|texel| texel[3] > 127).collect();
    let mean = |channel: usize| opaque.iter().map(|texel| f32::from(texel[channel])).sum::<f32>() / opaque.len() as f32;
    std::array::from_fn(mean)
}

#[test]
fn an_oak_is_green_in_summer_brown_in_autumn_and_bare_in_winter() {
    let [winter, summer, autumn] = [0.02, 0.55, 0.83].map(|year| at(&OAK, year));
    assert!(winter.primitive("oak", "leaves").is_none() && winter.primitive("oak", "twigs").is_some());
    assert!(summer.primitive("oak", "leaves").is_some() && summer.primitive("oak", "twigs").is_none());
    let [red, green, _] = mean_colour(&summer, "oak leaves");
    assert!(green > 1.15 * red, "{red} {green}");
    let [red, green, _] = mean_colour(&autumn, "oak leaves");
    assert!(red > 1.1 * green, "{red} {green}");
}

#[test]
fn as_many_sprays_are_bare_as_have_shed() {
    let year = 0.86;
    let autumn = at(&OAK, year);
    let count = |material| autumn.primitive("oak", material).map_or(0, |part| autumn.indices(&part).len());
    let share = count("leaves") as f32 / (count("leaves") + count("twigs")) as f32;
    let expected = OAK.model.leaf_season.share(year);
    assert!((share - expected).abs() < 0.1, "{share}, {expected} expected");
    assert_eq!(count("leaves") + count("twigs"), 2 * OAK.model.leaves.indices.len(), "both sides of all");
}

#[test]
fn evergreens_keep_their_needles() {
    let pine = Grown::shipped("scots_pine", 15.0);
    let name = pine.species.name.clone();
    let winter = at(&pine, 0.0);
    assert!(winter.primitive(&name, "leaves").is_some() && winter.primitive(&name, "twigs").is_none());
}

/// Texture times vertices, with the mean colour of the leaves, is what the renderer's shader makes of that colour.
#[test]
fn colours_multiply_to_those_of_the_renderer() {
    use crate::texture::linear;
    use bevy::math::Vec3;
    let summer = at(&OAK, 0.55);
    let part = summer.primitive("oak", "leaves").unwrap();
    let colours: Vec<Vec3> =
        part.reader(|_| Some(summer.blob())).read_colors(0).unwrap().into_rgb_f32().map(Vec3::from_array).collect();
    let leaves = &OAK.model.leaves;
    // In summer the vertices have the shader's shade, by a factor for all of a channel, for which the texture is lighter.
    let shade = |vertex: usize| {
        let (light, tint) = (leaves.sway[vertex][3], leaves.axis[vertex][3]);
        (0.25 + 0.75 * light) * (0.85 + 0.35 * tint) * Vec3::new(0.92 + 0.2 * tint, 1.0, 1.05 - 0.25 * tint)
    };
    let gain = (0..colours.len()).map(shade).fold(Vec3::ONE, Vec3::max);
    for (vertex, colour) in colours.iter().enumerate() {
        let expected = shade(vertex) / gain;
        assert!(colour.distance(expected) < 0.006, "{colour} {expected}");
    }
    let [_, own, _] = linear(mean_colour(&summer, "oak leaves").map(|channel| channel / 255.0));
    let [_, mean, _] = linear(OAK.textures.foliage_colour());
    assert!((own / mean / gain.y - 1.0).abs() < 0.15, "{own} {mean} {gain}");
}

#[test]
fn all_shipped_species_can_be_exported_in_autumn() {
    let folder = format!("{}/assets/species", env!("CARGO_MANIFEST_DIR"));
    let names = std::fs::read_dir(folder).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> =
        names.filter_map(|name| name.strip_suffix(".species.ron").map(str::to_owned)).collect();
    names.sort();
    assert!(names.len() > 20);
    for name in names {
        let grown = Grown::shipped(&name, 4.0);
        let parts = at(&grown, 0.84).gltf.meshes().next().unwrap().primitives().count();
        assert!(parts > 0, "{name}");
    }
}
