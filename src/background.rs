//! Work that no frame waits for.

use bevy::tasks::{AsyncComputeTaskPool, Task, block_on, poll_once};
use std::{
    any::Any,
    fmt,
    panic::{AssertUnwindSafe, catch_unwind},
};

/// Work in the background that may panic: whoever takes its result over tells of that, and goes on with what was there before.
pub(crate) type Work<T> = Task<Result<T, WorkerPanic>>;

/// What a worker panicked with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct WorkerPanic(String);

impl fmt::Display for WorkerPanic {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "a worker panicked: {}", self.0)
    }
}

impl From<Box<dyn Any + Send>> for WorkerPanic {
    fn from(payload: Box<dyn Any + Send>) -> Self {
        let text = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
        let text = text.or_else(|| payload.downcast_ref::<String>().cloned());
        Self(text.unwrap_or_else(|| "without a message".to_owned()))
    }
}

/// Has work done in the background. A panic ends the work and not the program: the frame that polls a plain task of Bevy's would panic as
/// well. What the work has of its own is dropped then, and so nothing is seen half done.
pub(crate) fn spawn_work<T: Send + 'static>(work: impl FnOnce() -> T + Send + 'static) -> Work<T> {
    AsyncComputeTaskPool::get().spawn(async move { catch_unwind(AssertUnwindSafe(work)).map_err(WorkerPanic::from) })
}

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

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::tasks::TaskPool;

    #[test]
    fn a_panic_is_a_result_with_its_message() {
        AsyncComputeTaskPool::get_or_init(TaskPool::new);
        assert_eq!(block_on(spawn_work(|| 3)), Ok(3));
        let number = 7;
        let panics: [(Work<()>, &str); 3] = [
            (spawn_work(|| panic!("no ground")), "a worker panicked: no ground"),
            (spawn_work(move || panic!("beam {number}")), "a worker panicked: beam 7"),
            (spawn_work(|| std::panic::panic_any(3)), "a worker panicked: without a message"),
        ];
        for (work, message) in panics {
            assert_eq!(block_on(work).unwrap_err().to_string(), message);
        }
        // The pool has lost no thread by that.
        assert_eq!(block_on(spawn_work(|| 4)), Ok(4));
    }
}
