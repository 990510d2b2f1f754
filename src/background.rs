//! Work that no frame waits for.

use bevy::tasks::{AsyncComputeTaskPool, Task, block_on, poll_once};

/// Drops a value in the background: to free tens of megabytes takes milliseconds of a frame. What shares the value drops its share in
/// this way too, since the last to do so frees it.
pub(crate) fn drop_in_background<T: Send + 'static>(value: T) {
    AsyncComputeTaskPool::get().spawn(async move { drop(value) }).detach();
}

/// Takes out what tasks have finished, with what they were begun for, in the order in which they were begun.
pub(crate) fn take_finished<K, T>(running: &mut Vec<(K, Task<T>)>) -> Vec<(K, T)> {
    let mut finished = Vec::new();
    let mut index = 0;
    while let Some((_, task)) = running.get_mut(index) {
        match block_on(poll_once(task)) {
            Some(value) => finished.push((running.remove(index).0, value)),
            None => index += 1,
        }
    }
    finished
}
