//! The structure of a GLB against the specification of glTF 2.0, and what is in it against the tree.

use super::{OAK, WIND, glb_reader::Reader};
use crate::export::{ExportLevels, ExportSettings, LeafSides, MotionSettings, tree_glb};
use bevy::math::Vec3;
use gltf::{
    Semantic,
    accessor::{DataType, Dimensions},
    json::Value,
    material::AlphaMode,
};
use std::sync::LazyLock;

static MOVING: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let motion = MotionSettings { joints: 24, loop_s: 4.0, fade_s: 1.0, ..MotionSettings::default() };
    let settings = ExportSettings { levels: ExportLevels::Lod, motion, ..ExportSettings::default() };
    tree_glb(&OAK.tree(), &settings, Some(&WIND)).unwrap()
});

fn floats(bytes: &[u8]) -> Vec<f32> {
    bytes.chunks_exact(4).map(|four| f32::from_le_bytes(four.try_into().unwrap())).collect()
}

#[test]
fn chunks_have_the_lengths_that_they_say() {
    let glb = &*MOVING;
    let word = |at: usize| u32::from_le_bytes(glb[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&glb[..4], word(4), word(8)), (&b"glTF"[..], 2, glb.len()));
    let json = word(12);
    assert_eq!((&glb[16..20], json % 4), (&b"JSON"[..], 0));
    let binary = 20 + json;
    assert_eq!((word(binary), &glb[binary + 4..binary + 8]), (glb.len() - binary - 8, &b"BIN\0"[..]));
}

#[test]
fn accessors_are_aligned_lie_in_the_buffer_and_hold_finite_numbers_within_their_bounds() {
    let reader = Reader::new(&MOVING);
    let mut bounded = 0;
    for accessor in reader.gltf.accessors() {
        let view = accessor.view().unwrap();
        assert_eq!((view.offset() + accessor.offset()) % accessor.data_type().size(), 0);
        assert!(view.offset() + view.length() <= reader.blob().len());
        assert!(accessor.offset() + accessor.count() * accessor.size() <= view.length());
        assert!(accessor.count() > 0);
        if accessor.data_type() != DataType::F32 {
            continue;
        }
        let values = floats(reader.bytes(&accessor));
        assert!(values.iter().all(|value| value.is_finite()), "accessor {}", accessor.index());
        let (Some(Value::Array(min)), Some(Value::Array(max))) = (accessor.min(), accessor.max()) else { continue };
        bounded += 1;
        let width = accessor.dimensions().multiplicity();
        for component in 0..width {
            let own = || values.iter().skip(component).step_by(width).copied();
            let [told_min, told_max] = [&min, &max].map(|told| told[component].as_f64().unwrap() as f32);
            assert_eq!(own().fold(f32::INFINITY, f32::min), told_min);
            assert_eq!(own().fold(f32::NEG_INFINITY, f32::max), told_max);
        }
    }
    // The positions of six primitives, and the times of the keys.
    assert_eq!(bounded, 7);
}

#[test]
fn attributes_of_vertices_are_as_the_specification_wants_them() {
    let reader = Reader::new(&MOVING);
    let joints = reader.joints().len();
    assert_eq!(joints, 24);
    for mesh in reader.gltf.meshes() {
        for primitive in mesh.primitives() {
            let count = primitive.get(&Semantic::Positions).unwrap().count();
            assert!(primitive.attributes().all(|(_, accessor)| accessor.count() == count));
            assert!(reader.indices(&primitive).iter().all(|index| (*index as usize) < count));
            assert_eq!(reader.indices(&primitive).len() % 3, 0);
            for (semantic, length) in [(Semantic::Normals, 3), (Semantic::Tangents, 4)] {
                let vectors = floats(reader.bytes(&primitive.get(&semantic).unwrap()));
                for vector in vectors.chunks_exact(length) {
                    assert!((Vec3::from_slice(vector).length() - 1.0).abs() < 1e-5, "{semantic:?} {vector:?}");
                    assert!(length == 3 || vector[3] == 1.0);
                }
            }
            let weights = primitive.get(&Semantic::Weights(0)).unwrap();
            assert_eq!(
                (weights.data_type(), weights.dimensions(), weights.normalized()),
                (DataType::U16, Dimensions::Vec4, true)
            );
            for eight in reader.bytes(&weights).chunks_exact(8) {
                let sum: u32 = eight.chunks_exact(2).map(|two| u32::from(u16::from_le_bytes([two[0], two[1]]))).sum();
                assert_eq!(sum, 65_535);
            }
            for influences in reader.influences(&primitive) {
                assert!(influences.iter().all(|(joint, weight)| *joint < joints && (*weight > 0.0 || *joint == 0)));
                let used: Vec<usize> = influences.iter().filter(|it| it.1 > 0.0).map(|it| it.0).collect();
                assert!(used.iter().enumerate().all(|(slot, joint)| !used[..slot].contains(joint)), "{used:?}");
            }
        }
    }
}

#[test]
fn keys_are_sorted_unit_and_closed() {
    let reader = Reader::new(&MOVING);
    for keys in &reader.keys()[1..] {
        assert_eq!((keys.times_s[0], *keys.times_s.last().unwrap()), (0.0, 4.0));
        assert!(keys.times_s.is_sorted_by(|a, b| a < b));
        assert_eq!([keys.rotations.len(), keys.translations.len()], [keys.times_s.len(); 2]);
        assert!(keys.rotations.iter().all(|turn| (turn.length() - 1.0).abs() < 1e-5));
        assert!(keys.rotations.windows(2).all(|pair| pair[0].dot(pair[1]) > 0.9), "no key turns the other way round");
        assert_eq!(
            (keys.rotations[0], keys.translations[0]),
            (*keys.rotations.last().unwrap(), *keys.translations.last().unwrap())
        );
    }
}

#[test]
fn joints_rest_where_their_beams_end() {
    let reader = Reader::new(&MOVING);
    let rest: Vec<_> = reader.joints().iter().map(|_| super::glb_reader::Keys::default()).collect();
    for (matrix, inverse) in reader.joint_matrices(&rest, 0.0).iter().zip(reader.inverse_binds()) {
        let both = *matrix * inverse;
        assert!(both.abs_diff_eq(bevy::math::Mat4::IDENTITY, 1e-5), "{both}");
    }
}

#[test]
fn the_full_tree_has_the_positions_and_triangles_of_its_model() {
    let glb = OAK.glb(&ExportSettings::default());
    let reader = Reader::new(&glb);
    let wood = reader.primitive("oak", "bark").unwrap();
    assert_eq!(reader.positions(&wood), OAK.model.wood.positions);
    assert_eq!(reader.indices(&wood), OAK.model.wood.indices);
    let leaves = reader.primitive("oak", "leaves").unwrap();
    let corners = |positions: &[[f32; 3]], indices: &[u32]| -> Vec<[f32; 3]> {
        indices.iter().map(|index| positions[*index as usize]).collect()
    };
    let own = corners(&OAK.model.leaves.positions, &OAK.model.leaves.indices);
    let indices = reader.indices(&leaves);
    let (upper, lower) = indices.split_at(indices.len() / 2);
    assert!(corners(&reader.positions(&leaves), upper) == own);
    let turned = upper.chunks_exact(3).flat_map(|corners| [corners[0], corners[2], corners[1]]);
    assert!(turned.eq(lower.iter().copied()), "the other side has the same corners the other way round");
    assert!(reader.gltf.skins().next().is_none(), "without a wind it has no skeleton");
}

#[test]
fn equal_trees_give_equal_bytes() {
    let motion = MotionSettings { joints: 24, loop_s: 4.0, fade_s: 1.0, ..MotionSettings::default() };
    let settings = ExportSettings { levels: ExportLevels::Lod, motion, ..ExportSettings::default() };
    assert!(tree_glb(&OAK.tree(), &settings, Some(&WIND)).unwrap() == *MOVING);
}

#[test]
fn lower_levels_are_behind_the_extension_and_smaller() {
    let reader = Reader::new(&MOVING);
    let lods = ["oak_LOD0", "oak_LOD1", "oak_LOD2"].map(|name| reader.node(name));
    let ids = lods[0].extension_value("MSFT_lod").unwrap()["ids"].clone();
    assert_eq!(ids, serde_json::json!([lods[1].index(), lods[2].index()]));
    let extras: Value = serde_json::from_str(lods[0].extras().as_ref().unwrap().get()).unwrap();
    let coverages: Vec<f64> =
        extras["MSFT_screencoverage"].as_array().unwrap().iter().map(|it| it.as_f64().unwrap()).collect();
    // 700 pixels of 1080, and the geometric mean of 700 and 128.
    let expected = [700.0 / 1080.0, (700.0_f64 * 128.0).sqrt() / 1080.0, 0.0];
    assert!(coverages.iter().zip(expected).all(|(told, expected)| (told - expected).abs() < 1e-4), "{coverages:?}");
    let in_scene: Vec<usize> = reader.gltf.default_scene().unwrap().nodes().map(|node| node.index()).collect();
    assert!(in_scene.contains(&lods[0].index()) && !in_scene.contains(&lods[1].index()));
    let triangles =
        lods.map(|lod| lod.mesh().unwrap().primitives().map(|part| reader.indices(&part).len()).sum::<usize>());
    assert!(triangles[0] > triangles[1] && triangles[1] > triangles[2], "{triangles:?}");
    let glb = OAK.glb(&ExportSettings { levels: ExportLevels::One(2), ..ExportSettings::default() });
    let alone = Reader::new(&glb);
    let of_one: usize = alone.node("oak").mesh().unwrap().primitives().map(|part| alone.indices(&part).len()).sum();
    assert_eq!(of_one, triangles[2]);
}

#[test]
fn materials_and_extras_say_what_the_tree_is() {
    let reader = Reader::new(&MOVING);
    let [bark, leaves] =
        ["oak bark", "oak leaves"].map(|name| reader.gltf.materials().find(|it| it.name() == Some(name)).unwrap());
    assert!(!bark.double_sided() && bark.alpha_mode() == AlphaMode::Opaque && bark.occlusion_texture().is_some());
    assert!(!leaves.double_sided() && leaves.alpha_mode() == AlphaMode::Mask && leaves.alpha_cutoff() == Some(0.5));
    assert!(bark.normal_texture().is_some() && leaves.normal_texture().is_some());
    let settings = ExportSettings { leaf_sides: LeafSides::DoubleSided, ..ExportSettings::default() };
    let double_sided = Reader::new(&OAK.glb(&settings));
    let leaves = double_sided.primitive("oak", "leaves").unwrap();
    assert!(leaves.material().double_sided());
    assert_eq!(double_sided.indices(&leaves).len(), OAK.model.leaves.indices.len());
    let extras: Value = serde_json::from_str(reader.node("oak_LOD0").extras().as_ref().unwrap().get()).unwrap();
    assert_eq!((&extras["species"], &extras["seed"]), (&"oak".into(), &u64::MAX.wrapping_sub(2).to_string().into()));
    assert_eq!(extras["height_m"].as_f64().unwrap() as f32, OAK.model.height_m());
    assert!(extras["generator"].as_str().unwrap().ends_with(env!("CARGO_PKG_VERSION")));
    for picture in reader.gltf.images() {
        let gltf::image::Source::View { view, mime_type } = picture.source() else { panic!("it is in the file") };
        let bytes = &reader.blob()[view.offset()..view.offset() + view.length()];
        let decoded = image::load_from_memory(bytes).unwrap();
        assert_eq!((mime_type, decoded.width()), ("image/png", 512));
    }
}
