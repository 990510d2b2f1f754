//! What is cut for a species in the background: the meshes of its levels, and what each piece is made of.

use super::{
    detail::LevelStyle,
    material::{ATTRIBUTE_LEAF_ANCHOR, ATTRIBUTE_LEAF_AXIS, ATTRIBUTE_SWAY},
    painted::{Painted, wrapped},
};
use crate::{
    lod::{
        CylinderLevel, EnvelopeVertices, LevelSettings, PlainVertices, Reduction, Scene,
        plain::plain,
        simplify::{bearable_radius_m, reduce},
    },
    tree::{
        Species, TreeModel,
        growth::Growth,
        leaf_mesh::LeafVertices,
        mesh::WoodVertices,
        painting::{SpeciesTextures, paint},
    },
};
use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};
use std::sync::Arc;

/// Of a tree that sheds its leaves, each level has at least that share of the wood: branches of birches are thin, and with
/// all that may go from under the leaves of an oak, one would be a bare pole in winter.
const LEAST_BARE: f32 = 0.45;

/// All that is prepared of a species at one age.
pub(super) struct Cut {
    /// Painted once for all ages.
    pub painted: Option<Painted>,
    pub variants: Vec<VariantCut>,
}

pub(super) struct VariantCut {
    /// From the finest to the coarsest: at least one.
    pub levels: Vec<LevelCut>,
    pub height_m: f32,
}

/// One level of a variant.
pub(super) struct LevelCut {
    pub wood: Piece,
    pub leaves: Option<Piece>,
    /// Whether its wood is part of that of the level before: then that is enough where both are worn.
    pub nested: bool,
}

/// A mesh and what it is made of.
pub(super) struct Piece {
    pub mesh: Mesh,
    pub cloth: Cloth,
}

pub(super) enum Cloth {
    Bark,
    /// Bark that fades into another level; it needs a mask, which costs.
    FadingBark,
    Foliage,
    /// An envelope of leaves in this texture.
    Envelope(Box<Image>),
    /// Linear colours of trunk and crown.
    Plain([[f32; 3]; 2]),
}

impl Cloth {
    /// Whether its shader can show it in part.
    pub fn fades(&self) -> bool {
        !matches!(self, Self::Bark)
    }
}

/// Cuts the levels of a style for each variant; with `painting`, paints the species, too.
pub(super) fn cut(species: &Species, painting: bool, models: Vec<TreeModel>, style: LevelStyle) -> Cut {
    let textures = (painting || style == LevelStyle::Paper).then(|| paint(species));
    let settings = LevelSettings::default();
    // A painter's crown has few parts, each of which is seen: none of them may go.
    let painted = matches!(species.growth, Growth::Gardner(_) | Growth::Impressionist(_));
    let leaf_share = |share| if painted { 1.0 } else { share };
    let least_radius_m = |model: &TreeModel, most_m| match species.phenology.evergreen {
        true => most_m,
        false => bearable_radius_m(&model.skeleton, most_m, LEAST_BARE),
    };
    let reductions = |model: &TreeModel| -> Vec<Reduction> {
        let bearable = |part: &Reduction| Reduction {
            least_radius_m: least_radius_m(model, part.least_radius_m),
            leaf_share: leaf_share(part.leaf_share),
        };
        settings.reductions.iter().map(bearable).collect()
    };
    let levels = |model: TreeModel| match (style, &textures) {
        (LevelStyle::Paper, Some(textures)) => paper_levels(species, model, textures, &settings),
        (LevelStyle::Thinned, _) => {
            let reductions = reductions(&model);
            thinned_levels(model, &reductions)
        }
        (LevelStyle::Full | LevelStyle::Paper, _) => vec![full_level(model, Cloth::Bark)],
    };
    let variant = |model: TreeModel| VariantCut { height_m: model.height_m(), levels: levels(model) };
    let variants = models.into_iter().map(variant).collect();
    Cut { painted: textures.filter(|_| painting).as_ref().map(Painted::from), variants }
}

fn full_level(model: TreeModel, bark: Cloth) -> LevelCut {
    LevelCut {
        wood: Piece { mesh: wood_mesh(Arc::unwrap_or_clone(model.wood)), cloth: bark },
        leaves: foliage(Arc::unwrap_or_clone(model.leaves)),
        nested: false,
    }
}

fn foliage(leaves: LeafVertices) -> Option<Piece> {
    (!leaves.indices.is_empty()).then(|| Piece { mesh: leaf_mesh(leaves), cloth: Cloth::Foliage })
}

/// The tree itself, and it thinned: only the last of its barks fades, into the cards behind it. Between the others no more
/// goes than twigs thinner than a pixel.
fn thinned_levels(model: TreeModel, reductions: &[Reduction]) -> Vec<LevelCut> {
    let last = reductions.len();
    let thinned = reductions.iter().enumerate().map(|(number, reduction)| {
        let meshes = reduce(&model, reduction);
        let cloth = if number + 1 == last { Cloth::FadingBark } else { Cloth::Bark };
        let wood = Piece { mesh: wood_mesh(meshes.wood), cloth };
        LevelCut { wood, leaves: foliage(meshes.leaves), nested: true }
    });
    let mut levels: Vec<LevelCut> = thinned.collect();
    let first = if last == 0 { Cloth::FadingBark } else { Cloth::Bark };
    levels.insert(0, full_level(model, first));
    levels
}

/// The paper's: trunk and envelope, then four polygons.
fn paper_levels(
    species: &Species,
    model: TreeModel,
    textures: &SpeciesTextures,
    settings: &LevelSettings,
) -> Vec<LevelCut> {
    let scene = Scene::new(species, &model, textures);
    let cylinder = CylinderLevel::bake(&scene, species, &model, &settings.cylinder);
    let four = plain(&scene, &model, cylinder.as_ref());
    drop(scene);
    let colours = [four.colours.first(), four.colours.last()].map(|colour| colour.copied().unwrap_or([0.1; 3]));
    let low = Piece { mesh: plain_mesh(four), cloth: Cloth::Plain(colours) };
    let medium = cylinder.map(|CylinderLevel { envelope, trunk, colour, images, .. }| {
        let cloth = Cloth::Envelope(Box::new(wrapped(&colour)));
        LevelCut {
            wood: Piece { mesh: wood_mesh(trunk), cloth: Cloth::FadingBark },
            leaves: Some(Piece { mesh: envelope_mesh(envelope, images), cloth }),
            nested: false,
        }
    });
    let low = LevelCut { wood: low, leaves: None, nested: false };
    std::iter::once(full_level(model, Cloth::FadingBark)).chain(medium).chain([low]).collect()
}

fn wood_mesh(wood: WoodVertices) -> Mesh {
    mesh(wood.positions, wood.normals, wood.uvs, wood.sway, wood.indices)
}

/// Its second coordinates hold the number of images of its sequence, and mark it as an envelope.
fn envelope_mesh(envelope: EnvelopeVertices, images: u32) -> Mesh {
    let sequence = vec![[images as f32, 0.0]; envelope.positions.len()];
    mesh(envelope.positions, envelope.normals, envelope.uvs, envelope.sway, envelope.indices)
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_1, sequence)
}

/// Its colours are two texels, of which each vertex has one; it stands as the root of the trunk does: still.
fn plain_mesh(four: PlainVertices) -> Mesh {
    let trunk = four.colours.first().copied();
    let uv = |colour: &[f32; 3]| [if Some(*colour) == trunk { 0.25 } else { 0.75 }, 0.5];
    let uvs = four.colours.iter().map(uv).collect();
    let sway = vec![[0.0, 0.0, 0.0, 1.0]; four.positions.len()];
    mesh(four.positions, four.normals, uvs, sway, four.indices)
}

fn leaf_mesh(leaves: LeafVertices) -> Mesh {
    mesh(leaves.positions, leaves.normals, leaves.uvs, leaves.sway, leaves.indices)
        .with_inserted_attribute(ATTRIBUTE_LEAF_AXIS, leaves.axis)
        .with_inserted_attribute(ATTRIBUTE_LEAF_ANCHOR, leaves.anchor)
}

fn mesh(
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    sway: Vec<[f32; 4]>,
    indices: Vec<u32>,
) -> Mesh {
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
        .with_inserted_attribute(ATTRIBUTE_SWAY, sway)
        .with_inserted_indices(Indices::U32(indices))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::MOST_ENLARGED;

    #[test]
    fn boxes_have_room_for_the_leaves_of_thinned_trees() {
        for Reduction { leaf_share, .. } in LevelSettings::default().reductions {
            assert!(leaf_share.sqrt().recip() < MOST_ENLARGED, "{leaf_share}");
        }
    }
}
