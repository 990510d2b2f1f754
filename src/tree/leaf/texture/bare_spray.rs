//! A spray in winter: lines that do not break into dots from afar.
//!
//! Averaged mips of thin lines are faint all over, and a mask keeps the dots of them that happen to be darkest. So each mip is drawn anew:
//! its lines are no thinner than a texel, and there are fewer of them, the main shoot first and the spurs last, so that as much of the card
//! is covered as in the first.

use super::{SIZE, SprayCanvas};
use crate::{
    texture::{LinearImage, TextureData},
    tree::{
        foliage::Foliage,
        green_wood::GreenWood,
        leaf::spray::{Shoot, spray},
    },
};

/// Half the width of the thinnest line of the first mip, texels.
const THINNEST_TEXELS: f32 = 1.2;
/// The same of all others: with less, a slanting line has gaps.
const UNBROKEN_TEXELS: f32 = 0.7;
/// Length of the spur that bore a leaf, in leaves.
const SPUR: f32 = 0.4;
/// Smaller mips are averages: there is no room for a line.
const LEAST_DRAWN: usize = 8;
/// Shares of its length that the last line of a mip may have, if it is there.
const SHARES: [f32; 4] = [0.25, 0.5, 0.75, 1.0];

/// Renders the colour of the same spray in winter: its twigs, and the spurs that bore its leaves. Its mask has as much coverage in every
/// mip, so that from afar few lines stay, and these do not break.
#[must_use]
pub fn bare_spray_texture(foliage: &Foliage, green: &GreenWood, seed: u64) -> TextureData {
    let lines = lines(foliage, green, seed);
    let mut canvas = blank(foliage, lines[0].colour, SIZE);
    lines.iter().for_each(|line| canvas.twig(&line.shoot, line.colour));
    let coverage = canvas.colours.coverage();
    let sizes = std::iter::successors(Some(SIZE / 2), |size| Some(size / 2)).take_while(|size| *size >= LEAST_DRAWN);
    let smaller = sizes.map(|size| with_coverage(foliage, &lines, size, coverage));
    LinearImage::mask_texture(std::iter::once(canvas.colours).chain(smaller).collect())
}

/// A line of a bare spray.
struct Line {
    shoot: Shoot,
    colour: [f32; 3],
}

/// The lines of a spray: the main shoot, then its side shoots and then the spurs, the longest first.
fn lines(foliage: &Foliage, green: &GreenWood, seed: u64) -> Vec<Line> {
    let (shoots, leaves) = spray(&foliage.leaf, seed);
    let [twig, side_shoots] = green.of_spray(foliage.leaf.twig_colour);
    let thinnest = THINNEST_TEXELS / SprayCanvas::texels(SIZE);
    let thickened = |shoot: Shoot| Shoot { radius: shoot.radius.max(2.0 * thinnest), ..shoot };
    let spurs = leaves.iter().step_by(2).map(|leaf| {
        let tip = leaf.root + leaf.direction * (SPUR * leaf.length);
        Line { shoot: Shoot { root: leaf.root, tip, radius: thinnest }, colour: side_shoots }
    });
    let shoots = shoots
        .into_iter()
        .enumerate()
        .map(|(index, shoot)| Line { shoot: thickened(shoot), colour: if index == 0 { twig } else { side_shoots } });
    let mut shoots: Vec<Line> = shoots.collect();
    let mut spurs: Vec<Line> = spurs.collect();
    let longest_first = |a: &Line, b: &Line| b.shoot.length().total_cmp(&a.shoot.length());
    if let Some(side_shoots) = shoots.get_mut(1..) {
        side_shoots.sort_by(longest_first);
    }
    spurs.sort_by(longest_first);
    shoots.append(&mut spurs);
    shoots
}

/// A canvas of the colour of its lines, without any of them: what is between texels has that colour, too.
fn blank(foliage: &Foliage, colour: [f32; 3], size: usize) -> SprayCanvas {
    let mut canvas = SprayCanvas::new(&foliage.leaf, size);
    canvas.colours = LinearImage::filled(size, [colour[0], colour[1], colour[2], 0.0]);
    canvas
}

/// A mip of some size with the first of the lines, so many that they cover that share of it.
fn with_coverage(foliage: &Foliage, lines: &[Line], size: usize, coverage: f32) -> LinearImage {
    let thinnest = UNBROKEN_TEXELS / SprayCanvas::texels(size);
    // The first lines, and of the next one that share of its length.
    let drawn = |count: usize, share_of_next: f32| {
        let mut canvas = blank(foliage, lines[0].colour, size);
        let shares = std::iter::repeat_n(1.0, count).chain([share_of_next]);
        for (line, share) in lines.iter().zip(shares).filter(|(_, share)| *share > 0.0) {
            let Shoot { root, tip, radius } = line.shoot;
            let shoot = Shoot { root, tip: root.lerp(tip, share), radius: radius.max(thinnest) };
            canvas.twig(&shoot, line.colour);
        }
        canvas.colours
    };
    let counts: Vec<usize> = (1..=lines.len()).collect();
    let whole = counts.partition_point(|&count| drawn(count, 0.0).coverage() <= coverage);
    let end = |share: f32| {
        let image = drawn(whole, share);
        ((image.coverage() - coverage).abs(), image)
    };
    let nearer = |best: (f32, LinearImage), share| {
        let other = end(share);
        if other.0 < best.0 { other } else { best }
    };
    SHARES.into_iter().fold(end(0.0), nearer).1
}
