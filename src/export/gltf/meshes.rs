//! Surfaces as meshes.

use super::{
    builder::{Elements, GlbBuilder},
    materials::SpeciesMaterials,
};
use crate::export::{error::ExportError, level::Level, skin::Skin, surface::Surface};
use bevy::math::Vec3;
use gltf_json::{
    Accessor, Index, Mesh,
    accessor::{ComponentType, Type},
    buffer::Target,
    mesh::{Mode, Primitive, Semantic},
    validation::Checked::Valid,
};
use serde_json::json;
use std::collections::BTreeMap;

/// Meshes of fewer vertices have indices of two bytes; the greatest such number is reserved.
const SHORT_INDICES: usize = 65_535;

const VERTICES: Option<Target> = Some(Target::ArrayBuffer);

/// The mesh of a level, one primitive for each part of it; with a skin, it has joints and weights.
pub(super) fn push_level(
    glb: &mut GlbBuilder,
    name: String,
    level: &Level,
    materials: &mut SpeciesMaterials,
    skin: Option<&Skin>,
) -> Result<Index<Mesh>, ExportError> {
    let mut primitives = Vec::with_capacity(level.parts.len());
    for (part, surface) in &level.parts {
        let mut primitive = primitive(glb, surface, materials.needs_tangents(*part), skin);
        primitive.indices = Some(indices(glb, surface, materials.has_both_sides(*part)));
        primitive.material = Some(materials.of(*part, glb)?);
        primitives.push(primitive);
    }
    Ok(glb.root.push(Mesh { extensions: None, extras: None, name: Some(name), primitives, weights: None }))
}

/// The vertices of a surface, without triangles and material.
fn primitive(glb: &mut GlbBuilder, surface: &Surface, has_tangents: bool, skin: Option<&Skin>) -> Primitive {
    let positions = Elements { bounds: Some(bounds(&surface.positions)), ..Elements::floats(Type::Vec3, VERTICES) };
    let bytes = |component, normalized| Elements { component, normalized, ..Elements::floats(Type::Vec4, VERTICES) };
    let mut attributes = BTreeMap::new();
    let mut add = |semantic, accessor: Index<Accessor>| {
        attributes.insert(Valid(semantic), accessor);
    };
    add(Semantic::Positions, glb.accessor(&surface.positions, positions));
    add(Semantic::Normals, glb.accessor(&surface.normals, Elements::floats(Type::Vec3, VERTICES)));
    if has_tangents {
        add(Semantic::Tangents, glb.accessor(&surface.tangents, Elements::floats(Type::Vec4, VERTICES)));
    }
    add(Semantic::TexCoords(0), glb.accessor(&surface.uvs, Elements::floats(Type::Vec2, VERTICES)));
    add(Semantic::Colors(0), glb.accessor(&surface.colours, bytes(ComponentType::U8, true)));
    if let Some(skin) = skin {
        let (joints, weights): (Vec<_>, Vec<_>) =
            surface.places.iter().map(|place| skin.influences(*place).packed()).unzip();
        add(Semantic::Joints(0), glb.accessor(&joints, bytes(ComponentType::U8, false)));
        add(Semantic::Weights(0), glb.accessor(&weights, bytes(ComponentType::U16, true)));
    }
    Primitive {
        attributes,
        extensions: None,
        extras: None,
        indices: None,
        material: None,
        mode: Valid(Mode::Triangles),
        targets: None,
    }
}

fn indices(glb: &mut GlbBuilder, surface: &Surface, has_both_sides: bool) -> Index<Accessor> {
    let elements =
        |component| Elements { component, ..Elements::floats(Type::Scalar, Some(Target::ElementArrayBuffer)) };
    let mut indices = surface.indices.clone();
    if has_both_sides {
        indices.extend(surface.indices.chunks_exact(3).flat_map(|corners| [corners[0], corners[2], corners[1]]));
    }
    if surface.positions.len() > SHORT_INDICES {
        return glb.accessor(&indices, elements(ComponentType::U32));
    }
    let short: Vec<u16> = indices.iter().map(|index| *index as u16).collect();
    glb.accessor(&short, elements(ComponentType::U16))
}

fn bounds(positions: &[[f32; 3]]) -> [serde_json::Value; 2] {
    let first = positions.first().copied().map_or(Vec3::ZERO, Vec3::from_array);
    let (min, max) = positions.iter().fold((first, first), |(min, max), position| {
        let position = Vec3::from_array(*position);
        (min.min(position), max.max(position))
    });
    [json!(min.to_array()), json!(max.to_array())]
}
