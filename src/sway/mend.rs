//! A mend for the renderer, without which a growing forest takes the app down.
//!
//! Bevy 0.19.1 notes which pages of the table of culling boxes are dirty, and forgets the last page when the table is grown
//! to a length of a little over a multiple of 64 pages: the first mesh on that page is written out of bounds, a panic
//! (<https://github.com/bevyengine/bevy/issues/24730>). A table that is grown in whole pages is safe, so it is grown so
//! before Bevy looks. To be taken out with the first version of Bevy that counts right.

use bevy::{
    pbr::{MeshCullingDataBuffer, MeshInputUniform, MeshUniform, collect_meshes_for_gpu_building},
    prelude::*,
    render::{Render, RenderApp, RenderSystems, batching::gpu_preprocessing::BatchedInstanceBuffers},
};

/// Boxes to whose multiples the table is grown: 16 of Bevy's pages.
const BOXES: usize = 4096;

pub(super) fn plugin(app: &mut App) {
    let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
    let grow = grow_in_whole_pages.in_set(RenderSystems::PrepareMeshes).before(collect_meshes_for_gpu_building);
    render_app.add_systems(Render, grow);
}

fn grow_in_whole_pages(
    instances: Option<Res<BatchedInstanceBuffers<MeshUniform, MeshInputUniform>>>,
    boxes: Option<ResMut<MeshCullingDataBuffer>>,
) {
    let (Some(instances), Some(mut boxes)) = (instances, boxes) else { return };
    let count = instances.current_input_buffer.buffer().len() as usize;
    let whole = count.next_multiple_of(BOXES) as u32;
    if boxes.len() < whole {
        boxes.grow(whole);
    }
}
