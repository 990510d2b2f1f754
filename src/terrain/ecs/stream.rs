//! Builds the ground about the viewers in the background, and shows it.

use crate::{
    background::{Work, spawn_work},
    render::new_device::remove_lost_mesh,
    setting::valid_or_last,
    terrain::{
        chunk::{ChunkVertices, chunk_vertices},
        chunk_key::{COARSEST_NEIGHBOUR, ChunkKey},
        components::{GroundLook, Terrain, TerrainSettings},
        material::{ATTRIBUTE_MARKS, GroundMaterial, GroundTextures, ground_material},
        pyramid::{Eye, Pyramid},
    },
    viewpoint::Viewpoints,
};
use bevy::{
    asset::RenderAssetUsages,
    camera::{primitives::Aabb, visibility::NoAutoAabb},
    mesh::{Indices, MeshTag, PrimitiveTopology},
    platform::collections::HashMap,
    prelude::*,
    tasks::{block_on, poll_once},
};

/// The chunks of a [`Terrain`].
#[derive(Component)]
pub struct TerrainChunks {
    pyramid: Pyramid,
    /// Settings in force: the last that were valid.
    settings: TerrainSettings,
    material: Handle<GroundMaterial>,
    building: Vec<(ChunkKey, Work<Built>)>,
    chunks: HashMap<ChunkKey, Entity>,
    /// Chunks that were spawned in the last frame: only now can they be shown, and coarser ones be hidden.
    arrived: Vec<ChunkKey>,
    eyes: Vec<Eye>,
    selected_from: Vec<Eye>,
    is_complete: bool,
    /// Whether it was told that a worker has panicked.
    has_told: bool,
}

struct Built {
    mesh: Mesh,
    bounds: Aabb,
}

impl TerrainChunks {
    fn new(settings: TerrainSettings, material: Handle<GroundMaterial>) -> Self {
        Self {
            pyramid: Pyramid::new(settings.shape()),
            settings,
            material,
            building: Vec::new(),
            chunks: HashMap::default(),
            arrived: Vec::new(),
            eyes: Vec::new(),
            selected_from: Vec::new(),
            is_complete: false,
            has_told: false,
        }
    }

    /// Whether all ground that is wanted from where the viewers are is drawn.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.is_complete
    }

    /// Number of chunks that are drawn.
    #[must_use]
    pub fn drawn(&self) -> usize {
        self.pyramid.drawn().len()
    }
}

/// One chunk of drawn ground, a child of its [`Terrain`].
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct TerrainChunk(pub ChunkKey);

/// What all chunks depend on.
type NewGround = Or<(Changed<Terrain>, Changed<TerrainSettings>)>;

/// Starts to build terrains that are new or were changed.
pub(in crate::terrain) fn begin_terrains(
    mut commands: Commands,
    textures: Res<GroundTextures>,
    mut materials: ResMut<Assets<GroundMaterial>>,
    changed: Query<(Entity, &TerrainSettings, &GroundLook, Option<&TerrainChunks>), NewGround>,
) {
    for (entity, wanted, look, before) in &changed {
        let last = before.map(|before| &before.settings);
        let settings = valid_or_last("terrain settings", wanted, TerrainSettings::validate, last);
        for chunk in before.into_iter().flat_map(|before| before.chunks.values()) {
            commands.entity(*chunk).despawn();
        }
        let look = if look.validate().is_ok() { *look } else { GroundLook::default() };
        let material = before.map(|before| before.material.clone());
        let material = material.unwrap_or_else(|| materials.add(ground_material(&look, textures.clone())));
        commands.entity(entity).insert(TerrainChunks::new(settings, material));
    }
}

/// Builds all ground again, when it lay on a graphics device that was lost.
pub(in crate::terrain) fn restore_ground(
    mut commands: Commands,
    textures: Res<GroundTextures>,
    mut images: ResMut<Assets<Image>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut terrains: Query<&mut TerrainChunks>,
    chunks: Query<(Entity, &Mesh3d), With<TerrainChunk>>,
) {
    if let Err(error) = textures.restore(&mut images) {
        error!("textures of the ground: {error}");
    }
    for (chunk, mesh) in &chunks {
        remove_lost_mesh(mesh, &mut meshes);
        commands.entity(chunk).despawn();
    }
    for mut terrain in &mut terrains {
        let (settings, material) = (terrain.settings, terrain.material.clone());
        *terrain = TerrainChunks::new(settings, material);
    }
}

/// Recolours ground whose look was changed.
pub(in crate::terrain) fn recolour_ground(
    textures: Res<GroundTextures>,
    mut materials: ResMut<Assets<GroundMaterial>>,
    changed: Query<(&GroundLook, &TerrainChunks), Changed<GroundLook>>,
) {
    for (look, chunks) in &changed {
        match look.validate() {
            Ok(()) => {
                if let Some(mut material) = materials.get_mut(&chunks.material) {
                    *material = ground_material(look, textures.clone());
                }
            }
            Err(error) => warn!("look of the ground: {error}; the last good one stays"),
        }
    }
}

/// Selects the chunks that are wanted, spawns what was built, and starts to build what is missing.
pub(in crate::terrain) fn stream_ground(
    mut commands: Commands,
    viewpoints: Viewpoints,
    mut meshes: ResMut<Assets<Mesh>>,
    mut terrains: Query<(Entity, &Terrain, &mut TerrainChunks)>,
    mut shown: Query<(&mut Visibility, &mut MeshTag), With<TerrainChunk>>,
) {
    for (entity, terrain, mut chunks) in &mut terrains {
        let chunks = &mut *chunks;
        let mut changed = chunks.select(terrain, &viewpoints);
        let dropped: Vec<Entity> = chunks.pyramid.dropped().filter_map(|key| chunks.chunks.remove(&key)).collect();
        dropped.into_iter().for_each(|chunk| commands.entity(chunk).despawn());
        changed |= !chunks.arrived.is_empty();
        for key in chunks.arrived.drain(..) {
            chunks.pyramid.receive(key);
        }
        chunks.spawn_built(entity, &mut commands, &mut meshes);
        chunks.start_builds(terrain);
        chunks.is_complete = chunks.building.is_empty() && chunks.arrived.is_empty() && chunks.pyramid.is_complete();
        if changed {
            chunks.pyramid.select_drawn();
            chunks.show(&mut shown);
        }
    }
}

impl TerrainChunks {
    /// Selects chunks again when a viewer has moved by half a cell; whether anything may have changed.
    fn select(&mut self, terrain: &Terrain, viewpoints: &Viewpoints) -> bool {
        let eye = |at: Vec3| {
            let place = at.as_dvec3().xz();
            Eye { place, above_ground_m: (f64::from(at.y) - terrain.ground.height_m(place)).max(0.0) }
        };
        self.eyes.clear();
        self.eyes.extend(viewpoints.iter().map(eye));
        let half_a_cell = 0.5 * f64::from(self.settings.finest_cell_m);
        let rests = |(now, then): (&Eye, &Eye)| {
            now.place.distance(then.place).max((now.above_ground_m - then.above_ground_m).abs()) < half_a_cell
        };
        // Without viewers, what is there stays.
        let is_unseen = self.eyes.is_empty();
        if is_unseen
            || self.eyes.len() == self.selected_from.len() && self.eyes.iter().zip(&self.selected_from).all(rests)
        {
            return false;
        }
        self.selected_from.clone_from(&self.eyes);
        self.pyramid.select(&self.eyes);
        true
    }

    /// Spawns chunks that are built, as many as a frame may.
    fn spawn_built(&mut self, terrain: Entity, commands: &mut Commands, meshes: &mut Assets<Mesh>) {
        let mut room = self.settings.chunks_per_frame;
        let Self { building, pyramid, chunks, arrived, material, settings, has_told, .. } = self;
        building.retain_mut(|(key, task)| {
            let built = if room > 0 { block_on(poll_once(task)) } else { None };
            let Some(built) = built else { return true };
            room -= 1;
            let built = match built {
                Ok(built) => built,
                Err(panic) => {
                    if !std::mem::replace(has_told, true) {
                        error!("terrain {terrain}: {panic}; no ground is drawn where its workers do");
                    }
                    // Nothing is drawn there, and it is not built again.
                    arrived.push(*key);
                    return false;
                }
            };
            if pyramid.awaits(*key) {
                let corner = key.corner_m(f64::from(settings.finest_cell_m)).as_vec2();
                let chunk = commands.spawn((
                    TerrainChunk(*key),
                    ChildOf(terrain),
                    Transform::from_xyz(corner.x, 0.0, corner.y),
                    Visibility::Hidden,
                    Mesh3d(meshes.add(built.mesh)),
                    MeshMaterial3d(material.clone()),
                    MeshTag::new(0),
                    built.bounds,
                    NoAutoAabb,
                ));
                chunks.insert(*key, chunk.id());
                arrived.push(*key);
            }
            false
        });
    }

    /// Starts to build what is missing, as much as may be built at once.
    fn start_builds(&mut self, terrain: &Terrain) {
        while self.building.len() < self.settings.builds_at_once as usize {
            let Some(key) = self.pyramid.next_to_build() else { break };
            let (terrain, cell_m) = (terrain.clone(), f64::from(self.settings.finest_cell_m));
            let task = spawn_work(move || {
                let vertices = chunk_vertices(&terrain.ground, terrain.cover.as_deref(), key, cell_m);
                let side_m = key.side_m(cell_m) as f32;
                let bounds = Aabb::from_min_max(
                    Vec3::new(0.0, vertices.lowest_m, 0.0),
                    Vec3::new(side_m, vertices.highest_m, side_m),
                );
                Built { mesh: chunk_mesh(vertices), bounds }
            });
            self.building.push((key, task));
        }
    }

    /// Shows the chunks that are drawn, with their seams, and hides all others.
    fn show(&self, shown: &mut Query<(&mut Visibility, &mut MeshTag), With<TerrainChunk>>) {
        for (key, entity) in &self.chunks {
            // One that was spawned in this frame comes in the next.
            let Ok((mut visibility, mut tag)) = shown.get_mut(*entity) else { continue };
            let seams = self.pyramid.seams(*key);
            visibility.set_if_neq(if seams.is_some() { Visibility::Inherited } else { Visibility::Hidden });
            if let Some(seams) = seams {
                tag.set_if_neq(MeshTag::new(seams.0));
            }
        }
    }
}

fn chunk_mesh(vertices: ChunkVertices) -> Mesh {
    const { assert!(COARSEST_NEIGHBOUR < 8, "three bits of a gap's code") };
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, vertices.positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vertices.normals)
        .with_inserted_attribute(ATTRIBUTE_MARKS, vertices.marks)
        .with_inserted_indices(Indices::U32(vertices.indices))
}
