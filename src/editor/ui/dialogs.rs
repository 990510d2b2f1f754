//! Dialogs: files, questions before anything is lost, the list of shortcuts.

use std::path::{Path, PathBuf};

use bevy_egui::egui::{Button, Context, Grid, Id, Key, Modal, RichText, ScrollArea, TextEdit, Ui};

use super::shortcuts::SHORTCUTS;
use crate::editor::file_session::{FileSession, Intent, Question};

/// A dialog that a person asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Dialog {
    /// A file to open.
    Open(PathField),
    /// A file to save to.
    SaveAs(PathField),
    /// A file to export the tree to.
    Export(PathField),
    /// The list of shortcuts.
    Shortcuts,
}

/// How files of exported trees end.
const EXPORTED: &str = ".glb";

/// A path that is typed, and the files of its folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PathField {
    pub path: String,
    files: Vec<PathBuf>,
}

impl PathField {
    fn new(path: &Path, extension: &str) -> Self {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let entries = std::fs::read_dir(folder).into_iter().flatten();
        let is_of_kind = |path: &PathBuf| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            name.ends_with(extension) && !name.starts_with('.')
        };
        let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).filter(is_of_kind).collect();
        files.sort();
        Self { path: path.display().to_string(), files }
    }

    /// Draws it. Returns whether a file of the list was chosen, or Enter pressed.
    fn show(&mut self, ui: &mut Ui, named: Id, extension: &str) -> bool {
        let edit = ui
            .add(TextEdit::singleline(&mut self.path).desired_width(460.0).hint_text("Path of a file"))
            .labelled_by(named);
        let mut is_chosen = edit.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        ui.add_space(4.0);
        ScrollArea::vertical().max_height(260.0).auto_shrink(false).show(ui, |ui| {
            for file in &self.files {
                let name = file.file_name().unwrap_or_default().to_string_lossy();
                let name = name.strip_suffix(extension).unwrap_or(&name).to_owned();
                let is_this = Path::new(&self.path) == file;
                let label = ui.selectable_label(is_this, name);
                if label.clicked() {
                    self.path = file.display().to_string();
                }
                is_chosen |= label.double_clicked();
            }
            if self.files.is_empty() {
                ui.weak("There are no such files in this folder.");
            }
        });
        is_chosen
    }
}

impl Dialog {
    /// Asks for a file to open, beginning with one.
    pub fn open(path: &Path) -> Self {
        Self::Open(PathField::new(path, &extension_of(path)))
    }

    /// Asks where to save, beginning with a file.
    pub fn save_as(path: &Path) -> Self {
        Self::SaveAs(PathField::new(path, &extension_of(path)))
    }

    /// Asks where to export to, beginning with the name of a species' file.
    pub fn export(path: &Path) -> Self {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let name = name.split('.').next().unwrap_or_default();
        Self::Export(PathField::new(&path.with_file_name(format!("{name}{EXPORTED}")), EXPORTED))
    }
}

/// What was answered.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Answer {
    /// Whether the program is to end.
    pub is_quitting: bool,
    /// Where the tree is to be exported to.
    pub export_to: Option<PathBuf>,
}

/// Shows the dialog that is open, and the session's question.
pub fn show(context: &Context, session: &mut dyn FileSession, dialog: &mut Option<Dialog>) -> Answer {
    let mut answer = Answer::default();
    if let Some(question) = session.question().cloned() {
        answer.is_quitting = ask(context, session, &question);
        return answer;
    }
    let Some(open) = dialog else { return answer };
    let mut is_done = false;
    let modal = Modal::new(Id::new("windwood dialog")).show(context, |ui| {
        ui.set_width(480.0);
        match open {
            Dialog::Open(field) => {
                let title = format!("Open: {}", session.name());
                if file_dialog(ui, (&title, "Open"), field, session.extension(), &mut is_done) {
                    session.open_another(&PathBuf::from(&field.path));
                }
            }
            Dialog::SaveAs(field) => {
                let title = format!("Save as: {}", session.name());
                if file_dialog(ui, (&title, "Save"), field, session.extension(), &mut is_done) {
                    let path = PathBuf::from(with_extension(&field.path, session.extension()));
                    session.save_to(Some(&path));
                }
            }
            Dialog::Export(field) => {
                ui.weak("The tree in its season, and a loop of its sway in the wind in force.");
                if file_dialog(ui, ("Export as GLB", "Export"), field, EXPORTED, &mut is_done) {
                    answer.export_to = Some(PathBuf::from(with_extension(&field.path, EXPORTED)));
                }
            }
            Dialog::Shortcuts => is_done = shortcuts(ui),
        }
    });
    if is_done || modal.should_close() {
        *dialog = None;
    }
    answer
}

/// Files without the ending of their kind would not be loaded.
fn with_extension(path: &str, extension: &str) -> String {
    if path.ends_with(extension) { path.to_owned() } else { format!("{path}{extension}") }
}

/// The last two parts of a file's name, which tell its kind: `.species.ron`.
fn extension_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let dot = name.rmatch_indices('.').nth(1).map_or(0, |(dot, _)| dot);
    name[dot..].to_owned()
}

fn file_dialog(
    ui: &mut Ui,
    (title, action): (&str, &str),
    field: &mut PathField,
    extension: &str,
    is_done: &mut bool,
) -> bool {
    let named = ui.heading(title).id;
    ui.add_space(6.0);
    let mut is_chosen = field.show(ui, named, extension);
    ui.add_space(6.0);
    ui.horizontal(|ui| {
        is_chosen |= ui.button(RichText::new(action).strong()).clicked();
        *is_done |= ui.button("Cancel").clicked();
    });
    *is_done |= is_chosen;
    is_chosen
}

fn shortcuts(ui: &mut Ui) -> bool {
    ui.heading("Shortcuts");
    ui.add_space(6.0);
    Grid::new("shortcuts").num_columns(2).spacing([24.0, 6.0]).show(ui, |ui| {
        for shortcut in &SHORTCUTS {
            ui.label(RichText::new(shortcut.keys()).monospace());
            ui.label(shortcut.what);
            ui.end_row();
        }
        for (keys, what) in [
            ("Tab, arrows", "From control to control; change a slider"),
            ("Drag, wheel", "Turn the view; nearer and farther"),
            ("Shift+drag", "Shift the view of a wood or of ground"),
            ("Arrows, Page Up, Down", "The same, once Tab has reached the picture; Shift+arrows shift"),
            ("Space", "There: put the tool down in the middle, and lift it"),
        ] {
            ui.label(RichText::new(keys).monospace());
            ui.label(what);
            ui.end_row();
        }
    });
    ui.add_space(6.0);
    ui.button("Close").clicked()
}

/// Asks, and does what is answered. Returns whether the program is to end.
fn ask(context: &Context, session: &mut dyn FileSession, question: &Question) -> bool {
    let mut is_quitting = false;
    let modal = Modal::new(Id::new("windwood question")).show(context, |ui| {
        ui.set_width(440.0);
        let (title, text) = words(session, question);
        ui.heading(title);
        ui.add_space(4.0);
        ui.label(text);
        ui.add_space(8.0);
        ui.horizontal(|ui| match question {
            Question::Unsaved(intent) => {
                if ui.button(RichText::new("Save").strong()).clicked() && session.save_to(None) {
                    is_quitting = follow(session, intent);
                }
                if ui.button("Do not save").clicked() {
                    session.forget();
                    is_quitting = follow(session, intent);
                }
                if ui.button("Cancel").clicked() {
                    session.dismiss_question();
                }
            }
            Question::LoseComments | Question::Overwrite => {
                if ui.button(RichText::new("Overwrite").strong()).clicked() {
                    session.save_to(None);
                }
                if ui.button("Cancel").clicked() {
                    session.dismiss_question();
                }
            }
            Question::Restore => {
                if ui.button(RichText::new("Restore").strong()).clicked() {
                    session.answer_restore(true);
                }
                if ui.add(Button::new("Forget it")).clicked() {
                    session.answer_restore(false);
                }
            }
        });
    });
    // Escape is the answer that loses nothing; what was kept stays kept until it is answered.
    if modal.should_close() && !matches!(question, Question::Restore) {
        session.dismiss_question();
    }
    is_quitting
}

fn words(session: &dyn FileSession, question: &Question) -> (&'static str, String) {
    let name = session.path().file_name().unwrap_or_default().to_string_lossy().into_owned();
    match question {
        Question::Unsaved(_) => ("Save the changes?", format!("{name} has changes that are not saved.")),
        Question::LoseComments => (
            "Comments would be lost",
            format!("A part of {name} has to be written anew, and the comments in that part cannot be kept."),
        ),
        Question::Overwrite => (
            "The file was changed",
            format!("Another program has changed {name} since it was read. Saving would overwrite that."),
        ),
        Question::Restore => (
            "Restore unsaved work?",
            format!("The workbench ended before changes of {name} were saved. They were kept."),
        ),
    }
}

fn follow(session: &mut dyn FileSession, intent: &Intent) -> bool {
    session.dismiss_question();
    match intent {
        Intent::Open(path) => session.open_now(path),
        Intent::Quit => return true,
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_the_folder_are_offered_in_order() {
        let of = |path: &str| match Dialog::open(Path::new(path)) {
            Dialog::Open(field) => field,
            other => panic!("{other:?}"),
        };
        let field = of(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/species/oak.species.ron"));
        assert!(field.files.len() > 20 && field.files.is_sorted());
        assert!(of("nowhere/x.species.ron").files.is_empty());
        let Dialog::Export(field) = Dialog::export(Path::new("a/elm.species.ron")) else { panic!("an export") };
        assert_eq!(field.path, "a/elm.glb");
    }

    #[test]
    fn a_species_gets_its_ending() {
        assert_eq!(with_extension("a/elm", ".species.ron"), "a/elm.species.ron");
        assert_eq!(with_extension("a/elm.species.ron", ".species.ron"), "a/elm.species.ron");
        assert_eq!(extension_of(Path::new("a.b/elm.v2.species.ron")), ".species.ron");
        assert_eq!(extension_of(Path::new("elm")), "elm");
    }
}
