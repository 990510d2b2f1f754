//! The tables of a wind as one GPU buffer. `render/shaders/wind.wesl` reads it.

use crate::{
    dynamics::{
        oscillator_grid::{LEAST_SIZE, SIZE_RATIO},
        response::TableRow,
    },
    sway::WindResponse,
};

/// Rows of `vec4` before where each row of the table is; `HEADER` of `render/shaders/wind.wesl`.
const HEADER: usize = 8;

/// One wind as the shaders read it, in rows of `vec4`: header, where each row of the table is, direction map, responses, velocities.
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
    // Whole numbers that an f32 holds exactly: 2^24 rows would be more than any device binds.
    let rows: Vec<[f32; 4]> = rows
        .map(|row| [(first + row.first) as f32, row.samples as f32, f32::from(u8::from(row.is_high)), 0.0])
        .collect();
    let parts: [&[u8]; 5] = [
        bytemuck::cast_slice(&header),
        bytemuck::cast_slice(&rows),
        bytemuck::cast_slice(map.texels()),
        bytemuck::cast_slice(&table.values),
        bytemuck::cast_slice(&table.velocities),
    ];
    parts.concat()
}
