use super::*;
use crate::tree::{Growth, Species};

const OAK: &str = include_str!("../../../assets/species/oak.species.ron");

fn oak_in(folder: &Path) -> DocumentFile<Species> {
    let path = folder.join("oak.species.ron");
    fs::write(&path, OAK).unwrap();
    DocumentFile::<Species>::open(&path).unwrap()
}

fn shipped() -> impl Iterator<Item = PathBuf> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/species");
    fs::read_dir(folder).unwrap().map(|file| file.unwrap().path())
}

#[test]
fn what_did_not_change_is_saved_byte_for_byte() {
    let folder = tempfile::tempdir().unwrap();
    let mut file = oak_in(folder.path());
    let changed = Species { name: "elm".into(), ..file.document.clone() };
    file.save(&changed, None).unwrap();
    assert_eq!(fs::read_to_string(&file.path).unwrap(), OAK.replace("\"oak\"", "\"elm\""));
    let back = Species { name: "oak".into(), ..changed };
    file.save(&back, None).unwrap();
    assert_eq!(fs::read_to_string(&file.path).unwrap(), OAK);
}

/// Each shipped file, with a number, a word, a colour and a field that most of them leave out.
#[test]
fn comments_of_every_shipped_species_stay() {
    for path in shipped() {
        let file = DocumentFile::<Species>::open(&path).unwrap();
        let own = fs::read_to_string(&path).unwrap();
        assert_eq!(file.text_of(&file.document).unwrap().text, own);
        let mut changed = file.document.clone();
        changed.seed += 12345;
        changed.wood.density_kg_m3 += 1.5;
        changed.wood.bark.colour[1] = 0.123;
        changed.foliage.leaf.vein_pairs = 11;
        changed.phenology.patchiness = 0.0625;
        let saved = file.text_of(&changed).unwrap();
        assert!(!saved.loses_comments, "{}", path.display());
        assert_eq!(Species::from_ron(&saved.text).unwrap(), changed);
        let remarks = |text: &str| {
            let lines = text.lines().filter_map(|line| Some(line.split_once("//")?.1.to_owned()));
            lines.collect::<Vec<_>>()
        };
        assert_eq!(remarks(&saved.text), remarks(&own), "{}", path.display());
    }
}

#[test]
fn comments_inside_of_what_is_written_anew_are_missed_aloud() {
    let folder = tempfile::tempdir().unwrap();
    let file = oak_in(folder.path());
    let changed = Species { growth: Growth::Oak(Default::default()), ..file.document.clone() };
    let saved = file.text_of(&changed).unwrap();
    assert!(saved.loses_comments && !saved.text.contains("// Limbs."));
    assert!(saved.text.contains("// Young oak leaves come out a little bronze."));
    assert_eq!(Species::from_ron(&saved.text).unwrap(), changed);
}

#[test]
fn a_file_that_cannot_be_written_stays() {
    let folder = tempfile::tempdir().unwrap();
    let mut file = oak_in(folder.path());
    let changed = Species { variants: 2, ..file.document.clone() };
    let missing = folder.path().join("missing/oak.species.ron");
    let error = file.save(&changed, Some(&missing)).unwrap_err().to_string();
    assert!(error.contains("missing"), "{error}");
    assert_eq!((file.on_disk(), file.document.variants), (OnDisk::AsKnown, 4));
}

#[test]
fn a_change_by_another_program_is_noticed() {
    let folder = tempfile::tempdir().unwrap();
    let file = oak_in(folder.path());
    assert_eq!(file.on_disk(), OnDisk::AsKnown);
    fs::write(&file.path, OAK.replace("variants: 4", "variants: 3")).unwrap();
    assert_eq!(file.on_disk(), OnDisk::Changed);
    fs::remove_file(&file.path).unwrap();
    assert_eq!(file.on_disk(), OnDisk::Removed);
    assert_eq!(DocumentFile::new(&file.path, Species::default()).on_disk(), OnDisk::AsKnown);
}

#[test]
fn unsaved_work_is_kept_and_offered() {
    let folder = tempfile::tempdir().unwrap();
    let file = oak_in(folder.path());
    assert_eq!(file.autosaved(), None);
    let changed = Species { variants: 2, ..file.document.clone() };
    file.autosave(&changed).unwrap();
    let again = DocumentFile::<Species>::open(&file.path).unwrap();
    assert_eq!(again.autosaved(), Some(changed));
    again.forget_autosave();
    assert_eq!(again.autosaved(), None);
}

#[test]
fn a_broken_file_is_told_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.species.ron");
    fs::write(&path, "(\n  name: \"x\",\n  wod: (),\n)").unwrap();
    let error = DocumentFile::<Species>::open(&path).unwrap_err().to_string();
    assert!(error.contains("line 3") && error.contains("wod"), "{error}");
}
