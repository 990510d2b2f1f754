//! Counts of real trees, for the tests.

use super::frequencies::Frequencies;

pub fn table(quadrats_with: &[u64]) -> Frequencies {
    Frequencies::new(quadrats_with.to_vec()).unwrap()
}

/// 65 Japanese black pine saplings, 8 x 8 quadrats.
pub const PINES: [u64; 5] = [22, 26, 10, 5, 1];
/// 134 Norway spruces, 14 x 10 quadrats.
pub const SPRUCES: [u64; 5] = [38, 74, 26, 0, 2];
/// 195 Californian redwood seedlings, 14 x 14 quadrats.
pub const REDWOODS: [u64; 10] = [101, 44, 27, 12, 5, 4, 2, 0, 0, 1];
/// 2251 trees of Lansing Woods, 47 x 48 quadrats.
pub const LANSING: [u64; 7] = [824, 826, 447, 117, 33, 6, 3];
