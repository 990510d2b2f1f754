//! A table on the CPU side of a GPU buffer that knows which of its rows have to be uploaded.

/// Two uploads are joined where no more unchanged rows than this lie between them: one copy costs more than a few rows.
const MAX_GAP_ROWS: u32 = 16;
/// Capacity of the first buffer, rows.
const FIRST_CAPACITY: u32 = 256;

/// The capacity for so many rows: an eighth as many again, so that a growing table seldom needs another buffer.
pub(crate) fn with_reserve(count: u32) -> u32 {
    count + count / 8
}

/// Rows, and which of them were written since the last upload.
pub(crate) struct DirtyTable<T> {
    rows: Vec<T>,
    /// Rows that were written, each once, in any order.
    written: Vec<u32>,
    is_written: Vec<bool>,
    /// Rows that the GPU buffer holds.
    capacity: u32,
    /// Rows that the device can bind at most: the reserve ends there.
    most_rows: u32,
}

impl<T> Default for DirtyTable<T> {
    fn default() -> Self {
        Self::limited(u32::MAX)
    }
}

impl<T> DirtyTable<T> {
    /// A table of so many rows at most.
    pub fn limited(most_rows: u32) -> Self {
        Self { rows: Vec::new(), written: Vec::new(), is_written: Vec::new(), capacity: 0, most_rows }
    }
}

impl<T: Copy + Default> DirtyTable<T> {
    #[cfg(test)]
    pub fn rows(&self) -> &[T] {
        &self.rows
    }

    pub fn len(&self) -> u32 {
        self.rows.len() as u32
    }

    /// Size of the GPU buffer, bytes.
    pub fn bytes(&self) -> usize {
        self.capacity as usize * size_of::<T>()
    }

    /// Whether there is anything to upload.
    pub fn is_dirty(&self) -> bool {
        !self.written.is_empty()
    }

    /// Appends default rows up to a length.
    pub fn grow_to(&mut self, length: u32) {
        for row in self.len()..length {
            self.rows.push(T::default());
            self.is_written.push(true);
            self.written.push(row);
        }
    }

    /// Drops the rows from `length` on. Their values stay in the GPU buffer, where nothing reads them.
    pub fn truncate(&mut self, length: u32) {
        self.rows.truncate(length as usize);
        self.is_written.truncate(length as usize);
        self.written.retain(|row| *row < length);
    }

    pub fn get(&self, row: u32) -> Option<&T> {
        self.rows.get(row as usize)
    }

    /// A row to write. It counts as written.
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

    /// Grows the capacity if the rows have outgrown it, with a reserve. Returns whether it did: then the GPU buffer has to be
    /// replaced, and all rows count as written.
    pub fn grow_capacity(&mut self) -> bool {
        if self.len() <= self.capacity {
            return false;
        }
        let wanted = with_reserve(self.len()).max(FIRST_CAPACITY);
        self.capacity = wanted.min(self.most_rows).max(self.len());
        self.mark_all_written();
        true
    }

    fn mark_all_written(&mut self) {
        self.written.clear();
        self.written.extend(0..self.rows.len() as u32);
        self.is_written.fill(true);
    }

    /// The GPU buffer is gone: another is needed, with all rows.
    pub fn forget_buffer(&mut self) {
        self.capacity = 0;
        self.mark_all_written();
    }

    /// Uploads what was written, run by run: the number of the first row, and the rows.
    pub fn upload(&mut self, mut upload: impl FnMut(u32, &[T])) {
        let Self { rows, written, is_written, .. } = self;
        written.sort_unstable();
        for run in written.chunk_by(|before, after| after - before <= MAX_GAP_ROWS + 1) {
            if let [first, .., last] | [first @ last] = run {
                upload(*first, &rows[*first as usize..=*last as usize]);
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
    fn uploads_make_the_copy_equal() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
        let (mut table, mut copy) = (DirtyTable::<u32>::default(), Vec::new());
        for round in 0..300 {
            match random.random_range(0..8) {
                0 => table.grow_to(table.len() + random.random_range(0..200)),
                1 => table.truncate(table.len() - table.len() / 5),
                _ => {}
            }
            for _ in 0..random.random_range(0..20) {
                let row = random.random_range(0..table.len().max(1));
                if let Some(row) = table.get_mut(row) {
                    *row = round;
                }
            }
            if table.grow_capacity() {
                copy = vec![u32::MAX; table.capacity as usize];
            }
            table.upload(|first, rows| copy[first as usize..][..rows.len()].copy_from_slice(rows));
            assert_eq!(copy[..table.rows().len()], *table.rows(), "round {round}");
            assert!(!table.is_dirty());
        }
    }

    #[test]
    fn a_buffer_that_is_gone_gets_all_rows_again() {
        let mut table = DirtyTable::<u32>::default();
        table.grow_to(40);
        table.grow_capacity();
        table.upload(|_, _| ());
        assert!(!table.grow_capacity());
        table.forget_buffer();
        assert!(table.is_dirty() && table.grow_capacity());
        let mut uploaded = 0;
        table.upload(|_, rows| uploaded += rows.len());
        assert_eq!((uploaded, table.capacity), (40, FIRST_CAPACITY));
    }

    #[test]
    fn the_reserve_ends_where_the_device_cannot_bind_more() {
        let mut table = DirtyTable::<u32>::limited(1100);
        for (length, capacity) in [(100, FIRST_CAPACITY), (600, 675), (1000, 1100), (1100, 1100)] {
            table.grow_to(length);
            table.grow_capacity();
            assert_eq!(table.capacity, capacity, "{length}");
        }
    }

    #[test]
    fn close_runs_are_joined_and_distant_ones_are_not() {
        let mut table = DirtyTable::<u32>::default();
        table.grow_to(1000);
        table.grow_capacity();
        table.upload(|_, _| ());
        for row in [700, 3, 4, 4 + MAX_GAP_ROWS + 1, 900, 700] {
            table.get_mut(row);
        }
        let mut runs = Vec::new();
        table.upload(|first, rows| runs.push((first, rows.len() as u32)));
        assert_eq!(runs, [(3, MAX_GAP_ROWS + 3), (700, 1), (900, 1)]);
        table.upload(|_, _| panic!("nothing is dirty"));
    }
}
