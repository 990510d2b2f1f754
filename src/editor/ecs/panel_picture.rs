//! The picture of the panels, kept from one layout to the next. In between, egui's renderer, which uploads all that it is given in every frame,
//! rests, and the picture is shown again.

use bevy::{
    prelude::*,
    render::{
        Extract, ExtractSchedule, RenderApp,
        render_resource::{Texture, TextureDescriptor, TextureDimension, TextureUsages},
        renderer::{RenderContext, RenderDevice, ViewQuery},
        view::ViewTarget,
    },
};

/// Whether panels were laid out in this frame, so that egui has something new to paint.
#[derive(Resource, Default)]
pub(super) struct PanelsLaidOut(pub bool);

/// What egui has painted last, in the render world.
#[derive(Resource, Default)]
pub(super) struct PanelPicture {
    /// Whether egui paints in this frame.
    is_new: bool,
    kept: Option<Texture>,
}

/// Adds the picture to the render world.
pub(super) fn plugin(app: &mut App) {
    app.init_resource::<PanelsLaidOut>();
    let Some(render) = app.get_sub_app_mut(RenderApp) else { return };
    render.init_resource::<PanelPicture>().add_systems(ExtractSchedule, extract_is_new);
}

fn extract_is_new(laid_out: Extract<Res<PanelsLaidOut>>, mut picture: ResMut<PanelPicture>) {
    picture.is_new = laid_out.0;
}

/// Whether egui paints in this frame.
pub(super) fn is_new(picture: Res<PanelPicture>) -> bool {
    picture.is_new
}

/// Keeps what egui has painted.
pub(super) fn keep_picture(
    view: ViewQuery<&ViewTarget>,
    device: Res<RenderDevice>,
    mut picture: ResMut<PanelPicture>,
    mut ctx: RenderContext,
) {
    let painted = view.into_inner().main_texture();
    let kept = picture.kept.take().filter(|kept| are_alike(kept, painted)).unwrap_or_else(|| {
        device.create_texture(&TextureDescriptor {
            label: Some("picture of the panels"),
            size: painted.size(),
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format: painted.format(),
            usage: TextureUsages::COPY_SRC | TextureUsages::COPY_DST,
            view_formats: &[],
        })
    });
    copy(painted, &kept, &mut ctx);
    picture.kept = Some(kept);
}

/// Shows what was kept. Where the window has changed since, a layout is due anyway.
pub(super) fn show_picture(view: ViewQuery<&ViewTarget>, picture: Res<PanelPicture>, mut ctx: RenderContext) {
    let shown = view.into_inner().main_texture();
    let Some(kept) = picture.kept.as_ref().filter(|kept| are_alike(kept, shown)) else { return };
    copy(kept, shown, &mut ctx);
}

fn are_alike(one: &Texture, other: &Texture) -> bool {
    one.size() == other.size() && one.format() == other.format()
}

fn copy(from: &Texture, to: &Texture, ctx: &mut RenderContext) {
    ctx.command_encoder().copy_texture_to_texture(from.as_image_copy(), to.as_image_copy(), from.size());
}
