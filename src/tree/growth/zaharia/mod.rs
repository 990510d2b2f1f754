//! Oak and fir after Zaharia, "Procedural Modeling of Natural Phenomena", section 2.3: age drives everything.
//!
//! ```text
//! no_branch = min_branch + (max_branch - min_branch) (age - min_age) / (max_age - min_age)
//! l_trunk   = length age / max_age + (-1)^random(65) delta random(no_branch) / no_branch
//! l_branch  = (length_father - dist) (adjust_branch + age / max_age) random()
//! ```
//!
//! `dist` is where on its father the branch sits. What of this cannot be taken as printed, and what is done:
//! - `no_branch` is a fraction at most ages: the fraction is the probability of one branch more.
//! - `random()` in 0..1 makes stumps of no length: it is drawn from `shortest`..1; with `shortest` 0 it is as printed.
//! - A single `adjust_branch` is named, "whose value increases with the level": each level has its own.
//! - With `delta` a seedling's trunk may come out shorter than nothing: it stays within half and one and a half times
//!   `length age / max_age`.
//! - A branch from the top of its father, `dist = length_father`, has no length; branches shorter than 8 cm do not grow, so
//!   that a sapling has few. The number of levels and the angles are not printed: they are parameters.
//!
//! Ages are clamped to `min_age`..`max_age`.
//!
//! Age is in all three formulas, and acts as printed. Table 2 leaves it little room in `no_branch`: its branches become
//! 1.44 times as many from 100 to 200 years, and rise between 140 and 160 in a step that nothing linear makes. With the three
//! levels of [`Oak::default`](Oak) that is a number of sub-branches that grows by 1.13; shipped oaks, which do not
//! follow the table, let it grow more than threefold. (By `l_trunk` and `l_branch` alone a tree has nearly as many branches
//! at any age, but smaller ones; that a sapling of ours has few is owed to the 8 cm.)
//!
//! Leaves sit on terminal branches alone, "typically between 5 and 10, depending on the branch length"
//! ([`LeafEllipsoids`](crate::tree::leaf::LeafEllipsoids)). Table 2 has 3.9 to 6.1 leaves to *every* branch. If all but
//! one branch in fourteen are terminal, as here, that is 4.2 to 6.5 to a terminal one: less than 5 in three of the six
//! rows. So text and table do not quite agree. We follow the text, and have 0.7 to 1.2 times the leaves of the table (`docs/measured.md`).

mod fir;
mod oak;
mod plan;

pub use fir::Fir;
pub use oak::{Counts, Oak};
