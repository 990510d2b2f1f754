//! The clock of what the processor has worked, which stands still while a thread waits for a core.

use std::time::Duration;

/// The CPU time of the current thread, where there is such a clock.
#[cfg(unix)]
pub const CPU_CLOCK: Option<fn() -> Duration> = Some(|| {
    use rustix::time::{ClockId, clock_gettime};
    Duration::try_from(clock_gettime(ClockId::ThreadCPUTime)).unwrap_or_default()
});
#[cfg(not(unix))]
pub const CPU_CLOCK: Option<fn() -> Duration> = None;
