//! From the plan of a forest to its plants, cell by cell.
//!
//! A [`Planter`] is a prepared plan; [`Planter::plant`] fills one cell. What stands where follows from the seed, the area
//! and the quadrat alone. So cells may be planted in any order, with any size and on any thread, without visible seams:
//!
//! 1. Every area has its own endless grid of quadrats. Each quadrat draws its number of plants from the area's law and
//!    places them, with random numbers of its own.
//! 2. A cell looks at the quadrats that reach into it, and as far beyond as the least distance; plants outside the area's
//!    shape, under a house or on ground that is too steep go.
//! 3. Of two plants that are too near to each other one gives way: that of the later area; in one area, that with the
//!    smaller random number. Every plant is compared with all that were drawn, even those that give way themselves
//!    (Matérn's second process), so that a chain of neighbours never reaches farther than one distance. Within a quadrat
//!    this is rarely needed: there the draw is repeated until the plant has room.
//! 4. Species, age, size, season and tint follow from the plant's own random number.
//!
//! Areas and shapes that are kept free are found through an index by place, so that a cell of a huge forest costs no more
//! than one of a small.

mod index;
mod layer;
mod planted;
mod planter;
mod spacing;

pub(crate) use planted::GREATEST_SIZE;
pub use planted::{Planted, Stem};
pub use planter::Planter;
