//! The meshes of the LOD levels of a species, made in the background, and the kind of material of each.

use super::{
    images::{SpeciesImages, repeating_image},
    tree_material::{ATTRIBUTE_LEAF_ANCHOR, ATTRIBUTE_LEAF_AXIS, ATTRIBUTE_SWAY},
};
use crate::{
    lod::{
        CrossedPolygons, Decimation, EnvelopeLevel, EnvelopeVertices, Lens, LodBakeSettings, LodScreenSizes, Scene,
        crossed_polygons, decimate, prunable_radius_m, thick_wood,
    },
    render::settings::LevelStyle,
    tree::{
        Growth, Species, TreeModel,
        crown::impressionist::leaves_at,
        textures::{SpeciesTextures, species_textures},
        vertices::{LeafVertices, WoodVertices},
    },
};
use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};
use std::sync::Arc;

/// Share of the side of its wood that each level of a tree that sheds its leaves keeps at least: under leaves, and without them, where
/// twigs are all that is seen of a crown. Branches of birches are thin: with all that may be left out under the leaves of an oak, a birch
/// would be a pole in spring.
const LEAST_WOOD_SHARE: f32 = 0.45;
const LEAST_BARE_WOOD_SHARE: f32 = 0.9;

/// A plant with no more vertices of leaves than so many is never thinned: its few leaves, enlarged, would look like another plant.
const SMALL_VERTICES: usize = 2000;

/// The meshes of a species at one age.
pub(crate) struct SpeciesMeshes {
    /// Made once for all ages.
    pub images: Option<SpeciesImages>,
    pub variants: Vec<VariantMeshes>,
}

/// The meshes of one variant.
pub(crate) struct VariantMeshes {
    /// From the finest to the coarsest: at least one.
    pub lods: Vec<LodMeshes>,
    pub height_m: f32,
}

/// The meshes of one LOD level.
pub(crate) struct LodMeshes {
    pub wood: MeshPart,
    /// What is drawn in its place while the tree has no leaves: more of its twigs.
    pub bare_wood: Option<MeshPart>,
    pub leaves: Option<MeshPart>,
    /// Whether its wood is part of that of the level before. Then the latter alone is drawn while both levels are.
    pub is_wood_nested: bool,
}

/// A mesh and its kind of material.
pub(crate) struct MeshPart {
    pub mesh: Mesh,
    pub material: MaterialKind,
}

/// A kind of material.
pub(crate) enum MaterialKind {
    Bark,
    /// Bark that fades into another level; it needs a mask, which costs.
    FadingBark,
    Foliage,
    /// An envelope of leaves in this texture.
    Envelope(Box<Image>),
    /// Linear colours of trunk and crown.
    TwoColours([[f32; 3]; 2]),
}

impl MaterialKind {
    /// Whether its shader can draw it in part.
    pub fn can_fade(&self) -> bool {
        !matches!(self, Self::Bark)
    }
}

/// Makes the LOD levels of a style for each variant; with `has_images`, the textures of the species too.
pub(crate) fn species_meshes(
    species: &Species,
    has_images: bool,
    models: Vec<TreeModel>,
    style: LevelStyle,
    settings: &LodBakeSettings,
) -> SpeciesMeshes {
    let textures = (has_images || style == LevelStyle::Paper).then(|| species_textures(species));
    // Ellipsoids are few, and each is seen: none may be left out. Impressionist crowns know which of their polygons may.
    let is_indivisible = matches!(species.growth, Growth::Gardner(_) | Growth::Impressionist(_));
    let leaf_share = |share| if is_indivisible { 1.0 } else { share };
    let is_evergreen = species.phenology.evergreen;
    let decimations = |model: &TreeModel| -> Vec<SeasonalDecimation> {
        if !is_indivisible && model.leaves.positions.len() <= SMALL_VERTICES {
            return vec![SeasonalDecimation::default(); settings.decimations.len()];
        }
        let of_level = |part: &Decimation| {
            let radius_m = |share| prunable_radius_m(&model.skeleton, part.least_radius_m, share);
            let leafy_m = if is_evergreen { part.least_radius_m } else { radius_m(LEAST_WOOD_SHARE) };
            let bare_m = if is_evergreen { leafy_m } else { radius_m(LEAST_BARE_WOOD_SHARE) };
            let in_leaf = Decimation { least_radius_m: leafy_m, leaf_share: leaf_share(part.leaf_share) };
            SeasonalDecimation { in_leaf, bare_radius_m: (bare_m < leafy_m).then_some(bare_m) }
        };
        settings.decimations.iter().map(of_level).collect()
    };
    let levels = |model: TreeModel| match (style, &textures) {
        (LevelStyle::Paper, Some(textures)) => paper_levels(species, model, textures, settings),
        (LevelStyle::Thinned, _) => {
            let decimations = decimations(&model);
            thinned_levels(species, model, &decimations)
        }
        (LevelStyle::Full | LevelStyle::Paper, _) => vec![full_level(model, MaterialKind::Bark)],
    };
    let variant = |model: TreeModel| VariantMeshes { height_m: model.height_m(), lods: levels(model) };
    let variants = models.into_iter().map(variant).collect();
    SpeciesMeshes { images: textures.filter(|_| has_images).as_ref().map(SpeciesImages::from), variants }
}

/// What is left out at a level.
#[derive(Clone, Copy, Default)]
struct SeasonalDecimation {
    in_leaf: Decimation,
    /// Branches as thick as this stay while the tree is bare, m, where those are more.
    bare_radius_m: Option<f32>,
}

fn full_level(model: TreeModel, bark: MaterialKind) -> LodMeshes {
    LodMeshes {
        bare_wood: None,
        wood: MeshPart { mesh: wood_mesh(Arc::unwrap_or_clone(model.wood)), material: bark },
        leaves: foliage(Arc::unwrap_or_clone(model.leaves)),
        is_wood_nested: false,
    }
}

fn foliage(leaves: LeafVertices) -> Option<MeshPart> {
    (!leaves.indices.is_empty()).then(|| MeshPart { mesh: leaf_mesh(leaves), material: MaterialKind::Foliage })
}

/// The tree itself, and thinned ones. Only the last bark fades, into the impostor. Between the others no more than twigs thinner than a
/// pixel is left out. Impressionist crowns have the polygons of the distance at which the level begins, on a usual camera's picture.
fn thinned_levels(species: &Species, model: TreeModel, decimations: &[SeasonalDecimation]) -> Vec<LodMeshes> {
    let last = decimations.len();
    let thinned = decimations.iter().enumerate().map(|(number, decimation)| {
        let mut meshes = decimate(&model, &decimation.in_leaf);
        if let Growth::Impressionist(crown) = &species.growth {
            let begin_m = LodScreenSizes::default().distances_of_three_m(crown.height_m, Lens::default())[number];
            meshes.leaves = leaves_at(crown, &model.skeleton, begin_m);
        }
        let wood = |wood: WoodVertices| MeshPart {
            mesh: wood_mesh(wood),
            material: if number + 1 == last { MaterialKind::FadingBark } else { MaterialKind::Bark },
        };
        let bare_wood =
            decimation.bare_radius_m.map(|radius_m| wood(thick_wood(&model.wood, &model.skeleton, radius_m)));
        LodMeshes { wood: wood(meshes.wood), bare_wood, leaves: foliage(meshes.leaves), is_wood_nested: true }
    });
    let mut levels: Vec<LodMeshes> = thinned.collect();
    let first = if last == 0 { MaterialKind::FadingBark } else { MaterialKind::Bark };
    levels.insert(0, full_level(model, first));
    levels
}

/// The paper's: trunk and envelope, then four polygons.
fn paper_levels(
    species: &Species,
    model: TreeModel,
    textures: &SpeciesTextures,
    settings: &LodBakeSettings,
) -> Vec<LodMeshes> {
    let scene = Scene::new(species, &model, textures);
    let cylinder = EnvelopeLevel::bake(&scene, species, &model, &settings.envelope);
    let four = crossed_polygons(&scene, &model, cylinder.as_ref());
    drop(scene);
    let colours = [four.colours.first(), four.colours.last()].map(|colour| colour.copied().unwrap_or([0.1; 3]));
    let low = MeshPart { mesh: plain_mesh(four), material: MaterialKind::TwoColours(colours) };
    let medium = cylinder.map(|EnvelopeLevel { envelope, trunk, colour, frames: images, .. }| {
        let material = MaterialKind::Envelope(Box::new(repeating_image(&colour)));
        LodMeshes {
            wood: MeshPart { mesh: wood_mesh(trunk), material: MaterialKind::FadingBark },
            bare_wood: None,
            leaves: Some(MeshPart { mesh: envelope_mesh(envelope, images), material }),
            is_wood_nested: false,
        }
    });
    let low = LodMeshes { wood: low, bare_wood: None, leaves: None, is_wood_nested: false };
    std::iter::once(full_level(model, MaterialKind::FadingBark)).chain(medium).chain([low]).collect()
}

fn wood_mesh(wood: WoodVertices) -> Mesh {
    mesh(wood.positions, wood.normals, wood.uvs, wood.sway, wood.indices)
}

/// Its second texture coordinates hold the number of images of its sequence, and mark it as an envelope.
fn envelope_mesh(envelope: EnvelopeVertices, images: u32) -> Mesh {
    let sequence = vec![[images as f32, 0.0]; envelope.positions.len()];
    mesh(envelope.positions, envelope.normals, envelope.uvs, envelope.sway, envelope.indices)
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_1, sequence)
}

/// Its colours are two texels, of which each vertex has one; it stands as the root of the trunk does: still.
fn plain_mesh(four: CrossedPolygons) -> Mesh {
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
    use crate::{
        lod::LEAST_LEAF_SHARE,
        tree::{MOST_ENLARGED, crown::impressionist::ImpressionistCrown},
    };

    #[test]
    fn bounds_have_room_for_the_leaves_of_thinned_trees() {
        assert!(LEAST_LEAF_SHARE.sqrt().recip() < MOST_ENLARGED);
    }

    #[test]
    fn impressionist_crowns_have_fewer_polygons_at_lower_levels() {
        let crown = ImpressionistCrown { full_detail_m: 30.0, ..ImpressionistCrown::default() };
        let species = Species { growth: Growth::Impressionist(crown), variants: 1, ..Species::default() };
        let model = TreeModel::bake(&species, species.age.mature_years, 1);
        let polygons = model.skeleton.clusters.len() as f32;
        let meshes = species_meshes(&species, false, vec![model], LevelStyle::Thinned, &LodBakeSettings::default());
        let vertices = |lod: &LodMeshes| lod.leaves.as_ref().map_or(0, |part| part.mesh.count_vertices());
        let shares: Vec<f32> =
            meshes.variants[0].lods.iter().map(|lod| vertices(lod) as f32 / 3.0 / polygons).collect();
        // A tree of 14 m has 700 pixels of a picture of 1080 at 26.1 m, and the geometric mean of 700 and 100 at 69.0 m.
        let expected = [1.0, 1.0, 30.0 / 69.0];
        assert!(shares.iter().zip(expected).all(|(share, expected)| (share - expected).abs() < 0.005), "{shares:?}");
    }
}
