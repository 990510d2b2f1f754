//! Ground that is edited: random ground, ground of control points, and a real map that is fitted.

use std::{path::Path, sync::Arc};

use super::{
    file_session::{FileSession, Message},
    map_fit::{MapFit, MapRequest, NoFit, Progress},
    session::Session,
    spline_points::{ControlPoint, height_m, with_height, with_patch},
    steps::Steps,
};
use crate::{
    ground::Ground,
    terrain::{SplineGround, SplineGroundSettings, TurningBandsSettings},
};

/// Which ground is edited.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GroundKind {
    /// A random field by turning bands.
    #[default]
    Random,
    /// Formed by control points.
    Spline,
    /// The map that was fitted, as it is.
    Map,
}

impl GroundKind {
    /// All of them, with their names and what they are.
    pub const ALL: [(Self, &'static str, &'static str); 3] = [
        (Self::Random, "Random", "A random field with the variogram of a model, without end"),
        (Self::Spline, "Control points", "Patches of a spline, formed by points that are dragged"),
        (Self::Map, "Real map", "A map of elevations; fit it, and get more ground of its kind"),
    ];
}

/// What becomes of a map.
#[derive(Clone, Debug, Default)]
pub enum Fitting {
    #[default]
    Idle,
    /// Asked for, and not begun.
    Wanted,
    Running(Arc<Progress>),
}

/// Ground that can be built.
#[derive(Clone, Debug)]
pub enum GroundPlan {
    Random(TurningBandsSettings),
    Spline(SplineGroundSettings),
    Map(Arc<MapFit>),
}

impl PartialEq for GroundPlan {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Random(own), Self::Random(other)) => own == other,
            (Self::Spline(own), Self::Spline(other)) => own == other,
            // Large, and never changed.
            (Self::Map(own), Self::Map(other)) => Arc::ptr_eq(own, other),
            _ => false,
        }
    }
}

/// Ground that is edited.
pub struct GroundDesk {
    pub kind: GroundKind,
    pub random: Session<TurningBandsSettings>,
    pub spline: Session<SplineGroundSettings>,
    pub request: MapRequest,
    pub fitting: Fitting,
    pub fit: Option<Arc<MapFit>>,
    /// Which of the fits more ground is made by.
    pub chosen_fit: usize,
    /// The control point that was held last.
    pub point: Option<ControlPoint>,
    pub is_held: bool,
    /// Whether the ground stands in the world.
    pub is_shown: bool,
}

impl GroundDesk {
    pub fn new(random: Session<TurningBandsSettings>, spline: Session<SplineGroundSettings>) -> Self {
        Self {
            kind: GroundKind::default(),
            random,
            spline,
            request: MapRequest::default(),
            fitting: Fitting::default(),
            fit: None,
            chosen_fit: 0,
            point: None,
            is_held: false,
            is_shown: false,
        }
    }

    /// The session of the kind that is open; that of random ground for a map, which is what comes of it.
    pub fn session(&mut self) -> &mut dyn FileSession {
        match self.kind {
            GroundKind::Random | GroundKind::Map => &mut self.random,
            GroundKind::Spline => &mut self.spline,
        }
    }

    /// Tells of something in the session of the kind that is open.
    pub fn tell(&mut self, message: Option<Message>) {
        match self.kind {
            GroundKind::Random | GroundKind::Map => self.random.message = message,
            GroundKind::Spline => self.spline.message = message,
        }
    }

    /// Opens a file of either kind, by its ending.
    pub fn open(&mut self, path: &Path) {
        let is_spline = path.to_string_lossy().ends_with(self.spline.extension());
        self.kind = if is_spline { GroundKind::Spline } else { GroundKind::Random };
        self.session().open_another(path);
    }

    /// The ground as it is now; none while it is not valid, or there is no map.
    pub fn plan(&self) -> Option<GroundPlan> {
        match self.kind {
            GroundKind::Random => {
                let settings = self.random.document();
                self.random.error().is_none().then(|| GroundPlan::Random(settings.clone()))
            }
            GroundKind::Spline => {
                let settings = self.spline.document();
                self.spline.error().is_none().then(|| GroundPlan::Spline(settings.clone()))
            }
            GroundKind::Map => self.fit.clone().map(GroundPlan::Map),
        }
    }

    /// The surface of the control points as they are now, for what is drawn over it.
    pub fn spline_ground(&self) -> Option<Arc<dyn Ground>> {
        let ground = SplineGround::new(self.spline.document()).ok()?;
        Some(Arc::new(ground))
    }

    /// Takes over what became of the map.
    pub fn take_fit(&mut self, fit: Result<MapFit, NoFit>) {
        self.fitting = Fitting::Idle;
        let message = match fit {
            Ok(fit) => {
                let name = fit.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
                self.chosen_fit = 0;
                self.fit = Some(Arc::new(fit));
                Message::Done(format!("Fitted {name}"))
            }
            Err(NoFit::Cancelled) => Message::Done("The fit was cancelled".into()),
            Err(NoFit::Failed(error)) => Message::Failed(error),
        };
        self.random.message = Some(message);
    }

    /// Makes random ground of the map's kind.
    pub fn make_more(&mut self) {
        let seed = self.random.document().seed;
        let Some(settings) = self.fit.as_ref().and_then(|fit| fit.settings(self.chosen_fit, seed)) else {
            self.random.message = Some(Message::Failed("This fit cannot be made into ground".into()));
            return;
        };
        self.random.change(settings, "Ground of the map's kind");
        self.random.end_gesture();
        self.kind = GroundKind::Random;
    }

    /// Takes hold of a control point.
    pub fn take(&mut self, point: ControlPoint) {
        (self.point, self.is_held) = (Some(point), true);
    }

    /// Moves the point that is chosen to a height, m.
    pub fn raise_to(&mut self, to_m: f32) {
        let Some(point) = self.point else { return };
        if let Some(settings) = with_height(self.spline.document(), point, to_m) {
            self.spline.change(settings, "Move a control point");
        }
    }

    /// Lets go.
    pub fn release(&mut self) {
        if std::mem::take(&mut self.is_held) {
            self.spline.end_gesture();
        }
    }

    /// The height of the point that is chosen, m.
    pub fn point_height_m(&self) -> Option<f32> {
        height_m(self.spline.document(), self.point?)
    }

    /// One more patch.
    pub fn add_patch(&mut self) {
        self.spline.change(with_patch(self.spline.document()), "Add a patch");
        self.spline.end_gesture();
    }

    /// Takes the patch of the chosen point away; the last one, if none is chosen.
    pub fn remove_patch(&mut self) {
        let mut settings = self.spline.document().clone();
        let last = settings.patches.len().saturating_sub(1);
        let patch = self.point.map_or(last, |point| point.patch);
        if patch < settings.patches.len() {
            settings.patches.remove(patch);
            self.spline.change(settings, "Remove a patch");
            self.spline.end_gesture();
            self.point = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn desk() -> GroundDesk {
        let spline =
            SplineGroundSettings::from_ron(include_str!("../../assets/terrain/five_patches.ground.ron")).unwrap();
        GroundDesk::new(
            Session::new(Path::new("new.bands.ron"), TurningBandsSettings::default()),
            Session::new(Path::new("new.ground.ron"), spline),
        )
    }

    #[test]
    fn a_point_that_is_dragged_is_one_step() {
        let mut desk = desk();
        desk.kind = GroundKind::Spline;
        let before = desk.plan();
        desk.take(ControlPoint { patch: 1, number: 2 });
        for to_m in [40.0, 44.0, 51.0] {
            desk.raise_to(to_m);
        }
        desk.release();
        assert_eq!(desk.point_height_m(), Some(51.0));
        desk.session().undo();
        assert_eq!((desk.plan(), desk.session().undo_step()), (before, None));
    }

    #[test]
    fn patches_come_and_go() {
        let mut desk = desk();
        desk.add_patch();
        assert_eq!(desk.spline.document().patches.len(), 6);
        desk.point = Some(ControlPoint { patch: 0, number: 0 });
        desk.remove_patch();
        assert_eq!((desk.spline.document().patches.len(), desk.point), (5, None));
        (0..9).for_each(|_| desk.remove_patch());
        assert!(desk.spline.document().patches.is_empty() && desk.spline_ground().is_some());
    }

    #[test]
    fn a_map_becomes_random_ground_of_its_kind() {
        let mut desk = desk();
        desk.kind = GroundKind::Map;
        assert_eq!(desk.plan(), None);
        desk.take_fit(Err(NoFit::Cancelled));
        desk.make_more();
        assert!(matches!(desk.random.message, Some(Message::Failed(_))) && desk.kind == GroundKind::Map);
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/terrain/rmnp-dem-16bit.png").to_owned();
        let request = MapRequest { path, cell_x_m: 233.0, cell_z_m: 234.0, metres_per_unit: 1.0 };
        desk.take_fit(MapFit::of(&request, &Progress::default()));
        assert!(matches!(desk.plan(), Some(GroundPlan::Map(_))));
        desk.make_more();
        assert_eq!(desk.kind, GroundKind::Random);
        assert!(desk.random.document().mean_m > 2500.0 && desk.random.error().is_none());
        desk.session().undo();
        assert_eq!(*desk.random.document(), TurningBandsSettings::default());
    }

    #[test]
    fn ground_that_is_wrong_is_not_built() {
        let mut desk = desk();
        desk.random.change(TurningBandsSettings { lines: 1, ..Default::default() }, "Lines");
        assert_eq!(desk.plan(), None);
        desk.open(Path::new("nowhere/x.ground.ron"));
        assert_eq!(desk.kind, GroundKind::Spline);
        assert!(matches!(desk.spline.message, Some(Message::Failed(_))));
    }
}
