use super::*;

/// Mean difference of the colours of two columns (or rows) of texels, 0..255.
fn difference(texture: &TextureData, first: impl Fn(usize) -> usize, second: impl Fn(usize) -> usize) -> f32 {
    let texel = |index: usize| &texture.mips[0][4 * index..4 * index + 3];
    let apart = |k: usize| -> f32 {
        texel(first(k)).iter().zip(texel(second(k))).map(|(&a, &b)| f32::from(a.abs_diff(b))).sum()
    };
    (0..SIZE).map(apart).sum::<f32>() / (3 * SIZE) as f32
}

#[test]
fn bark_tiles_without_a_seam() {
    let textures = bark_textures(&Bark::default(), 3);
    for texture in [&textures.base_colour, &textures.normal] {
        let column = |x: usize| move |y: usize| y * SIZE + x;
        let row = |y: usize| move |x: usize| y * SIZE + x;
        let across_seam = difference(texture, column(SIZE - 1), column(0));
        let inside: f32 =
            (1..9).map(|k| difference(texture, column(50 * k), column(50 * k + 1))).sum::<f32>() / 8.0;
        // A seam would differ like strangers, several times as much as neighbours do.
        assert!(across_seam < 1.7 * inside, "{across_seam} across the seam, {inside} inside");
        let across_seam = difference(texture, row(SIZE - 1), row(0));
        let inside: f32 = (1..9).map(|k| difference(texture, row(50 * k), row(50 * k + 1))).sum::<f32>() / 8.0;
        assert!(across_seam < 1.7 * inside, "{across_seam} across the seam, {inside} inside");
    }
}

#[test]
fn bark_repeats_for_its_seed_only() {
    let bark = Bark { plates_around: 5, ..Bark::default() };
    assert_eq!(bark_textures(&bark, 1), bark_textures(&bark, 1));
    assert_ne!(bark_textures(&bark, 1), bark_textures(&bark, 2));
}

#[test]
fn extreme_barks_are_painted_too() {
    for plates in [1, 32] {
        let bark =
            Bark { plates_around: plates, plates_along: plates, winding: 2.0, depth: 1.0, ..Bark::default() };
        bark.validate().unwrap();
        assert_eq!(bark_textures(&bark, 9).normal.mips[0].len(), 4 * SIZE * SIZE);
    }
}
