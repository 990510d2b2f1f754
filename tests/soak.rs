//! A game that goes on and on: it walks, teleports, fells, plants, changes the wind, lets trees come and go, all at random. Every minute of its
//! time it goes home and puts everything away. What is there then must be what was there before: entities, handles, memory, buffers on the
//! GPU. Needs a Vulkan driver. Mesa's software one will do.
//!
//! ```sh
//! cargo test --test soak -- --ignored --nocapture        # an hour of the game's time
//! SOAK_MINUTES=10 cargo test --test soak -- --ignored    # another time
//! ```

#[path = "soak/census.rs"]
mod census;
#[path = "soak/game.rs"]
mod game;
mod support;

use census::Census;
use game::Game;

/// What a minute is in the short run, s of the game's time.
const SHORT_MINUTE_S: f32 = 8.0;
/// Of the minutes, the first so many fill caches: of pipelines, of allocators, of levels of detail.
const WARM_UP_MINUTES: usize = 4;

/// Plays so many minutes, and counts after each.
fn play(minutes: usize, minute_s: f32) -> Vec<Census> {
    let mut game = Game::new(7);
    let counts = |minute: usize| {
        game.play(minute_s);
        game.go_home();
        let census = Census::take(&mut game.app);
        println!("minute {minute}: {census:?}");
        census
    };
    (0..minutes).map(counts).collect()
}

/// Growth per minute, of values at minutes 0, 1, 2 and so on: the median of the slopes between any two of them (Theil 1950, Sen 1968). A leak
/// is in all of these. Least squares would take a step for growth: of nothing that is counted here or is on the GPU, allocators take some
/// 10 or 40 MB at once.
fn slope(values: &[f64]) -> f64 {
    let later = |(from, &value): (usize, &f64)| {
        let slopes = values.iter().enumerate().skip(from + 1);
        slopes.map(move |(to, &other)| (other - value) / (to - from) as f64).collect::<Vec<f64>>()
    };
    median(values.iter().enumerate().flat_map(later).collect())
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// The median of what is added from minute to minute: what leaks does so in most of them. Slopes over few minutes would take a single
/// step for growth.
fn median_step(values: &[f64]) -> f64 {
    median(values.windows(2).map(|pair| pair[1] - pair[0]).collect())
}

/// What is counted is in the end what it was, and never more than a hundredth off. Memory has allocators below it, which keep what they get:
/// it must not grow by more than so much a minute.
fn assert_flat(censuses: &[Census], growth: fn(&[f64]) -> f64, [most_resident, most_gpu]: [f64; 2]) {
    let first = &censuses[0];
    for (minute, census) in censuses.iter().enumerate() {
        for (what, count) in &census.counts {
            let before = first.counts[what];
            assert!(
                count.abs_diff(before) * 100 <= before,
                "{count} {what} in minute {minute} after the warm-up, and {before} before"
            );
        }
    }
    assert_eq!(censuses.last().map(|last| &last.counts), Some(&first.counts));
    let resident: Vec<f64> = censuses.iter().map(|census| census.resident_bytes as f64).collect();
    let gpu: Vec<f64> = censuses.iter().map(|census| census.gpu_bytes as f64).collect();
    let [resident, gpu] = [resident, gpu].map(|values| growth(&values));
    println!("growth: resident memory {resident:.0} B/min, GPU {gpu:.0} B/min");
    assert!(resident < most_resident, "resident memory grows by {resident} B/min");
    assert!(gpu < most_gpu, "GPU memory grows by {gpu} B/min");
}

#[test]
fn a_game_that_goes_home_has_what_it_had() {
    let censuses = play(WARM_UP_MINUTES + 4, SHORT_MINUTE_S);
    assert_flat(&censuses[WARM_UP_MINUTES..], median_step, [1e6, 100e3]);
}

#[test]
#[ignore = "a long run: an hour of the game's time, a quarter of an hour"]
fn an_hour_leaves_nothing_behind() {
    let minutes = std::env::var("SOAK_MINUTES").ok().and_then(|text| text.parse().ok()).unwrap_or(60);
    let censuses = play(minutes, 60.0);
    assert_flat(&censuses[minutes / 4..], slope, [200e3, 20e3]);
}

#[test]
fn the_slope_of_a_line_is_its_slope() {
    let line: Vec<f64> = (0..10).map(|at| 5.0 - 3.0 * f64::from(at)).collect();
    assert!((slope(&line) + 3.0).abs() < 1e-12);
    assert_eq!(slope(&[4.0; 7]), 0.0);
    // A leak is found among steps that are a hundred times as large, and steps alone are none.
    let stepping = |leak: f64| -> Vec<f64> {
        (0..45).map(|at| leak * f64::from(at) + if at % 3 == 0 || at % 7 == 2 { 40.0 } else { 0.0 }).collect()
    };
    assert!((slope(&stepping(0.4)) - 0.4).abs() < 0.1 && slope(&stepping(0.0)).abs() < 0.1);
    assert_eq!((median_step(&line), median_step(&[1.0, 1.0, 1.0, 9.0])), (-3.0, 0.0));
}
