//! A cross-fade from one value to the next, with a smooth weight.
//!
//! While one fade runs, the newest successor waits. Fades never overlap, so there are never more than two values at once.

use bevy::math::FloatExt;

/// A value that changes by a cross-fade: `from` alone, or `from` and `to` with a weight between them.
#[derive(Clone, Debug)]
pub struct CrossFade<T> {
    from: T,
    to: Option<T>,
    waiting: Option<(T, f32)>,
    elapsed_s: f32,
    duration_s: f32,
}

/// What a step of the fade did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FadeStep<T> {
    /// Nothing runs.
    Rest,
    /// A new successor has begun to fade in; its weight is still 0.
    Began,
    /// A fade runs.
    Running,
    /// The successor is now the only value. This is the one that it replaced.
    Finished(T),
}

impl<T> CrossFade<T> {
    /// Starts with one value.
    pub fn new(first: T) -> Self {
        Self { from: first, to: None, waiting: None, elapsed_s: 0.0, duration_s: 0.0 }
    }

    /// Adds a successor that takes `duration_s` seconds to fade in (0, less or NaN: one step). Its fade begins with the
    /// next step that finds no fade running. Of several waiting, the last counts: the one before it is returned.
    pub fn succeed(&mut self, next: T, duration_s: f32) -> Option<T> {
        self.waiting.replace((next, duration_s.max(0.0))).map(|(before, _)| before)
    }

    /// Advances by `delta_s` seconds.
    pub fn advance(&mut self, delta_s: f32) -> FadeStep<T> {
        if self.to.is_some() {
            self.elapsed_s += delta_s.max(0.0);
            if self.elapsed_s < self.duration_s {
                return FadeStep::Running;
            }
        }
        if let Some(to) = self.to.take() {
            return FadeStep::Finished(std::mem::replace(&mut self.from, to));
        }
        match self.waiting.take() {
            Some((next, duration_s)) => {
                self.to = Some(next);
                self.elapsed_s = 0.0;
                self.duration_s = duration_s;
                FadeStep::Began
            }
            None => FadeStep::Rest,
        }
    }

    /// The value that fades out, or the only one.
    pub fn from(&self) -> &T {
        &self.from
    }

    /// The value that fades in.
    pub fn to(&self) -> Option<&T> {
        self.to.as_ref()
    }

    /// All values that blow or will: one to three.
    pub fn values(&self) -> impl Iterator<Item = &T> {
        let waiting = self.waiting.as_ref().map(|(next, _)| next);
        [Some(&self.from), self.to.as_ref(), waiting].into_iter().flatten()
    }

    /// The value in force once all fades are done.
    pub fn newest(&self) -> &T {
        self.waiting.as_ref().map(|(next, _)| next).or(self.to.as_ref()).unwrap_or(&self.from)
    }

    /// Weight of [`to`](Self::to), 0..1, with zero slope at both ends.
    pub fn weight(&self) -> f32 {
        if self.to.is_none() {
            return 0.0;
        }
        if self.duration_s > 0.0 { self.elapsed_s.smoothstep(0.0, self.duration_s) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weight_grows_from_zero_to_one_and_the_successor_replaces_the_value() {
        let mut fade = CrossFade::new('a');
        assert_eq!(fade.advance(0.1), FadeStep::Rest);
        fade.succeed('b', 1.0);
        assert_eq!(fade.advance(0.1), FadeStep::Began);
        assert_eq!(fade.weight(), 0.0);
        let mut last = 0.0;
        for _ in 0..9 {
            assert_eq!(fade.advance(0.1), FadeStep::Running);
            assert!(fade.weight() > last && fade.weight() < 1.0);
            last = fade.weight();
        }
        assert_eq!(fade.advance(0.2), FadeStep::Finished('a'));
        assert_eq!((*fade.from(), fade.to(), fade.weight()), ('b', None, 0.0));
    }

    #[test]
    fn the_last_successor_during_a_fade_follows_it() {
        let mut fade = CrossFade::new('a');
        fade.succeed('b', 1.0);
        fade.advance(0.0);
        assert_eq!(fade.succeed('c', 1.0), None);
        assert_eq!(fade.succeed('d', 1.0), Some('c'));
        assert_eq!(*fade.newest(), 'd');
        assert_eq!((*fade.from(), fade.to().copied()), ('a', Some('b')));
        assert_eq!(fade.advance(2.0), FadeStep::Finished('a'));
        assert_eq!(fade.advance(0.0), FadeStep::Began);
        assert_eq!((*fade.from(), fade.to().copied()), ('b', Some('d')));
    }

    #[test]
    fn fade_without_duration_takes_one_step() {
        let mut fade = CrossFade::new(1);
        fade.succeed(2, 0.0);
        assert_eq!(fade.advance(0.0), FadeStep::Began);
        assert_eq!(fade.advance(0.0), FadeStep::Finished(1));
        assert_eq!(*fade.from(), 2);
    }
}
