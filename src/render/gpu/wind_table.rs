//! The tables of a wind as one GPU buffer. `render/shaders/wind.wesl` reads it.

use crate::{
    dynamics::{
        oscillator_grid::{LEAST_SIZE, SIZE_RATIO},
        response::TableRow,
    },
    sway::WindResponse,
};
use half::f16;

/// Rows of `vec4` before where each row of the table is; `HEADER` of `render/shaders/wind.wesl`.
const HEADER: usize = 8;

/// Samples of series in a `vec4`: four halves each.
const SAMPLES_A_ROW: usize = 2;

/// One wind as the shaders read it, in rows of `vec4`: header, where each row of the table is, direction map, responses, velocities. The two
/// last have half precision: a share of 2^-11 of what is rounded.
pub(crate) fn pack_wind(wind: &WindResponse) -> Vec<u8> {
    let (frame, table, map) = (wind.field.frame(), &wind.table, wind.basis.map());
    let (mean, grid) = (wind.mean_wind, table.grid);
    let [along, across] = [frame.along, frame.across].map(|axis| axis.to_array());
    let lateral = wind.field.lateral();
    let spacing = wind.field.settings().resolution.column_spacing_m;
    let [a, b, c] = grid.damping_mix();
    let [whole, middle, part] = grid.natural_admittances;
    let header: [[f32; 4]; HEADER] = [
        [along[0], along[1], along[2], wind.field.convective_speed_m_s()],
        [across[0], across[1], across[2], spacing],
        [grid.classes.count as f32, table.columns as f32, table.samples as f32, table.time_step_s],
        [map.size() as f32, 1.0 / grid.classes.ratio.ln(), lateral.slowness_s_m, lateral.lag_s],
        [mean.speed_m_s, mean.roughness_m, mean.displacement_m, mean.inverse_log],
        [grid.damping_ratios[0], a, b, c],
        [
            1.0 / (LEAST_SIZE * grid.speed_m_s),
            1.0 / SIZE_RATIO.ln(),
            grid.classes.first_fast() as f32,
            table.rows.len() as f32,
        ],
        [whole, middle, part, table.bands.short_period_s as f32],
    ];
    // A texel is four rows.
    let first = HEADER + table.rows.len() + 1 + 4 * map.size() * map.size();
    let velocities = TableRow { first: table.values.len(), samples: table.samples, is_high: false };
    let rows = table.rows.iter().copied().chain([velocities]);
    // Whole numbers that an f32 holds exactly: 2^24 samples would be 128 MB.
    let first = SAMPLES_A_ROW * first;
    let rows: Vec<[f32; 4]> = rows
        .map(|row| [(first + row.first) as f32, row.samples as f32, f32::from(u8::from(row.is_high)), 0.0])
        .collect();
    let series = table.values.iter().chain(&table.velocities);
    let mut samples: Vec<[u16; 4]> = series.map(|sample| sample.to_array().map(half_bits)).collect();
    samples.resize(samples.len().next_multiple_of(SAMPLES_A_ROW), [0; 4]);
    let parts: [&[u8]; 4] = [
        bytemuck::cast_slice(&header),
        bytemuck::cast_slice(&rows),
        bytemuck::cast_slice(map.texels()),
        bytemuck::cast_slice(&samples),
    ];
    parts.concat()
}

/// The bits of the nearest number in half precision (IEEE 754 binary16), of two equally near ones that which is even. What is too large or no
/// number becomes the greatest.
fn half_bits(value: f32) -> u16 {
    let most = f16::MAX.to_f32();
    f16::from_f32(value.min(most).max(-most)).to_bits()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The number that bits in half precision stand for.
    fn value(bits: u16) -> f32 {
        let (exponent, fraction) = (i32::from(bits >> 10 & 31), f32::from(bits & 1023));
        let magnitude = match exponent {
            0 => fraction * 2.0_f32.powi(-24),
            _ => (1.0 + fraction / 1024.0) * 2.0_f32.powi(exponent - 15),
        };
        if bits >> 15 == 1 { -magnitude } else { magnitude }
    }

    #[test]
    fn all_halves_are_their_own_nearest_and_midpoints_go_to_even_ones() {
        for bits in (0..0x7c00_u16).chain(0x8000..0xfc00) {
            assert_eq!(half_bits(value(bits)), bits);
            if bits & 0x7fff < 0x7bff {
                let middle = 0.5 * (value(bits) + value(bits + 1));
                assert_eq!(half_bits(middle), bits + (bits & 1), "{middle}");
                assert_eq!(half_bits(middle * (1.0 - 1e-6)), bits);
                assert_eq!(half_bits(middle * (1.0 + 1e-6)), bits + 1);
            }
        }
        for bad in [f32::NAN, f32::INFINITY, 1e30, 65_520.0] {
            assert_eq!(half_bits(bad) & 0x7fff, 0x7bff);
        }
    }
}
