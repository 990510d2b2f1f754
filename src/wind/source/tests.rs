use super::{blast::SOUND_SPEED_M_S, *};
use bevy::math::DVec3;
use std::f64::consts::PI;

const NOW: SourceMoment = SourceMoment { age_s: 1.0, before_s: 0.98, strength: 1.0 };
const WIDE_M: f32 = 1e4;

fn flow(kind: SourceKind, place: Vec3) -> SourceFlow {
    SourceFlow::new(&kind, place, Quat::IDENTITY, WIDE_M, NOW).expect("it blows")
}

fn downwash() -> SourceFlow {
    let kind = SourceKind::Downwash { rotor_radius_m: 5.0, thrust_n: 20_000.0, ground_m: 3.0 };
    flow(kind, Vec3::new(7.0, 23.0, -4.0))
}

fn cone() -> SourceFlow {
    flow(SourceKind::Cone { speed_m_s: 30.0, nozzle_radius_m: 0.5, half_angle_deg: 5.37 }, Vec3::new(1.0, 2.0, 3.0))
}

fn vortex() -> SourceFlow {
    let kind = SourceKind::Vortex { speed_m_s: 20.0, core_radius_m: 2.0, length_m: 40.0, spreading_m2_s: 0.3 };
    flow(kind, Vec3::new(-3.0, 10.0, 2.0))
}

/// Divergence by central differences, 1/s, and the size of the gradient.
fn divergence(flow: &SourceFlow, at: Vec3) -> (f32, f32) {
    const STEP_M: f32 = 0.02;
    let slope = |axis: Vec3| (flow.velocity(at + axis * STEP_M) - flow.velocity(at - axis * STEP_M)) / (2.0 * STEP_M);
    let [x, y, z] = Vec3::AXES.map(slope);
    (x.x + y.y + z.z, (x.length_squared() + y.length_squared() + z.length_squared()).sqrt())
}

#[test]
fn air_neither_comes_nor_goes_in_flows_without_compression() {
    for flow in [downwash(), cone(), vortex()] {
        let mut seen = 0;
        for k in 0..400 {
            let k = k as f32;
            let out = Vec3::new((1.3 * k).sin(), 0.35 + 0.3 * (0.7 * k).cos(), (2.1 * k).cos() - 1.1) * (0.05 * k);
            // Above the ground and before the nozzle.
            let at = flow.place + out.with_y(out.y.abs() + 0.1) - Vec3::Z * 0.2;
            let (divergence, gradient) = divergence(&flow, at);
            seen += usize::from(gradient > 0.05);
            assert!(divergence.abs() < 0.01 * gradient + 0.01, "{:?} at {at}: {divergence} of {gradient}", flow.form);
        }
        assert!(seen > 50, "{:?} blows at {seen} places only", flow.form);
    }
}

#[test]
fn a_wake_has_the_momentum_of_the_thrust() {
    let flow = downwash();
    let height_m = 12.0;
    let (steps, step_m) = (4000, 0.01);
    let momentum: f64 = (0..steps)
        .map(|step| (f64::from(step) + 0.5) * step_m)
        .map(|r| {
            let down = f64::from(flow.velocity(flow.place + Vec3::new(r as f32, height_m, 0.0)).y);
            1.225 * down * down * 2.0 * PI * r * step_m
        })
        .sum();
    assert!((momentum / 20_000.0 - 1.0).abs() < 2e-3, "{momentum} N");
}

#[test]
fn outwash_is_as_fast_as_the_wake_and_falls_with_distance() {
    let flow = downwash();
    let speed = |r: f32| flow.velocity(flow.place + Vec3::X * r).x;
    let fastest = (1..2000).map(|step| speed(step as f32 * 0.01)).fold(0.0, f32::max);
    let wake = -flow.velocity(flow.place + Vec3::Y * 12.0).y;
    assert!((fastest / wake - 1.0).abs() < 2e-3, "{fastest} against {wake}");
    assert!((speed(30.0) / speed(60.0) - 2.0).abs() < 1e-3);
    // The ground lets nothing through, and above the rotor air is drawn in.
    assert!(flow.velocity(flow.place + Vec3::new(4.0, 0.0, 3.0)).y == 0.0);
    assert!(flow.velocity(flow.place + Vec3::new(5.0, 22.5, 0.0)).x < 0.0);
    assert!(flow.velocity(flow.place + Vec3::Y * 26.0).length() < 1e-6);
}

#[test]
fn a_jet_keeps_its_momentum_and_has_half_its_speed_at_its_angle() {
    let flow = cone();
    let along = |x: f32, r: f32| -flow.velocity(flow.place + Vec3::new(r, 0.0, -x)).z;
    let momentum = |x: f32| -> f64 {
        let ring = |step: u32| (f64::from(step) + 0.5) * 0.01;
        (0..6000).map(ring).map(|r| f64::from(along(x, r as f32)).powi(2) * 2.0 * PI * r * 0.01).sum()
    };
    assert!((momentum(5.0) / momentum(40.0) - 1.0).abs() < 1e-3);
    let origin_m = flow.numbers[1];
    for x in [1.0, 10.0, 50.0] {
        let half = (x + origin_m) * 5.37_f32.to_radians().tan();
        assert!((along(x, half) / along(x, 0.0) - 0.5).abs() < 1e-3, "{x}");
    }
    assert!((along(0.0, 0.0) - 30.0).abs() < 1e-3 && along(-1.0, 0.0) == 0.0);
}

#[test]
fn a_vortex_is_fastest_at_its_core_and_keeps_its_circulation() {
    let kind = SourceKind::Vortex { speed_m_s: 20.0, core_radius_m: 2.0, length_m: 40.0, spreading_m2_s: 0.3 };
    for age_s in [0.0, 9.0] {
        let at = SourceMoment { age_s, before_s: age_s, strength: 1.0 };
        let flow = SourceFlow::new(&kind, Vec3::ZERO, Quat::IDENTITY, WIDE_M, at).expect("it blows");
        let speed = |r: f32| -flow.velocity(Vec3::X * r).z;
        let core_m = (4.0 + 4.0 * 1.256_431 * 0.3 * age_s).sqrt();
        let fastest = (1..4000).map(|step| step as f32 * 0.005).max_by(|a, b| speed(*a).total_cmp(&speed(*b)));
        assert!((fastest.unwrap_or(0.0) / core_m - 1.0).abs() < 0.01, "{fastest:?} is not {core_m}");
        assert!((speed(core_m) - 20.0 * 2.0 / core_m).abs() < 1e-3);
        assert!((speed(200.0) * 200.0 / (20.0 * 2.0 * (1.0 + 0.5 / 1.256_431)) - 1.0).abs() < 1e-4);
    }
    // It turns the way its axis says, and ends with its length.
    assert!(vortex().velocity(vortex().place + Vec3::X).z < 0.0);
    assert_eq!(vortex().velocity(vortex().place + Vec3::new(1.0, 21.0, 0.0)), Vec3::ZERO);
}

/// Sadovskii's formulas (1952) for TNT in free air: 0.085/Z + 0.3/Z^2 + 0.8/Z^3 `MPa`, and a positive phase of 1.2 sqrt(Z) ms.
#[test]
fn blasts_have_about_the_pressure_and_duration_that_others_have_found() {
    for scaled_m in [1.0_f32, 2.0, 5.0, 10.0] {
        let over_atm = (0.085 / scaled_m + 0.3 / scaled_m.powi(2) + 0.8 / scaled_m.powi(3)) / 0.101_325;
        let ratio = blast::overpressure_atm(scaled_m) / over_atm;
        assert!((ratio - 1.0).abs() < 0.25, "{scaled_m}: {ratio}");
        let ratio = 1e3 * blast::positive_phase_s(scaled_m) / (1.2 * scaled_m.sqrt());
        // Next to the charge the two differ by more.
        assert!(scaled_m < 2.0 || (ratio - 1.0).abs() < 0.35, "{scaled_m}: {ratio}");
    }
    // Rankine and Hugoniot: at 1 atm the wind behind the front is 178 m/s.
    let scaled_m = (100..400).map(|step| step as f32 * 0.01).find(|z| blast::overpressure_atm(*z) < 1.0).unwrap_or(0.0);
    assert!((blast::peak_m_s(scaled_m) - 178.0).abs() < 2.0, "{}", blast::peak_m_s(scaled_m));
}

#[test]
fn fronts_are_first_faster_than_sound_and_then_as_fast() {
    let speed = |time_s: f32| (blast::front_scaled_m(time_s + 1e-3) - blast::front_scaled_m(time_s)) / 1e-3;
    assert!(speed(0.001) > 1.5 * SOUND_SPEED_M_S);
    assert!((speed(0.5) / SOUND_SPEED_M_S - 1.0).abs() < 0.01);
}

/// The air that a blast carries off comes back: the integral of the velocity over time is small beside that of its size.
#[test]
fn air_comes_back_after_a_blast() {
    let kind = SourceKind::Blast { charge_kg: 100.0 };
    let (mut sum, mut size) = (DVec3::ZERO, 0.0);
    for step in 0..40_000 {
        let age_s = step as f32 * 2e-5;
        let at = SourceMoment { age_s, before_s: age_s, strength: 1.0 };
        let Some(flow) = SourceFlow::new(&kind, Vec3::ZERO, Quat::IDENTITY, WIDE_M, at) else { break };
        let velocity = flow.velocity(Vec3::X * 40.0).as_dvec3();
        sum += velocity;
        size += velocity.length();
    }
    assert!(sum.length() < 0.02 * size && size > 0.0, "{sum} of {size}");
}

/// Looked at a few times a frame, a pulse has the impulse that it has when looked at ten thousand times.
#[test]
fn pulses_have_the_same_impulse_at_any_frame_rate() {
    let kind = SourceKind::Blast { charge_kg: 400.0 };
    let place = Vec3::new(18.0, 2.0, 14.0);
    let impulse = |frame_s: f64| -> f64 {
        let frames = (0.6 / frame_s) as u32;
        let mut sum = 0.0;
        for frame in 0..frames {
            let [before_s, age_s] = [frame, frame + 1].map(|frame| (f64::from(frame) * frame_s) as f32);
            let at = SourceMoment { age_s, before_s, strength: 1.0 };
            let Some(flow) = SourceFlow::new(&kind, Vec3::ZERO, Quat::IDENTITY, WIDE_M, at) else { break };
            let loads = flow.pulse(place).map(|(u, share)| f64::from(share * u.length() * u.dot(place.normalize())));
            sum += frame_s * loads.sum::<f64>();
        }
        sum
    };
    let fine = impulse(1e-4);
    for frame_s in [1.0 / 240.0, 1.0 / 60.0, 1.0 / 20.0] {
        let coarse = impulse(frame_s);
        assert!((coarse / fine - 1.0).abs() < 0.03, "{frame_s}: {coarse} against {fine}");
    }
}

#[test]
fn sources_end_at_their_reach() {
    for kind in [
        SourceKind::Cone { speed_m_s: 40.0, nozzle_radius_m: 1.0, half_angle_deg: 20.0 },
        SourceKind::Downwash { rotor_radius_m: 5.0, thrust_n: 5e4, ground_m: -2.0 },
        SourceKind::Vortex { speed_m_s: 30.0, core_radius_m: 3.0, length_m: 60.0, spreading_m2_s: 0.0 },
    ] {
        let flow = SourceFlow::new(&kind, Vec3::ZERO, Quat::IDENTITY, 12.0, NOW).expect("it blows");
        for k in 0..100 {
            let direction = Quat::from_rotation_y(k as f32) * Vec3::new(0.9, -0.1, 0.3).normalize();
            assert_eq!(flow.velocity(flow.place + direction * 12.01), Vec3::ZERO);
        }
        assert!(!flow.touches(Vec3::new(0.0, 0.0, 40.0), 20.0, 0.1));
    }
    let blast = SourceKind::Blast { charge_kg: 1.0 };
    let late = SourceMoment { age_s: 9.0, before_s: 8.9, strength: 1.0 };
    assert_eq!(SourceFlow::new(&blast, Vec3::ZERO, Quat::IDENTITY, 100.0, late), None);
}

#[test]
fn what_blows_in_a_ball_touches_it() {
    let cone = cone();
    let aside = cone.place + Vec3::new(3.0, 0.0, -20.0);
    assert!(cone.touches(aside, 3.0, 1.0) && !cone.touches(cone.place + Vec3::Z * 9.0, 3.0, 1.0));
    let kind = SourceKind::Blast { charge_kg: 100.0 };
    let flow = SourceFlow::new(&kind, Vec3::ZERO, Quat::IDENTITY, 300.0, NOW);
    assert!(
        flow.is_some_and(|flow| flow.touches(Vec3::X * 290.0, 80.0, 0.1) && !flow.touches(Vec3::X * 50.0, 10.0, 0.1))
    );
}

#[test]
fn no_place_and_no_source_gives_a_velocity_that_is_no_number() {
    let odd = [f32::NAN, f32::INFINITY, -1.0, 0.0, 1e30];
    for flow in [downwash(), cone(), vortex(), flow(SourceKind::Blast { charge_kg: 10.0 }, Vec3::ZERO)] {
        for x in odd {
            for at in [Vec3::splat(x), Vec3::X * x, flow.place] {
                assert!(
                    flow.velocity(at).is_finite()
                        && flow.pulse(at).all(|(u, share)| u.is_finite() && share.is_finite())
                );
                flow.touches(at, x, 1.0);
            }
        }
    }
    assert_eq!(SourceFlow::new(&SourceKind::default(), Vec3::NAN, Quat::IDENTITY, 10.0, NOW), None);
}

#[test]
fn settings_out_of_range_are_named() {
    let error = SourceKind::Blast { charge_kg: 0.0 }.validate().unwrap_err();
    assert_eq!(error.to_string(), "`charge_kg` is 0, but must be 0.001 to 100000");
    let error = SourceKind::Cone { speed_m_s: 10.0, nozzle_radius_m: 1.0, half_angle_deg: f32::NAN }.validate();
    assert!(error.unwrap_err().to_string().starts_with("`half_angle_deg` is NaN"));
    SourceKind::default().validate().unwrap();
}
