//! What there is in an app.

use bevy::{
    prelude::*,
    render::{
        RenderApp, render_asset::RenderAssets, renderer::RenderDevice, storage::GpuShaderBuffer, storage::ShaderBuffer,
        texture::GpuImage,
    },
};
use bevy_windwood::{
    prelude::*,
    tree::{SpeciesModels, TreeModel},
};
use std::collections::BTreeMap;

/// What there is in an app.
#[derive(Debug)]
pub struct Census {
    /// Things that are counted one by one.
    pub counts: BTreeMap<&'static str, usize>,
    /// Memory of the process that is in use.
    pub resident_bytes: u64,
    /// Buffers and textures on the device.
    pub gpu_bytes: u64,
}

impl Census {
    /// Counts.
    pub fn take(app: &mut App) -> Self {
        let device = app.world().resource::<RenderDevice>().clone();
        let report = device.wgpu_device().generate_allocator_report();
        let world = app.world_mut();
        let mut counts = BTreeMap::from([
            ("entities", world.query::<Entity>().iter(world).count()),
            ("trees", world.query::<&Tree>().iter(world).count()),
            ("entities with meshes", world.query::<&Mesh3d>().iter(world).count()),
            ("entities with parents", world.query::<&ChildOf>().iter(world).count()),
            ("wind cells", world.query::<&WindCell>().iter(world).count()),
            ("meshes", world.resource::<Assets<Mesh>>().len()),
            ("images", world.resource::<Assets<Image>>().len()),
            ("buffers", world.resource::<Assets<ShaderBuffer>>().len()),
            ("tree models", world.resource::<Assets<TreeModel>>().len()),
            ("species", world.resource::<SpeciesModels>().len()),
            ("still materials", world.resource::<Assets<StandardMaterial>>().len()),
        ]);
        let render = app.sub_app_mut(RenderApp).world_mut();
        counts.extend([
            ("render entities", render.query::<Entity>().iter(render).count()),
            ("images on the GPU", render.resource::<RenderAssets<GpuImage>>().iter().count()),
            ("buffers on the GPU", render.resource::<RenderAssets<GpuShaderBuffer>>().iter().count()),
        ]);
        let gpu_bytes = report.map_or(0, |report| report.total_allocated_bytes);
        Self { counts, resident_bytes: resident_bytes(), gpu_bytes }
    }
}

/// What the system has given the process, and it uses; 0 where that cannot be read.
fn resident_bytes() -> u64 {
    const PAGE: u64 = 4096;
    let statm = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    statm.split_whitespace().nth(1).and_then(|pages| pages.parse::<u64>().ok()).unwrap_or(0) * PAGE
}
