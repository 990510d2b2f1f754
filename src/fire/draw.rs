//! Draws fires: a mesh and a material for each, made once, and a light that flickers.

use super::{
    components::{Fire, Flames, generate_flames},
    material::{FireMaterial, ShelteredFireMaterial},
    mesh::{bounds, fire_mesh},
};
use crate::{
    plugin_checks::{has_renderer, require_renderer_before},
    removal::remove_made,
    render::{
        RenderCapabilities, SwayBuffers,
        new_device::{device_is_new, remove_lost_mesh},
    },
    schedule::WindwoodSystems,
    wind::WindClock,
};
use bevy::{
    asset::embedded_asset,
    camera::{primitives::Aabb, visibility::NoAutoAabb},
    light::{NotShadowCaster, NotShadowReceiver},
    pbr::MaterialPlugin,
    prelude::*,
};

/// Draws [`Fire`]s and spawns their lights. Needs [`TreeRenderPlugin`](crate::render::TreeRenderPlugin), which has the wind
/// tables. Without a renderer it does nothing.
pub struct FireDrawPlugin;

impl Plugin for FireDrawPlugin {
    fn build(&self, app: &mut App) {
        if !has_renderer(app) {
            return;
        }
        embedded_asset!(app, "shaders/fire.wesl");
        let can_draw = resource_exists::<RenderCapabilities>;
        app.add_plugins((
            MaterialPlugin::<FireMaterial>::default(),
            MaterialPlugin::<ShelteredFireMaterial>::default(),
        ))
        .register_type::<FireLight>()
        .add_observer(remove_made::<Fire, FireLight, FireMesh>)
        .add_systems(
            Update,
            (remake_lost_meshes.run_if(device_is_new), show_fires, flicker_lights)
                .chain()
                .after(generate_flames)
                .before(WindwoodSystems::SelectLod)
                .run_if(can_draw),
        );
    }

    fn finish(&self, app: &mut App) {
        require_renderer_before::<Self>(app, app.is_plugin_added::<MaterialPlugin<FireMaterial>>());
    }
}

/// What the entity of a fire is drawn with.
type FireMesh = (
    Mesh3d,
    MeshMaterial3d<FireMaterial>,
    MeshMaterial3d<ShelteredFireMaterial>,
    Aabb,
    NoAutoAabb,
    NotShadowCaster,
    NotShadowReceiver,
);

/// The light of a fire: a child of it, with a [`PointLight`] whose intensity flickers.
#[derive(Component, Reflect, Clone, Copy, Debug, Default)]
#[reflect(Component, Default)]
pub struct FireLight;

/// Height of the light over that of the fire: where most of the flames are.
const LIGHT_HEIGHT: f32 = 0.45;
/// Beyond this distance the light gives less than this, lx: less than a full moon.
const LEAST_ILLUMINANCE_LX: f32 = 0.1;

/// Makes the meshes of all fires again, when they lay on a graphics device that was lost. Lights stay.
fn remake_lost_meshes(mut meshes: ResMut<Assets<Mesh>>, mut fires: Query<(&Flames, &mut Mesh3d)>) {
    for (flames, mut mesh) in &mut fires {
        remove_lost_mesh(&*mesh, &mut meshes);
        mesh.0 = meshes.add(fire_mesh(flames));
    }
}

fn show_fires(
    mut commands: Commands,
    capabilities: Res<RenderCapabilities>,
    buffers: Res<SwayBuffers>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut windy: ResMut<Assets<FireMaterial>>,
    mut sheltered: ResMut<Assets<ShelteredFireMaterial>>,
    fires: Query<(Entity, &Flames, Option<&Children>), Changed<Flames>>,
    lights: Query<Entity, With<FireLight>>,
) {
    for (entity, flames, children) in &fires {
        for old in children.into_iter().flatten().filter(|child| lights.contains(**child)) {
            commands.entity(*old).despawn();
        }
        let mut fire = commands.entity(entity);
        fire.insert((
            Mesh3d(meshes.add(fire_mesh(flames))),
            bounds(flames),
            NoAutoAabb,
            NotShadowCaster,
            NotShadowReceiver,
        ));
        if capabilities.sways {
            fire.insert(MeshMaterial3d(windy.add(FireMaterial::new(flames, &buffers))));
        } else {
            fire.insert(MeshMaterial3d(sheltered.add(ShelteredFireMaterial::new(flames))));
        }
        if flames.fire.look.light_lm > 0.0 {
            let place = Transform::from_xyz(0.0, LIGHT_HEIGHT * flames.height_m, 0.0);
            fire.with_child((FireLight, point_light(flames), place));
        }
    }
}

fn point_light(flames: &Flames) -> PointLight {
    let look = &flames.fire.look;
    let [red, green, blue] = look.light_colour;
    PointLight {
        color: Color::linear_rgb(red, green, blue),
        intensity: look.light_lm,
        // A point light of I lm gives I / (4 pi r^2) lx.
        range: (look.light_lm / (4.0 * std::f32::consts::PI * LEAST_ILLUMINANCE_LX)).sqrt(),
        radius: 0.25 * flames.fire.shape.size_m,
        shadow_maps_enabled: look.casts_shadows,
        ..default()
    }
}

fn flicker_lights(
    clock: Res<WindClock>,
    fires: Query<&Flames>,
    mut lights: Query<(&ChildOf, &mut PointLight), With<FireLight>>,
) {
    for (fire, mut light) in &mut lights {
        let Ok(flames) = fires.get(fire.parent()) else { continue };
        light.intensity = flames.fire.look.light_lm * flames.flicker.level(clock.time_s);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fire_that_is_removed_takes_its_own_light_and_no_other() {
        let mut world = World::new();
        world.add_observer(remove_made::<Fire, FireLight, FireMesh>);
        let burning = |world: &mut World| {
            let fire = world.spawn((Fire::default(), NotShadowCaster)).id();
            (fire, world.spawn((FireLight, ChildOf(fire))).id())
        };
        let ((fire, light), (torch, light_of_torch)) = (burning(&mut world), burning(&mut world));
        world.entity_mut(torch).insert(ChildOf(fire));
        let pot = world.spawn(ChildOf(fire)).id();
        world.entity_mut(fire).remove::<Fire>();
        world.flush();
        assert!(world.get_entity(light).is_err(), "the light goes");
        assert!(world.get::<NotShadowCaster>(fire).is_none(), "what the fire put on its entity goes");
        assert!(world.get::<Fire>(torch).is_some() && world.get_entity(light_of_torch).is_ok(), "the torch burns on");
        assert!(world.get_entity(pot).is_ok(), "what the game has put there stays");
    }
}
