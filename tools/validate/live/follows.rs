//! A live tree, driven step by step by the load of the periodic wind, against the table, which is computed in the frequency domain.
//!
//! The load is worked out here: basis signals of the wind's column, the admittance of the crowns, frequency by frequency, and samples at the
//! frame rate. A beam of two natural frequencies is two here, each with its share: in gusts both have the same size but not the same
//! oscillators of the table, of which each stands for a load of its own. That live ones of two frequencies are the sum of two is the matter of a unit
//! test.

use crate::report::Report;
use bevy::math::{Vec3, Vec3A, Vec4};
use bevy_windwood::{
    dynamics::{
        BeamDynamics, BeamLoad, BeamSway, LiveBeam, LiveSteps, LiveTree, RowWeights, SLOPE_TIP, SecondMode, TablePlace,
    },
    sway::{SwaySettings, WindResponse},
    tree::{Species, TreeModel},
    wind::{FieldSettings, WindField},
};
use rustfft::{FftPlanner, num_complex::Complex};
use std::{collections::BTreeMap, sync::Arc};

/// Frames in a sample of the wind: 64 a second.
const FRAMES: usize = 4;
/// Sizes and damping ratios of the grid, in the order of its rows.
const SIZES: usize = 3;
const DAMPINGS: usize = 2;

pub fn run(report: &mut Report) {
    let (mut square, mut size) = (0.0, 0.0);
    let (mut slow, mut all) = (0, 0);
    for species in ["oak", "fir", "hazel"] {
        match Experiment::new(species).map(|it| it.run()) {
            Ok(found) => {
                square += found.square;
                size += found.size;
                slow += found.slow;
                all += found.all;
            }
            Err(error) => {
                eprintln!("live: {species}: {error}");
                square = f64::NAN;
            }
        }
    }
    report.at_most(
        "live_vs_table_rms",
        (square / size).sqrt(),
        0.01,
        "angles of oak, fir and hazel in 8 m/s, relative rms",
    );
    report.record("live_vs_table_beams", slow as f64 / all as f64, "share of the beams compared: those up to 3.6 Hz");
}

/// Sums over beams and times of squared angles: of the difference, and of the table's; and beams.
struct Found {
    square: f64,
    size: f64,
    slow: usize,
    all: usize,
}

struct Experiment {
    wind: WindResponse,
    model: TreeModel,
    /// Of the first column, sample by sample.
    signals: Vec<Vec4>,
}

/// A beam for each natural frequency of this one, with its share of the motion. `ratio` is that of neighbouring classes.
fn modes(beam: &BeamDynamics, ratio: f32) -> impl Iterator<Item = BeamDynamics> {
    let (sway, second) = (beam.in_leaf, beam.in_leaf.second);
    let mode = |class_offset: f32, share: f32| {
        let faster = ratio.powf(class_offset);
        let in_leaf = BeamSway {
            gain: share * sway.gain,
            class: sway.class + class_offset,
            averaging_speed_m_s: sway.averaging_speed_m_s * faster,
            drag_damping_s_m: sway.drag_damping_s_m / faster,
            second: SecondMode::default(),
            ..sway
        };
        BeamDynamics { in_leaf, bare: in_leaf, ..*beam }
    };
    let both = [mode(0.0, 1.0 - second.share), mode(second.class_offset, second.share)];
    both.into_iter().take(if second.share > 0.0 { 2 } else { 1 })
}

/// How a beam follows signals: free angle by each, rad.
struct Follower {
    moving: [Vec3; 4],
    read: RowWeights,
}

impl Follower {
    fn angle(&self, signals: Vec4) -> Vec3A {
        let [a, b, c, d] = self.moving;
        (a * signals.x + b * signals.y + c * signals.z + d * signals.w).into()
    }

    /// Class and smaller size of its rows, and the weight of the larger.
    fn felt(&self) -> (usize, usize, f32) {
        let first = self.read.rows[0] as usize / DAMPINGS;
        (first / SIZES, first % SIZES, self.read.weights[2] + self.read.weights[3])
    }
}

impl Experiment {
    fn new(species: &str) -> Result<Self, String> {
        let path = format!("{}/assets/species/{species}.species.ron", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(&path).map_err(|error| format!("{path}: {error}"))?;
        let species = Species::from_ron(&text).map_err(|error| error.to_string())?;
        let model = TreeModel::bake(&species, species.age.mature_years, 1);
        let field = WindField::synthesise(&FieldSettings::default()).map_err(|error| error.to_string())?;
        let settings = SwaySettings::default();
        let mut velocities = Vec::new();
        field.column_velocities(0, settings.reference_height_m, &mut velocities);
        let wind = WindResponse::new(Arc::new(field), &settings);
        let signals = velocities.into_iter().map(|velocity| wind.basis.signals(velocity)).collect();
        Ok(Self { wind, model, signals })
    }

    fn run(&self) -> Found {
        let (beam_wind, frame) = (self.wind.beam_wind(), self.wind.field.frame());
        let first_fast = beam_wind.grid.classes.first_fast();
        let is_slow = |beam: &BeamDynamics| beam_wind.grid.classes.nearest(beam.in_leaf.class) < first_fast;
        let modes: Vec<BeamDynamics> =
            self.model.beams.iter().flat_map(|beam| modes(beam, beam_wind.grid.classes.ratio)).collect();
        let beams: Vec<&BeamDynamics> = modes.iter().filter(|beam| is_slow(beam)).collect();
        let prepared: Vec<LiveBeam> = beams.iter().map(|beam| LiveBeam::new(beam, &beam_wind, 1.0, 1.0)).collect();
        let followers: Vec<Follower> = beams
            .iter()
            .map(|beam| {
                let load = self.wind.basis.coefficients(frame.wind_from_world() * beam.direction);
                let answer = beam.in_leaf.answer(&beam_wind, 1.0);
                Follower { moving: load.moving.map(|moving| moving * SLOPE_TIP * answer.gust_gain), read: answer.read }
            })
            .collect();
        let mut felt: BTreeMap<(usize, usize), Vec<Vec4>> = BTreeMap::new();
        for (class, first, _) in followers.iter().map(Follower::felt) {
            for size in [first, first + 1] {
                felt.entry((class, size)).or_insert_with(|| self.felt_signals(class, size));
            }
        }
        let load = |follower: &Follower, frame: usize| {
            let (class, size, larger) = follower.felt();
            let at = |size: usize| felt[&(class, size)][frame];
            follower.angle(at(size).lerp(at(size + 1), larger))
        };
        let mut live = LiveTree::new(&prepared, &beam_wind.grid);
        let frames = self.signals.len() * FRAMES;
        let frame_s = self.wind.table.period_s() / frames as f64;
        let Some(steps) = LiveSteps::new(&beam_wind.grid, frame_s) else { unreachable!("a frame takes time") };
        let mut found = Found { square: 0.0, size: 0.0, slow: beams.len(), all: modes.len() };
        // In the first period it comes into the steady state that the table has.
        for frame in 1..=2 * frames {
            live.step(&prepared, &steps, |beam, _| BeamLoad {
                steady: Some(load(&followers[beam], frame % frames)),
                pulse: Vec3A::ZERO,
            });
            if frame > frames && frame % FRAMES == 0 {
                let place = TablePlace::on_column(0, frame as f64 * frame_s);
                for (beam, follower) in followers.iter().enumerate() {
                    let expected = follower.angle(self.response(&follower.read, &place));
                    found.square += f64::from(live.angle(beam).distance_squared(expected));
                    found.size += f64::from(expected.length_squared());
                }
            }
        }
        found
    }

    fn response(&self, read: &RowWeights, place: &TablePlace) -> Vec4 {
        let rows = read.rows.iter().zip(read.weights);
        rows.map(|(row, weight)| self.wind.table.response(*row as usize, place) * weight).sum()
    }

    /// The signals as what is of that size feels them, frame by frame.
    fn felt_signals(&self, class: usize, size: usize) -> Vec<Vec4> {
        let (samples, frames) = (self.signals.len(), self.signals.len() * FRAMES);
        let bin_hz = 1.0 / self.wind.table.period_s();
        let admittances: Vec<f64> = self.wind.table.grid.admittances(class, size, bin_hz).take(samples / 2).collect();
        let mut planner = FftPlanner::new();
        let (to_bins, to_time) = (planner.plan_fft_forward(samples), planner.plan_fft_inverse(frames));
        let components: [Vec<f64>; 4] = std::array::from_fn(|component| {
            let mut bins: Vec<Complex<f64>> =
                self.signals.iter().map(|signals| Complex::from(f64::from(signals[component]))).collect();
            to_bins.process(&mut bins);
            let mut spectrum = vec![Complex::default(); frames];
            for (bin, felt) in admittances.iter().enumerate() {
                let value = bins[bin] * *felt / samples as f64;
                spectrum[bin] += value;
                // The other half of a real series; the mean has none.
                if bin > 0 {
                    spectrum[frames - bin] += value.conj();
                }
            }
            to_time.process(&mut spectrum);
            spectrum.into_iter().map(|value| value.re).collect()
        });
        (0..frames).map(|frame| Vec4::from_array(components.each_ref().map(|series| series[frame] as f32))).collect()
    }
}
