//! Which squares of the pyramid are drawn from where the viewers are, and which are to be built next.
//!
//! A square is split into the four finer ones when a viewer is near to it, measured in its own side. It is drawn until all
//! four are there, so that the ground never has a hole, however fast the viewer flies; and coarse squares are built before
//! fine ones, so that there is always something to draw.

use super::chunk_key::{ChunkKey, Edge, Seams};
use bevy::{math::DVec2, platform::collections::HashMap};

/// Where a viewer is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eye {
    /// (x, z), m.
    pub place: DVec2,
    /// Height over the ground, m.
    pub above_ground_m: f64,
}

/// The shape of a pyramid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PyramidShape {
    /// Cells of the finest level, m.
    pub finest_cell_m: f64,
    /// The coarsest level.
    pub coarsest_level: u32,
    /// A square is split when an eye is nearer than so many of its sides. Above sqrt 2, neighbours differ by no more than
    /// one level once all is built.
    pub detail: f64,
    /// How far the ground is drawn, m.
    pub reach_m: f64,
}

/// Distance at which what was split is joined again, over that at which it was split: a viewer on a border makes nothing
/// flicker.
const HYSTERESIS: f64 = 1.1;

/// The squares that are there, and those that should be.
#[derive(Clone, Debug)]
pub struct Pyramid {
    shape: PyramidShape,
    nodes: HashMap<ChunkKey, Node>,
    /// Squares in the order in which they should be built, the last first.
    queue: Vec<ChunkKey>,
    drawn: Vec<(ChunkKey, Seams)>,
    dropped: Vec<ChunkKey>,
    roots: Vec<ChunkKey>,
    selections: u64,
}

#[derive(Clone, Copy, Debug, Default)]
struct Node {
    split: bool,
    asked: bool,
    ready: bool,
    /// How it is drawn, if it is.
    drawn: Option<Seams>,
    /// The number of the selection that last wanted it.
    wanted: u64,
}

impl Pyramid {
    /// An empty pyramid.
    #[must_use]
    pub fn new(shape: PyramidShape) -> Self {
        Self {
            shape,
            nodes: HashMap::default(),
            queue: Vec::new(),
            drawn: Vec::new(),
            dropped: Vec::new(),
            roots: Vec::new(),
            selections: 0,
        }
    }

    /// Its shape.
    #[must_use]
    pub fn shape(&self) -> &PyramidShape {
        &self.shape
    }

    /// Selects the squares that are wanted from these places. Those that no longer are go to [`dropped`](Self::dropped).
    pub fn select(&mut self, eyes: &[Eye]) {
        self.selections += 1;
        self.queue.clear();
        self.find_roots(eyes);
        for index in 0..self.roots.len() {
            self.want(self.roots[index], eyes);
        }
        let (selections, dropped) = (self.selections, &mut self.dropped);
        self.nodes.retain(|key, node| {
            let stays = node.wanted == selections;
            if !stays && node.asked {
                dropped.push(*key);
            }
            stays
        });
        // They come out of a hash map.
        self.dropped.sort_unstable();
        let shape = self.shape;
        let distance_m = |key: &ChunkKey| eyes.iter().map(|eye| shape.distance_m(*key, eye)).fold(f64::MAX, f64::min);
        self.queue.sort_by_cached_key(|key| (key.level, std::cmp::Reverse(distance_m(key) as u64), *key));
        self.select_drawn();
    }

    /// The squares of the coarsest level within reach.
    fn find_roots(&mut self, eyes: &[Eye]) {
        self.roots.clear();
        let level = self.shape.coarsest_level;
        let side_m = ChunkKey { level, column: 0, row: 0 }.side_m(self.shape.finest_cell_m);
        for eye in eyes {
            let [least, greatest] = [-1.0, 1.0]
                .map(|way| ((eye.place + way * self.shape.reach_m * HYSTERESIS) / side_m).floor().as_ivec2());
            for row in least.y..=greatest.y {
                for column in least.x..=greatest.x {
                    let key = ChunkKey { level, column, row };
                    let reach_m = self.shape.reach_m * if self.nodes.contains_key(&key) { HYSTERESIS } else { 1.0 };
                    if self.shape.distance_m(key, eye) < reach_m && !self.roots.contains(&key) {
                        self.roots.push(key);
                    }
                }
            }
        }
    }

    /// Wants a square, and the finer ones inside that an eye is near to.
    fn want(&mut self, key: ChunkKey, eyes: &[Eye]) {
        let (selections, shape) = (self.selections, self.shape);
        let node = self.nodes.entry(key).or_default();
        let near_m = shape.detail * key.side_m(shape.finest_cell_m) * if node.split { HYSTERESIS } else { 1.0 };
        let is_near = |eye: &Eye| shape.distance_m(key, eye) < near_m;
        node.split = key.level > 0 && eyes.iter().any(is_near);
        node.wanted = selections;
        if !node.asked {
            self.queue.push(key);
        }
        if node.split {
            key.children().into_iter().for_each(|child| self.want(child, eyes));
        }
    }

    /// The next square to build: the coarsest, and the nearest of these.
    pub fn next_to_build(&mut self) -> Option<ChunkKey> {
        let key = self.queue.pop()?;
        if let Some(node) = self.nodes.get_mut(&key) {
            node.asked = true;
        }
        Some(key)
    }

    /// Whether a square that has been asked for is still wanted.
    #[must_use]
    pub fn awaits(&self, key: ChunkKey) -> bool {
        self.nodes.get(&key).is_some_and(|node| node.asked && !node.ready)
    }

    /// Notes that a square can be drawn; one that is no longer wanted is left out.
    pub fn receive(&mut self, key: ChunkKey) {
        if let Some(node) = self.nodes.get_mut(&key) {
            node.ready = true;
        }
    }

    /// Whether everything that is wanted is there.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.nodes.values().all(|node| node.ready)
    }

    /// Takes out those squares that have been asked for, and are no longer wanted.
    pub fn dropped(&mut self) -> std::vec::Drain<'_, ChunkKey> {
        self.dropped.drain(..)
    }

    /// What is drawn now, and how much coarser the ground about each square is.
    #[must_use]
    pub fn drawn(&self) -> &[(ChunkKey, Seams)] {
        &self.drawn
    }

    /// Whether a square is drawn now, and how much coarser the ground about it is.
    #[must_use]
    pub fn seams(&self, key: ChunkKey) -> Option<Seams> {
        self.nodes.get(&key)?.drawn
    }

    /// Chooses what is drawn among the squares that are there.
    pub fn select_drawn(&mut self) {
        self.drawn.clear();
        self.nodes.values_mut().for_each(|node| node.drawn = None);
        for index in 0..self.roots.len() {
            self.select_drawn_within(self.roots[index]);
        }
        for index in 0..self.drawn.len() {
            let key = self.drawn[index].0;
            let seams =
                Edge::ALL.into_iter().fold(Seams::default(), |seams, edge| seams.with(edge, self.step(key, edge)));
            self.drawn[index].1 = seams;
            if let Some(node) = self.nodes.get_mut(&key) {
                node.drawn = Some(seams);
            }
        }
    }

    fn select_drawn_within(&mut self, key: ChunkKey) {
        let is_ready = |key: &ChunkKey| self.nodes.get(key).is_some_and(|node| node.ready);
        let splits = self.nodes.get(&key).is_some_and(|node| node.split);
        if splits && key.children().iter().all(is_ready) {
            key.children().into_iter().for_each(|child| self.select_drawn_within(child));
        } else if let Some(node) = self.nodes.get_mut(&key).filter(|node| node.ready) {
            node.drawn = Some(Seams::default());
            self.drawn.push((key, Seams::default()));
        }
    }

    /// By how many levels the ground beyond an edge is coarser; 0 where it is as fine or finer, or there is none.
    fn step(&self, key: ChunkKey, edge: Edge) -> u32 {
        let mut other = key.beyond(edge);
        while other.level <= self.shape.coarsest_level {
            if self.nodes.get(&other).is_some_and(|node| node.drawn.is_some()) {
                return other.level - key.level;
            }
            other = other.parent();
        }
        0
    }
}

impl PyramidShape {
    /// From an eye to the nearest place of a square, m.
    fn distance_m(&self, key: ChunkKey, eye: &Eye) -> f64 {
        let (corner, side_m) = (key.corner_m(self.finest_cell_m), key.side_m(self.finest_cell_m));
        let nearest = eye.place.clamp(corner, corner + side_m);
        nearest.distance(eye.place).hypot(eye.above_ground_m)
    }
}

#[cfg(test)]
mod tests;
