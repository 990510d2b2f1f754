//! The panels of the workbench over what a camera sees, from frame to frame. Needs a Vulkan driver. Mesa's software one will do.

mod support;

use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_windwood::editor::{EditorPlugin, Workbench};
use image::RgbaImage;
use std::time::Duration;
use support::capture;

/// At this rate panels are laid out in every twentieth frame where nobody touches them.
const FRAME: Duration = Duration::from_millis(10);
const FRAMES_BETWEEN_LAYOUTS: usize = 20;
/// The window that panels are made for.
const SIZE: (u32, u32) = (1280, 720);
/// Until panels have their letters, and nothing fades in any more.
const SETTLING_FRAMES: usize = 60;
/// Differences up to this are not seen, of 255: a picture that was kept is rounded once more.
const ROUNDING: u8 = 2;

struct Bench {
    app: App,
    target: Handle<Image>,
}

impl Bench {
    fn new() -> Self {
        let mut app = support::headless_app(FRAME, None);
        app.add_plugins(EditorPlugin::default()).insert_resource(ClearColor(support::BACKGROUND));
        capture::begin(&mut app).expect("a graphics device");
        app.insert_resource(TimeUpdateStrategy::ManualDuration(FRAME));
        let target = capture::target(&mut app, SIZE);
        app.world_mut().spawn(capture::camera(&target));
        Self { app, target }
    }

    fn set_open(&mut self, is_open: bool) {
        self.app.world_mut().resource_mut::<Workbench>().is_open = is_open;
        (0..SETTLING_FRAMES).for_each(|_| capture::step(&mut self.app));
    }

    fn picture(&mut self) -> RgbaImage {
        capture::capture(&mut self.app, &self.target, SIZE).expect("a picture")
    }
}

/// Share of the picture that is not background.
fn covered(picture: &RgbaImage) -> f64 {
    let drawn = picture.pixels().filter(|pixel| !support::is_background(pixel));
    drawn.count() as f64 / f64::from(picture.width() * picture.height())
}

fn greatest_difference(one: &RgbaImage, other: &RgbaImage) -> u8 {
    one.iter().zip(other.iter()).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}

#[test]
fn panels_are_seen_in_every_frame_and_gone_once_they_are_closed() {
    let mut bench = Bench::new();
    bench.set_open(false);
    assert_eq!(covered(&bench.picture()), 0.0);
    for opened in 0..2 {
        bench.set_open(true);
        let first = bench.picture();
        assert!(covered(&first) > 0.3, "opened {opened} times before: {}", covered(&first));
        // One that is laid out anew is among them.
        for frame in 0..=FRAMES_BETWEEN_LAYOUTS {
            let next = bench.picture();
            let change = greatest_difference(&first, &next);
            assert!(change <= ROUNDING, "opened {opened} times before, frame {frame}: {change}");
        }
        bench.set_open(false);
        assert_eq!(covered(&bench.picture()), 0.0);
    }
}
