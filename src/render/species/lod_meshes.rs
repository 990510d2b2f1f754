//! The meshes of the LOD levels of a species, made in the background, and the kind of material of each.

use super::{
    images::SpeciesImages,
    packed_vertices::{pack_leaves, pack_wood},
    part_set::{LevelPart, PartSet},
};
use crate::{
    lod::{
        CrossedPolygons, EnvelopeLevel, EnvelopeVertices, LodBakeSettings, Scene, ThinnedMeshes, bind_to_swaying,
        crossed_polygons, swaying_beams, thinned,
    },
    render::{settings::LevelStyle, texture_image::repeating_image},
    tree::{
        Species, TreeModel,
        textures::{SpeciesTextures, species_textures},
        vertices::{LeafVertices, WoodVertices},
    },
};
use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};

/// What the levels of a species are made of, and how.
#[derive(Default)]
pub(crate) struct LevelRecipe {
    pub species: Species,
    pub style: LevelStyle,
    pub bake: LodBakeSettings,
    /// Whether the device reads textures in blocks.
    pub compresses_textures: bool,
}

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
    /// Beams that move the coarsest level: the first ones.
    pub coarse_beams: u32,
}

/// The meshes of one LOD level.
pub(crate) struct LodMeshes {
    pub wood: MeshPart,
    /// What is drawn in its place while the tree has no leaves: more of its twigs.
    pub bare_wood: Option<MeshPart>,
    pub leaves: Option<MeshPart>,
    /// Whether its wood is of branches that the level before has, too. Then the latter alone is drawn while both levels are.
    pub is_wood_nested: bool,
}

/// A mesh and its kind of material.
pub(crate) struct MeshPart {
    /// None where it was not asked for.
    pub mesh: Option<Mesh>,
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

/// Makes the LOD levels of a recipe for each variant; with `has_images`, the textures of the species too. Of the parts that can be made
/// again ([`remade_level`]) only those are made that are `wanted`, and the coarsest level.
pub(crate) fn species_meshes(
    recipe: &LevelRecipe,
    has_images: bool,
    models: &[TreeModel],
    wanted: PartSet,
) -> SpeciesMeshes {
    let LevelRecipe { species, style, .. } = recipe;
    let textures = (has_images || *style == LevelStyle::Paper).then(|| species_textures(species));
    let levels = |model: &TreeModel| match (style, &textures) {
        (LevelStyle::Paper, Some(textures)) => paper_levels(recipe, model, textures),
        (LevelStyle::Thinned, _) => {
            let last = recipe.bake.decimations.len();
            let wanted = wanted.and(PartSet::in_leaf(last));
            (0..=last).map(|level| remade_level(recipe, model, level, wanted)).collect()
        }
        (LevelStyle::Full | LevelStyle::Paper, _) => {
            vec![full_level(model, MaterialKind::Bark, PartSet::in_leaf(0))]
        }
    };
    let is_thinned = *style == LevelStyle::Thinned && !recipe.bake.decimations.is_empty();
    let coarse_beams = |model: &TreeModel| if is_thinned { swaying_beams(&model.skeleton) } else { u32::MAX };
    let variant = |model: &TreeModel| VariantMeshes {
        lods: levels(model),
        height_m: model.height_m(),
        coarse_beams: coarse_beams(model),
    };
    let variants = models.iter().map(variant).collect();
    let images = textures.filter(|_| has_images);
    SpeciesMeshes { images: images.map(|it| SpeciesImages::new(species, &it, recipe.compresses_textures)), variants }
}

/// A level of [`LevelStyle::Thinned`] with the meshes of those of its parts that are wanted: the tree itself, or a thinned one. Only the last
/// bark fades, into the impostor. Between the others no more than twigs thinner than a pixel is left out.
pub(crate) fn remade_level(recipe: &LevelRecipe, model: &TreeModel, level: usize, wanted: PartSet) -> LodMeshes {
    let LevelRecipe { species, bake, .. } = recipe;
    let bark = || if level == bake.decimations.len() { MaterialKind::FadingBark } else { MaterialKind::Bark };
    let decimation = level.checked_sub(1).and_then(|number| Some((number, bake.decimations.get(number)?)));
    let Some((number, decimation)) = decimation else { return full_level(model, bark(), wanted) };
    let wants = |part| wanted.contains(PartSet::one(level, part));
    let ThinnedMeshes { mut meshes, mut bare_wood } = thinned(species, model, number, decimation);
    if level == bake.decimations.len() {
        let woods = [Some(&mut meshes.wood), bare_wood.as_mut()].into_iter().flatten().map(|wood| &mut wood.sway);
        woods.chain([&mut meshes.leaves.sway]).for_each(|sway| bind_to_swaying(&model.skeleton, sway));
    }
    let wood = |wood: WoodVertices, part| MeshPart { mesh: wants(part).then(|| wood_mesh(&wood)), material: bark() };
    LodMeshes {
        wood: wood(meshes.wood, LevelPart::Wood),
        bare_wood: bare_wood.map(|it| wood(it, LevelPart::BareWood)),
        leaves: foliage(&meshes.leaves, wants(LevelPart::Leaves)),
        is_wood_nested: true,
    }
}

fn full_level(model: &TreeModel, bark: MaterialKind, wanted: PartSet) -> LodMeshes {
    let wants = |part| wanted.contains(PartSet::one(0, part));
    LodMeshes {
        bare_wood: None,
        wood: MeshPart { mesh: wants(LevelPart::Wood).then(|| wood_mesh(&model.wood)), material: bark },
        leaves: foliage(&model.leaves, wants(LevelPart::Leaves)),
        is_wood_nested: false,
    }
}

fn foliage(leaves: &LeafVertices, is_wanted: bool) -> Option<MeshPart> {
    let part = || MeshPart { mesh: is_wanted.then(|| leaf_mesh(leaves)), material: MaterialKind::Foliage };
    (!leaves.indices.is_empty()).then(part)
}

/// The paper's: trunk and envelope, then four polygons.
fn paper_levels(recipe: &LevelRecipe, model: &TreeModel, textures: &SpeciesTextures) -> Vec<LodMeshes> {
    let scene = Scene::new(&recipe.species, model, textures);
    let cylinder = EnvelopeLevel::bake(&scene, &recipe.species, model, &recipe.bake.envelope);
    let four = crossed_polygons(&scene, model, cylinder.as_ref());
    drop(scene);
    let colours = [four.colours.first(), four.colours.last()].map(|colour| colour.copied().unwrap_or([0.1; 3]));
    let low = MeshPart { mesh: Some(plain_mesh(&four)), material: MaterialKind::TwoColours(colours) };
    let medium = cylinder.map(|EnvelopeLevel { envelope, trunk, colour, frames: images, .. }| {
        let material = MaterialKind::Envelope(Box::new(repeating_image(&colour)));
        LodMeshes {
            wood: MeshPart { mesh: Some(wood_mesh(&trunk)), material: MaterialKind::FadingBark },
            bare_wood: None,
            leaves: Some(MeshPart { mesh: Some(envelope_mesh(&envelope, images)), material }),
            is_wood_nested: false,
        }
    });
    let low = LodMeshes { wood: low, bare_wood: None, leaves: None, is_wood_nested: false };
    let high = full_level(model, MaterialKind::FadingBark, PartSet::in_leaf(0));
    std::iter::once(high).chain(medium).chain([low]).collect()
}

fn wood_mesh(wood: &WoodVertices) -> Mesh {
    pack_wood(mesh(&wood.positions, &wood.normals, &wood.uvs, &wood.indices), &wood.sway)
}

/// Its second texture coordinates hold the number of images of its sequence, and mark it as an envelope.
fn envelope_mesh(envelope: &EnvelopeVertices, images: u32) -> Mesh {
    let sequence = vec![[images as f32, 0.0]; envelope.positions.len()];
    pack_wood(mesh(&envelope.positions, &envelope.normals, &envelope.uvs, &envelope.indices), &envelope.sway)
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_1, sequence)
}

/// Its colours are two texels, of which each vertex has one; it stands as the root of the trunk does: still.
fn plain_mesh(four: &CrossedPolygons) -> Mesh {
    let trunk = four.colours.first().copied();
    let uv = |colour: &[f32; 3]| [if Some(*colour) == trunk { 0.25 } else { 0.75 }, 0.5];
    let uvs: Vec<[f32; 2]> = four.colours.iter().map(uv).collect();
    let sway = vec![[0.0, 0.0, 0.0, 1.0]; four.positions.len()];
    pack_wood(mesh(&four.positions, &four.normals, &uvs, &four.indices), &sway)
}

fn leaf_mesh(leaves: &LeafVertices) -> Mesh {
    let mesh = mesh(&leaves.positions, &leaves.normals, &leaves.uvs, &leaves.indices);
    pack_leaves(mesh, &leaves.sway, &leaves.axis, &leaves.anchor)
}

fn mesh(positions: &[[f32; 3]], normals: &[[f32; 3]], uvs: &[[f32; 2]], indices: &[u32]) -> Mesh {
    // The copy on the CPU goes by `mesh_copies.rs`.
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions.to_vec())
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals.to_vec())
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs.to_vec())
        .with_inserted_indices(Indices::U32(indices.to_vec()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        lod::LEAST_LEAF_SHARE,
        tree::{Growth, MOST_ENLARGED, crown::impressionist::ImpressionistCrown},
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
        let recipe = LevelRecipe { species, ..LevelRecipe::default() };
        let meshes = species_meshes(&recipe, false, &[model], PartSet::ALL);
        let leaves = |lod: &LodMeshes| lod.leaves.as_ref().and_then(|part| part.mesh.clone());
        let vertices = |lod: &LodMeshes| leaves(lod).map_or(0, |mesh| mesh.count_vertices());
        let shares: Vec<f32> =
            meshes.variants[0].lods.iter().map(|lod| vertices(lod) as f32 / 3.0 / polygons).collect();
        // A tree of 14 m has 700 pixels of a picture of 1080 at 26.1 m, and the geometric mean of 700 and 128 at 61.0 m.
        let expected = [1.0, 1.0, 30.0 / 61.0];
        assert!(shares.iter().zip(expected).all(|(share, expected)| (share - expected).abs() < 0.005), "{shares:?}");
    }

    #[test]
    fn only_what_is_wanted_and_the_coarsest_level_are_made_at_first() {
        // A bare oak needs some of the wood that is left out under its leaves.
        let oak = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/species/oak.species.ron"));
        let species: Species = crate::ron_text::from_ron(oak).expect("the species that is shipped");
        let model = TreeModel::bake(&species, species.age.mature_years, 2);
        let recipe = LevelRecipe { species, ..LevelRecipe::default() };
        let made = |wanted: PartSet| -> Vec<[bool; 3]> {
            let meshes = species_meshes(&recipe, false, std::slice::from_ref(&model), wanted);
            let is_made = |part: Option<&MeshPart>| part.is_some_and(|part| part.mesh.is_some());
            let parts = |lod: &LodMeshes| [Some(&lod.wood), lod.bare_wood.as_ref(), lod.leaves.as_ref()].map(is_made);
            meshes.variants[0].lods.iter().map(parts).collect()
        };
        assert_eq!(made(PartSet::EMPTY), [[false; 3], [false; 3], [true, false, true]]);
        let bare = PartSet::one(1, LevelPart::BareWood);
        let expected = [[true, false, true], [false, true, false], [true, false, true]];
        assert_eq!(made(bare.and(PartSet::in_leaf(0))), expected);
    }
}
