//! Maps and tables as people have them (`tests/data/cases`).

use super::*;

#[test]
fn elevations_in_other_containers_are_characterised_alike() {
    let folder = folder();
    let rockies = found(&folder, &["terrain", ROCKIES, "--cell-size", "233", "--cell-size-z", "234"]);
    let scale_m = number(&rockies["fits"][0]["scale_m"]);
    let voids = ["--cell-size", "233", "--cell-size-z", "234", "--no-data"];
    let cases: [(&str, &[&str]); 4] = [
        ("metres-with-nodata.tif", &[]),
        ("float-metres.tif", &[]),
        ("voids-65535.png", &[&voids[..], &["65535"]].concat()),
        ("signed-voids-read-as-unsigned.png", &[&voids[..], &["32768"]].concat()),
    ];
    for (name, options) in cases {
        let json = found(&folder, &[&["terrain", &case(&format!("elevation/{name}"))], options].concat());
        assert_eq!(json["map"]["cell_m"], serde_json::json!([233.0, 234.0]), "{name}");
        let (least_m, greatest_m) = (number(&json["map"]["least_m"]), number(&json["map"]["greatest_m"]));
        assert!(least_m >= 2280.0 && greatest_m <= 4262.0, "{name}: {least_m} to {greatest_m}");
        let gaps = number(&json["map"]["cells_without_data"]);
        let told = notes(&json);
        assert_eq!(told.len(), usize::from(gaps > 0.0), "{told:?}");
        assert!(told.iter().all(|note| note.starts_with(&format!("{gaps} of 28424 cells"))), "{told:?}");
        let ratio = number(&json["fits"][0]["scale_m"]) / scale_m;
        assert!((ratio - 1.0).abs() < 0.02, "{name}: a scale {ratio} times that of the whole map");
    }
    let json = found(&folder, &["terrain", &case("elevation/ascii-grid.asc")]);
    assert_eq!(json["map"]["cell_m"], serde_json::json!([466.0, 466.0]));
    let json = found(
        &folder,
        &["terrain", &case("elevation/eight-bit.png"), "--cell-size", "233", "--height-range", "2281,4261"],
    );
    assert_eq!((number(&json["map"]["least_m"]), number(&json["map"]["greatest_m"])), (2281.0, 4261.0));
}

#[test]
fn values_that_look_like_no_data_are_warned_about() {
    let folder = folder();
    for (name, value) in [("voids-65535.png", 65535), ("signed-voids-read-as-unsigned.png", 32768)] {
        let json = found(&folder, &["terrain", &case(&format!("elevation/{name}")), "--cell-size", "233"]);
        let told = notes(&json);
        assert!(told[0].starts_with('!') && told[0].ends_with(&format!("use --no-data {value}")), "{told:?}");
    }
}

#[test]
fn tables_are_read_and_what_was_left_out_is_told() {
    let folder = folder();
    let points = |name: &str| {
        found(&folder, &["points", &case(&format!("tables/{name}")), "--window", "0,0,120,80", "--quadrats", "9x6"])
    };
    for name in ["semicolon-bom-names.csv", "census.csv", "tabs.tsv"] {
        let json = points(name);
        assert_eq!((json["points"].clone(), notes(&json).len()), (80.into(), 1), "{name}: {json:#}");
    }
    assert!(notes(&points("missing-values.csv"))[0].ends_with("line 42"));
    let json = points("every-point-three-times.csv");
    assert!(notes(&json)[0].starts_with("!160 points stand where others do"), "{json:#}");
    let window = ["--window", "512000,4649000,512120,4649080"];
    assert_eq!(found(&folder, &[&["points", &case("tables/utm.csv")], &window[..]].concat())["points"], 80);
    let error = complaint(&folder, &["points", &case("tables/decimal-comma-unquoted.csv"), "--window", "0,0,120,80"]);
    assert!(error.contains("line 2: the row has 4 fields, but the header has 2"), "{error}");
    write(&folder, "own.csv", csv(random_points(1, 300)).replace("x,y", "stem_a,stem_b"));
    let own = |columns: &str| found(&folder, &["points", "own.csv", "--window", "0,0,60,40", "--columns", columns]);
    assert_eq!((own("stem_a,stem_b")["points"].clone(), own("1,2")["points"].clone()), (300.into(), 300.into()));
}
