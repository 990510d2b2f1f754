use super::*;
use crate::{
    editor::{
        fields::{all_fields, number, set_number},
        file_session::{FileSession, Intent},
        randomiser::Randomiser,
        steps::Steps,
    },
    tree::{Growth, Species},
};
use bevy::reflect::GetPath;
use std::fs;

const OAK: &str = include_str!("../../../assets/species/oak.species.ron");

/// A session with an oak in a folder of its own.
fn session() -> (tempfile::TempDir, Session<Species>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("oak.species.ron");
    fs::write(&path, OAK).unwrap();
    let session = Session::<Species>::open(&path).unwrap();
    (folder, session)
}

fn text(session: &Session<Species>) -> String {
    fs::read_to_string(session.path()).unwrap()
}

/// Changes every field of the table, one after another.
fn change_every_field(session: &mut Session<Species>) -> usize {
    let fields: Vec<Field> = all_fields(session.table()).into_iter().cloned().collect();
    let mut changed = 0;
    for field in &fields {
        let mut species = session.document().clone();
        let Some(range) = field.range.clone() else { continue };
        let Ok(value) = species.reflect_path_mut(field.path.as_str()) else { continue };
        let now = number(value).unwrap();
        let wanted =
            0.9 * now + 0.1 * if now < 0.5 * (range.start() + range.end()) { range.end() } else { range.start() };
        set_number(value, wanted);
        if species.validate().is_ok() && species != *session.document() {
            session.change(species, &field.name);
            session.end_gesture();
            changed += 1;
        }
    }
    changed
}

#[test]
fn undone_to_the_start_a_file_is_saved_byte_for_byte() {
    let (_folder, mut session) = session();
    let changed = change_every_field(&mut session);
    assert!(changed > 60, "{changed} fields");
    session.save();
    // Three lists of orders keep their comments, for no order came or went.
    assert_eq!(session.question, None);
    assert!(text(&session) != OAK && Species::from_ron(&text(&session)).unwrap() == *session.document());
    (0..changed).for_each(|_| session.undo());
    assert_eq!(session.undo_step(), None);
    session.save();
    // What was left out in the file was added with its changed value, and stays with the one it had.
    let saved = text(&session);
    assert_eq!(Species::from_ron(&saved).unwrap(), Species::from_ron(OAK).unwrap());
    assert_eq!(saved.matches("//").count(), OAK.matches("//").count());
}

#[test]
fn undone_to_the_start_without_saving_between_not_a_byte_is_changed() {
    let (_folder, mut session) = session();
    let changed = change_every_field(&mut session);
    (0..changed).for_each(|_| session.undo());
    assert!(!session.is_changed());
    session.save();
    assert_eq!(text(&session), OAK);
    (0..changed).for_each(|_| session.redo());
    assert!(session.is_changed() && session.redo_step().is_none());
}

#[test]
fn a_field_is_reset_to_what_the_file_says_and_then_to_the_default() {
    let (_folder, mut session) = session();
    let find = |session: &Session<Species>, name: &str| {
        all_fields(session.table()).into_iter().find(|field| field.name == name).cloned().unwrap()
    };
    let density = find(&session, "wood.density_kg_m3");
    assert!(!session.is_field_changed(&density));
    let mut species = session.document().clone();
    species.wood.density_kg_m3 = 700.0;
    session.change(species, "Density");
    assert!(session.is_field_changed(&density));
    session.reset(&density);
    assert_eq!(session.document().wood.density_kg_m3, 1000.0);
    let shade = find(&session, "growth.shade_pruning");
    session.reset(&shade);
    let Growth::ReevesBlau(growth) = &session.document().growth else { panic!("the oak's model") };
    assert_eq!(growth.shade_pruning, 0.5, "the file has 0.25 already: the default is 0.5");
}

#[test]
fn randomising_is_a_step_that_can_be_undone_and_keeps_a_locked_seed() {
    let (_folder, mut session) = session();
    let before = session.document().clone();
    let mut randomiser = Randomiser::default();
    randomiser.randomise(&mut session);
    let first = session.document().clone();
    assert!(first != before && first.seed == before.seed && session.error().is_none());
    randomiser.is_seed_locked = false;
    randomiser.randomise(&mut session);
    assert!(session.document().seed != before.seed && *session.document() != first);
    session.undo();
    session.undo();
    assert_eq!(*session.document(), before);
}

#[test]
fn unsaved_changes_are_asked_about() {
    let (folder, mut session) = session();
    let other = folder.path().join("fir.species.ron");
    fs::write(&other, include_str!("../../../assets/species/fir.species.ron")).unwrap();
    assert!(session.may_quit());
    session.change(Species { name: "elm".into(), ..session.document().clone() }, "Name");
    session.open_another(&other);
    assert_eq!(session.question, Some(Question::Unsaved(Intent::Open(other.clone()))));
    assert_eq!(session.document().name, "elm");
    assert!(!session.may_quit() && session.question == Some(Question::Unsaved(Intent::Quit)));
    session.open_now(&other);
    assert_eq!((session.document().name.as_str(), session.question.clone()), ("fir", None));
}

#[test]
fn changes_that_were_given_up_do_not_keep_the_program_from_ending() {
    let (_folder, mut session) = session();
    session.change(Species { name: "elm".into(), ..session.document().clone() }, "Name");
    assert!(!session.may_quit());
    session.forget();
    session.dismiss_question();
    assert!(session.may_quit());
    session.change(Species { name: "ash".into(), ..session.document().clone() }, "Name");
    assert!(!session.may_quit());
}

#[test]
fn a_broken_file_is_told_and_the_old_tree_stays() {
    let (folder, mut session) = session();
    let broken = folder.path().join("broken.species.ron");
    fs::write(&broken, "(name: \"x\", growth: Oak(height_m: ))").unwrap();
    session.open_another(&broken);
    let Some(Message::Failed(error)) = &session.message else { panic!("{:?}", session.message) };
    assert!(error.contains("broken.species.ron") && error.contains("line 1"), "{error}");
    assert_eq!(session.document().name, "oak");
    fs::write(&broken, OAK.replace("height_m: 8.5", "height_m: -3.0")).unwrap();
    session.open_another(&broken);
    let Some(Message::Failed(error)) = &session.message else { panic!("{:?}", session.message) };
    assert!(error.contains("`growth.trunk.height_m` is -3"), "{error}");
}

#[test]
fn what_cannot_be_grown_is_not_saved() {
    let (_folder, mut session) = session();
    session.change(Species { variants: 99, ..session.document().clone() }, "Variants");
    assert_eq!(session.error().unwrap(), "`variants` is 99, but must be 1 to 16");
    session.save();
    assert!(matches!(session.message, Some(Message::Failed(_))));
    assert_eq!(text(&session), OAK);
}

#[test]
fn a_change_by_another_program_is_asked_about_before_it_is_overwritten() {
    let (_folder, mut session) = session();
    session.change(Species { name: "elm".into(), ..session.document().clone() }, "Name");
    fs::write(session.path(), OAK.replace("variants: 4", "variants: 2")).unwrap();
    session.save();
    assert_eq!(session.question, Some(Question::Overwrite));
    assert!(text(&session).contains("variants: 2"));
    session.reload();
    assert_eq!((session.document().variants, session.document().name.as_str()), (2, "oak"));
}

#[test]
fn lost_comments_are_asked_about() {
    let (_folder, mut session) = session();
    session.change(Species { growth: Growth::Oak(Default::default()), ..session.document().clone() }, "Growth");
    session.save();
    assert_eq!(session.question, Some(Question::LoseComments));
    assert_eq!(text(&session), OAK);
    assert!(session.save_to(None));
    assert_eq!(Species::from_ron(&text(&session)).unwrap(), *session.document());
}

#[test]
fn work_of_a_session_that_ended_is_offered() {
    let (_folder, mut session) = session();
    session.change(Species { name: "elm".into(), ..session.document().clone() }, "Name");
    session.keep();
    let path = session.path().to_owned();
    drop(session);
    let mut again = Session::<Species>::open(&path).unwrap();
    assert_eq!((again.question.clone(), again.document().name.as_str()), (Some(Question::Restore), "oak"));
    again.keep();
    again.answer_restore(true);
    assert_eq!((again.document().name.as_str(), again.undo_step()), ("elm", Some("Restore unsaved work")));
    again.save();
    assert!(Session::<Species>::open(&path).unwrap().question.is_none());
}
