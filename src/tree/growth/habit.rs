//! The habit of a branch: how it runs from its bud.

/// How a branch runs from its bud.
pub(super) struct Habit {
    pub segments: u32,
    pub crook_rad: f32,
    pub rise: f32,
    pub sag: f32,
}
