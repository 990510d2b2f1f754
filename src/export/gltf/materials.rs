//! The materials of a species: bark, leaves, and sprays without leaves.

use super::builder::GlbBuilder;
use crate::{
    export::{error::ExportError, look::SpeciesLook, settings::LeafSides, surface::Part},
    texture::MASK_CUT_OFF,
};
use gltf_json::{
    Index, Material, Texture,
    extensions::material::Material as MaterialExtensions,
    material::{AlphaCutoff, AlphaMode, NormalTexture, OcclusionTexture, PbrMetallicRoughness, StrengthFactor},
    texture::{Info, MagFilter, MinFilter, Sampler, WrappingMode},
    validation::Checked::Valid,
};
use serde_json::{Map, Value, json};

/// The renderer's reflectance of bark and leaves: 0.5 is the 4% of usual surfaces.
const BARK_REFLECTANCE: f32 = 0.2;
const LEAF_REFLECTANCE: f32 = 0.08;
const LEAF_ROUGHNESS: f32 = 0.8;
/// The factor of an ellipsoid's mask, 1/(2 - u²) with the cosine u between its surface and the eye, where u² has its mean over the disc
/// that is seen: 1/2. A file can have no other factor towards the outline.
const MEAN_SILHOUETTE: f32 = 1.0 / 1.5;

/// The materials of a species, made when they are first asked for.
pub(super) struct SpeciesMaterials<'a> {
    look: &'a SpeciesLook<'a>,
    /// By [`Part`].
    made: [Option<Index<Material>>; 3],
    /// Sprays with and without leaves share it.
    leaf_normal: Option<Index<Texture>>,
}

impl<'a> SpeciesMaterials<'a> {
    pub fn new(look: &'a SpeciesLook<'a>) -> Self {
        Self { look, made: [None; 3], leaf_normal: None }
    }

    /// Whether meshes of a part need tangents.
    pub fn needs_tangents(&self, part: Part) -> bool {
        self.look.has_normal_map(part)
    }

    /// Whether triangles of a part are there for both sides.
    pub fn has_both_sides(&self, part: Part) -> bool {
        part != Part::Wood && self.look.leaf_sides == LeafSides::Twice
    }

    /// The material of a part.
    pub fn of(&mut self, part: Part, glb: &mut GlbBuilder) -> Result<Index<Material>, ExportError> {
        if let Some(material) = self.made[part as usize] {
            return Ok(material);
        }
        let material = match part {
            Part::Wood => self.bark(glb)?,
            Part::Leaves | Part::BareSprays => self.foliage(part, glb)?,
        };
        let material = glb.root.push(material);
        self.made[part as usize] = Some(material);
        Ok(material)
    }

    fn bark(&self, glb: &mut GlbBuilder) -> Result<Material, ExportError> {
        let colour = self.texture(glb, "colour", Part::Wood, &self.look.colour_png(Part::Wood)?);
        let normal = self.look.normal_png(Part::Wood).transpose()?;
        let normal = normal.map(|png| self.texture(glb, "normals", Part::Wood, &png));
        let surface = self.texture(glb, "surface", Part::Wood, &self.look.bark_surface_png()?);
        Ok(Material {
            name: Some(self.name(Part::Wood)),
            pbr_metallic_roughness: PbrMetallicRoughness {
                base_color_texture: Some(info(colour)),
                metallic_factor: StrengthFactor(0.0),
                metallic_roughness_texture: Some(info(surface)),
                ..PbrMetallicRoughness::default()
            },
            normal_texture: normal.map(normal_texture),
            occlusion_texture: Some(OcclusionTexture {
                index: surface,
                strength: StrengthFactor(1.0),
                tex_coord: 0,
                extensions: None,
                extras: None,
            }),
            extensions: Some(extensions(glb, BARK_REFLECTANCE, 0.0)),
            ..Material::default()
        })
    }

    fn foliage(&mut self, part: Part, glb: &mut GlbBuilder) -> Result<Material, ExportError> {
        let colour = self.texture(glb, "colour", part, &self.look.colour_png(part)?);
        if self.leaf_normal.is_none()
            && let Some(png) = self.look.normal_png(part)
        {
            self.leaf_normal = Some(self.texture(glb, "normals", part, &png?));
        }
        let cut_off = if self.look.species.has_ellipsoids() { MASK_CUT_OFF / MEAN_SILHOUETTE } else { MASK_CUT_OFF };
        let translucency = if part == Part::Leaves { self.look.species.foliage.translucency } else { 0.0 };
        Ok(Material {
            name: Some(self.name(part)),
            alpha_cutoff: Some(AlphaCutoff(cut_off)),
            alpha_mode: Valid(AlphaMode::Mask),
            double_sided: self.look.leaf_sides == LeafSides::DoubleSided,
            pbr_metallic_roughness: PbrMetallicRoughness {
                base_color_texture: Some(info(colour)),
                metallic_factor: StrengthFactor(0.0),
                roughness_factor: StrengthFactor(LEAF_ROUGHNESS),
                ..PbrMetallicRoughness::default()
            },
            normal_texture: self.leaf_normal.map(normal_texture),
            extensions: Some(extensions(glb, LEAF_REFLECTANCE, translucency)),
            ..Material::default()
        })
    }

    fn name(&self, part: Part) -> String {
        format!("{} {}", self.look.species.name, part.name())
    }

    fn texture(&self, glb: &mut GlbBuilder, what: &str, part: Part, png: &[u8]) -> Index<Texture> {
        // Bark repeats around the branch and along it. The mask of leaves has no mips: averaged ones would thin the crown with distance.
        let (wrap, filter) = match part {
            Part::Wood => (WrappingMode::Repeat, MinFilter::LinearMipmapLinear),
            Part::Leaves | Part::BareSprays => (WrappingMode::ClampToEdge, MinFilter::Linear),
        };
        let source = glb.image(format!("{} {what}", self.name(part)), png);
        let sampler = sampler(glb, wrap, filter);
        glb.root.push(Texture { name: None, sampler: Some(sampler), source, extensions: None, extras: None })
    }
}

/// The sampler that repeats, or the one that does not.
fn sampler(glb: &mut GlbBuilder, wrap: WrappingMode, filter: MinFilter) -> Index<Sampler> {
    if let Some(known) = glb.root.samplers.iter().position(|sampler| sampler.wrap_s == Valid(wrap)) {
        return Index::new(known as u32);
    }
    glb.root.push(Sampler {
        mag_filter: Some(Valid(MagFilter::Linear)),
        min_filter: Some(Valid(filter)),
        wrap_s: Valid(wrap),
        wrap_t: Valid(wrap),
        ..Sampler::default()
    })
}

/// Less reflection than usual surfaces have, and the light that comes through leaves.
fn extensions(glb: &mut GlbBuilder, reflectance: f32, translucency: f32) -> MaterialExtensions {
    let mut others = Map::new();
    let mut add = |name: &str, value: Value| {
        glb.use_extension(name);
        others.insert(name.to_owned(), value);
    };
    // The renderer's reflection at right angles is 0.16 times the square of its reflectance, that of the format 0.04 times the factor.
    add("KHR_materials_specular", json!({ "specularFactor": 4.0 * reflectance * reflectance }));
    if translucency > 0.0 {
        add("KHR_materials_diffuse_transmission", json!({ "diffuseTransmissionFactor": translucency }));
    }
    MaterialExtensions { others, ..MaterialExtensions::default() }
}

fn info(index: Index<Texture>) -> Info {
    Info { index, tex_coord: 0, extensions: None, extras: None }
}

fn normal_texture(index: Index<Texture>) -> NormalTexture {
    NormalTexture { index, scale: 1.0, tex_coord: 0, extensions: None, extras: None }
}
