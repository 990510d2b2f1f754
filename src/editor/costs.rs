//! What everything costs: counts, times and bytes of the last seconds.

use std::{collections::VecDeque, time::Duration};

/// How long is looked back, s.
const REMEMBERED_S: f64 = 10.0;
/// Frames are put together for so long.
const STEP: Duration = Duration::from_millis(100);

/// What a frame cost.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// From the beginning of the frame before to that of this one.
    pub length: Duration,
    /// Of each of our systems, by name.
    pub systems: Vec<(&'static str, Duration)>,
    /// Trees of each level, from the grown one on.
    pub trees: [usize; 3],
    /// What trees have in tables on the GPU, bytes.
    pub bytes: usize,
}

/// Means of some frames.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// When it ended, s.
    pub time_s: f64,
    pub frame_ms: f64,
    pub ours_ms: f64,
}

/// What the trees of a species cost that are entities.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SpeciesCost {
    pub name: String,
    pub trees: usize,
    /// Beams that are posed.
    pub beams: usize,
    /// Triangles at the full level.
    pub triangles: usize,
}

/// The costs of the last seconds.
#[derive(Clone, Debug, Default)]
pub struct Costs {
    /// Of the species there are, the dearest first.
    pub species: Vec<SpeciesCost>,
    pub steps: VecDeque<Step>,
    /// Means of the last step, the dearest first: name, µs.
    pub systems: Vec<(&'static str, f64)>,
    pub last: Frame,
    time: Duration,
    frames: Vec<Frame>,
}

impl Costs {
    /// Adds a frame.
    pub fn add(&mut self, frame: Frame) {
        self.time += frame.length;
        self.last.clone_from(&frame);
        self.frames.push(frame);
        if self.frames.iter().map(|frame| frame.length).sum::<Duration>() >= STEP {
            self.end_step();
        }
    }

    /// Takes over what species cost, in any order.
    pub fn set_species(&mut self, mut species: Vec<SpeciesCost>) {
        species.sort_by(|a, b| b.triangles.cmp(&a.triangles).then_with(|| a.name.cmp(&b.name)));
        self.species = species;
    }

    fn end_step(&mut self) {
        let frames = std::mem::take(&mut self.frames);
        let time_s = self.time.as_secs_f64();
        let mean_ms = |of: fn(&Frame) -> Duration| {
            1e3 * frames.iter().map(|frame| of(frame).as_secs_f64()).sum::<f64>() / frames.len() as f64
        };
        let ours = |frame: &Frame| frame.systems.iter().map(|(_, time)| *time).sum();
        self.steps.push_back(Step { time_s, frame_ms: mean_ms(|frame| frame.length), ours_ms: mean_ms(ours) });
        while self.steps.front().is_some_and(|step| step.time_s + REMEMBERED_S < time_s) {
            self.steps.pop_front();
        }
        let names = self.last.systems.iter().map(|(name, _)| *name);
        let mean_us = |name: &str| {
            let of_name = frames.iter().flat_map(|frame| frame.systems.iter().filter(|(own, _)| *own == name));
            1e6 * of_name.map(|(_, time)| time.as_secs_f64()).sum::<f64>() / frames.len() as f64
        };
        self.systems = names.map(|name| (name, mean_us(name))).collect();
        self.systems.sort_by(|a, b| b.1.total_cmp(&a.1));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dearest_species_comes_first() {
        let of = |name: &str, triangles| SpeciesCost { name: name.into(), triangles, ..SpeciesCost::default() };
        let mut costs = Costs::default();
        costs.set_species(vec![of("birch", 10), of("oak", 30), of("beech", 10)]);
        assert_eq!(costs.species, [of("oak", 30), of("beech", 10), of("birch", 10)]);
    }

    #[test]
    fn frames_become_means_and_old_ones_are_forgotten() {
        let mut costs = Costs::default();
        let ms = Duration::from_millis;
        for number in 0..2000 {
            let systems = vec![("a", ms(1)), ("b", ms(2 * (number % 2)))];
            costs.add(Frame { length: ms(10), systems, trees: [1, 2, 3], bytes: 64 });
        }
        assert!((100..=101).contains(&costs.steps.len()));
        let last = costs.steps.back().unwrap();
        assert!(
            (last.frame_ms - 10.0).abs() < 1e-9
                && (last.ours_ms - 2.0).abs() < 1e-9
                && (last.time_s - 20.0).abs() < 1e-6
        );
        assert_eq!((costs.systems[0].0, costs.systems[1].0, costs.last.bytes), ("a", "b", 64));
        assert!(costs.systems.iter().all(|(_, us)| (us - 1000.0).abs() < 1e-6));
    }
}
