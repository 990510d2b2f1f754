//! The tables of a wind as one GPU buffer. `render/shaders/wind.wesl` reads it.

use crate::sway::WindResponse;

/// Rows of `vec4` before the direction map; `HEADER` of `render/shaders/wind.wesl`.
const HEADER: usize = 4;

/// One wind as the shaders read it, in rows of `vec4`: header, direction map, responses, velocities.
pub(crate) fn pack_wind(wind: &WindResponse) -> Vec<u8> {
    let (frame, table, map) = (wind.field.frame(), &wind.table, wind.basis.map());
    let along = frame.along;
    let across = frame.across;
    let lateral = wind.field.lateral();
    let spacing = wind.field.settings().resolution.column_spacing_m;
    let header: [[f32; 4]; HEADER] = [
        [along.x, along.y, along.z, wind.field.convective_speed_m_s()],
        [across.x, across.y, across.z, spacing],
        [table.classes.count as f32, table.columns as f32, table.samples as f32, table.time_step_s],
        [map.size() as f32, 1.0 / table.classes.ratio.ln(), lateral.slowness_s_m, lateral.lag_s],
    ];
    let parts: [&[u8]; 4] = [
        bytemuck::cast_slice(&header),
        bytemuck::cast_slice(map.texels()),
        bytemuck::cast_slice(&table.values),
        bytemuck::cast_slice(&table.velocities),
    ];
    parts.concat()
}
