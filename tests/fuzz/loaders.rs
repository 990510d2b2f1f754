//! Every reader of files, with damaged files: an error or something that is sound, and never a panic.

use super::{
    damage::{damaged, damaged_text},
    from_environment, seed,
    table::read_table,
};
use bevy::math::{IVec2, Vec3};
use bevy_windwood::{
    LevelGround,
    scatter::{ForestPlan, Planter},
    terrain::{Elevation, ElevationSettings, RawLayout, RawSample},
    tree::{Species, individual::grow},
};
use image::{DynamicImage, ImageBuffer, ImageFormat, Luma};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::{fs, io::Cursor, path::Path};

/// Cases of each reader with every test, and in a long run.
const FEW: u32 = 2000;
const MANY: u32 = 1_000_000;

/// The files of a folder with one of these endings.
fn files(folder: &str, endings: &[&str]) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = fs::read_dir(folder).expect("it is there").map(|entry| entry.expect("an entry").path());
    let mut paths: Vec<_> =
        entries.filter(|path| endings.iter().any(|ending| path.to_string_lossy().ends_with(ending))).collect();
    paths.sort();
    let files: Vec<_> = paths.iter().map(|path| fs::read(path).expect("a file")).collect();
    assert!(!files.is_empty());
    files
}

fn texts(folder: &str, endings: &[&str]) -> Vec<String> {
    files(folder, endings).into_iter().map(|bytes| String::from_utf8(bytes).expect("text")).collect()
}

/// Damages one of the files `cases` times; `check` says whether it was read.
fn run<T>(name: &str, cases: u32, files: &[T], mut check: impl FnMut(&T, &mut Xoshiro256PlusPlus) -> bool) {
    let cases = from_environment("FUZZ_CASES", cases);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed());
    let read = (0..cases).filter(|_| check(&files[random.random_range(0..files.len())], &mut random)).count();
    println!("{name}: {cases} files, {read} of them read");
}

fn species(cases: u32) {
    run("species", cases, &texts("assets/species", &[".species.ron"]), |text, random| {
        let Ok(species) = Species::from_ron(&damaged_text(text, random)) else { return false };
        species.validate().expect("what was read is valid");
        if random.random_range(0..200) == 0 {
            let tree = grow(&species, 3.0, 1);
            let is_sound = |place: Vec3| place.is_finite() && place.length() < 1e4;
            assert!(tree.beams.iter().all(|beam| is_sound(beam.path(1.0)) && beam.base_radius_m.is_finite()));
            assert!(tree.clusters.iter().all(|cluster| is_sound(cluster.anchor) && cluster.size_m.is_finite()));
        }
        true
    });
}

fn plans(cases: u32) {
    run("plans", cases, &texts("assets/forests", &[".forest.ron"]), |text, random| {
        let Ok(plan) = ForestPlan::from_ron(&damaged_text(text, random)) else { return false };
        let planter = Planter::new(&plan).expect("what was read is valid");
        if random.random_range(0..200) == 0 {
            let mut plants = Vec::new();
            planter.plant(IVec2::ZERO, &LevelGround(0.0), &mut plants);
            assert!(plants.iter().all(|plant| plant.position.is_finite() && plant.plan_size > 0.0));
        }
        true
    });
}

fn read_elevation(name: &str, bytes: &[u8], settings: &ElevationSettings) -> bool {
    let Ok(elevation) = Elevation::read(name, bytes, settings) else { return false };
    assert!(elevation.grid.heights_m().iter().all(|height| height.is_finite()), "{name}");
    true
}

fn told() -> ElevationSettings {
    ElevationSettings::with_cells(30.0, 30.0)
}

fn pngs(cases: u32) {
    let picture = ImageBuffer::from_fn(9, 7, |x, y| Luma([(100 * x * y) as u16]));
    let mut small = Cursor::new(Vec::new());
    DynamicImage::ImageLuma16(picture).write_to(&mut small, ImageFormat::Png).expect("a picture");
    let mut all = vec![small.into_inner(); 9];
    all.extend(files("tests/data/cases/elevation", &["eight-bit.png"]));
    run("PNG", cases, &all, |bytes, random| read_elevation("a.png", &damaged(bytes, random), &told()));
}

fn raws(cases: u32) {
    let samples = [
        RawSample::U16LittleEndian,
        RawSample::U16BigEndian,
        RawSample::I16LittleEndian,
        RawSample::I16BigEndian,
        RawSample::F32LittleEndian,
        RawSample::F32BigEndian,
    ];
    run("raw", cases, &samples, |sample, random| {
        let (columns, rows) = (random.random_range(0..12), random.random_range(0..12));
        let wide = if matches!(sample, RawSample::F32LittleEndian | RawSample::F32BigEndian) { 4 } else { 2 };
        let fitting = (columns * rows * wide) as usize;
        let length = if random.random() { fitting } else { random.random_range(0..200) };
        let bytes: Vec<u8> = (0..length).map(|_| random.random()).collect();
        let raw = Some(RawLayout { columns, rows, sample: *sample });
        read_elevation("a.raw", &bytes, &ElevationSettings { raw, ..told() })
    });
}

fn geotiffs(cases: u32) {
    let files = files("tests/data/cases/elevation", &[".tif"]);
    run("GeoTIFF", cases, &files, |bytes, random| read_elevation("a.tif", &damaged(bytes, random), &told()));
}

fn grids(cases: u32) {
    let small = "ncols 4\nnrows 3\nxllcorner 423000\nyllcorner 4446000\ncellsize 30\nNODATA_value -9999\n\
                 1 2 3 4\n5 -9999 7 8\n9 10 11 12.5\n";
    run("grids", cases, &[small.to_string()], |text, random| {
        read_elevation("a.asc", damaged_text(text, random).as_bytes(), &told())
    });
}

fn tables(cases: u32) {
    let files = files("tests/data/cases/tables", &[".csv", ".txt", ".tsv"]);
    run("tables", cases, &files, |bytes, random| {
        let Ok(table) = read_table(&damaged(bytes, random), None, |_| Ok(())) else { return false };
        assert!(table.points.iter().all(|point| point.is_finite()));
        true
    });
}

macro_rules! loaders {
    ($($loader:ident: $few:ident, $many:ident;)+) => {
        $(
            #[test]
            fn $few() {
                $loader(FEW);
            }

            #[test]
            #[ignore = "a long run: some minutes"]
            fn $many() {
                $loader(MANY);
            }
        )+
    };
}

loaders! {
    species: damaged_species_are_refused_or_sound, many_damaged_species_are_refused_or_sound;
    plans: damaged_plans_are_refused_or_sound, many_damaged_plans_are_refused_or_sound;
    pngs: damaged_pngs_are_refused_or_sound, many_damaged_pngs_are_refused_or_sound;
    raws: raw_samples_are_refused_or_sound, many_raw_samples_are_refused_or_sound;
    geotiffs: damaged_geotiffs_are_refused_or_sound, many_damaged_geotiffs_are_refused_or_sound;
    grids: damaged_grids_are_refused_or_sound, many_damaged_grids_are_refused_or_sound;
    tables: damaged_tables_are_refused_or_sound, many_damaged_tables_are_refused_or_sound;
}
