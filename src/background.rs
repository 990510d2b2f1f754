//! Work that no frame waits for.

use bevy::tasks::AsyncComputeTaskPool;

/// Drops a value in the background: to free tens of megabytes takes milliseconds of a frame. What shares the value drops its share in
/// this way too, since the last to do so frees it.
pub(crate) fn drop_in_background<T: Send + 'static>(value: T) {
    AsyncComputeTaskPool::get().spawn(async move { drop(value) }).detach();
}
