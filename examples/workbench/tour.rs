//! The first steps of a new user, by mouse and keys: a species that did not exist, a wood with a path and a clearing on a real map, and a
//! file for other programs; with a picture of each step.
//!
//! The species is made out of the maple: what is typed is every field of the shipped horse chestnut that differs, and in the end both
//! are compared.

mod fields;

use crate::{
    hand::Hand,
    options::Options,
    pictures::{look, shoot},
    studio,
    support::capture::{self, create_folder},
};
use bevy::prelude::*;
use bevy_egui::{
    EguiContext,
    egui::{Key, Modifiers, Pos2, accesskit::Role},
};
use bevy_windwood::{
    editor::{Arrangement, StageCamera, Workbench},
    prelude::*,
};
use fields::{LOOK, SHAPE, type_fields};
use std::{
    path::PathBuf,
    time::{Duration, Instant},
};

/// The species that is begun with, and the one that is made of it.
const FIRST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/species/maple.species.ron");
const MADE: &str = include_str!("../../assets/species/horse_chestnut.species.ron");
const NAME: &str = "horse_chestnut";
/// A real map, and its cells, m.
const MAP: &str = "assets/terrain/rmnp-dem-16bit.png";
const MAP_CELLS_M: [(&str, &str); 2] = [("Cell, east", "233"), ("Cell, south", "234")];
/// Longest wait for work in the background.
const TIMEOUT: Duration = Duration::from_secs(300);

/// Corners of the wood that are dragged: from where to where (x, z), from the middle of the view, m.
const CORNERS: [([f32; 2], [f32; 2]); 3] =
    [([50.0, 50.0], [78.0, 62.0]), ([50.0, -50.0], [92.0, -40.0]), ([-50.0, 50.0], [-70.0, 36.0])];
/// A path across it, and the middle of a clearing, from the middle of the view, m.
const PATH: [[f32; 2]; 7] =
    [[-75.0, 20.0], [-45.0, 12.0], [-15.0, 18.0], [10.0, 8.0], [35.0, -8.0], [60.0, -12.0], [95.0, -4.0]];
const CLEARING: [f32; 2] = [5.0, -22.0];
/// Where on the map it stands (x, z), m: a gentle slope.
const PLACE: [f32; 2] = [13_860.0, 9360.0];

/// Chooses the files that are begun with. What an earlier tour has left is removed.
///
/// # Errors
/// If the folder cannot be made.
pub fn prepare(options: &mut Options) -> Result<(), String> {
    create_folder(&options.out)?;
    options.file = FIRST.into();
    options.plan = made(options, "park.forest.ron");
    for name in ["park.forest.ron", "horse_chestnut.species.ron", "horse_chestnut.glb"] {
        // It is not there at the first time.
        let _ = std::fs::remove_file(made(options, name));
    }
    Ok(())
}

fn made(options: &Options, name: &str) -> PathBuf {
    options.out.join(name)
}

/// Goes through all steps.
///
/// # Errors
/// If a control is not where a person would look for it, or what was made is not what it should be.
pub fn run(app: &mut App, options: &Options) -> Result<(), String> {
    capture::begin(app)?;
    let target = capture::target(app, options.image.render_size());
    app.world_mut().spawn((StageCamera, capture::camera(&target), studio::projection()));
    look(app, false);
    (0..8).for_each(|_| app.update());
    // Where there is no window, nobody has asked for the names of controls.
    let world = app.world_mut();
    let mut contexts = world.query::<&mut EguiContext>();
    contexts.iter_mut(world).for_each(|mut context| context.get_mut().enable_accesskit());
    let mut tour = Tour { app, target, options, pictures: 0 };
    tour.make_species()?;
    tour.export()?;
    tour.fit_map()?;
    tour.make_wood()
}

struct Tour<'a> {
    app: &'a mut App,
    target: Handle<Image>,
    options: &'a Options,
    pictures: u32,
}

impl Tour<'_> {
    fn hand(&mut self) -> Hand<'_> {
        Hand { app: self.app }
    }

    /// A picture of what there is to be seen now.
    fn picture(&mut self, name: &str) -> Result<(), String> {
        self.pictures += 1;
        let name = format!("tour_{}_{name}", self.pictures);
        shoot(self.app, &self.target, self.options, &name)?;
        look(self.app, false);
        Ok(())
    }

    fn wait(&mut self, what: &str, mut is_there: impl FnMut(&mut Hand) -> bool) -> Result<(), String> {
        let start = Instant::now();
        while start.elapsed() < TIMEOUT {
            let mut hand = self.hand();
            if is_there(&mut hand) {
                return Ok(());
            }
            hand.app.update();
            std::thread::sleep(Duration::from_millis(2));
        }
        Err(format!("{what} did not come"))
    }

    /// Saves under a path, by the dialog.
    fn save_as(&mut self, path: PathBuf) -> Result<(), String> {
        let mut hand = self.hand();
        hand.key(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
        // The field of the dialog is the one that was not there before.
        let text = path.display().to_string();
        let field = hand.controls().into_iter().filter(|it| it.role == Role::TextInput).max_by(|a, b| {
            let in_middle = |it: &crate::hand::Control| it.at.left();
            in_middle(a).total_cmp(&in_middle(b))
        });
        hand.write(&field.ok_or("the dialog has no field")?, &text);
        if path.exists() { Ok(()) } else { Err(format!("{text} was not written")) }
    }

    fn make_species(&mut self) -> Result<(), String> {
        let wanted = Species::from_ron(MADE).map_err(|error| error.to_string())?;
        self.picture("opened")?;
        self.save_as(made(self.options, "horse_chestnut.species.ron"))?;
        type_fields(&mut self.hand(), SHAPE, &wanted)?;
        self.app.world_mut().resource_mut::<Workbench>().find_field("");
        self.picture("shape")?;
        type_fields(&mut self.hand(), LOOK, &wanted)?;
        self.hand().field("foliage.leaf", &[Role::SpinButton])?;
        self.app.world_mut().resource_mut::<Workbench>().stage.distance = 0.45;
        self.picture("leaves")?;
        let own = self.app.world().resource::<Workbench>().species().clone();
        if own != wanted {
            return Err(format!("what was made is not what is shipped:\n{own:#?}\n{wanted:#?}"));
        }
        self.hand().key(Modifiers::COMMAND, Key::S);
        let mut workbench = self.app.world_mut().resource_mut::<Workbench>();
        workbench.stage.distance = 1.0;
        workbench.find_field("");
        self.hand().press("Seasons")?;
        self.picture("seasons")?;
        self.app.world_mut().resource_mut::<Workbench>().stage.arrangement = Arrangement::One;
        Ok(())
    }

    fn export(&mut self) -> Result<(), String> {
        if self.hand().find(Role::Button, "Export…").is_err() {
            println!("without the feature `export` nothing is exported");
            return Ok(());
        }
        let path = made(self.options, "horse_chestnut.glb");
        self.hand().press("Export…")?;
        self.picture("export")?;
        // The one of the dialog is the lower of two buttons.
        let mut hand = self.hand();
        hand.press("Export")?;
        self.wait("the exported tree", |_| path.exists())
    }

    fn fit_map(&mut self) -> Result<(), String> {
        let mut hand = self.hand();
        hand.key(Modifiers::COMMAND, Key::Num3);
        hand.press("Real map")?;
        let file = hand.find(Role::TextInput, "File")?;
        hand.write(&file, MAP);
        for (name, cell_m) in MAP_CELLS_M {
            let cell = hand.find(Role::SpinButton, name)?;
            hand.write(&cell, cell_m);
        }
        hand.press("Fit")?;
        self.wait("the fit", |hand| hand.find(Role::ComboBox, "Model").is_ok())?;
        self.hand().press("Show all")?;
        self.picture("map")
    }

    fn make_wood(&mut self) -> Result<(), String> {
        self.hand().key(Modifiers::COMMAND, Key::Num2);
        self.app.world_mut().resource_mut::<Workbench>().look_at_place(PLACE.into(), 330.0, 52.0);
        let mut hand = self.hand();
        hand.press("New area")?;
        let species = hand.scroll_to(Role::TextInput, "Species")?;
        hand.write(&species, NAME);
        for (from, to) in CORNERS {
            let way = [from, to].map(|at| self.on_screen(at));
            let [Some(from), Some(to)] = way else { return Err("a corner is not in the picture".into()) };
            self.hand().drag(&[from, from.lerp(to, 0.5), to]);
        }
        let mut hand = self.hand();
        hand.press("Keep free")?;
        let brush = hand.find(Role::SpinButton, "Brush")?;
        hand.write(&brush, "3");
        let path: Option<Vec<Pos2>> = PATH.iter().map(|at| self.on_screen(*at)).collect();
        self.hand().drag(&path.ok_or("the path is not in the picture")?);
        let mut hand = self.hand();
        let brush = hand.find(Role::SpinButton, "Brush")?;
        hand.write(&brush, "16");
        let clearing = self.on_screen(CLEARING).ok_or("the clearing is not in the picture")?;
        let mut hand = self.hand();
        hand.click(clearing);
        hand.press("Move")?;
        let chosen = hand.find(Role::ComboBox, "Chosen")?;
        hand.choose_of(&chosen, "area 1")?;
        hand.key(Modifiers::COMMAND, Key::S);
        if !made(self.options, "park.forest.ron").exists() {
            return Err("the plan was not saved".into());
        }
        self.picture("wood")?;
        self.app.world_mut().resource_mut::<Workbench>().look_at_place(PLACE.into(), 150.0, 14.0);
        self.picture("walk")
    }

    /// Where a place (x, z) from the middle of the view, m, is on the screen.
    fn on_screen(&mut self, place: [f32; 2]) -> Option<Pos2> {
        let world = self.app.world_mut();
        let place = Vec2::from(PLACE) + Vec2::from(place);
        let height_m = world.query::<&Terrain>().iter(world).next()?.ground.height_m(place.as_dvec2()) as f32;
        let mut cameras = world.query_filtered::<(&Camera, &GlobalTransform), With<StageCamera>>();
        let (camera, at) = cameras.iter(world).next()?;
        let pixels = camera.world_to_viewport(at, Vec3::new(place.x, height_m, place.y)).ok()?;
        Some(Pos2::new(pixels.x, pixels.y))
    }
}
