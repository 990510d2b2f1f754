//! What should be known about a file that was read.

use std::fmt;

/// Something that should be known about a file of elevations that was read.
#[derive(Clone, Debug, PartialEq)]
pub enum ElevationNotice {
    /// Cells have no data. They are left out of statistics, and filled for drawing.
    NoData {
        /// How many.
        cells: usize,
        /// Of how many.
        of: usize,
    },
    /// No sample is the value that was told to be no data.
    NoDataUnused {
        /// The value.
        value: f64,
    },
    /// Cells hold a value that stands apart from all others, as one that means no data does.
    StandsApart {
        /// The value, as it is written.
        value: f32,
        /// How many hold it.
        cells: usize,
        /// The nearest value of another cell.
        nearest: f32,
    },
    /// The file has a cell size, but another was told.
    OtherCellSize {
        /// Eastwards and southwards, m, as in the file.
        in_file_m: [f64; 2],
    },
    /// The file has cells of degrees, which were turned to metres.
    Degrees {
        /// The latitude at which they were turned.
        latitude_deg: f64,
        /// Eastwards and southwards, m.
        cell_m: [f64; 2],
        /// The file does not say that its cells have degrees, but they would be too small in metres.
        is_guessed: bool,
    },
}

impl ElevationNotice {
    /// Whether something may be wrong.
    #[must_use]
    pub fn is_warning(&self) -> bool {
        match self {
            Self::NoDataUnused { .. } | Self::StandsApart { .. } | Self::OtherCellSize { .. } => true,
            Self::NoData { .. } => false,
            Self::Degrees { is_guessed, .. } => *is_guessed,
        }
    }
}

impl fmt::Display for ElevationNotice {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoData { cells, of } => {
                let share = 100.0 * *cells as f64 / *of as f64;
                write!(
                    out,
                    "{cells} of {of} cells ({share:.2}%) have no data: they are left out of statistics, and filled for drawing"
                )
            }
            Self::NoDataUnused { value } => write!(out, "`no_data` is {value}, but no sample is"),
            Self::StandsApart { value, cells, nearest } => {
                let value = f64::from(*value);
                write!(
                    out,
                    "{cells} cells hold {value}, which stands apart from all others (the nearest is {nearest}): if they are \
                     cells without data, set `no_data` to {value}"
                )
            }
            Self::OtherCellSize { in_file_m: [x_m, z_m] } => {
                write!(out, "the file has cells of {x_m} x {z_m} m, but others were told, and are used")
            }
            Self::Degrees { latitude_deg, cell_m: [x_m, z_m], is_guessed } => {
                let guess = if *is_guessed { " (which the file does not say, but its places do)" } else { "" };
                write!(
                    out,
                    "cells of degrees{guess} were turned to {x_m:.3} x {z_m:.3} m, as they are at latitude {latitude_deg:.3}"
                )
            }
        }
    }
}
