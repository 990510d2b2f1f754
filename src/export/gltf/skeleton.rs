//! Joints as nodes with a skin, and their motion as an animation.

use super::builder::{Elements, GlbBuilder};
use crate::export::{
    motion::SwayLoop,
    skin::{Joint, Skin},
};
use bevy::math::{Mat4, Vec3};
use gltf_json::{
    Accessor, Animation, Index, Node, Skin as GltfSkin,
    accessor::Type,
    animation::{Channel, Interpolation, Property, Sampler, Target},
    validation::Checked::Valid,
};
use serde_json::json;

/// A skin in the document.
pub(super) struct PushedSkin {
    pub skin: Index<GltfSkin>,
    /// The joint in the ground, above all others.
    pub ground: Index<Node>,
}

/// Adds the joints, the skin and the animation of a tree.
pub(super) fn push_skin(glb: &mut GlbBuilder, name: &str, skin: &Skin, sway: &SwayLoop) -> PushedSkin {
    let nodes: Vec<Index<Node>> = skin.joints.iter().map(|joint| glb.root.push(node(joint, skin))).collect();
    let mut children: Vec<Vec<Index<Node>>> = vec![Vec::new(); nodes.len()];
    for (joint, node) in skin.joints.iter().zip(&nodes) {
        if let Some(parent) = joint.parent {
            children[parent].push(*node);
        }
    }
    for (node, children) in nodes.iter().zip(children).filter(|(_, children)| !children.is_empty()) {
        glb.root.nodes[node.value()].children = Some(children);
    }
    // Joints have the axes of the tree at rest.
    let inverse_binds: Vec<[f32; 16]> =
        skin.joints.iter().map(|joint| Mat4::from_translation(-joint.rest).to_cols_array()).collect();
    let inverse_binds = glb.accessor(&inverse_binds, Elements::floats(Type::Mat4, None));
    let ground = nodes[0];
    let pushed = glb.root.push(GltfSkin {
        extensions: None,
        extras: None,
        inverse_bind_matrices: Some(inverse_binds),
        joints: nodes.clone(),
        name: Some(format!("{name} skin")),
        skeleton: Some(ground),
    });
    push_animation(glb, skin, sway, &nodes);
    PushedSkin { skin: pushed, ground }
}

fn node(joint: &Joint, skin: &Skin) -> Node {
    let below = joint.parent.map_or(Vec3::ZERO, |parent| skin.joints[parent].rest);
    Node {
        name: Some(joint.beam.map_or_else(|| "ground".to_owned(), |beam| format!("beam {beam}"))),
        translation: Some((joint.rest - below).to_array()),
        ..Node::default()
    }
}

fn push_animation(glb: &mut GlbBuilder, skin: &Skin, sway: &SwayLoop, nodes: &[Index<Node>]) {
    let last_s = sway.times_s.last().copied().unwrap_or(0.0);
    let bounds = Some([json!([0.0]), json!([last_s])]);
    let times = glb.accessor(&sway.times_s, Elements { bounds, ..Elements::floats(Type::Scalar, None) });
    let (mut channels, mut samplers) = (Vec::new(), Vec::new());
    let mut add = |node: Index<Node>, path: Property, output: Index<Accessor>| {
        let sampler = Index::push(
            &mut samplers,
            Sampler {
                extensions: None,
                extras: None,
                input: times,
                interpolation: Valid(Interpolation::Linear),
                output,
            },
        );
        let target = Target { extensions: None, extras: None, node, path: Valid(path) };
        channels.push(Channel { sampler, target, extensions: None, extras: None });
    };
    for (node, motion) in nodes[1..].iter().zip(sway.joint_motions(skin)) {
        add(*node, Property::Rotation, glb.accessor(&motion.rotations, Elements::floats(Type::Vec4, None)));
        add(*node, Property::Translation, glb.accessor(&motion.translations, Elements::floats(Type::Vec3, None)));
    }
    if !channels.is_empty() {
        glb.root.push(Animation { extensions: None, extras: None, channels, name: Some("sway".to_owned()), samplers });
    }
}
