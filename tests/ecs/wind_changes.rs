//! From one wind to the next.

use super::*;

/// Whether a wind of that speed has begun.
pub fn blows_at(world: &World, speed_m_s: f32) -> bool {
    world.resource::<ActiveSway>().now().any(|wind| wind.response.field.settings().speed == speed_m_s)
}

#[test]
fn trees_and_wind_cells_change_to_a_new_wind_together() {
    let mut app = app();
    let place = Vec3::new(12.0, 10.0, 31.0);
    wait_for_wind(&mut app);
    // A wind that is asked for while another one fades in follows it.
    for speed in [16.0, 4.0] {
        app.world_mut().resource_mut::<Wind>().speed = speed;
        let mut between = 0;
        for _ in 0..6000 {
            app.update();
            let world = app.world();
            let (wind, time_s) = (world.resource::<ActiveWind>(), world.resource::<WindClock>().time_s);
            let winds = world.resource::<ActiveSway>().now();
            let of_trees: Vec3 = winds.map(|wind| wind.weight * wind.response.field.sample(place, time_s)).sum();
            // Two roundings of some 16 m/s.
            assert!(wind.sample(place, time_s).distance(of_trees) < 1e-5);
            between += u32::from(world.resource::<ActiveSway>().now().count() == 2);
            let is_done = if speed == 4.0 { wind.is_settled() && blows_at(world, 4.0) } else { between == 20 };
            if is_done {
                break;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        assert!(between > 0, "no wind of {speed} m/s faded in");
    }
    assert!(blows_at(app.world(), 4.0));
}

#[test]
fn other_sway_settings_fade_in_with_the_same_field() {
    let mut app = app();
    wait_for_wind(&mut app);
    app.world_mut().resource_mut::<SwaySettings>().damping_ratio = 0.4;
    wait_until(&mut app, "other tables", |world| world.resource::<ActiveSway>().now().count() == 2);
    let fields: Vec<_> = app.world().resource::<ActiveSway>().now().map(|wind| wind.response.field.clone()).collect();
    assert!(std::sync::Arc::ptr_eq(&fields[0], &fields[1]));
    (0..100).for_each(|_| app.update());
    assert!(app.world().resource::<ActiveSway>().is_settled() && app.world().resource::<ActiveWind>().is_settled());
}

/// Frames in which a system sees [`ActiveWind`] as changed.
#[derive(Resource, Default)]
struct ChangedFrames(u32);

#[test]
fn active_wind_counts_as_changed_only_while_it_changes() {
    let mut app = app();
    app.init_resource::<ChangedFrames>().add_systems(
        Update,
        |wind: Res<ActiveWind>, mut frames: ResMut<ChangedFrames>| {
            frames.0 += u32::from(wind.is_changed());
        },
    );
    wait_until(&mut app, "the wind", |world| world.resource::<ActiveWind>().is_settled());
    let changed_frames = |app: &mut App, frames: u32| {
        app.world_mut().resource_mut::<ChangedFrames>().0 = 0;
        (0..frames).for_each(|_| app.update());
        app.world().resource::<ChangedFrames>().0
    };
    assert_eq!(changed_frames(&mut app, 50), 0, "nothing changes");

    app.world_mut().resource_mut::<Wind>().speed = 12.0;
    wait_until(&mut app, "the new wind", |world| blows_at(world, 12.0));
    // The fade takes 3 s, 90 frames.
    assert_eq!(changed_frames(&mut app, 60), 60, "the fade runs");
    assert!(changed_frames(&mut app, 60) < 60, "the fade has ended");
    assert!(app.world().resource::<ActiveWind>().is_settled());
    assert_eq!(changed_frames(&mut app, 50), 0, "nothing changes");
}
