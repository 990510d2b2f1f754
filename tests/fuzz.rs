//! Files that are damaged at random, and games that do anything in any order: nothing panics, leaks or becomes a number that is none.
//!
//! A few cases run with every test. The long runs are ignored by default:
//!
//! ```sh
//! cargo test --test fuzz -- --ignored --nocapture        # 10^6 files for each reader, 10^4 sequences of a game
//! FUZZ_CASES=1000 cargo test --test fuzz -- --ignored    # other numbers
//! FUZZ_SEED=7 cargo test --test fuzz                     # other cases
//! ```

#[path = "fuzz/damage.rs"]
mod damage;
#[path = "fuzz/loaders.rs"]
mod loaders;
#[path = "../tools/characterise/note.rs"]
#[expect(dead_code, reason = "the example prints notes")]
mod note;
#[path = "fuzz/sequences.rs"]
mod sequences;
#[path = "support/server.rs"]
mod server;
#[path = "../tools/characterise/table/mod.rs"]
#[expect(dead_code, reason = "the example reads files with it, these tests text")]
mod table;

/// A number from the environment, or the one that is usual.
fn from_environment<T: std::str::FromStr>(name: &str, usual: T) -> T {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// The seed of all cases.
fn seed() -> u64 {
    from_environment("FUZZ_SEED", 1)
}
