//! The picture of the panels, kept from one layout to the next. In between their camera rests, which costs half a millisecond with all that
//! Bevy does for a camera, and the picture is laid over the window by itself.

use super::{
    camera::{BLEND, DrawPanels, PanelCamera},
    workbench::Workbench,
};
use bevy::{
    camera::{CompositingSpace, NormalizedRenderTarget, RenderTarget},
    core_pipeline::{
        blit::{BlitPipeline, BlitPipelineKey},
        schedule::camera_driver,
        upscaling::upscaling,
    },
    ecs::schedule::ScheduleBuildSettings,
    prelude::*,
    render::{
        Extract, ExtractSchedule, GpuResourceAppExt, RenderApp,
        render_resource::{
            BindGroup, PipelineCache, RenderPassDescriptor, SpecializedRenderPipelines, Texture, TextureDescriptor,
            TextureDimension, TextureUsages, TextureViewDescriptor,
        },
        renderer::{RenderContext, RenderDevice, RenderGraph, RenderGraphSystems, ViewQuery},
        view::{ResolvedCompositingSpace, ViewTarget, ViewTargetAttachments},
    },
    window::PrimaryWindow,
};
use bevy_egui::render::{egui_pass, prepare_egui_pass};

/// What egui has painted last, in the render world.
#[derive(Resource, Default)]
struct PanelPicture {
    kept: Option<Kept>,
    /// Where it is shown in this frame.
    shown_on: Option<NormalizedRenderTarget>,
}

struct Kept {
    texture: Texture,
    bind_group: BindGroup,
    space: Option<CompositingSpace>,
}

/// Adds the picture to the render world, and the passes of the panels' camera.
pub(super) fn plugin(app: &mut App) {
    let Some(render) = app.get_sub_app_mut(RenderApp) else { return };
    let mut passes = Schedule::new(DrawPanels);
    passes.set_build_settings(ScheduleBuildSettings { auto_insert_apply_deferred: false, ..default() });
    passes.add_systems((prepare_egui_pass, egui_pass, keep_picture, upscaling).chain());
    render
        .add_schedule(passes)
        // It is there for the first extraction, which comes before any device, and is made anew with each device.
        .init_resource::<PanelPicture>()
        .init_gpu_resource::<PanelPicture>()
        .add_systems(ExtractSchedule, extract_where_it_is_shown)
        .add_systems(RenderGraph, show_picture.in_set(RenderGraphSystems::Render).after(camera_driver));
}

fn extract_where_it_is_shown(
    workbench: Extract<Res<Workbench>>,
    panels: Extract<Query<(&Camera, &RenderTarget), With<PanelCamera>>>,
    window: Extract<Query<Entity, With<PrimaryWindow>>>,
    mut picture: ResMut<PanelPicture>,
) {
    let resting = panels.single().ok().filter(|(camera, _)| workbench.is_open && !camera.is_active);
    picture.shown_on = resting.and_then(|(_, target)| target.normalize(window.single().ok()));
}

/// Keeps what egui has painted.
fn keep_picture(
    view: ViewQuery<(&ViewTarget, Option<&ResolvedCompositingSpace>)>,
    device: Res<RenderDevice>,
    pipelines: Res<PipelineCache>,
    blit: Res<BlitPipeline>,
    mut picture: ResMut<PanelPicture>,
    mut ctx: RenderContext,
) {
    let (view, space) = view.into_inner();
    let painted = view.main_texture();
    let is_alike = |kept: &Kept| kept.texture.size() == painted.size() && kept.texture.format() == painted.format();
    if !picture.kept.as_ref().is_some_and(is_alike) {
        let texture = device.create_texture(&TextureDescriptor {
            label: Some("picture of the panels"),
            size: painted.size(),
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format: painted.format(),
            usage: TextureUsages::COPY_DST | TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let view = texture.create_view(&TextureViewDescriptor::default());
        let bind_group = blit.create_bind_group(&device, &view, &pipelines);
        picture.kept = Some(Kept { texture, bind_group, space: ResolvedCompositingSpace::space(space) });
    }
    let Some(Kept { texture, .. }) = &picture.kept else { return };
    ctx.command_encoder().copy_texture_to_texture(painted.as_image_copy(), texture.as_image_copy(), painted.size());
}

/// Shows what was kept, in the way in which Bevy lays what a camera has drawn over its window.
fn show_picture(
    picture: Res<PanelPicture>,
    targets: Res<ViewTargetAttachments>,
    blit: Res<BlitPipeline>,
    mut variants: ResMut<SpecializedRenderPipelines<BlitPipeline>>,
    pipelines: Res<PipelineCache>,
    mut ctx: RenderContext,
) {
    let PanelPicture { kept: Some(kept), shown_on: Some(target) } = &*picture else { return };
    // It is there where another camera has drawn to it, and is another one while a picture of it is taken.
    let Some(target) = targets.get(target) else { return };
    // The same as the camera's own, so it has been compiled.
    let key = BlitPipelineKey {
        target_format: target.view_format,
        blend_state: Some(BLEND),
        samples: 1,
        source_space: kept.space,
    };
    let pipeline = variants.specialize(&pipelines, &blit, key);
    let Some(pipeline) = pipelines.get_render_pipeline(pipeline) else { return };
    let mut pass = ctx.command_encoder().begin_render_pass(&RenderPassDescriptor {
        label: Some("panels"),
        color_attachments: &[Some(target.get_attachment(None))],
        depth_stencil_attachment: None,
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, &kept.bind_group, &[]);
    pass.draw(0..3, 0..1);
}
