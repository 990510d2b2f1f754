//! The levels of detail of each species beside the full trees, at the distances at which they change, in the wind: how much
//! of the picture they cover, their colour, and whether the eye can tell the moment of the change from the wind's own motion.

mod sheet;
mod stand;

use crate::report::Report;
use bevy_windwood::tree::Season;
use image::RgbImage;
use sheet::Sheet;
use stand::{Shot, Stand};
use std::path::Path;

/// Species of all kinds of growth.
const SPECIES: [&str; 8] =
    ["oak", "fir", "birch", "norway_spruce", "scots_pine", "poplar", "billows", "impression_summer"];
/// Painters' crowns: a few large parts on a stiff frame, which from one frame to the next stand as good as still. But for the
/// pop, their changes are told apart: beside next to no motion any change at once is large.
const PAINTED: [&str; 2] = ["billows", "impression_summer"];
/// Moments of a fade at which a frame of it is compared with the wind, as shares of its way.
const MOMENTS: [f32; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];
/// A step of the dither is a 1024th of the fade, which takes a fifth of the distance.
const STEP: f32 = 0.2 / 1024.0;
/// What a walker makes in a frame, m: 1.5 m/s at 60 frames/s.
const PACE_M: f32 = 0.025;

/// What is found of one change.
#[derive(Default, Clone, Copy)]
struct Found {
    /// How much more or less of the picture the lower level covers, as a share of what the full tree covers.
    coverage: f64,
    /// How its outline differs: that much of what the full tree covers lies elsewhere, or is missing, by squares of a tenth
    /// of its height.
    outline: f64,
    /// How its mean colour differs, of 255.
    colour: f64,
    /// The greatest difference of two frames of a walker while it fades, over the wind's own from frame to frame.
    pop: f64,
    /// The difference if it changed at once, over the wind's own.
    abrupt: f64,
}

/// All species, or one of them, at a time of the year.
pub fn run(picture: &Path, only: Option<&str>, year: f32) -> Report {
    let mut sheet = Sheet::default();
    let [mut worst, mut worst_painted, mut worst_paper] = [Found::default(); 3];
    println!(
        "{:<18} {:<22} {:>9} {:>9} {:>9} {:>9} {:>9}",
        "species", "change", "coverage", "outline", "colour", "pop", "at once"
    );
    for species in SPECIES.into_iter().filter(|species| only.is_none_or(|only| *species == only)) {
        let mut stand = match Stand::new(species, Season { year }) {
            Ok(stand) => stand,
            Err(error) => {
                eprintln!("{species}: {error}");
                worst.pop = f64::NAN;
                continue;
            }
        };
        sheet.begin();
        for change in 0..3 {
            let found = ours(&mut stand, change, &mut sheet);
            tell(species, ["full to thinned", "to sparse", "to card"][change], found);
            let worst = if PAINTED.contains(&species) { &mut worst_painted } else { &mut worst };
            *worst = worst.worse(found);
        }
        for level in 0..2 {
            let found = papers(&mut stand, level, &mut sheet);
            tell(species, ["paper: envelope", "paper: four polygons"][level], found);
            worst_paper = worst_paper.worse(found);
        }
    }
    match sheet.save(picture) {
        Ok(()) => println!("sheet: {}", picture.display()),
        Err(error) => eprintln!("{}: {error}", picture.display()),
    }
    let mut report = Report::default();
    report.at_most(
        "pop_ratio_worst",
        worst.worse(worst_painted).pop,
        1.0,
        "what a fade changes in a walker's frame over what the wind does",
    );
    report.tell("abrupt_ratio_worst", worst.abrupt, "the same if levels changed at once");
    report.tell("abrupt_ratio_painted", worst_painted.abrupt, "of painters' crowns, which hardly move");
    report.tell("coverage_difference_painted", worst_painted.coverage, "painters' crowns");
    report.tell("colour_difference_painted", worst_painted.colour, "painters' crowns");
    report.tell("coverage_difference_worst", worst.coverage, "of a lower level, as a share of the full tree's");
    report.tell(
        "outline_difference_worst",
        worst.outline,
        "by squares of a tenth of a tree, as a share of the full tree's",
    );
    report.tell("colour_difference_worst", worst.colour, "of mean colours, of 255");
    report.tell("paper_coverage_difference_worst", worst_paper.coverage, "the paper's levels");
    report.tell("paper_colour_difference_worst", worst_paper.colour, "the paper's levels");
    report
}

fn tell(species: &str, change: &str, Found { coverage, outline, colour, pop, abrupt }: Found) {
    println!("{species:<18} {change:<22} {coverage:>9.3} {outline:>9.3} {colour:>9.1} {pop:>9.2} {abrupt:>9.2}");
}

/// One of the three changes of our own levels.
fn ours(stand: &mut Stand, change: usize, sheet: &mut Sheet) -> Found {
    stand.stand_back(stand.switching_px()[change]);
    let full = stand.shoot(Shot::Full);
    let later = stand.shoot_later(Shot::Full);
    let finer = if change == 0 { full.clone() } else { stand.shoot(Shot::Level(change)) };
    let coarser = stand.shoot(Shot::Level(change + 1));
    sheet.add(&full, stand.crop());
    sheet.add(&coarser, stand.crop());
    let wind = difference(&full, &later);
    // What changes in a frame is a step of the dither at least.
    let step = STEP.max(PACE_M / stand.distance_m());
    let mut pop = 0.0_f64;
    for moment in MOMENTS {
        // A card comes before its tree goes: both fades lie one after the other.
        let (from, way) = if change == 2 { (0.78, 0.6) } else { (0.9, 0.2) };
        let at = from + way * moment;
        let [before, after] = [at, at + step].map(|share| stand.shoot(Shot::Fading(change, share)));
        pop = pop.max(difference(&before, &after) / wind);
    }
    Found { pop, abrupt: difference(&finer, &coarser) / wind, ..compare(&full, &coarser, stand.tenth_px()) }
}

/// One of the paper's lower levels.
fn papers(stand: &mut Stand, level: usize, sheet: &mut Sheet) -> Found {
    stand.stand_back(stand.switching_px()[2 * level]);
    let full = stand.shoot(Shot::Full);
    let lower = stand.shoot(Shot::Paper(level + 1));
    sheet.add(&lower, stand.crop());
    compare(&full, &lower, stand.tenth_px())
}

impl Found {
    fn worse(self, other: Self) -> Self {
        Self {
            coverage: self.coverage.max(other.coverage),
            outline: self.outline.max(other.outline),
            colour: self.colour.max(other.colour),
            pop: if self.pop.is_nan() { self.pop } else { self.pop.max(other.pop) },
            abrupt: self.abrupt.max(other.abrupt),
        }
    }
}

/// Coverage, outline and colour of a level beside the full trees.
fn compare(full: &RgbImage, level: &RgbImage, tenth_px: u32) -> Found {
    let (squares, others) = (squares(full, tenth_px), squares(level, tenth_px));
    let (full, level) = (covered(full), covered(level));
    let moved: u32 = squares.iter().zip(&others).map(|(one, other)| one.abs_diff(*other)).sum();
    let outline = f64::from(moved) / full.0.max(1.0);
    let coverage = (level.0 / full.0.max(1.0) - 1.0).abs();
    let apart = full.1.iter().zip(level.1).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
    Found { coverage, outline, colour: (apart / 3.0).sqrt(), ..Found::default() }
}

/// Number of pixels that are not background, and their mean colour.
fn covered(picture: &RgbImage) -> (f64, [f64; 3]) {
    let drawn = || picture.pixels().filter(|pixel| !stand::is_background(pixel));
    let count = drawn().count() as f64;
    let mean = [0, 1, 2].map(|channel| drawn().map(|pixel| f64::from(pixel.0[channel])).sum::<f64>() / count.max(1.0));
    (count, mean)
}

/// Pixels of each square that are not background.
fn squares(picture: &RgbImage, side_px: u32) -> Vec<u32> {
    let across = picture.width().div_ceil(side_px);
    let mut squares = vec![0; (across * picture.height().div_ceil(side_px)) as usize];
    for (x, y, pixel) in picture.enumerate_pixels() {
        squares[(y / side_px * across + x / side_px) as usize] += u32::from(!stand::is_background(pixel));
    }
    squares
}

/// Mean difference of two pictures, of 255.
fn difference(one: &RgbImage, other: &RgbImage) -> f64 {
    let sum: u64 = one.iter().zip(other.iter()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    (sum as f64 / one.len() as f64).max(1e-6)
}
