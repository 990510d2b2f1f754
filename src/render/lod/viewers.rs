//! From where trees are seen, and how large.

use super::thresholds::{LodDistance, LodThresholds};
use crate::{lod::Lens, render::settings::ActiveLevelOfDetail, viewpoint::Viewpoints};
use bevy::prelude::*;

/// LOD levels are selected anew when a viewer has moved so far, m.
const STEP_M: f32 = 0.5;

/// A place from which trees are seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LodViewer {
    pub eye: Vec3,
    pub scale: LodScale,
}

/// How a viewer's picture shows sizes, beside that of the lens of the thresholds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LodScale {
    /// Perspective: a tree looks as large as one so many times as far away.
    Distance(f32),
    /// Orthographic: every tree looks as large as one at this distance, m.
    Constant(f32),
}

impl LodViewer {
    /// As the shaders have it: the factor of the distance, or below 0 a distance.
    pub fn factor(&self) -> f32 {
        match self.scale {
            LodScale::Distance(factor) => factor,
            LodScale::Constant(distance_m) => -distance_m,
        }
    }

    fn scaled_m(&self, distance_m: f32) -> f32 {
        match self.scale {
            LodScale::Distance(factor) => factor * distance_m,
            LodScale::Constant(constant_m) => constant_m,
        }
    }
}

/// The viewers of this frame, and where levels end for them.
#[derive(Resource)]
pub(crate) struct LodViewers {
    pub thresholds: LodThresholds,
    viewers: Vec<LodViewer>,
    selected_for: Vec<LodViewer>,
    /// Whether levels have to be selected anew for all trees.
    pub is_due: bool,
}

impl FromWorld for LodViewers {
    fn from_world(world: &mut World) -> Self {
        let settings = &world.get_resource_or_init::<ActiveLevelOfDetail>().0;
        let thresholds = LodThresholds::new(settings, Lens::default());
        Self { thresholds, viewers: Vec::new(), selected_for: Vec::new(), is_due: false }
    }
}

impl LodViewers {
    /// How far a place is from the nearest viewer; 0 where there is none.
    pub fn distance(&self, place: Vec3) -> LodDistance {
        let nearest = |of: fn(&LodViewer, f32) -> f32| {
            let distances = self.viewers.iter().map(|viewer| of(viewer, viewer.eye.distance(place)));
            distances.reduce(f32::min).unwrap_or(0.0)
        };
        LodDistance { m: nearest(|_, distance_m| distance_m), scaled_m: nearest(LodViewer::scaled_m) }
    }

    pub fn iter(&self) -> impl Iterator<Item = &LodViewer> {
        self.viewers.iter()
    }
}

/// Pixels that a metre has in a picture, one metre away from a perspective camera, or anywhere before an orthographic one.
#[derive(Clone, Copy)]
enum PixelsPerMetre {
    At1M(f32),
    Anywhere(f32),
}

fn pixels_per_metre(camera: &Camera, projection: &Projection) -> Option<PixelsPerMetre> {
    let picture_px = camera.physical_viewport_size()?.y as f32;
    let pixels = match projection {
        Projection::Perspective(perspective) => {
            PixelsPerMetre::At1M(Lens { fov_rad: perspective.fov, picture_px }.pixels_at_1_m())
        }
        Projection::Orthographic(orthographic) => PixelsPerMetre::Anywhere(picture_px / orthographic.area.height()),
        Projection::Custom(_) => return None,
    };
    let (PixelsPerMetre::At1M(px) | PixelsPerMetre::Anywhere(px)) = pixels;
    (px.is_finite() && px > 0.0).then_some(pixels)
}

/// Notes where the viewers are, and whether levels have to be selected anew.
pub(crate) fn update_lod_viewers(
    settings: Res<ActiveLevelOfDetail>,
    viewpoints: Viewpoints,
    lamps: (Query<&PointLight>, Query<&SpotLight>),
    mut viewers: ResMut<LodViewers>,
) {
    let viewers = viewers.bypass_change_detection();
    let seen = || {
        // A camera that was spawned in this frame has neither a place nor a picture yet.
        let has_picture =
            |camera: Option<&Camera>| camera.is_none_or(|camera| camera.physical_viewport_size().is_some());
        let eyes = viewpoints.active().filter(move |(_, camera, _)| has_picture(*camera));
        eyes.map(|(at, camera, projection)| {
            (at.translation(), camera.zip(projection).and_then(|(camera, it)| pixels_per_metre(camera, it)))
        })
    };
    let perspective = seen().filter_map(|(_, pixels)| match pixels {
        Some(PixelsPerMetre::At1M(px)) => Some(px),
        _ => None,
    });
    // The lens that shows most is that of the thresholds; without a camera, the usual one.
    let px_at_1_m = perspective.reduce(f32::max).unwrap_or(Lens::default().pixels_at_1_m());
    viewers.viewers.clear();
    viewers.viewers.extend(seen().map(|(eye, pixels)| {
        let scale = match pixels {
            Some(PixelsPerMetre::At1M(px)) => LodScale::Distance(px_at_1_m / px),
            Some(PixelsPerMetre::Anywhere(px)) => LodScale::Constant(px_at_1_m / px),
            None => LodScale::Distance(1.0),
        };
        LodViewer { eye, scale }
    }));
    let thresholds = LodThresholds::new(&settings.0, Lens::with_pixels_at_1_m(px_at_1_m));
    let has_lamps = lamps.0.iter().any(|it| it.shadow_maps_enabled) || lamps.1.iter().any(|it| it.shadow_maps_enabled);
    let thresholds = if has_lamps { thresholds.with_lamps() } else { thresholds };
    let rests = |(now, then): (&LodViewer, &LodViewer)| now.eye.distance(then.eye) < STEP_M && now.scale == then.scale;
    let all_rest = viewers.viewers.len() == viewers.selected_for.len()
        && viewers.viewers.iter().zip(&viewers.selected_for).all(rests);
    if !all_rest || thresholds != viewers.thresholds {
        viewers.thresholds = thresholds;
        viewers.selected_for.clone_from(&viewers.viewers);
        viewers.is_due = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{lod::LodScreenSizes, viewpoint::Viewpoint};
    use bevy::{
        camera::{ScalingMode, Viewport},
        ecs::system::RunSystemOnce,
    };

    const HEIGHT_PX: u32 = 1000;

    /// Viewers in the world's origin, with these projections on pictures of one size.
    fn viewers(projections: impl IntoIterator<Item = Projection>) -> World {
        let mut world = World::new();
        world.init_resource::<ActiveLevelOfDetail>();
        world.init_resource::<LodViewers>();
        for projection in projections {
            let viewport = Some(Viewport { physical_size: UVec2::new(1600, HEIGHT_PX), ..default() });
            world.spawn((Camera { viewport, ..default() }, projection, GlobalTransform::IDENTITY, Viewpoint));
        }
        world.run_system_once(update_lod_viewers).expect("it runs");
        world
    }

    fn perspective(fov: f32) -> Projection {
        Projection::Perspective(PerspectiveProjection { fov, ..default() })
    }

    /// Height on the picture of a tree of 10 m at a distance at which the thresholds change to level 1, pixels.
    fn px_at_first_end(world: &World, px_per_m: impl Fn(f32) -> f32) -> f32 {
        let viewers = world.resource::<LodViewers>();
        let end_m = viewers.thresholds.ends[0] * 10.0;
        let distance_m = (1..100_000).map(|step| step as f32 * 0.05);
        let at =
            distance_m.map(|m| (m, viewers.distance(Vec3::X * m).scaled_m)).find(|(_, scaled_m)| *scaled_m >= end_m);
        at.map_or(f32::NAN, |(m, _)| 10.0 * px_per_m(m))
    }

    #[test]
    fn levels_end_at_the_same_size_on_the_picture_of_any_lens() {
        let expected_px = LodScreenSizes::default().high_px;
        for fov in [0.05, 0.4, 1.2] {
            let world = viewers([perspective(fov)]);
            let px = px_at_first_end(&world, |m| HEIGHT_PX as f32 / (2.0 * m * (0.5 * fov).tan()));
            assert!((px / expected_px - 1.0).abs() < 0.02, "fov {fov}: {px} px");
        }
    }

    #[test]
    fn the_camera_that_shows_most_decides_in_split_screen() {
        let world = viewers([perspective(1.2), perspective(0.3)]);
        let both = world.resource::<LodViewers>().distance(Vec3::X * 50.0);
        let telephoto = viewers([perspective(0.3)]);
        assert_eq!(both, telephoto.resource::<LodViewers>().distance(Vec3::X * 50.0));
    }

    #[test]
    fn an_orthographic_camera_sees_trees_at_any_distance_alike() {
        let mut projection = OrthographicProjection::default_3d();
        projection.scaling_mode = ScalingMode::FixedVertical { viewport_height: 40.0 };
        projection.area = Rect::from_center_half_size(Vec2::ZERO, Vec2::new(32.0, 20.0));
        let world = viewers([Projection::Orthographic(projection)]);
        let viewers = world.resource::<LodViewers>();
        let [near, far] = [5.0, 3000.0].map(|m| viewers.distance(Vec3::X * m).scaled_m);
        assert_eq!(near, far);
        // A tree of 10 m is a quarter of the picture: less than the full level needs.
        let px = 10.0 / 40.0 * HEIGHT_PX as f32;
        let lod = viewers.thresholds.select(near, 10.0, 3, None).lod;
        assert_eq!(lod > 0, px < LodScreenSizes::default().high_px);
    }
}
