//! A birch, a hazel and a few others by a meadow.

use crate::{
    actors::{Ask, Struck, act, follow_script, roll_ball, spawn_actors},
    options::{Event, Options},
    support::{daylight::Daylight, options::SceneOptions, scene::Scene},
    window,
};
use bevy::prelude::*;
use bevy_windwood::prelude::*;

/// What the scene is made from.
#[derive(Resource)]
pub struct BlastScene {
    pub options: Options,
}

impl BlastScene {
    /// Whether something is there: in pictures only what they are about, in the window everything.
    pub fn shows(&self, event: Event) -> bool {
        self.options.event == event || !self.options.scene.image.headless
    }
}

impl Scene for BlastScene {
    const TITLE: &'static str = "bevy_windwood: blast and axe";
    const SPEEDS_M_S: [f32; 2] = [4.0, 16.0];
    const RUNS: bool = true;

    fn options(&self) -> &SceneOptions {
        &self.options.scene
    }

    fn wind(&self) -> Wind {
        Wind { direction: Dir2::X, ..default() }
    }

    fn picture_name(&self) -> &'static str {
        match self.options.event {
            Event::Blast => "blast",
            Event::Axe => "axe",
            Event::Ball => "ball",
            Event::Helicopter => "helicopter",
        }
    }

    fn camera_transform(&self) -> Transform {
        let (eye, target) = match self.options.event {
            Event::Blast => (Vec3::new(2.5, 2.2, 16.0), Vec3::new(0.6, 3.4, 0.0)),
            Event::Axe => (Vec3::new(4.0, 2.0, 14.0), Vec3::new(0.0, 5.0, 0.0)),
            Event::Ball => (Vec3::new(0.2, 2.7, 11.6), Vec3::new(1.2, 0.7, 6.0)),
            Event::Helicopter => (Vec3::new(1.5, 2.4, 19.5), Vec3::new(0.0, 2.2, 2.0)),
        };
        Transform::from_translation(eye).looking_at(target, Vec3::Y)
    }

    fn camera_effects(&self) -> impl Bundle + use<> {
        Daylight::AFTERNOON.haze(900.0)
    }

    fn plugin(app: &mut App) {
        app.add_message::<Ask>()
            .add_systems(Startup, (spawn_scene, spawn_actors))
            .add_systems(Update, (follow_script, act, roll_ball).chain());
    }

    fn window_plugin(app: &mut App) {
        window::plugin(app);
    }

    fn is_spawned(&self, world: &mut World) -> Result<bool, String> {
        Ok(world.query::<&Tree>().iter(world).next().is_some())
    }
}

/// Spawns everything but the camera and those who act.
fn spawn_scene(
    mut commands: Commands,
    scene: Res<BlastScene>,
    assets: Res<AssetServer>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let earth = StandardMaterial {
        base_color: Color::srgb(0.24, 0.26, 0.12),
        perceptual_roughness: 1.0,
        reflectance: 0.05,
        ..default()
    };
    commands.spawn((
        Mesh3d(meshes.add(Plane3d::default().mesh().size(600.0, 600.0))),
        MeshMaterial3d(materials.add(earth)),
    ));
    let seed = scene.options.scene.wind.seed;
    let tuft = Tuft { shortest_m: 0.2, longest_m: 0.65, narrowest_m: 0.006, widest_m: 0.012, ..default() };
    let sward = Sward { width_m: 26.0, depth_m: 18.0, tufts_per_m2: 16.0, tuft, seed, ..default() };
    let look = GrassLook { thins_from_m: 14.0, ..default() };
    commands.spawn((
        GrassPatch { sward, look, ..default() },
        Transform::from_xyz(0.0, 0.0, 5.0),
        bevy::light::NotShadowCaster,
    ));
    spawn_trees(&mut commands, &assets);
    Daylight::AFTERNOON.spawn(&mut commands, &mut meshes, &mut materials, (Vec3::ZERO, 2000.0), (18.0, 60.0));
}

fn spawn_trees(commands: &mut Commands, assets: &AssetServer) {
    let tree = |species: &str| Tree::new(assets.load(format!("species/{species}.species.ron")));
    let birch = tree("birch").with_seed(3).with_age(14.0);
    commands.spawn((Struck, birch, Transform::default()));
    commands.spawn((tree("hazel").with_seed(2).with_age(8.0), Transform::from_xyz(2.4, 0.0, 5.6)));
    for (species, age_years, x, z) in [
        ("hazel", 12.0, 8.0, -1.5),
        ("birch", 25.0, -7.5, -9.0),
        ("scots_pine", 30.0, 7.5, -11.0),
        ("birch", 20.0, 15.0, -8.0),
        ("hawthorn", 10.0, -4.0, -4.0),
    ] {
        commands.spawn((tree(species).with_age(age_years), Transform::from_xyz(x, 0.0, z)));
    }
}
