//! A table that the graphics processor reads, as it is on the processor, and what of it has still to be sent.

/// Rows that did not change are sent along where no more of them lie between two that did: one copy costs more than a few
/// rows.
const GAP: u32 = 16;
/// Rows for which there is room at first.
const FIRST_ROOM: u32 = 256;

/// For how many there is to be room: half as many again as are needed, so that what grows seldom needs more.
pub(super) fn with_reserve(count: u32) -> u32 {
    count + count / 2
}

/// Rows, and which of them were written since they were last sent.
pub(super) struct Table<T> {
    rows: Vec<T>,
    /// Each once, in any order.
    written: Vec<u32>,
    is_written: Vec<bool>,
    /// Rows for which there is room on the graphics processor.
    room: u32,
}

impl<T> Default for Table<T> {
    fn default() -> Self {
        Self { rows: Vec::new(), written: Vec::new(), is_written: Vec::new(), room: 0 }
    }
}

impl<T: Copy + Default> Table<T> {
    #[cfg(test)]
    pub fn rows(&self) -> &[T] {
        &self.rows
    }

    pub fn len(&self) -> u32 {
        self.rows.len() as u32
    }

    /// What it has on the graphics processor, bytes.
    pub fn bytes(&self) -> usize {
        self.room as usize * size_of::<T>()
    }

    /// Whether there is anything to send.
    pub fn has_news(&self) -> bool {
        !self.written.is_empty()
    }

    /// Makes it no shorter than this; rows that are new are default ones.
    pub fn reach(&mut self, length: u32) {
        for row in self.len()..length {
            self.rows.push(T::default());
            self.is_written.push(true);
            self.written.push(row);
        }
    }

    /// Drops the rows from `length` on. What was sent of them stays where it is, and nobody reads it.
    pub fn truncate(&mut self, length: u32) {
        self.rows.truncate(length as usize);
        self.is_written.truncate(length as usize);
        self.written.retain(|row| *row < length);
    }

    pub fn get(&self, row: u32) -> Option<&T> {
        self.rows.get(row as usize)
    }

    /// A row that is about to be written.
    pub fn get_mut(&mut self, row: u32) -> Option<&mut T> {
        let is_written = self.is_written.get_mut(row as usize)?;
        if !std::mem::replace(is_written, true) {
            self.written.push(row);
        }
        self.rows.get_mut(row as usize)
    }

    pub fn write(&mut self, row: u32, to: T) {
        if let Some(there) = self.get_mut(row) {
            *there = to;
        }
    }

    /// Makes room on the graphics processor for all rows, with a reserve, and says whether there was too little: then
    /// everything has to be sent anew.
    pub fn make_room(&mut self) -> bool {
        if self.len() <= self.room {
            return false;
        }
        self.room = with_reserve(self.len()).max(FIRST_ROOM);
        self.written.clear();
        self.written.extend(0..self.rows.len() as u32);
        self.is_written.fill(true);
        true
    }

    /// Sends what was written: rows one after another, and the number of the first of them.
    pub fn send(&mut self, mut send: impl FnMut(u32, &[T])) {
        let Self { rows, written, is_written, .. } = self;
        written.sort_unstable();
        for run in written.chunk_by(|before, after| after - before <= GAP + 1) {
            if let [first, .., last] | [first @ last] = run {
                send(*first, &rows[*first as usize..=*last as usize]);
            }
        }
        written.drain(..).for_each(|row| is_written[row as usize] = false);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

    #[test]
    fn what_is_sent_makes_the_copy_the_same() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
        let (mut table, mut copy) = (Table::<u32>::default(), Vec::new());
        for round in 0..300 {
            match random.random_range(0..8) {
                0 => table.reach(table.len() + random.random_range(0..200)),
                1 => table.truncate(table.len() - table.len() / 5),
                _ => {}
            }
            for _ in 0..random.random_range(0..20) {
                let row = random.random_range(0..table.len().max(1));
                if let Some(row) = table.get_mut(row) {
                    *row = round;
                }
            }
            if table.make_room() {
                copy = vec![u32::MAX; table.room as usize];
            }
            table.send(|first, rows| copy[first as usize..][..rows.len()].copy_from_slice(rows));
            assert_eq!(copy[..table.rows().len()], *table.rows(), "round {round}");
            assert!(!table.has_news());
        }
    }

    #[test]
    fn only_what_was_written_is_sent_and_what_lies_close_between() {
        let mut table = Table::<u32>::default();
        table.reach(1000);
        table.make_room();
        table.send(|_, _| ());
        for row in [700, 3, 4, 4 + GAP + 1, 900, 700] {
            table.get_mut(row);
        }
        let mut runs = Vec::new();
        table.send(|first, rows| runs.push((first, rows.len() as u32)));
        assert_eq!(runs, [(3, GAP + 3), (700, 1), (900, 1)]);
        table.send(|_, _| panic!("there is nothing to send"));
    }
}
