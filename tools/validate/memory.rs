//! Memory on the GPU of a mixed forest: what its textures, meshes and tables are there, counted by their sizes.

use crate::{grid, report::Report, support::capture};
use bevy::{
    prelude::*,
    render::{
        RenderApp,
        mesh::{RenderMesh, RenderMeshBufferInfo},
        render_asset::RenderAssets,
        render_resource::{Extent3d, TextureFormat},
        storage::GpuShaderBuffer,
        texture::GpuImage,
    },
};
use bevy_windwood::{
    prelude::*,
    scatter::{
        ForestPlan,
        plan::{Area, Shape, Stock},
    },
};

const SPECIES: [&str; 8] = ["oak", "beech", "birch", "maple", "fir", "norway_spruce", "scots_pine", "larch"];
const HALF_SIDE_M: f32 = 200.0;
const SIZE: (u32, u32) = (320, 180);
const MIB: f64 = 1024.0 * 1024.0;

/// Adds the row to those of the topic `cost`.
pub fn run(report: &mut Report) {
    let note = "textures, meshes and tables of a forest of eight species";
    match measure() {
        Ok(Memory { textures, meshes, tables }) => {
            let [textures, meshes, tables] = [textures, meshes, tables].map(|bytes| bytes as f64 / MIB);
            println!("  eight species: textures {textures:.1}, meshes {meshes:.1}, tables {tables:.1} MiB");
            report.record("texture_mib", textures, "of it textures");
            report.record("mesh_mib", meshes, "of it meshes");
            report.record("table_mib", tables, "of it tables: winds, beams, trees, poses");
            report.at_most("forest_mib", textures + meshes + tables, 150.0, note);
        }
        Err(error) => {
            eprintln!("memory: {error}");
            report.at_most("forest_mib", f64::NAN, 150.0, "could not be measured");
        }
    }
}

/// Bytes on the GPU.
#[derive(Clone, Copy)]
struct Memory {
    textures: u64,
    meshes: u64,
    tables: u64,
}

impl Memory {
    /// All that the app has there, but for what it renders to.
    fn of(app: &App) -> Self {
        let world = app.sub_app(RenderApp).world();
        let images = world.resource::<RenderAssets<GpuImage>>().iter().map(|(_, image)| texture_bytes(image));
        let meshes = world.resource::<RenderAssets<RenderMesh>>().iter().map(|(_, mesh)| mesh_bytes(mesh));
        let tables = world.resource::<RenderAssets<GpuShaderBuffer>>().iter().map(|(_, table)| table.buffer.size());
        Self { textures: images.sum(), meshes: meshes.sum(), tables: tables.sum() }
    }

    fn since(self, before: Self) -> Self {
        Self {
            textures: self.textures - before.textures,
            meshes: self.meshes - before.meshes,
            tables: self.tables - before.tables,
        }
    }
}

fn texture_bytes(image: &GpuImage) -> u64 {
    let descriptor = &image.texture_descriptor;
    let mip = |level| mip_bytes(descriptor.format, descriptor.size.mip_level_size(level, descriptor.dimension));
    (0..descriptor.mip_level_count).map(mip).sum()
}

fn mip_bytes(format: TextureFormat, size: Extent3d) -> u64 {
    let (width, height) = format.block_dimensions();
    let blocks = u64::from(size.width.div_ceil(width)) * u64::from(size.height.div_ceil(height));
    blocks * u64::from(size.depth_or_array_layers) * u64::from(format.block_copy_size(None).unwrap_or(4))
}

fn mesh_bytes(mesh: &RenderMesh) -> u64 {
    let indices = match &mesh.buffer_info {
        RenderMeshBufferInfo::Indexed { count, index_format } => u64::from(*count) * index_format.byte_size() as u64,
        RenderMeshBufferInfo::NonIndexed => 0,
    };
    u64::from(mesh.vertex_count) * mesh.layout.0.layout().array_stride + indices
}

fn measure() -> Result<Memory, String> {
    let mut app = App::new();
    app.add_plugins((capture::headless_engine(None), WindwoodPlugins));
    capture::begin(&mut app)?;
    let target = capture::target(&mut app, SIZE);
    grid::spawn_ground_and_sun(app.world_mut());
    capture::step(&mut app);
    let before = Memory::of(&app);
    let world = app.world_mut();
    let plan = world.resource_mut::<Assets<ForestPlan>>().add(plan());
    world.spawn((Forest::new(plan), ForestSettings { cells_at_once: 64, trees_per_frame: 100_000, ..default() }));
    let eye = Transform::from_xyz(0.0, 2.0, 0.0).looking_to(Vec3::NEG_Z, Vec3::Y);
    let viewpoint = world.spawn((Viewpoint, eye)).id();
    grid::wait_until_drawn(&mut app)?;
    app.world_mut().entity_mut(viewpoint).insert(capture::camera(&target));
    (0..4).for_each(|_| capture::step(&mut app));
    Ok(Memory::of(&app).since(before))
}

/// Trees of all ages of all species.
fn plan() -> ForestPlan {
    let stock = |species: &str| Stock { species: species.into(), age_years: 60.0, age_spread_years: 30.0, ..default() };
    let area = Area {
        shape: Shape::Rectangle { min_m: [-HALF_SIDE_M; 2], max_m: [HALF_SIDE_M; 2] },
        density_per_ha: 200.0,
        stock: SPECIES.map(stock).into(),
        ..default()
    };
    ForestPlan { seed: 8, areas: vec![area], ..default() }
}
