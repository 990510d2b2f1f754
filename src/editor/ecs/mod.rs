//! The workbench in an app.

mod camera;
mod egui_rest;
#[cfg(feature = "export")]
mod export;
mod land;
mod manners;
mod measure;
mod mesh;
mod panel_layout;
mod panel_picture;
mod panels;
mod show_ground;
mod show_species;
mod show_woods;
pub mod turntable;
pub mod workbench;

use self::{
    camera::{scale_panels, spawn_camera},
    egui_rest::EguiRestPlugin,
    land::{note_view, show_land},
    manners::is_open,
    measure::{Measuring, measure_tip, measure_wind, note_costs, note_species_costs, point_at_tree, show_arrows},
    mesh::{begin_diagrams, hide_trees, show_diagrams},
    panels::draw_panels,
    show_ground::{BuiltGround, build_ground, fit_map, raise_ground},
    show_species::{Applied, apply_species, has_species_to_show, note_tree},
    show_woods::{AppliedPlan, apply_plan, count_quadrats, note_woods},
    turntable::{arrange_trees, place_trees, turn},
    workbench::Workbench,
};
use super::ui::Panel;
use crate::{
    plugin_checks::require_plugin, render::TreeRenderPlugin, schedule::WindwoodSystems, timing::timed, tree::TreePlaces,
};
use bevy::{camera::CameraUpdateSystems, prelude::*, time::common_conditions::on_real_timer};
use bevy_egui::{EguiGlobalSettings, EguiPlugin, EguiPrimaryContextPass};
use std::{path::PathBuf, time::Duration};

/// The workbench: panels that edit species, woods, the ground, the wind and levels of detail while the program runs. Add it after
/// [`WindwoodPlugins`](crate::WindwoodPlugins); F2 opens and closes it.
///
/// It adds `bevy_egui`'s plugin where there is none, and draws with a camera of its own.
#[derive(Clone, Debug, Default)]
pub struct EditorPlugin {
    /// The file of the species that is edited first. In a game, its trees change with it where the game has loaded that file.
    pub file: Option<PathBuf>,
    /// The file of the plan that is edited first. In a game, forests change with it where the game has loaded that file.
    pub plan: Option<PathBuf>,
    /// The file of the ground that is edited first: `.bands.ron` for random ground, `.ground.ron` for ground of control points.
    pub ground: Option<PathBuf>,
    /// Whether the species stands on a turntable, before a [`StageCamera`](turntable::StageCamera) of yours. Else it stands
    /// wherever the game has planted it.
    pub turntable: bool,
    /// Whether it is open from the beginning.
    pub starts_open: bool,
}

/// Between two counts of what species cost.
const COUNTING: Duration = Duration::from_secs(1);

fn shows_costs(workbench: Res<Workbench>) -> bool {
    workbench.is_open && workbench.panel == Panel::Levels
}

/// Whether it is told which tree is under the pointer. Without `TreeQueryPlugin` nobody can tell.
fn is_pointing(workbench: Res<Workbench>, places: Option<Res<TreePlaces>>) -> bool {
    places.is_some() && workbench.panel == Panel::Wind && workbench.pointer.is_some()
}

impl Plugin for EditorPlugin {
    fn build(&self, app: &mut App) {
        require_plugin::<Self, TreeRenderPlugin>(app);
        if !app.is_plugin_added::<EguiPlugin>() {
            app.add_plugins((EguiPlugin::default(), EguiRestPlugin));
            let mut settings = app.world_mut().resource_mut::<EguiGlobalSettings>();
            settings.auto_create_primary_context = false;
            // What is typed or dragged in a panel is not meant for the game.
            settings.enable_absorb_bevy_input_system = true;
        }
        let (plan, ground) = (self.plan.as_deref(), self.ground.as_deref());
        let mut workbench = Workbench::new(self.file.as_deref(), plan, ground, self.turntable);
        workbench.is_open = self.starts_open;
        app.insert_resource(workbench)
            .init_resource::<Applied>()
            .init_resource::<AppliedPlan>()
            .init_resource::<BuiltGround>()
            .init_resource::<Measuring>()
            .add_plugins((manners::plugin, panel_layout::plugin, panel_picture::plugin))
            .add_systems(PreUpdate, scale_panels.run_if(is_open))
            .add_systems(
                Update,
                (
                    spawn_camera.run_if(is_open),
                    (
                        apply_species.run_if(has_species_to_show),
                        (point_at_tree.run_if(is_pointing), measure_wind, measure_tip).run_if(is_open),
                        show_arrows,
                    )
                        .before(WindwoodSystems::Bake),
                    (apply_plan, count_quadrats, fit_map, build_ground, raise_ground)
                        .run_if(is_open)
                        .before(WindwoodSystems::Stream),
                ),
            )
            .add_systems(
                PostUpdate,
                (
                    note_tree,
                    note_woods,
                    // Cameras know their matrices by then.
                    note_view.after(TransformSystems::Propagate).after(CameraUpdateSystems),
                )
                    .run_if(is_open),
            )
            .add_systems(
                Last,
                (note_costs.run_if(is_open), note_species_costs.run_if(shows_costs).run_if(on_real_timer(COUNTING))),
            );
        #[cfg(feature = "export")]
        app.init_resource::<export::Exporting>()
            .add_systems(Update, export::export_tree.run_if(is_open).before(WindwoodSystems::Bake));
        // What the panels cost is told with the rest.
        let draw_panels = timed!(app, draw_panels).run_if(is_open);
        app.add_systems(EguiPrimaryContextPass, draw_panels);
        if self.turntable {
            app.add_systems(Update, ((turn, arrange_trees).chain(), show_land).before(WindwoodSystems::Bake))
                .add_systems(
                    Update,
                    (place_trees, begin_diagrams, show_diagrams, hide_trees).chain().after(WindwoodSystems::SelectLod),
                );
        }
    }
}
