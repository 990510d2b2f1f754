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
    render::{RenderCapabilities, SwayBuffers},
    scatter::{
        ForestPlan,
        plan::{Area, Shape, Stock},
    },
};
use std::collections::BTreeMap;

const SPECIES: [&str; 8] = ["oak", "beech", "birch", "maple", "fir", "norway_spruce", "scots_pine", "larch"];
const HALF_SIDE_M: f32 = 200.0;
/// As large as a usual picture: levels of detail are chosen by the size of trees on it.
const SIZE: (u32, u32) = (1920, 1080);
const MIB: f64 = 1024.0 * 1024.0;

/// Adds the rows to those of the topic `cost`.
pub fn run(report: &mut Report) {
    let note = "textures, meshes and tables of a forest of eight species";
    match measure() {
        Ok(memory) => {
            let mib = |bytes: u64| bytes as f64 / MIB;
            memory.print();
            report.record("texture_mib", mib(total(&memory.textures)), "of it textures");
            report.record("mesh_mib", mib(total(&memory.meshes)), "of it meshes");
            report.record("table_mib", mib(total(&memory.tables)), "of it tables: winds, beams, trees, poses");
            report.at_most("forest_mib", mib(memory.total()), 150.0, note);
        }
        Err(error) => {
            eprintln!("memory: {error}");
            report.at_most("forest_mib", f64::NAN, 150.0, "could not be measured");
        }
    }
}

/// Bytes on the GPU by what they are of.
type Bytes = BTreeMap<String, u64>;

/// Bytes on the GPU: of textures by their format, of meshes by the size of a vertex, of tables by their name.
struct Memory {
    textures: Bytes,
    meshes: Bytes,
    tables: Bytes,
}

impl Memory {
    /// All that the app has there, but for what it renders to.
    fn of(app: &App) -> Self {
        let tables = &app.world().resource::<SwayBuffers>();
        let names = [
            (tables.poses.id(), "poses"),
            (tables.beams.id(), "beams"),
            (tables.trees.id(), "trees"),
            (tables.winds[0].id(), "winds"),
            (tables.winds[1].id(), "winds"),
        ];
        let name = |id| names.iter().find(|(named, _)| *named == id).map_or("others", |(_, name)| name);
        let world = app.sub_app(RenderApp).world();
        let images = world.resource::<RenderAssets<GpuImage>>().iter();
        let meshes = world.resource::<RenderAssets<RenderMesh>>().iter();
        let buffers = world.resource::<RenderAssets<GpuShaderBuffer>>().iter();
        Self {
            textures: sum(images.map(|(_, it)| (format!("{:?}", it.texture_descriptor.format), texture_bytes(it)))),
            meshes: sum(meshes.flat_map(|(_, mesh)| {
                let [vertices, indices] = mesh_bytes(mesh);
                let stride = mesh.layout.0.layout().array_stride;
                [(format!("vertices of {stride} bytes"), vertices), (format!("their indices ({stride})"), indices)]
            })),
            tables: sum(buffers.map(|(id, table)| (name(id).into(), table.buffer.size()))),
        }
    }

    fn since(mut self, before: &Self) -> Self {
        let parts = [
            (&mut self.textures, &before.textures),
            (&mut self.meshes, &before.meshes),
            (&mut self.tables, &before.tables),
        ];
        for (now, before) in parts {
            before.iter().for_each(|(name, bytes)| *now.entry(name.clone()).or_default() -= bytes);
        }
        self
    }

    fn total(&self) -> u64 {
        total(&self.textures) + total(&self.meshes) + total(&self.tables)
    }

    fn print(&self) {
        for (kind, parts) in [("textures", &self.textures), ("meshes", &self.meshes), ("tables", &self.tables)] {
            println!("  {kind} {:.1} MiB", total(parts) as f64 / MIB);
            parts.iter().for_each(|(name, bytes)| println!("    {name}: {:.1}", *bytes as f64 / MIB));
        }
    }
}

fn sum(parts: impl Iterator<Item = (String, u64)>) -> Bytes {
    parts.fold(Bytes::new(), |mut all, (name, bytes)| {
        *all.entry(name).or_default() += bytes;
        all
    })
}

fn total(parts: &Bytes) -> u64 {
    parts.values().sum()
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

/// Those of the vertices and of the indices.
fn mesh_bytes(mesh: &RenderMesh) -> [u64; 2] {
    let indices = match &mesh.buffer_info {
        RenderMeshBufferInfo::Indexed { count, index_format } => u64::from(*count) * index_format.byte_size() as u64,
        RenderMeshBufferInfo::NonIndexed => 0,
    };
    [u64::from(mesh.vertex_count) * mesh.layout.0.layout().array_stride, indices]
}

fn measure() -> Result<Memory, String> {
    let mut app = App::new();
    app.add_plugins((capture::headless_engine(None), WindwoodPlugins));
    capture::begin(&mut app)?;
    // As on a GPU, whatever this device is.
    app.world_mut().resource_mut::<RenderCapabilities>().compresses_textures = true;
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
    Ok(Memory::of(&app).since(&before))
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
