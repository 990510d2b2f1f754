//! The textures of barks, for every pattern.

use super::*;
use crate::tree::bark::BarkPattern;

const PATTERNS: [BarkPattern; 5] =
    [BarkPattern::Furrows, BarkPattern::Plates, BarkPattern::Strips, BarkPattern::Peeling, BarkPattern::Smooth];

/// Mean difference of the colours of two columns (or rows) of texels, 0..255.
fn difference(texture: &TextureData, first: impl Fn(usize) -> usize, second: impl Fn(usize) -> usize) -> f32 {
    let texel = |index: usize| &texture.mips[0][4 * index..4 * index + 3];
    let apart = |k: usize| -> f32 {
        texel(first(k)).iter().zip(texel(second(k))).map(|(&a, &b)| f32::from(a.abs_diff(b))).sum()
    };
    (0..SIZE).map(apart).sum::<f32>() / (3 * SIZE) as f32
}

/// A seam would differ like strangers, several times as much as neighbours do.
#[test]
fn bark_tiles_without_a_seam() {
    for pattern in PATTERNS {
        let bark = Bark { pattern, ..Bark::default() };
        let textures = bark_textures(&bark, 3);
        for texture in [&textures.base_colour, &textures.normal, &textures.surface] {
            let column = |x: usize| move |y: usize| y * SIZE + x;
            let row = |y: usize| move |x: usize| y * SIZE + x;
            let mut inside: Vec<f32> =
                (1..33).map(|k| difference(texture, column(15 * k), column(15 * k + 1))).collect();
            inside.extend((1..33).map(|k| difference(texture, row(15 * k), row(15 * k + 1))));
            let greatest = inside.into_iter().fold(0.0, f32::max);
            for across in [difference(texture, column(SIZE - 1), column(0)), difference(texture, row(SIZE - 1), row(0))]
            {
                assert!(across < 1.3 * greatest + 0.5, "{pattern:?}: {across} across the seam, {greatest} inside");
            }
        }
    }
}

#[test]
fn bark_is_determined_by_its_seed() {
    for pattern in PATTERNS {
        let bark = Bark { pattern, plates_around: 5, ..Bark::default() };
        assert_eq!(bark_textures(&bark, 1), bark_textures(&bark, 1));
        assert_ne!(bark_textures(&bark, 1), bark_textures(&bark, 2));
    }
}

#[test]
fn furrows_are_darker_and_more_closed_than_plates() {
    for pattern in [BarkPattern::Furrows, BarkPattern::Plates, BarkPattern::Strips] {
        let textures = bark_textures(&Bark { pattern, lichen: 0.0, ..Bark::default() }, 5);
        let mut texels: Vec<(u8, f32)> = textures.surface.mips[0]
            .chunks_exact(4)
            .zip(textures.base_colour.mips[0].chunks_exact(4))
            .map(|(surface, colour)| (surface[0], colour[..3].iter().map(|&channel| f32::from(channel)).sum()))
            .collect();
        texels.sort_by_key(|&(open, _)| open);
        let tenth = texels.len() / 10;
        let mean = |part: &[(u8, f32)]| part.iter().map(|&(_, light)| light).sum::<f32>() / part.len() as f32;
        let (closed, open) = (mean(&texels[..tenth]), mean(&texels[9 * tenth..]));
        assert!(closed < 0.7 * open, "{pattern:?}: {closed} in furrows, {open} on plates");
        assert!(texels[0].0 < texels[10 * tenth - 1].0);
    }
}

#[test]
fn extreme_barks_have_textures() {
    for pattern in PATTERNS {
        for plates in [1, 32] {
            let bark = Bark {
                pattern,
                plates_around: plates,
                plates_along: plates,
                winding: 2.0,
                depth: 1.0,
                lichen: 1.0,
                ..Bark::default()
            };
            bark.validate().unwrap();
            assert_eq!(bark_textures(&bark, 9).normal.mips[0].len(), 4 * SIZE * SIZE);
        }
    }
}
