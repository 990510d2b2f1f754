//! The observed table: how many quadrats hold 0, 1, 2, ... plants.

use crate::setting::SettingError;

/// More plants than this in one quadrat call for smaller quadrats: the laws' tables grow with the square of it.
const GREATEST_COUNT: usize = 1000;

/// How many quadrats hold 0, 1, 2, ... plants.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frequencies {
    quadrats_with: Vec<u64>,
}

impl Frequencies {
    /// From a table whose entry r is the number of quadrats that hold r plants.
    ///
    /// # Errors
    /// [`SettingError`] with fewer than two quadrats, for which there is no variance, or without a plant.
    pub fn new(mut quadrats_with: Vec<u64>) -> Result<Self, SettingError> {
        while quadrats_with.last() == Some(&0) {
            quadrats_with.pop();
        }
        let quadrats = quadrats_with.iter().fold(0_u64, |sum, &quadrats| sum.saturating_add(quadrats));
        if !(2..=1 << 40).contains(&quadrats) {
            return Err(SettingError::new("quadrats", quadrats, "2 to 2^40"));
        }
        if quadrats_with.len() < 2 {
            return Err(SettingError::new("plants", 0, "at least 1"));
        }
        if quadrats_with.len() > GREATEST_COUNT + 1 {
            let count = quadrats_with.len() - 1;
            return Err(SettingError::new("plants in one quadrat", count, format!("0 to {GREATEST_COUNT}")));
        }
        Ok(Self { quadrats_with })
    }

    /// From the number of plants in each quadrat.
    ///
    /// # Errors
    /// As [`Frequencies::new`].
    pub fn of_counts(counts: &[u32]) -> Result<Self, SettingError> {
        let greatest = counts.iter().copied().max().unwrap_or(0) as usize;
        if greatest > GREATEST_COUNT {
            return Err(SettingError::new("plants in one quadrat", greatest, format!("0 to {GREATEST_COUNT}")));
        }
        let mut quadrats_with = vec![0; greatest + 1];
        for &count in counts {
            quadrats_with[count as usize] += 1;
        }
        Self::new(quadrats_with)
    }

    /// The table: entry r is the number of quadrats that hold r plants. The last is not 0.
    pub fn quadrats_with(&self) -> &[u64] {
        &self.quadrats_with
    }

    /// Number of quadrats.
    pub fn quadrats(&self) -> f64 {
        self.quadrats_with.iter().sum::<u64>() as f64
    }

    /// The most plants in a quadrat.
    pub fn greatest(&self) -> usize {
        self.quadrats_with.len() - 1
    }

    /// Mean number of plants in a quadrat.
    pub fn mean(&self) -> f64 {
        self.sum(|count| count) / self.quadrats()
    }

    /// Sample variance (over Q - 1) of the number of plants in a quadrat.
    pub fn variance(&self) -> f64 {
        let mean = self.mean();
        self.sum(|count| (count - mean).powi(2)) / (self.quadrats() - 1.0)
    }

    /// Third central moment of the number of plants in a quadrat.
    pub(super) fn third_moment(&self) -> f64 {
        let mean = self.mean();
        self.sum(|count| (count - mean).powi(3)) / self.quadrats()
    }

    fn sum(&self, of: impl Fn(f64) -> f64) -> f64 {
        self.quadrats_with.iter().enumerate().map(|(count, &quadrats)| quadrats as f64 * of(count as f64)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn moments_are_those_of_the_list_of_counts() {
        let counts = [0, 0, 1, 1, 1, 2, 5, 0, 3, 1];
        let table = Frequencies::of_counts(&counts).unwrap();
        assert_eq!(table.quadrats_with(), [3, 4, 1, 1, 0, 1]);
        let mean = 1.4;
        assert_relative_eq!(table.mean(), mean, max_relative = 1e-12);
        let central = |power: i32| counts.iter().map(|&count| (f64::from(count) - mean).powi(power)).sum::<f64>();
        assert_relative_eq!(table.variance(), central(2) / 9.0, max_relative = 1e-12);
        assert_relative_eq!(table.third_moment(), central(3) / 10.0, max_relative = 1e-12);
    }

    #[test]
    fn tables_without_quadrats_or_plants_are_refused() {
        assert_eq!(Frequencies::new(vec![]).unwrap_err().to_string(), "`quadrats` is 0, but must be 2 to 2^40");
        assert_eq!(
            Frequencies::of_counts(&[0, 0, 0]).unwrap_err().to_string(),
            "`plants` is 0, but must be at least 1"
        );
        assert!(Frequencies::of_counts(&[u32::MAX, 1]).is_err());
        assert!(Frequencies::new(vec![u64::MAX, u64::MAX]).is_err());
    }
}
