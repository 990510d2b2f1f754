//! A stand as a GLB: each tree once, and where it stands.
//!
//! The stand does not sway: a skinned mesh cannot be instanced.

use super::{
    builder::{Elements, GlbBuilder},
    materials::SpeciesMaterials,
    meshes::push_level,
};
use crate::{
    export::{
        error::ExportError,
        level::levels,
        look::SpeciesLook,
        settings::{ExportLevels, ExportSettings},
        tree::ExportedTree,
    },
    setting::{SettingError, require},
};
use bevy::math::{Quat, Vec3};
use gltf_json::{Index, Node, Scene, accessor::Type, extensions::scene::Node as NodeExtensions, scene::UnitQuaternion};
use serde_json::{Map, Value, json, value::to_raw_value};

/// The extension that draws a mesh at many places.
const EXTENSION: &str = "EXT_mesh_gpu_instancing";

/// A tree of a stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandInstance {
    /// Which of the trees stands there.
    pub tree: usize,
    /// Where its foot is, m, y up.
    pub position: Vec3,
    /// Turn about the vertical, rad.
    pub turn_rad: f32,
    /// Uniform scale. domain: 0.001 to 1000.
    pub scale: f32,
}

/// How the places of a stand are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Instancing {
    /// With `EXT_mesh_gpu_instancing`, one node for each tree. The file asks for it: without it, the places are not known.
    #[default]
    Gpu,
    /// A node for each instance: larger, and for programs without the extension, Bevy among them.
    Nodes,
}

/// A stand as a GLB: trees, one mesh each, and the places at which they stand. Trees that refer to one
/// [`Species`](crate::tree::Species) share their pictures.
///
/// # Errors
/// [`ExportError::Setting`] for the first setting or instance outside its domain; levels must be [`ExportLevels::One`].
pub fn stand_glb(
    trees: &[ExportedTree],
    instances: &[StandInstance],
    instancing: Instancing,
    settings: &ExportSettings,
) -> Result<Vec<u8>, ExportError> {
    settings.validate()?;
    if !matches!(settings.levels, ExportLevels::One(_)) {
        return Err(SettingError::new("levels", format!("{:?}", settings.levels), "One(..) for a stand").into());
    }
    if instances.is_empty() {
        return Err(SettingError::new("instances", "0 long", "at least 1 long").into());
    }
    instances.iter().enumerate().try_for_each(|(number, instance)| {
        instance.validate(trees.len()).map_err(|error| error.inside(&format!("instances[{number}]")))
    })?;
    let mut glb = GlbBuilder::new();
    let mut nodes = Vec::new();
    for (first, members) in by_species(trees) {
        let look = SpeciesLook::new(&first, &members.iter().map(|&tree| trees[tree]).collect::<Vec<_>>(), settings);
        let mut materials = SpeciesMaterials::new(&look);
        for tree in members {
            let of_tree: Vec<&StandInstance> = instances.iter().filter(|instance| instance.tree == tree).collect();
            if of_tree.is_empty() {
                continue;
            }
            let name = format!("{} {tree}", first.species.name);
            for level in levels(&trees[tree], &look, settings) {
                let mesh = push_level(&mut glb, name.clone(), &level, &mut materials, None)?;
                let extras = Some(to_raw_value(&trees[tree].extras(settings.year))?);
                let node = Node { mesh: Some(mesh), name: Some(name.clone()), extras, ..Node::default() };
                match instancing {
                    Instancing::Gpu => nodes.push(push_instanced(&mut glb, node, &of_tree)),
                    Instancing::Nodes => {
                        nodes.extend(of_tree.iter().map(|instance| glb.root.push(instance.place(node.clone()))));
                    }
                }
            }
        }
    }
    let scene = glb.root.push(Scene { extensions: None, extras: None, name: Some("stand".to_owned()), nodes });
    glb.root.scene = Some(scene);
    glb.into_bytes()
}

/// The trees of each species, by their numbers, with the first of each.
fn by_species<'a>(trees: &[ExportedTree<'a>]) -> Vec<(ExportedTree<'a>, Vec<usize>)> {
    let mut groups: Vec<(ExportedTree, Vec<usize>)> = Vec::new();
    for (number, tree) in trees.iter().enumerate() {
        match groups.iter_mut().find(|(first, _)| std::ptr::eq(first.species, tree.species)) {
            Some((_, members)) => members.push(number),
            None => groups.push((*tree, vec![number])),
        }
    }
    groups
}

/// A node whose mesh is drawn at all these places.
fn push_instanced(glb: &mut GlbBuilder, node: Node, instances: &[&StandInstance]) -> Index<Node> {
    let positions: Vec<[f32; 3]> = instances.iter().map(|instance| instance.position.to_array()).collect();
    let rotations: Vec<[f32; 4]> = instances.iter().map(|instance| instance.rotation().to_array()).collect();
    let scales: Vec<[f32; 3]> = instances.iter().map(|instance| [instance.scale; 3]).collect();
    let attributes = json!({
        "TRANSLATION": glb.accessor(&positions, Elements::floats(Type::Vec3, None)).value(),
        "ROTATION": glb.accessor(&rotations, Elements::floats(Type::Vec4, None)).value(),
        "SCALE": glb.accessor(&scales, Elements::floats(Type::Vec3, None)).value(),
    });
    let others: Map<String, Value> =
        [(EXTENSION.to_owned(), json!({ "attributes": attributes }))].into_iter().collect();
    glb.use_extension(EXTENSION);
    glb.root.extensions_required = vec![EXTENSION.to_owned()];
    glb.root.push(Node { extensions: Some(NodeExtensions { others, ..NodeExtensions::default() }), ..node })
}

impl StandInstance {
    fn validate(&self, trees: usize) -> Result<(), SettingError> {
        if self.tree >= trees {
            return Err(SettingError::new("tree", self.tree, format!("less than {trees}, the number of trees")));
        }
        if !self.position.is_finite() {
            return Err(SettingError::new("position", self.position, "finite"));
        }
        require("turn_rad", self.turn_rad, f32::MIN..=f32::MAX)?;
        require("scale", self.scale, 0.001..=1000.0)
    }

    fn rotation(&self) -> Quat {
        Quat::from_rotation_y(self.turn_rad).normalize()
    }

    fn place(&self, node: Node) -> Node {
        Node {
            translation: Some(self.position.to_array()),
            rotation: Some(UnitQuaternion(self.rotation().to_array())),
            scale: Some([self.scale; 3]),
            ..node
        }
    }
}
