//! How long our systems take.

use bevy::{
    ecs::{
        message::MessageUpdateSystems,
        system::{Adapt, IntoAdapterSystem, IntoSystem, RunSystemError, System, SystemIn},
    },
    prelude::*,
};
use std::{
    sync::{
        Arc, LazyLock, OnceLock,
        atomic::{AtomicU64, Ordering},
    },
    time::{Duration, Instant},
};

/// How long each of our systems ran in this frame, or in the last where it has not run yet. What it costs is two looks at
/// the clock a system.
#[derive(Resource, Default)]
pub struct SystemTimes {
    systems: Vec<(&'static str, Arc<AtomicU64>)>,
    clock: Arc<OnceLock<Clock>>,
}

type Clock = fn() -> Duration;

/// The clock on the wall: since it was first looked at.
fn wall_time() -> Duration {
    static BEGINNING: LazyLock<Instant> = LazyLock::new(Instant::now);
    BEGINNING.elapsed()
}

impl SystemTimes {
    /// The name of every system that is watched, and its time.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, Duration)> + '_ {
        self.systems
            .iter()
            .map(|(name, nanoseconds)| (*name, Duration::from_nanos(nanoseconds.load(Ordering::Relaxed))))
    }

    /// All together, as if none ran beside another.
    #[must_use]
    pub fn total(&self) -> Duration {
        self.iter().map(|(_, time)| time).sum()
    }

    /// Has times taken from another clock from now on: say, one of the time that the processor has spent on a thread, which
    /// stands still while a system waits for a core. A system runs on one thread from beginning to end. Of several clocks the
    /// first counts.
    pub fn use_clock(&self, clock: fn() -> Duration) {
        self.clock.get_or_init(|| clock);
    }
}

/// Writes how long a system runs.
#[derive(Clone)]
pub(crate) struct Timed {
    nanoseconds: Arc<AtomicU64>,
    clock: Arc<OnceLock<Clock>>,
}

impl<S: System<In = (), Out = ()>> Adapt<S> for Timed {
    type In = ();
    type Out = ();

    fn adapt(
        &mut self,
        (): (),
        run: impl FnOnce(SystemIn<'_, S>) -> Result<(), RunSystemError>,
    ) -> Result<(), RunSystemError> {
        let clock = self.clock.get().copied().unwrap_or(wall_time);
        let begun = clock();
        let result = run(());
        let time = clock().saturating_sub(begun);
        self.nanoseconds.store(u64::try_from(time.as_nanos()).unwrap_or(u64::MAX), Ordering::Relaxed);
        result
    }
}

/// A system that is watched: its time stands among the app's [`SystemTimes`] under that name.
pub(crate) fn timed_as<Marker, S: IntoSystem<(), (), Marker>>(
    app: &mut App,
    name: &'static str,
    system: S,
) -> IntoAdapterSystem<Timed, S> {
    if !app.world().contains_resource::<SystemTimes>() {
        app.init_resource::<SystemTimes>().add_systems(First, forget_times.after(MessageUpdateSystems));
    }
    let nanoseconds = Arc::new(AtomicU64::new(0));
    let mut times = app.world_mut().resource_mut::<SystemTimes>();
    times.systems.push((name, nanoseconds.clone()));
    let clock = times.clock.clone();
    IntoAdapterSystem::new(Timed { nanoseconds, clock }, system)
}

/// Systems that are watched under their own names, as [`timed_as`] does.
macro_rules! timed {
    ($app:expr, $($system:ident),+ $(,)?) => {
        ($($crate::timing::timed_as($app, stringify!($system), $system)),+)
    };
}
pub(crate) use timed;

/// A system that does not run takes no time.
fn forget_times(times: Res<SystemTimes>) {
    times.systems.iter().for_each(|(_, nanoseconds)| nanoseconds.store(0, Ordering::Relaxed));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_that_takes_its_time_is_found_out() {
        let mut app = App::new();
        let slow = timed_as(&mut app, "slow", || std::thread::sleep(Duration::from_millis(3)));
        let never = timed_as(&mut app, "never", || {});
        app.add_systems(Update, (slow, never.run_if(|| false)));
        app.update();
        let times: Vec<_> = app.world().resource::<SystemTimes>().iter().collect();
        assert!(times[0].0 == "slow" && times[0].1 >= Duration::from_millis(3), "{times:?}");
        assert_eq!(times[1], ("never", Duration::ZERO));
        assert_eq!(app.world().resource::<SystemTimes>().total(), times[0].1);
    }

    #[test]
    fn times_are_those_of_the_clock_that_is_read() {
        static HOURS: AtomicU64 = AtomicU64::new(0);
        let mut app = App::new();
        let system = timed_as(&mut app, "two hours", || {
            HOURS.fetch_add(2, Ordering::Relaxed);
        });
        app.add_systems(Update, system);
        let clock = || Duration::from_secs(3600 * HOURS.load(Ordering::Relaxed));
        app.world().resource::<SystemTimes>().use_clock(clock);
        app.update();
        assert_eq!(app.world().resource::<SystemTimes>().total(), Duration::from_secs(7200));
    }
}
