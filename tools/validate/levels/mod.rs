//! Levels of detail of each species against the full trees, at the distances at which they change, in the wind: how much of the
//! picture they cover, their outline and colour, and how visible the cross-fade is beside the motion of the wind.

mod contact_sheet;
mod scene;

use crate::report::Report;
use bevy_windwood::{prelude::LevelOfDetail, tree::Season};
use contact_sheet::ContactSheet;
use image::RgbImage;
use scene::{Shot, TestScene};
use std::path::Path;

/// Species of all growth models.
const SPECIES: [&str; 8] =
    ["oak", "fir", "birch", "norway_spruce", "scots_pine", "poplar", "billows", "impression_summer"];
/// Species whose crowns are a few large parts on a stiff frame. They hardly move from frame to frame, so an abrupt change is large
/// beside their motion: except for the fade, their numbers are reported apart.
const COARSE_CROWNS: [&str; 2] = ["billows", "impression_summer"];
/// Points of a fade at which one frame of it is compared with the wind, as shares of its length. They reach well beyond it, for an impostor
/// goes by the height of its atlas, which is up to an eighth more than the tree's.
const FADE_POINTS: [f32; 12] = [-0.4, -0.1, 0.1, 0.3, 0.5, 0.7, 0.9, 1.1, 1.3, 1.5, 1.8, 2.1];
/// Steps of the dither.
const DITHER_STEPS: f32 = 1024.0;
/// Way of a walker in a frame, m: 1.5 m/s at 60 frames/s.
const STEP_M: f32 = 0.025;

/// Differences of one change of level.
#[derive(Default, Clone, Copy)]
struct Differences {
    /// How many more pixels the level covers, as a share of what the full tree covers.
    coverage: f64,
    /// Difference of outlines: sum over squares of a tenth of the height of the difference of covered pixels, as a share of what
    /// the full tree covers.
    outline: f64,
    /// Difference of mean colours, of 255.
    colour: f64,
    /// Greatest difference of two frames of a walker during the fade, over the difference that the wind makes in a frame.
    pop: f64,
    /// The same if the level changed at once.
    abrupt: f64,
}

/// Measures all species, or one of them, at a time of the year.
pub fn run(picture: &Path, only: Option<&str>, year: f32) -> Report {
    let mut sheet = ContactSheet::default();
    let [mut worst, mut worst_coarse, mut worst_paper] = [Differences::default(); 3];
    println!(
        "{:<18} {:<22} {:>9} {:>9} {:>9} {:>9} {:>9}",
        "species", "change", "coverage", "outline", "colour", "pop", "at once"
    );
    for species in SPECIES.into_iter().filter(|species| only.is_none_or(|only| *species == only)) {
        let mut scene = match TestScene::new(species, Season { year }) {
            Ok(scene) => scene,
            Err(error) => {
                eprintln!("{species}: {error}");
                worst.pop = f64::NAN;
                continue;
            }
        };
        sheet.begin_row();
        for change in 0..3 {
            let differences = measure_level(&mut scene, change, &mut sheet);
            print_row(species, ["full to thinned", "to sparse", "to impostor"][change], differences);
            let worst = if COARSE_CROWNS.contains(&species) { &mut worst_coarse } else { &mut worst };
            *worst = worst.worse(differences);
        }
        for level in 0..2 {
            let differences = measure_paper_level(&mut scene, level, &mut sheet);
            print_row(species, ["paper: envelope", "paper: four polygons"][level], differences);
            worst_paper = worst_paper.worse(differences);
        }
    }
    match sheet.save(picture) {
        Ok(()) => println!("sheet: {}", picture.display()),
        Err(error) => eprintln!("{}: {error}", picture.display()),
    }
    let mut report = Report::default();
    report.at_most(
        "pop_ratio_worst",
        worst.worse(worst_coarse).pop,
        1.0,
        "what a fade changes in a frame of a walker, over what the wind does",
    );
    report.record("abrupt_ratio_worst", worst.abrupt, "the same if levels changed at once");
    report.record(
        "abrupt_ratio_coarse_crowns",
        worst_coarse.abrupt,
        "of crowns of a few large parts, which hardly move",
    );
    report.record("coverage_difference_coarse_crowns", worst_coarse.coverage.abs(), "of crowns of a few large parts");
    report.record("colour_difference_coarse_crowns", worst_coarse.colour, "of crowns of a few large parts");
    report.record(
        "coverage_difference_worst",
        worst.coverage.abs(),
        "of a coarser level, as a share of the full tree's",
    );
    report.record(
        "outline_difference_worst",
        worst.outline,
        "by squares of a tenth of a tree, as a share of the full tree's",
    );
    report.record("colour_difference_worst", worst.colour, "of mean colours, of 255");
    report.record("paper_coverage_difference_worst", worst_paper.coverage.abs(), "the paper's levels");
    report.record("paper_colour_difference_worst", worst_paper.colour, "the paper's levels");
    report
}

fn print_row(species: &str, change: &str, Differences { coverage, outline, colour, pop, abrupt }: Differences) {
    println!("{species:<18} {change:<22} {coverage:>+9.3} {outline:>9.3} {colour:>9.1} {pop:>9.2} {abrupt:>9.2}");
}

/// Measures one of the three changes of our levels.
fn measure_level(scene: &mut TestScene, change: usize, sheet: &mut ContactSheet) -> Differences {
    scene.set_size_px(scene.switching_px()[change]);
    let full = scene.render(Shot::Full);
    let later = scene.render_next_frame(Shot::Full);
    let finer = if change == 0 { full.clone() } else { scene.render(Shot::Level(change)) };
    let coarser = scene.render(Shot::Level(change + 1));
    sheet.add(&full, scene.crop());
    sheet.add(&coarser, scene.crop());
    let wind = difference(&full, &later);
    let LevelOfDetail { fade, impostor_fade, .. } = LevelOfDetail::default();
    let fade = if change == 2 { impostor_fade } else { fade };
    // A frame changes at least one step of the dither.
    let step = (2.0 * fade / DITHER_STEPS).max(STEP_M / scene.distance_m());
    let mut pop = 0.0_f64;
    for point in FADE_POINTS {
        let at = 1.0 - fade + 2.0 * fade * point;
        let [before, after] = [at, at + step].map(|share| scene.render(Shot::Fading(change, share)));
        pop = pop.max(difference(&before, &after) / wind);
    }
    Differences { pop, abrupt: difference(&finer, &coarser) / wind, ..compare(&full, &coarser, scene.tenth_px()) }
}

/// Measures one of the levels of the paper.
fn measure_paper_level(scene: &mut TestScene, level: usize, sheet: &mut ContactSheet) -> Differences {
    scene.set_size_px(scene.switching_px()[2 * level]);
    let full = scene.render(Shot::Full);
    let coarser = scene.render(Shot::Paper(level + 1));
    sheet.add(&coarser, scene.crop());
    compare(&full, &coarser, scene.tenth_px())
}

impl Differences {
    /// The worse of each.
    fn worse(self, other: Self) -> Self {
        Self {
            coverage: if other.coverage.abs() > self.coverage.abs() { other.coverage } else { self.coverage },
            outline: self.outline.max(other.outline),
            colour: self.colour.max(other.colour),
            pop: if self.pop.is_nan() { self.pop } else { self.pop.max(other.pop) },
            abrupt: self.abrupt.max(other.abrupt),
        }
    }
}

/// Coverage, outline and colour of a level against the full trees.
fn compare(full: &RgbImage, level: &RgbImage, tenth_px: u32) -> Differences {
    let (squares, others) = (squares(full, tenth_px), squares(level, tenth_px));
    let (full, level) = (covered(full), covered(level));
    let moved: u32 = squares.iter().zip(&others).map(|(one, other)| one.abs_diff(*other)).sum();
    let outline = f64::from(moved) / full.0.max(1.0);
    let coverage = level.0 / full.0.max(1.0) - 1.0;
    let apart = full.1.iter().zip(level.1).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
    Differences { coverage, outline, colour: (apart / 3.0).sqrt(), ..Differences::default() }
}

/// Number of pixels that are not background, and their mean colour.
fn covered(picture: &RgbImage) -> (f64, [f64; 3]) {
    let drawn = || picture.pixels().filter(|pixel| !scene::is_background(pixel));
    let count = drawn().count() as f64;
    let mean = [0, 1, 2].map(|channel| drawn().map(|pixel| f64::from(pixel.0[channel])).sum::<f64>() / count.max(1.0));
    (count, mean)
}

/// Number of pixels of each square that are not background.
fn squares(picture: &RgbImage, side_px: u32) -> Vec<u32> {
    let across = picture.width().div_ceil(side_px);
    let mut squares = vec![0; (across * picture.height().div_ceil(side_px)) as usize];
    for (x, y, pixel) in picture.enumerate_pixels() {
        squares[(y / side_px * across + x / side_px) as usize] += u32::from(!scene::is_background(pixel));
    }
    squares
}

/// Mean difference of two pictures, of 255.
fn difference(one: &RgbImage, other: &RgbImage) -> f64 {
    let sum: u64 = one.iter().zip(other.iter()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    (sum as f64 / one.len() as f64).max(1e-6)
}
