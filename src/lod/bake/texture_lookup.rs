//! Looks up textures where rays hit triangles: a mip in linear light, and the gaps in it.

use bevy::math::Vec3;

use crate::{
    texture::{MASK_CUT_OFF, TextureData, linear},
    tree::ellipsoid::silhouette_alpha,
};

/// Whether a triangle stops rays.
pub(in crate::lod) enum Opacity<'a> {
    /// It stops none.
    Clear,
    /// It stops all that meet it.
    Opaque,
    /// It stops them where its mask is. With normals, and where it is so beyond the outline of an ellipsoid of leaves.
    Masked { mask: &'a LinearMip, uvs: [[f32; 2]; 3], normals: Option<[Vec3; 3]> },
}

impl Opacity<'_> {
    /// Whether a ray along a unit vector is stopped at a place: the shares of the triangle's second and third corner.
    pub fn stops(&self, at: [f32; 2], direction: Vec3) -> bool {
        let Self::Masked { mask, uvs, normals } = self else { return matches!(self, Self::Opaque) };
        let alpha = mask.alpha[mask.clamped(interpolated(*uvs, at))];
        let outline =
            |normals: [Vec3; 3]| silhouette_alpha(interpolated_vector(normals, at).normalize_or_zero().dot(direction));
        alpha > MASK_CUT_OFF && normals.is_none_or(|normals| alpha * outline(normals) > MASK_CUT_OFF)
    }
}

/// One mip of a texture, in linear light.
pub(in crate::lod) struct LinearMip {
    width: usize,
    height: usize,
    /// Linear.
    pub colour: Vec<[f32; 3]>,
    pub alpha: Vec<f32>,
    /// Share of the species' translucency, 0 to 1.
    pub translucency: Vec<f32>,
}

impl LinearMip {
    /// Colours, and translucency from the alpha of the normals, where there are any.
    pub fn new(colours: &TextureData, normals: Option<&TextureData>, mip: usize) -> Self {
        let mip = mip.min(colours.mips.len() - 1);
        let share = |byte: u8| f32::from(byte) / 255.0;
        let texels = || colours.mips[mip].chunks_exact(4);
        let normals = normals
            .and_then(|normals| normals.mips.get(mip))
            .filter(|normals| normals.len() == colours.mips[mip].len());
        Self {
            width: (colours.width as usize >> mip).max(1),
            height: (colours.height as usize >> mip).max(1),
            colour: texels().map(|bytes| linear([bytes[0], bytes[1], bytes[2]].map(share))).collect(),
            alpha: texels().map(|bytes| share(bytes[3])).collect(),
            translucency: match normals {
                Some(normals) => normals.chunks_exact(4).map(|bytes| share(bytes[3])).collect(),
                None => texels().map(|_| 1.0).collect(),
            },
        }
    }

    /// Index of the texel at a place; beyond the rim, of that on the rim.
    pub fn clamped(&self, [u, v]: [f32; 2]) -> usize {
        let place = |share: f32, size: usize| ((share * size as f32) as usize).min(size - 1);
        place(v, self.height) * self.width + place(u, self.width)
    }

    /// Index of the texel at a place of a texture that repeats.
    pub fn repeated(&self, uv: [f32; 2]) -> usize {
        self.clamped(uv.map(|share| share - share.floor()))
    }

    /// Mean colour, linear.
    pub fn mean(&self) -> [f32; 3] {
        let sum = |channel: usize| self.colour.iter().map(|colour| colour[channel]).sum::<f32>();
        std::array::from_fn(|channel| sum(channel) / self.colour.len() as f32)
    }
}

/// The mean of three corners' values: the shares of the second and the third are given.
pub(in crate::lod) fn interpolated<const N: usize>(corners: [[f32; N]; 3], [u, v]: [f32; 2]) -> [f32; N] {
    let [a, b, c] = corners;
    std::array::from_fn(|channel| a[channel] * (1.0 - u - v) + b[channel] * u + c[channel] * v)
}

/// The same for vectors.
pub(in crate::lod) fn interpolated_vector([a, b, c]: [Vec3; 3], [u, v]: [f32; 2]) -> Vec3 {
    a * (1.0 - u - v) + b * u + c * v
}
