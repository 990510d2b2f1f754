//! A tree as a GLB.

use super::{builder::GlbBuilder, materials::SpeciesMaterials, meshes::push_level, skeleton::push_skin};
use crate::{
    export::{
        error::ExportError,
        level::{Level, levels, screen_coverages},
        look::SpeciesLook,
        motion::SwayLoop,
        settings::{ExportLevels, ExportSettings},
        tree::ExportedTree,
    },
    sway::WindResponse,
};
use gltf_json::{Index, Node, Scene, extensions::scene::Node as NodeExtensions};
use serde_json::{Map, Value, json, value::to_raw_value};

/// A tree as a GLB, y up, in metres, its foot at the origin. With a wind it has a skeleton and the animation `sway`, a loop; a mesh whose
/// program ignores both stands still.
///
/// Equal trees, settings and winds give equal bytes. See [`ExportSettings`] for what can be chosen.
///
/// # Errors
/// [`ExportError::Setting`] for the first setting outside its domain; [`ExportError::Picture`] and the like where a part cannot be encoded.
pub fn tree_glb(
    tree: &ExportedTree,
    settings: &ExportSettings,
    wind: Option<&WindResponse>,
) -> Result<Vec<u8>, ExportError> {
    settings.validate()?;
    let mut glb = GlbBuilder::new();
    let look = SpeciesLook::new(tree, std::slice::from_ref(tree), settings);
    let mut materials = SpeciesMaterials::new(&look);
    let sway = wind.map(|wind| SwayLoop::new(tree.model, wind, settings.year, &settings.motion));
    let skin = sway.as_ref().map(|sway| sway.skin(settings.motion.joints));
    let pushed =
        sway.as_ref().zip(skin.as_ref()).map(|(sway, skin)| push_skin(&mut glb, &tree.species.name, skin, sway));
    let mut nodes: Vec<Index<Node>> = Vec::new();
    for level in levels(tree, &look, settings) {
        let name = level_name(tree, &level, settings.levels);
        let mesh = push_level(&mut glb, name.clone(), &level, &mut materials, skin.as_ref())?;
        nodes.push(glb.root.push(Node {
            mesh: Some(mesh),
            skin: pushed.as_ref().map(|pushed| pushed.skin),
            name: Some(name),
            ..Node::default()
        }));
    }
    let mut extras = tree.extras(settings.year);
    let in_scene = if settings.levels == ExportLevels::Lod { 1 } else { nodes.len() };
    if settings.levels == ExportLevels::Lod && nodes.len() > 1 {
        extras["MSFT_screencoverage"] = json!(screen_coverages(nodes.len()));
        add_lower_levels(&mut glb, &nodes);
    }
    for node in &nodes[..in_scene.min(nodes.len())] {
        glb.root.nodes[node.value()].extras = Some(to_raw_value(&extras)?);
    }
    let ground = pushed.iter().map(|pushed| pushed.ground);
    let scene = Scene {
        extensions: None,
        extras: None,
        name: Some(tree.species.name.clone()),
        nodes: ground.chain(nodes.iter().take(in_scene).copied()).collect(),
    };
    let scene = glb.root.push(scene);
    glb.root.scene = Some(scene);
    glb.into_bytes()
}

fn level_name(tree: &ExportedTree, level: &Level, levels: ExportLevels) -> String {
    match levels {
        ExportLevels::One(_) => tree.species.name.clone(),
        ExportLevels::Lod | ExportLevels::Nodes => format!("{}_LOD{}", tree.species.name, level.number),
    }
}

/// Has the first node know the others as its lower levels.
fn add_lower_levels(glb: &mut GlbBuilder, nodes: &[Index<Node>]) {
    let ids: Vec<usize> = nodes[1..].iter().map(Index::value).collect();
    let others: Map<String, Value> = [("MSFT_lod".to_owned(), json!({ "ids": ids }))].into_iter().collect();
    glb.use_extension("MSFT_lod");
    glb.root.nodes[nodes[0].value()].extensions = Some(NodeExtensions { others, ..NodeExtensions::default() });
}
