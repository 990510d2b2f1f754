//! How long our systems take.

use bevy::{
    ecs::system::{Adapt, IntoAdapterSystem, IntoSystem, RunSystemError, System, SystemIn},
    prelude::*,
};
use std::{
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
    time::{Duration, Instant},
};

/// How long each of our systems ran in this frame, or in the last where it has not run yet. What it costs is two looks at
/// the clock a system.
#[derive(Resource, Default)]
pub struct SystemTimes(Vec<(&'static str, Arc<AtomicU64>)>);

impl SystemTimes {
    /// The name of every system that is watched, and its time.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, Duration)> + '_ {
        self.0.iter().map(|(name, nanoseconds)| (*name, Duration::from_nanos(nanoseconds.load(Ordering::Relaxed))))
    }

    /// All together, as if none ran beside another.
    #[must_use]
    pub fn total(&self) -> Duration {
        self.iter().map(|(_, time)| time).sum()
    }
}

/// Writes how long a system runs.
#[derive(Clone)]
pub(crate) struct Timed(Arc<AtomicU64>);

impl<S: System<In = (), Out = ()>> Adapt<S> for Timed {
    type In = ();
    type Out = ();

    fn adapt(
        &mut self,
        (): (),
        run: impl FnOnce(SystemIn<'_, S>) -> Result<(), RunSystemError>,
    ) -> Result<(), RunSystemError> {
        let begun = Instant::now();
        let result = run(());
        let nanoseconds = u64::try_from(begun.elapsed().as_nanos()).unwrap_or(u64::MAX);
        self.0.store(nanoseconds, Ordering::Relaxed);
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
        app.init_resource::<SystemTimes>().add_systems(First, forget_times);
    }
    let nanoseconds = Arc::new(AtomicU64::new(0));
    app.world_mut().resource_mut::<SystemTimes>().0.push((name, nanoseconds.clone()));
    IntoAdapterSystem::new(Timed(nanoseconds), system)
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
    times.0.iter().for_each(|(_, nanoseconds)| nanoseconds.store(0, Ordering::Relaxed));
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
}
