//! The polygons of an impressionist crown, as Starling & Ashdown describe them.
//!
//! The paper keeps a "polygonal data-base": "the coordinates of the three vertices of every leaf, and the 3D texture value from which the
//! colour is computed", which "can be exported to other modelling systems". Its polygons are flat, without a picture, each of one colour
//! out of the crown's hue and saturation and a brightness by that value. So they are here, as OBJ: each polygon has vertices of its own,
//! one normal, and the texture's value, 0 outermost to 1, as the first of its texture coordinates. Materials are steps of brightness.

use super::{
    error::ExportError,
    obj::ObjText,
    surface::Surface,
    tree::{ExportedTree, GENERATOR},
    write::{ExportedFiles, require_file_name},
};
use crate::tree::{
    Growth,
    crown::impressionist::{ImpressionistCrown, leaves, polygon_colour},
};
use bevy::math::Vec3;
use std::fmt::Write;

/// Steps of brightness.
const STEPS: usize = 32;

/// The polygons of a crown as `NAME.obj` and `NAME.mtl`, m, y up. The wood is left out, as in the paper's data.
///
/// # Errors
/// [`ExportError::NoPolygons`] for a crown that is made of other things; [`ExportError::Setting`] for the name.
pub fn polygon_files(tree: &ExportedTree, name: &str) -> Result<ExportedFiles, ExportError> {
    require_file_name(name)?;
    let Growth::Impressionist(crown) = &tree.species.growth else {
        return Err(ExportError::NoPolygons { species: tree.species.name.clone() });
    };
    let mut text = ObjText::new(name);
    let mut material_text = format!("# {GENERATOR}\n");
    for (step, surface) in by_brightness(crown, tree).into_iter().enumerate() {
        if surface.indices.is_empty() {
            continue;
        }
        let material = format!("polygons_{step:02}");
        let [red, green, blue] = polygon_colour(crown, depth_of(step));
        writeln!(material_text, "\nnewmtl {material}\nillum 1\nKd {red} {green} {blue}\nKs 0 0 0")?;
        text.object(&material, &material, &surface)?;
    }
    Ok(ExportedFiles(vec![
        (format!("{name}.mtl"), material_text.into_bytes()),
        (format!("{name}.obj"), text.0.into_bytes()),
    ]))
}

/// The polygons of each step of brightness, the outermost first.
fn by_brightness(crown: &ImpressionistCrown, tree: &ExportedTree) -> Vec<Surface> {
    let mut surfaces = vec![Surface::default(); STEPS];
    let polygons = leaves(crown, &tree.model.skeleton);
    for (polygon, corners) in tree.model.skeleton.clusters.iter().zip(polygons.positions.chunks_exact(3)) {
        let surface = &mut surfaces[step_of(polygon.depth)];
        let first = surface.positions.len() as u32;
        let [a, b, c] = [corners[0], corners[1], corners[2]].map(Vec3::from_array);
        let normal = (b - a).cross(c - a).try_normalize().unwrap_or(polygon.normal);
        surface.positions.extend(corners);
        surface.normals.extend([normal.to_array(); 3]);
        surface.uvs.extend([[polygon.depth, 0.0]; 3]);
        surface.indices.extend([first, first + 1, first + 2]);
    }
    surfaces
}

fn step_of(depth: f32) -> usize {
    ((depth.clamp(0.0, 1.0) * STEPS as f32) as usize).min(STEPS - 1)
}

/// The depth in the middle of a step.
fn depth_of(step: usize) -> f32 {
    (step as f32 + 0.5) / STEPS as f32
}
