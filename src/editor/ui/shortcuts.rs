//! Keys, and what they do: one table for those who press them and for the list that tells them.

use bevy_egui::egui::{Context, Key, KeyboardShortcut, Modifiers};

/// What a shortcut does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    Open,
    Save,
    SaveAs,
    Undo,
    Redo,
    Randomise,
    Panel(usize),
    Turn,
    Help,
    Close,
}

/// A key with its modifiers.
pub struct Shortcut {
    modifiers: Modifiers,
    key: Key,
    pub command: Command,
    pub what: &'static str,
}

const fn shortcut(modifiers: Modifiers, key: Key, command: Command, what: &'static str) -> Shortcut {
    Shortcut { modifiers, key, command, what }
}

const BOTH: Modifiers = Modifiers { shift: true, ..Modifiers::COMMAND };

/// All shortcuts. Those with more modifiers come first, for the others would take their keys.
pub const SHORTCUTS: [Shortcut; 14] = [
    shortcut(BOTH, Key::S, Command::SaveAs, "Save as"),
    shortcut(BOTH, Key::Z, Command::Redo, "Redo"),
    shortcut(Modifiers::COMMAND, Key::O, Command::Open, "Open a file"),
    shortcut(Modifiers::COMMAND, Key::S, Command::Save, "Save"),
    shortcut(Modifiers::COMMAND, Key::Z, Command::Undo, "Undo"),
    shortcut(Modifiers::COMMAND, Key::R, Command::Randomise, "Randomise within natural spread"),
    shortcut(Modifiers::COMMAND, Key::Num1, Command::Panel(0), "Species"),
    shortcut(Modifiers::COMMAND, Key::Num2, Command::Panel(1), "Woods"),
    shortcut(Modifiers::COMMAND, Key::Num3, Command::Panel(2), "Ground"),
    shortcut(Modifiers::COMMAND, Key::Num4, Command::Panel(3), "Wind"),
    shortcut(Modifiers::COMMAND, Key::Num5, Command::Panel(4), "Levels and cost"),
    shortcut(Modifiers::COMMAND, Key::T, Command::Turn, "Turn the tree, or let it stand"),
    shortcut(Modifiers::NONE, Key::Questionmark, Command::Help, "This list"),
    shortcut(Modifiers::NONE, Key::F2, Command::Close, "Close and open the workbench in a game"),
];

impl Shortcut {
    /// The keys in words.
    pub fn keys(&self) -> String {
        let part = |is_held: bool, name: &'static str| if is_held { name } else { "" };
        let (command, shift) = (part(self.modifiers.command, "Ctrl+"), part(self.modifiers.shift, "Shift+"));
        let key = if self.key == Key::Questionmark { "?" } else { self.key.name() };
        format!("{command}{shift}{key}")
    }
}

/// The commands whose keys were pressed in this frame. `is_typing` leaves keys without modifiers to the text.
pub fn pressed(context: &Context) -> Vec<Command> {
    let is_typing = context.egui_wants_keyboard_input();
    let may = |shortcut: &&Shortcut| !(is_typing && shortcut.modifiers.is_none());
    // F2 is the plugin's: it has to work while the workbench is closed.
    let ours = SHORTCUTS.iter().filter(|shortcut| shortcut.command != Command::Close).filter(may);
    ours.filter(|shortcut| {
        context.input_mut(|input| input.consume_shortcut(&KeyboardShortcut::new(shortcut.modifiers, shortcut.key)))
    })
    .map(|shortcut| shortcut.command)
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_shortcuts_have_the_same_keys() {
        let mut keys: Vec<String> = SHORTCUTS.iter().map(Shortcut::keys).collect();
        assert_eq!(keys[0], "Ctrl+Shift+S");
        keys.sort();
        keys.dedup();
        assert_eq!(keys.len(), SHORTCUTS.len());
    }
}
