//! The tool `characterise` as its users run it, with valid and invalid maps and patterns.

use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use rand_distr::{Distribution, Normal};
use serde_json::Value;
use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};
use tempfile::TempDir;

#[path = "../examples/support/arguments.rs"]
mod arguments;
#[path = "characterise/given_files.rs"]
mod given_files;
#[path = "characterise/in_words.rs"]
mod in_words;
#[path = "../tools/characterise/note.rs"]
#[expect(dead_code, reason = "the example prints notes, these tests read them")]
mod note;
#[path = "../tools/characterise/options.rs"]
#[expect(dead_code, reason = "the example takes options over, these tests parse them")]
mod options;
#[path = "../tools/characterise/polygon.rs"]
mod polygon;
#[path = "../tools/characterise/table/mod.rs"]
#[expect(dead_code, reason = "the example reads files with it, these tests text")]
mod table;
#[path = "../tools/characterise/window.rs"]
#[expect(dead_code, reason = "the example counts in windows, these tests cut them")]
mod window;
#[path = "../tools/characterise/words.rs"]
#[expect(dead_code, reason = "the example speaks of laws, these tests of places")]
mod words;

const CASES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/cases");
const ROCKIES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/terrain/rmnp-dem-16bit.png");

/// The example, which cargo builds beside the folder of the tests.
fn example() -> PathBuf {
    let test = std::env::current_exe().expect("a test knows where it is");
    let built = test.parent().and_then(Path::parent).expect("tests are built in `deps`");
    let example = built.join("examples/characterise").with_extension(std::env::consts::EXE_EXTENSION);
    assert!(example.is_file(), "run `cargo build --example characterise` first: it is not in {}", built.display());
    example
}

/// Runs the example in `folder`.
fn run(folder: &TempDir, arguments: &[&str]) -> Output {
    Command::new(example()).args(arguments).current_dir(folder).output().expect("the example starts")
}

/// What it complains of, in one line.
fn complaint(folder: &TempDir, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {error}");
    assert_eq!(error.lines().count(), 1, "{arguments:?}: {error}");
    error.trim_end().to_owned()
}

/// Runs the example, which must succeed, and reads `found.json`.
fn found(folder: &TempDir, arguments: &[&str]) -> Value {
    let output = run(folder, &[arguments, &["--json", "found.json", "--out", "sub/picture.png"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let picture = image::open(folder.path().join("sub/picture.png")).expect("there is a picture").into_rgb8();
    assert!(picture.width() > 1000 && picture.height() > 500, "{:?}", picture.dimensions());
    assert!(picture.pixels().any(|pixel| pixel.0.iter().all(|&channel| channel < 80)), "nothing is drawn");
    let json = fs::read_to_string(folder.path().join("found.json")).expect("there is a JSON file");
    serde_json::from_str(&json).expect("it is JSON")
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("there is room for a folder")
}

/// Writes a file into the folder.
fn write(folder: &TempDir, name: &str, bytes: impl AsRef<[u8]>) {
    fs::write(folder.path().join(name), bytes).expect("the folder can be written to");
}

fn csv(points: impl IntoIterator<Item = [f64; 2]>) -> String {
    points.into_iter().fold("x,y\n".to_owned(), |text, [x, y]| text + &format!("{x},{y}\n"))
}

/// Points anywhere in 60 x 40 m.
fn random_points(seed: u64, number: usize) -> Vec<[f64; 2]> {
    let random = &mut Xoshiro256PlusPlus::seed_from_u64(seed);
    (0..number).map(|_| [60.0 * random.random::<f64>(), 40.0 * random.random::<f64>()]).collect()
}

/// The path of a given file.
fn case(name: &str) -> String {
    format!("{CASES}/{name}")
}

/// The notes of a result, each behind `!` if it is a warning.
fn notes(json: &Value) -> Vec<String> {
    let note = |note: &Value| {
        let mark = if note["is_warning"] == true { "!" } else { "" };
        format!("{mark}{}", note["text"].as_str().expect("a text"))
    };
    json["notes"].as_array().expect("a list").iter().map(note).collect()
}

fn number(json: &Value) -> f64 {
    json.as_f64().unwrap_or_else(|| panic!("{json} is no number"))
}

#[test]
fn the_shipped_map_is_characterised() {
    let folder = folder();
    let json = found(&folder, &["terrain", ROCKIES, "--cell-size", "233", "--cell-size-z", "234"]);
    assert_eq!((json["map"]["columns"].clone(), json["map"]["rows"].clone()), (152.into(), 187.into()));
    assert_eq!((number(&json["map"]["least_m"]), number(&json["map"]["greatest_m"])), (2281.0, 4261.0));
    let fits = json["fits"].as_array().expect("a list");
    assert_eq!(fits.len(), 8);
    assert!(fits.is_sorted_by_key(|fit| number(&fit["error"])), "{fits:?}");
    assert!((0.0..0.2).contains(&number(&fits[0]["error"])), "{fits:?}");
    for fit in fits {
        let deviation_m = number(&fit["deviation_m"]);
        assert!((number(&fit["sill_m2"]) / deviation_m.powi(2) - 1.0).abs() < 1e-9, "{fit}");
        assert_eq!(fit["dimension"].is_number(), fit["model"] == "fractal", "{fit}");
    }
    assert!(json["variogram"].as_array().is_some_and(|classes| classes.len() > 20));
    assert_eq!(number(&json["simulated"]["scale_m"]), number(&fits[0]["scale_m"]));
}

#[test]
fn bases_and_units_shift_and_stretch_the_elevations() {
    let folder = folder();
    let scaled = ["--cell-size", "30", "--metres-per-unit", "0.1", "--base", "-100"];
    let json = found(&folder, &[&["terrain", ROCKIES], &scaled[..]].concat());
    assert!((number(&json["map"]["least_m"]) - 128.1).abs() < 1e-3);
    assert!((number(&json["map"]["greatest_m"]) - 326.1).abs() < 1e-3);
}

#[test]
fn a_random_pattern_is_found_to_be_random() {
    let folder = folder();
    write(&folder, "random.csv", csv(random_points(3, 2400)));
    let json = found(&folder, &["points", "random.csv", "--window", "0,0,60,40"]);
    assert_eq!(json["points"], 2400);
    assert_eq!(json["quadrats"], serde_json::json!([60, 40]));
    let dispersion = &json["dispersion"];
    let [low, high] = [0, 1].map(|end| number(&dispersion["index_if_random"][end]));
    assert!(low < 1.0 && high > 1.0 && high - low < 0.15, "{dispersion}");
    assert!((low..=high).contains(&number(&dispersion["index"])), "{dispersion}");
    assert_eq!(dispersion["verdict"], "random", "{dispersion}");
    let laws = json["laws"].as_array().expect("a list");
    assert_eq!(laws.len(), 6);
    let poisson = laws.iter().find(|law| law["law"] == "Poisson").expect("it is never left out");
    // A law with a parameter more gains half of a chi-square variable by chance.
    assert!(number(&poisson["aic"]) - number(&laws[0]["aic"]) < 4.0, "{laws:?}");
    assert!(number(&poisson["p"]) > 0.01, "{poisson}");
}

#[test]
fn clumps_are_found_to_be_clumps_and_rows_to_be_regular() {
    let folder = folder();
    let random = &mut Xoshiro256PlusPlus::seed_from_u64(7);
    let spread = Normal::new(0.0, 0.3).expect("a valid law");
    let mut clumps = Vec::new();
    for [x, y] in random_points(4, 200) {
        clumps.extend((0..8).map(|_| [x + spread.sample(random), y + spread.sample(random)]));
    }
    clumps.retain(|[x, y]| (0.0..60.0).contains(x) && (0.0..40.0).contains(y));
    write(&folder, "clumps.csv", csv(clumps));
    let json = found(&folder, &["points", "clumps.csv", "--window", "0,0,60,40", "--quadrats", "30x20"]);
    assert_eq!(json["quadrats"], serde_json::json!([30, 20]));
    assert_eq!(json["dispersion"]["verdict"], "clustered");
    assert!(json["laws"][0]["law"] != "Poisson" && json["laws"][0]["law"] != "binomial", "{json:#}");
    assert!(json["laws"][0]["by_likelihood"].is_object(), "{json:#}");

    let mut jitter = || 1.4 * (random.random::<f64>() - 0.5);
    let rows = (0..2400).map(|index| [f64::from(index % 60), f64::from(index / 60)]);
    let rows = rows.map(|[x, y]| [(x + 0.5 + jitter()).clamp(0.0, 60.0), (y + 0.5 + jitter()).clamp(0.0, 40.0)]);
    write(&folder, "rows.csv", csv(rows.collect::<Vec<_>>()));
    let json = found(&folder, &["points", "rows.csv", "--window", "0,0,60,40"]);
    assert_eq!(json["dispersion"]["verdict"], "regular", "{}", json["dispersion"]);
    assert_eq!(json["laws"][0]["law"], "binomial");
}

#[test]
fn the_same_seed_draws_the_same_picture() {
    let folder = folder();
    write(&folder, "points.csv", csv(random_points(1, 300)));
    let picture = |seed: &str| {
        let output = run(&folder, &["points", "points.csv", "--window", "0,0,60,40", "--seed", seed]);
        assert!(output.status.success());
        fs::read(folder.path().join("out/characterise_points.png")).expect("there is a picture")
    };
    let first = picture("1");
    assert!(first == picture("1") && first != picture("2"));
}

#[test]
fn bad_maps_are_refused_in_one_line_that_names_them() {
    let folder = folder();
    let rockies = fs::read(ROCKIES).expect("it is shipped");
    write(&folder, "cut.png", &rockies[..rockies.len() / 2]);
    write(&folder, "text.png", "no picture at all");
    let picture = |name: &str, image: image::DynamicImage| image.save(folder.path().join(name)).expect("writable");
    picture("eight.png", image::GrayImage::new(20, 20).into());
    let grey = |columns, rows| image::ImageBuffer::<image::Luma<u16>, _>::new(columns, rows);
    picture("level.png", grey(20, 20).into());
    picture("dot.png", grey(1, 1).into());
    picture("wide.png", grey(4097, 4097).into());

    let of = |file: &str| complaint(&folder, &["terrain", file, "--cell-size", "30"]);
    assert!(of("cut.png").starts_with("cut.png: the elevation file cannot be read: "), "{}", of("cut.png"));
    assert!(
        of("text.png")
            .starts_with("text.png: the elevation file is of no kind that is known, but must be a PNG, a GeoTIFF, ")
    );
    assert_eq!(
        of("eight.png"),
        "eight.png: the elevation file is a PNG with L8 samples, but must be a PNG with 16 bits of grey (L16): 8 bits have 256 heights only, \
         and do not say which; `--height-range LOW,HIGH` does"
    );
    assert!(of("level.png").starts_with("level.png: all elevations lie in one plane"));
    assert_eq!(of("dot.png"), "dot.png: `columns` is 1, but must be 2 to 16384");
    assert_eq!(of("wide.png"), "wide.png: `columns x rows` is 16785409, but must be 0 to 16777216");
    assert!(of("missing.png").starts_with("missing.png: "));
    assert!(of(".").starts_with(".: "));
}

#[test]
fn bad_options_are_refused_in_one_line_that_names_them() {
    let folder = folder();
    let terrain = |options: &[&str]| complaint(&folder, &[&["terrain", ROCKIES], options].concat());
    for bad in ["0", "-30", "nan", "inf", "wide"] {
        let error = terrain(&[&format!("--cell-size={bad}")]);
        assert!(error.contains(bad) && error.ends_with("expected a number from 0.001 to 7000 m"), "{error}");
    }
    assert_eq!(
        terrain(&[]).split_once(": ").map(|(_, error)| error.to_owned()),
        Some(
            "`--cell-size` is not given, but must be given, in metres: the file does not have the size of its cells"
                .to_owned()
        )
    );
    assert!(terrain(&["--cell-size", "30", "--height-range", "9,3"]).contains("expected LOW below HIGH"));
    assert!(terrain(&["--cell-size", "30", "--no-data", "none"]).ends_with("expected a number, or nan"));
    assert!(terrain(&["--cell-size", "30", "--raw", "9x9"]).contains("but 9 x 9 need 162"));
    assert!(terrain(&["--cell-size", "30", "--metres-per-unit", "0"]).contains("0.000001 to 1000 m"));
    let unwritable = terrain(&["--cell-size", "30", "--out", &format!("{ROCKIES}/below/a/file.png")]);
    assert!(unwritable.contains("rmnp-dem-16bit.png/below/a: "), "{unwritable}");

    write(&folder, "points.csv", csv(random_points(1, 300)));
    let window = |window: &str| complaint(&folder, &["points", "points.csv", "--window", window]);
    assert!(window("0,0,60").ends_with("expected four numbers X0,Y0,X1,Y1, but there are 3"));
    assert!(window("0,0,60,north").ends_with("for each of X0,Y0,X1,Y1"));
    assert!(window("0,0,0,40").contains("its size is 0 x 40 m, but must be at least 0.001 m each way"));
    assert!(window("60,0,0,40").contains("its size is -60 x 40 m"));
    let quadrats =
        |quadrats: &str| complaint(&folder, &["points", "points.csv", "--window", "0,0,60,40", "--quadrats", quadrats]);
    assert!(quadrats("0x4").contains("each from 1 to 4096"));
    assert_eq!(quadrats("1x1"), "points.csv: `quadrats` is 1, but must be 2 to 2^40");
}

#[test]
fn bad_points_are_refused_in_one_line_that_names_file_line_and_value() {
    let folder = folder();
    let of = |text: &str| {
        write(&folder, "points.csv", text);
        complaint(&folder, &["points", "points.csv", "--window", "0,0,60,40"])
    };
    let good = csv(random_points(1, 300));
    assert_eq!(of(&(good.clone() + "1,oak\n")), "points.csv: line 302: column 2 is `oak`, but must be a finite number");
    assert_eq!(
        of(&(good.clone() + "\n# far\n1,40.5\n")),
        "points.csv: line 304: the point [1, 40.5] is outside the window, but must be from [0, 0] to [60, 40]"
    );
    assert!(of(&(good + "1\n")).starts_with("points.csv: line 302: there is no column 2"));
    assert_eq!(of(""), "points.csv: there are 0 points, but must be at least 20");
    assert_eq!(of("x,y\n1,1\n"), "points.csv: there are 1 points, but must be at least 20");
    assert!(of(&"5,5\n".repeat(5000)).starts_with("points.csv: `plants in one quadrat` is 5000"));
    assert!(complaint(&folder, &["points", "none.csv", "--window", "0,0,60,40"]).starts_with("none.csv: "));
}
