//! How the forest does: counts and times among Bevy's diagnostics, and its cells as boxes.

use super::{cells::ForestCells, cull::CulledCells, impostors::ForestImpostors};
use crate::{render::draw::counts::TreesByLod, schedule::WindwoodSystems, timing::SystemTimes};
use bevy::{
    diagnostic::{Diagnostic, DiagnosticPath, Diagnostics, RegisterDiagnostic},
    gizmos::GizmoPlugin,
    platform::collections::HashMap,
    prelude::*,
};

/// Puts the forest among Bevy's diagnostics: cells, trees of each level, bytes, and the time of each of our systems. Not in
/// [`WindwoodPlugins`](crate::WindwoodPlugins): add it, and a `LogDiagnosticsPlugin` or a display of your own.
pub struct ForestDiagnosticsPlugin;

impl ForestDiagnosticsPlugin {
    /// Cells whose stems are known.
    pub const CELLS_PLANTED: DiagnosticPath = DiagnosticPath::const_new("windwood/cells_planted");
    /// Stems that are known.
    pub const STEMS: DiagnosticPath = DiagnosticPath::const_new("windwood/stems");
    /// Near cells: their trees are entities.
    pub const CELLS_NEAR: DiagnosticPath = DiagnosticPath::const_new("windwood/cells_near");
    /// Near cells that are seen, or whose shadows may be.
    pub const CELLS_SEEN: DiagnosticPath = DiagnosticPath::const_new("windwood/cells");
    /// Trees that are drawn in full, at the first lower level, and at the second.
    pub const TREES: [DiagnosticPath; 3] = [
        DiagnosticPath::const_new("windwood/trees_full"),
        DiagnosticPath::const_new("windwood/trees_lower"),
        DiagnosticPath::const_new("windwood/trees_lowest"),
    ];
    /// Trees of which two levels are drawn, one of which fades into the other.
    pub const TREES_FADING: DiagnosticPath = DiagnosticPath::const_new("windwood/trees_fading");
    /// Trees that have impostors.
    pub const IMPOSTORS: DiagnosticPath = DiagnosticPath::const_new("windwood/impostors");
    /// What the tables of trees, beams and poses, and the meshes of impostors have on the GPU, bytes.
    pub const GPU_BYTES: DiagnosticPath = DiagnosticPath::const_new("windwood/gpu_bytes");
}

impl Plugin for ForestDiagnosticsPlugin {
    fn build(&self, app: &mut App) {
        let counts =
            [Self::CELLS_PLANTED, Self::STEMS, Self::CELLS_NEAR, Self::CELLS_SEEN, Self::TREES_FADING, Self::IMPOSTORS]
                .into_iter()
                .chain(Self::TREES);
        for path in counts {
            app.register_diagnostic(Diagnostic::new(path));
        }
        app.register_diagnostic(Diagnostic::new(Self::GPU_BYTES).with_suffix(" B"));
        app.add_systems(Last, (count_forest, time_systems));
    }
}

fn count_forest(
    forests: Query<(&ForestCells, Option<&ForestImpostors>, Option<&CulledCells>)>,
    trees: TreesByLod,
    mut diagnostics: Diagnostics,
) {
    use ForestDiagnosticsPlugin as Is;
    let mut add = |path: &DiagnosticPath, value: usize| diagnostics.add_measurement(path, || value as f64);
    let sum = |of: fn(&ForestCells) -> usize| forests.iter().map(|(forest, ..)| of(forest)).sum();
    add(&Is::CELLS_PLANTED, sum(|forest| forest.store().len()));
    add(&Is::STEMS, sum(|forest| forest.store().plants()));
    add(&Is::CELLS_NEAR, sum(|forest| forest.near.entities().count()));
    add(&Is::CELLS_SEEN, forests.iter().filter_map(|(.., cells)| cells).map(CulledCells::seen).sum());
    let (levels, fading) = trees.count();
    Is::TREES.iter().zip(levels).for_each(|(path, count)| add(path, count));
    add(&Is::TREES_FADING, fading);
    let tiles = || forests.iter().filter_map(|(_, tiles, _)| tiles);
    add(&Is::IMPOSTORS, tiles().map(ForestImpostors::trees).sum());
    add(&Is::GPU_BYTES, trees.table_bytes() + tiles().map(ForestImpostors::bytes).sum::<usize>());
}

/// One diagnostic a system, in microseconds.
fn time_systems(
    times: Option<Res<SystemTimes>>,
    mut paths: Local<HashMap<&'static str, DiagnosticPath>>,
    mut store: ResMut<bevy::diagnostic::DiagnosticsStore>,
) {
    let Some(times) = times else { return };
    for (name, time) in times.iter() {
        let path = paths.entry(name).or_insert_with(|| {
            let path = DiagnosticPath::from_components(["windwood", "system", name]);
            store.add(Diagnostic::new(path.clone()).with_suffix(" us"));
            path
        });
        if let Some(diagnostic) = store.get_mut(path) {
            let time = bevy::diagnostic::DiagnosticMeasurement {
                time: bevy::platform::time::Instant::now(),
                value: time.as_secs_f64() * 1e6,
            };
            diagnostic.add_measurement(time);
        }
    }
}

/// Draws near cells as boxes.
#[derive(Resource, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Resource, Default)]
pub struct ForestGizmos {
    /// Whether boxes are drawn.
    pub enabled: bool,
    /// Colour of cells that are seen, or whose shadows may be.
    pub seen: Color,
    /// Colour of others.
    pub unseen: Color,
    /// Colours over the trees: full, lower, lowest.
    pub levels: [Color; 3],
}

impl Default for ForestGizmos {
    fn default() -> Self {
        Self {
            enabled: false,
            seen: Color::srgb(0.3, 0.9, 0.4),
            unseen: Color::srgb(0.4, 0.4, 0.4),
            levels: [Color::srgb(1.0, 0.3, 0.2), Color::srgb(1.0, 0.8, 0.2), Color::srgb(0.3, 0.6, 1.0)],
        }
    }
}

/// Draws what [`ForestGizmos`] asks for. Without a gizmo renderer it does nothing.
pub(super) struct ForestGizmoPlugin;

impl Plugin for ForestGizmoPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ForestGizmos>().init_resource::<ForestGizmos>();
    }

    /// Whether there are gizmos is known only when all plugins have been added.
    fn finish(&self, app: &mut App) {
        if app.is_plugin_added::<GizmoPlugin>() {
            let draw = draw_cells.after(WindwoodSystems::Cull).after(WindwoodSystems::Upload);
            app.add_systems(PostUpdate, draw.run_if(|settings: Res<ForestGizmos>| settings.enabled));
        }
    }
}

fn draw_cells(settings: Res<ForestGizmos>, forests: Query<&CulledCells>, trees: TreesByLod, mut gizmos: Gizmos) {
    for ([min, max], seen) in forests.iter().flat_map(CulledCells::boxes) {
        let colour = if seen { settings.seen } else { settings.unseen };
        gizmos.cube(Transform::from_translation(0.5 * (min + max)).with_scale(max - min), colour);
    }
    for (place, level) in trees.iter() {
        gizmos.line(place, place + Vec3::Y * 3.0, settings.levels[level.min(2)]);
    }
}
