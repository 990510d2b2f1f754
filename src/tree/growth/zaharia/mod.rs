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
//! Ages are clamped to `min_age`..`max_age`. Leaves sit on the last level of branches alone, "between 5 and 10, depending
//! on the branch length"; but table 2 counts only 4.4 to 6.1 to *every* branch, so shorter ones must have fewer: see
//! [`Oak::counts`].

mod fir;
mod oak;
mod plan;

pub use fir::Fir;
pub use oak::{Counts, Oak};
