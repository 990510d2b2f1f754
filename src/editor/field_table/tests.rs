use super::*;
use crate::{
    editor::fields::all_fields,
    tree::{Growth, Species, crown::impressionist::ImpressionistCrown, growth::zaharia},
    wind::FieldSettings,
};

fn table(species: &Species) -> Section {
    fields_of(species, Species::validate)
}

fn find<'a>(table: &'a Section, name: &str) -> &'a Field {
    all_fields(table).into_iter().find(|field| field.name == name).unwrap_or_else(|| panic!("{name}"))
}

/// A species of each growth model, and one with all that is optional.
fn every_species() -> Vec<Species> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/species");
    let files = std::fs::read_dir(folder).unwrap().map(|file| std::fs::read_to_string(file.unwrap().path()).unwrap());
    let mut all: Vec<Species> = files.map(|text| Species::from_ron(&text).unwrap()).collect();
    all.push(Species { growth: Growth::Oak(zaharia::Oak::default()), ..Species::default() });
    all
}

#[test]
fn fields_have_labels_units_ranges_and_documentation() {
    let table = table(&Species::default());
    let height = find(&table, "growth.trunk.height_m");
    assert_eq!((height.label.as_str(), height.unit.unwrap().symbol), ("Height", "m"));
    assert!(!height.docs.is_empty() && !height.docs.contains('`'), "{}", height.docs);
    // The range depends on another field, and the check knows it.
    assert_eq!(height.range.as_ref().map(|range| *range.start()), Some(0.5));
    assert!(find(&table, "growth.orders[1].spacing_m").range.is_some());
    assert_eq!(find(&table, "seed").kind, Kind::Seed);
    assert_eq!(find(&table, "foliage.leaf.colour").kind, Kind::Colour);
    assert_eq!(find(&table, "phenology.autumn_colours[1]").label, "Autumn colours 2");
    let Kind::Choice(choices) = &find(&table, "wood.bark.pattern").kind else { panic!("a choice") };
    assert!(choices.iter().any(|choice| choice.name == "Plates" && choice.docs.contains("pine")));
}

/// No field of any species is left out: as many as there are plain values in what is written of it.
#[test]
fn every_value_of_every_species_has_its_field() {
    for species in every_species() {
        let written = serde_json::to_value(&species).unwrap();
        let fields = table(&species);
        let shown: usize = all_fields(&fields).iter().map(|field| if field.kind == Kind::Colour { 3 } else { 1 }).sum();
        assert_eq!(shown, values(&written), "{}", species.name);
    }
}

/// Plain values, and for a variant with settings one more: its name.
fn values(json: &serde_json::Value) -> usize {
    match json {
        serde_json::Value::Object(fields) => {
            let is_variant = fields.len() == 1 && fields.keys().all(|name| name.starts_with(char::is_uppercase));
            fields.values().map(values).sum::<usize>() + usize::from(is_variant)
        }
        serde_json::Value::Array(items) => items.iter().map(values).sum(),
        _ => 1,
    }
}

#[test]
fn every_number_has_a_range_and_the_ends_of_it_pass_its_own_check() {
    for species in every_species() {
        let fields = table(&species);
        for field in all_fields(&fields).into_iter().filter(|field| matches!(field.kind, Kind::Number | Kind::Whole)) {
            // The one has to be above another field, the others are a direction of any length.
            let is_open = field.name.ends_with("full_speed_m_s") || field.name.contains("towards");
            let Some(range) = field.range.clone() else {
                assert!(is_open, "{}: {}", species.name, field.name);
                continue;
            };
            let now = number(species.reflect_path(field.path.as_str()).unwrap()).unwrap();
            // What is written as 0.01 is a little less with 32 bits.
            let stored = *range.start() as f32..=*range.end() as f32;
            assert!(stored.contains(&(now as f32)), "{}: {} is {now}, not in {range:?}", species.name, field.name);
            for end in [*range.start(), *range.end()] {
                let mut changed = species.clone();
                set_number(changed.reflect_path_mut(field.path.as_str()).unwrap(), end);
                // Another field may have to follow, but the changed one is not what is wrong in itself.
                let error = changed.validate().err().filter(|error| error.field == field.name);
                let is_of_itself = error.as_ref().is_some_and(|error| allowed_range(&error.allowed).is_some());
                let rounds = error
                    .as_ref()
                    .is_some_and(|error| (error.value.parse::<f64>().unwrap() - end).abs() < 1e-6 * end.abs());
                assert!(!is_of_itself || rounds, "{}: {error:?}", species.name);
            }
        }
    }
}

#[test]
fn every_field_of_a_species_is_documented() {
    for species in every_species() {
        let fields = table(&species);
        for field in all_fields(&fields) {
            assert!(!field.docs.is_empty(), "{}: {}", species.name, field.name);
        }
    }
}

#[test]
fn a_wind_has_fields_too() {
    let table = fields_of(&FieldSettings::default(), FieldSettings::validate);
    assert_eq!(find(&table, "speed").range, Some(0.0..=75.0));
    assert_eq!(find(&table, "direction").kind, Kind::Direction);
}

#[test]
fn numbers_of_all_types_are_set() {
    let mut crown = ImpressionistCrown::default();
    set_number(crown.reflect_path_mut("polygons").unwrap(), 12.6);
    set_number(crown.reflect_path_mut("curve").unwrap(), 1.25);
    assert_eq!((crown.polygons, crown.curve), (13, 1.25));
    assert_eq!(number(crown.reflect_path("polygons").unwrap()), Some(13.0));
}

#[test]
fn documentation_is_plain_text() {
    assert_eq!(
        plain(" See [`Age`](super::Age), `a` to 3. domain: \\[0, 1\\].\n More."),
        "See Age, a to 3. domain: [0, 1]. More."
    );
}
