//! Taking leave of what is large.

use bevy::tasks::AsyncComputeTaskPool;

/// Drops something in the background: to give tens of megabytes back takes milliseconds of a frame. Whoever shares it lets
/// go of it in this way, for the last to do so drops it.
pub(crate) fn retire<T: Send + 'static>(gone: T) {
    AsyncComputeTaskPool::get().spawn(async move { drop(gone) }).detach();
}
