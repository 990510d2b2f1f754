//! OBJ, crowns of polygons, impostors and stands.

use super::{Grown, OAK, glb_reader::Reader};
use crate::{
    export::{
        ExportError, ExportLevels, ExportSettings, ExportedFiles, Instancing, StandInstance, impostor_files, obj_files,
        polygon_files, stand_glb,
    },
    tree::{Growth, Species, crown::impressionist::ImpressionistCrown},
};
use bevy::math::{Quat, Vec3};
use std::io::{BufReader, Cursor};

fn file<'a>(files: &'a ExportedFiles, name: &str) -> &'a [u8] {
    &files.0.iter().find(|(other, _)| other == name).unwrap_or_else(|| panic!("there is no {name}")).1
}

/// Models and materials of `NAME.obj`, as the crate `tobj` reads them.
fn read(files: &ExportedFiles, name: &str) -> (Vec<tobj::Model>, Vec<tobj::Material>) {
    let mut obj = BufReader::new(Cursor::new(file(files, &format!("{name}.obj"))));
    let options = tobj::LoadOptions { single_index: true, ..tobj::LoadOptions::default() };
    let (models, materials) = tobj::load_obj_buf(&mut obj, &options, |path| {
        tobj::load_mtl_buf(&mut BufReader::new(Cursor::new(file(files, path.to_str().unwrap()))))
    })
    .unwrap();
    (models, materials.unwrap())
}

#[test]
fn an_obj_read_back_has_the_triangles_of_the_model() {
    let files = obj_files(&OAK.tree(), "my-oak_1", &ExportSettings::default()).unwrap();
    let (models, materials) = read(&files, "my-oak_1");
    let names: Vec<&str> = models.iter().map(|model| model.name.as_str()).collect();
    assert_eq!(names, ["bark", "leaves"]);
    let wood = &OAK.model.wood;
    let mesh = &models[0].mesh;
    let corner = |index: u32| std::array::from_fn::<f32, 3, _>(|axis| mesh.positions[3 * index as usize + axis]);
    let found: Vec<[f32; 3]> = mesh.indices.iter().map(|index| corner(*index)).collect();
    let own: Vec<[f32; 3]> = wood.indices.iter().map(|index| wood.positions[*index as usize]).collect();
    assert!(found == own);
    for (material, part) in materials.iter().zip(["bark", "leaves"]) {
        assert_eq!(material.name, part);
        let picture = material.diffuse_texture.as_ref().unwrap();
        assert_eq!(image::load_from_memory(file(&files, picture)).unwrap().width(), 512);
        assert!(material.diffuse.unwrap().iter().all(|channel| (0.1..=1.0).contains(channel)));
    }
    let mask = image::load_from_memory(file(&files, materials[1].dissolve_texture.as_ref().unwrap())).unwrap();
    assert_eq!(mask.color(), image::ColorType::L8);
}

#[test]
fn names_that_would_lead_elsewhere_and_levels_that_obj_has_not_are_refused() {
    let settings = ExportSettings::default();
    for name in ["", "../oak", "an oak", "a/b", "oak.obj"] {
        let error = obj_files(&OAK.tree(), name, &settings).unwrap_err().to_string();
        assert_eq!(error, format!("`name` is {name:?}, but must be letters, digits, `_` and `-`, at least one"));
    }
    let error = obj_files(&OAK.tree(), "oak", &ExportSettings { levels: ExportLevels::Lod, ..settings }).unwrap_err();
    assert_eq!(error.to_string(), "`levels` is Lod, but must be One(..) for OBJ");
}

#[test]
fn polygons_of_a_crown_have_their_corners_their_value_and_its_brightness() {
    let crown = ImpressionistCrown { polygons: 300, ..ImpressionistCrown::default() };
    let species = Species { growth: Growth::Impressionist(crown), ..Species::default() };
    let grown = Grown::new(species, 120.0, 1);
    let files = polygon_files(&grown.tree(), "crown").unwrap();
    let (models, materials) = read(&files, "crown");
    let polygons = models.iter().map(|model| model.mesh.indices.len() / 3).sum::<usize>();
    assert_eq!(polygons, grown.model.skeleton.clusters.len());
    let mut brightness = Vec::new();
    for model in &models {
        let mesh = &model.mesh;
        let colour = materials[mesh.material_id.unwrap()].diffuse.unwrap();
        let value = colour.into_iter().fold(0.0, f32::max);
        for corner in mesh.indices.iter().map(|index| *index as usize) {
            // The greatest channel of a colour is its value, which falls linearly with the texture's.
            let depth = mesh.texcoords[2 * corner];
            let expected = crown.greatest_brightness + depth * (crown.least_brightness - crown.greatest_brightness);
            assert!((value - expected).abs() < 0.51 * (crown.greatest_brightness - crown.least_brightness) / 32.0);
            let anchor = Vec3::from_slice(&mesh.positions[3 * corner..]);
            assert!(anchor.is_finite());
        }
        brightness.push(value);
    }
    assert!(brightness.is_sorted_by(|outer, inner| outer > inner), "{brightness:?}");
    let error = polygon_files(&OAK.tree(), "oak").unwrap_err();
    assert!(matches!(&error, ExportError::NoPolygons { species } if species == "oak"), "{error}");
}

#[test]
fn an_atlas_of_impostors_says_what_its_views_show() {
    let mut settings = ExportSettings::default();
    settings.bake.impostor.views_per_side = 4;
    settings.bake.impostor.tile_texels = 32;
    let files = impostor_files(&OAK.tree(), "oak", &settings).unwrap();
    let text: serde_json::Value = serde_json::from_slice(file(&files, "oak.json")).unwrap();
    let number = |value: &serde_json::Value| value.as_f64().unwrap() as f32;
    let vector =
        |value: &serde_json::Value| Vec3::from_slice(&value.as_array().unwrap().iter().map(number).collect::<Vec<_>>());
    let tile = [&text["tile_texels"][0], &text["tile_texels"][1]].map(|side| side.as_u64().unwrap() as u32);
    let picture = image::load_from_memory(file(&files, text["files"]["colour"].as_str().unwrap())).unwrap().to_rgba8();
    // The tree in leaf, and below it the bare one.
    assert_eq!([picture.width(), picture.height()], [4 * tile[0], 2 * 4 * tile[1]]);
    assert_eq!((&text["grids"][1]["season"], &text["grids"][1]["first_row"]), (&"bare".into(), &4.into()));
    let views = text["views"].as_array().unwrap();
    assert_eq!(views.len(), 16);
    // Where the text says that the top of the trunk's first beam is, the bare tree is opaque or nearly so.
    let centre = vector(&text["centre_m"]);
    let trunk = &OAK.model.skeleton.beams[0];
    for view in views {
        let [to_eye, right, up] = ["to_eye", "right", "up"].map(|axis| vector(&view[axis]));
        assert!(to_eye.is_normalized() && to_eye.y > -1e-6 && right.cross(up).distance(to_eye) < 1e-5);
        let from = trunk.path(0.5) - centre;
        let half = [&view["half_size_m"][0], &view["half_size_m"][1]].map(number);
        let place = [0.5 + 0.5 * from.dot(right) / half[0], 0.5 - 0.5 * from.dot(up) / half[1]];
        let corner = [view["column"].as_u64().unwrap() as u32, 4 + view["row"].as_u64().unwrap() as u32];
        let [x, y] = std::array::from_fn(|axis| corner[axis] * tile[axis] + (place[axis] * tile[axis] as f32) as u32);
        let nearby = |dx: u32| picture.get_pixel((x + dx).saturating_sub(1).min(picture.width() - 1), y).0[3];
        assert!((0..3).map(nearby).max().unwrap() > 60, "{view}");
    }
}

#[test]
fn a_stand_has_each_tree_once_and_its_places() {
    let young = Grown::new(OAK.species.clone(), 6.0, 1);
    let trees = [OAK.tree(), crate::export::ExportedTree { species: &OAK.species, ..young.tree() }];
    let instances: Vec<StandInstance> = (0..7)
        .map(|number| StandInstance {
            tree: usize::from(number % 3 == 0),
            position: Vec3::new(number as f32, 0.5, -2.0 * number as f32),
            turn_rad: number as f32,
            scale: 1.0 + 0.1 * number as f32,
        })
        .collect();
    let settings = ExportSettings { levels: ExportLevels::One(1), ..ExportSettings::default() };
    let plain = Reader::new(&stand_glb(&trees, &instances, Instancing::Nodes, &settings).unwrap());
    assert_eq!((plain.gltf.nodes().count(), plain.gltf.meshes().count(), plain.gltf.materials().count()), (7, 2, 2));
    let of_tree = |tree: usize| instances.iter().filter(move |instance| instance.tree == tree);
    for (node, instance) in plain.gltf.nodes().zip(of_tree(0).chain(of_tree(1))) {
        let (position, rotation, scale) = node.transform().decomposed();
        assert_eq!((Vec3::from_array(position), scale), (instance.position, [instance.scale; 3]));
        assert!(Quat::from_array(rotation).angle_between(Quat::from_rotation_y(instance.turn_rad)) < 1e-3);
    }
    // The crate `gltf` refuses required extensions that it does not know, so the document is read as it is.
    let glb = stand_glb(&trees, &instances, Instancing::Gpu, &settings).unwrap();
    let json_bytes = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    let document: serde_json::Value = serde_json::from_slice(&glb[20..20 + json_bytes]).unwrap();
    assert_eq!(document["extensionsRequired"], serde_json::json!(["EXT_mesh_gpu_instancing"]));
    let nodes = document["nodes"].as_array().unwrap();
    let counts = nodes.iter().map(|node| {
        let attributes = &node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
        ["TRANSLATION", "ROTATION", "SCALE"]
            .map(|name| document["accessors"][attributes[name].as_u64().unwrap() as usize]["count"].as_u64().unwrap())
    });
    assert_eq!(counts.collect::<Vec<_>>(), [[4; 3], [3; 3]]);
    assert!(glb.len() < plain.blob().len() + 20_000);
}

#[test]
fn instances_that_stand_nowhere_are_refused_by_number() {
    let instance = StandInstance { tree: 0, position: Vec3::ZERO, turn_rad: 0.0, scale: 1.0 };
    let none = stand_glb(&[OAK.tree()], &[], Instancing::Gpu, &ExportSettings::default()).unwrap_err();
    assert_eq!(none.to_string(), "`instances` is 0 long, but must be at least 1 long");
    let refused = |instance: StandInstance| {
        let trees = [OAK.tree()];
        stand_glb(&trees, &[instance], Instancing::Gpu, &ExportSettings::default()).unwrap_err().to_string()
    };
    assert_eq!(
        refused(StandInstance { tree: 4, ..instance }),
        "`instances[0].tree` is 4, but must be less than 1, the number of trees"
    );
    assert_eq!(
        refused(StandInstance { position: Vec3::new(0.0, f32::NAN, 0.0), ..instance }),
        "`instances[0].position` is [0, NaN, 0], but must be finite"
    );
    assert_eq!(
        refused(StandInstance { scale: 0.0, ..instance }),
        "`instances[0].scale` is 0, but must be 0.001 to 1000"
    );
}
