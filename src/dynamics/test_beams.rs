//! Beams and winds that tests share.

use super::{
    beam::{BeamDynamics, BeamSway, BeamWind, NO_PARENT},
    frequency_classes::FrequencyClasses,
    mean_wind::MeanWind,
    oscillator_grid::OscillatorGrid,
    second_mode::SecondMode,
    stand_wind::StandWind,
};
use crate::wind::LogProfile;
use bevy::math::Vec3;

/// An oak's trunk in leaf.
pub(crate) const OAK: BeamSway = BeamSway {
    gain: 1e-3,
    class: 8.0,
    averaging_speed_m_s: 0.9,
    drag_damping_s_m: 5e-3,
    load_height_m: 10.0,
    drag_exponent: -0.35,
    second: SecondMode { class_offset: 0.0, share: 0.0 },
};

/// A wind over open country of that speed at 10 m.
pub(crate) fn wind(speed_m_s: f32) -> BeamWind {
    let mean = MeanWind::new(&LogProfile::from_reference(speed_m_s, 0.1, 0.0), 10.0);
    let grid = OscillatorGrid::new(FrequencyClasses::default(), 0.05, speed_m_s, 10.0);
    BeamWind { stand: StandWind::open(mean), grid }
}

/// An upright beam on the ground that sways alike in leaf and bare.
pub(crate) fn upright(sway: BeamSway, length_m: f32) -> BeamDynamics {
    BeamDynamics {
        stiff_axis: Vec3::ZERO,
        base: Vec3::ZERO,
        length_m,
        direction: Vec3::Y,
        attach: 0.0,
        parent: NO_PARENT,
        angle_limit_rad: 1.1,
        compliance_rad_n_m: 1e-6,
        in_leaf: sway,
        bare: sway,
    }
}
