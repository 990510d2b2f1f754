//! A person's hand on the panels: mouse and keys, by the names that screen readers read out.

use bevy::prelude::*;
use bevy_egui::{
    EguiContext, EguiOutput, PrimaryEguiContext,
    egui::{
        Event, Key, Modifiers, MouseWheelUnit, PointerButton, Pos2, Rect, TouchPhase,
        accesskit::{Node, NodeId, Role},
        vec2,
    },
    input::EguiInputEvent,
};
use std::collections::BTreeMap;

/// A control as a screen reader is told of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Control {
    pub id: NodeId,
    pub role: Role,
    pub name: String,
    pub at: Rect,
}

/// Frames after which a change of the panels is laid out.
const LAYOUT_FRAMES: usize = 3;
/// Turns of the wheel after which a control that is out of sight is given up, and points of each.
const MOST_TURNS: usize = 60;
const TURN: f32 = 120.0;
/// Width of the panel with the fields, points.
const FIELDS_WIDTH: f32 = 400.0;

/// The hand. It acts in whole frames, in which nothing of the scene is drawn.
pub struct Hand<'a> {
    pub app: &'a mut App,
}

impl Hand<'_> {
    /// Lets the panels draw themselves some times.
    pub fn rest(&mut self) {
        (0..LAYOUT_FRAMES).for_each(|_| self.app.update());
    }

    fn act(&mut self, event: Event) {
        let world = self.app.world_mut();
        let mut contexts = world.query_filtered::<Entity, (With<EguiContext>, With<PrimaryEguiContext>)>();
        if let Some(context) = contexts.iter(world).next() {
            world.write_message(EguiInputEvent { context, event });
        }
        self.app.update();
    }

    /// Everything that is told to screen readers.
    pub fn controls(&mut self) -> Vec<Control> {
        let world = self.app.world_mut();
        let mut outputs = world.query_filtered::<&EguiOutput, With<PrimaryEguiContext>>();
        let update = outputs.iter(world).next().and_then(|output| output.platform_output.accesskit_update.clone());
        let nodes: BTreeMap<NodeId, Node> = update.map(|update| update.nodes).into_iter().flatten().collect();
        let own_name = |node: &Node| node.label().or(node.value()).unwrap_or_default().to_owned();
        let name = |node: &Node| {
            let by: Vec<String> = node.labelled_by().iter().filter_map(|id| nodes.get(id)).map(own_name).collect();
            if by.is_empty() { own_name(node) } else { by.join(" ") }
        };
        let control = |(id, node): (&NodeId, &Node)| {
            let at = node.bounds()?;
            let corner = |x: f64, y: f64| Pos2::new(x as f32, y as f32);
            let at = Rect::from_min_max(corner(at.x0, at.y0), corner(at.x1, at.y1));
            Some(Control { id: *id, role: node.role(), name: name(node), at })
        };
        nodes.iter().filter_map(control).collect()
    }

    /// The control of a role and a name; the upper one of two.
    ///
    /// # Errors
    /// With the names that there are, if there is none.
    pub fn find(&mut self, role: Role, name: &str) -> Result<Control, String> {
        let controls = self.controls();
        let mut found: Vec<&Control> =
            controls.iter().filter(|control| control.role == role && control.name == name).collect();
        found.sort_by(|a, b| a.at.top().total_cmp(&b.at.top()));
        let names = || controls.iter().filter(|control| control.role == role).map(|control| control.name.as_str());
        let told = || format!("there is no {role:?} `{name}` among {:?}", names().collect::<Vec<_>>());
        found.first().map(|control| (*control).clone()).ok_or_else(told)
    }

    pub fn click(&mut self, at: Pos2) {
        self.act(Event::PointerMoved(at));
        for pressed in [true, false] {
            self.act(button(at, pressed));
        }
        self.rest();
    }

    /// Presses a button.
    ///
    /// # Errors
    /// If there is none of that name.
    pub fn press(&mut self, name: &str) -> Result<(), String> {
        let at = self.find(Role::Button, name)?.at.center();
        self.click(at);
        Ok(())
    }

    /// Drags with the main button through points of the screen.
    pub fn drag(&mut self, through: &[Pos2]) {
        let [first, .., last] = through else { return };
        self.act(Event::PointerMoved(*first));
        self.act(button(*first, true));
        through.iter().for_each(|at| self.act(Event::PointerMoved(*at)));
        self.act(button(*last, false));
        self.rest();
    }

    pub fn key(&mut self, modifiers: Modifiers, key: Key) {
        for pressed in [true, false] {
            self.act(Event::Key { key, physical_key: None, pressed, repeat: false, modifiers });
        }
        self.rest();
    }

    /// Types into a control instead of what it has.
    pub fn write(&mut self, control: &Control, text: &str) {
        self.click(control.at.center());
        self.key(Modifiers::COMMAND, Key::A);
        self.act(Event::Text(text.to_owned()));
        self.key(Modifiers::NONE, Key::Enter);
    }

    /// Scrolls the panel with the fields until a control of that role and name is in sight.
    ///
    /// # Errors
    /// If it does not come.
    pub fn scroll_to(&mut self, role: Role, name: &str) -> Result<Control, String> {
        let (top, bottom) = (200.0, 640.0);
        for _ in 0..MOST_TURNS {
            let found = self.find(role, name);
            if let Ok(control) = &found
                && (top..bottom).contains(&control.at.center().y)
            {
                return found;
            }
            self.act(Event::PointerMoved(Pos2::new(0.5 * FIELDS_WIDTH, 0.5 * (top + bottom))));
            let delta = vec2(0.0, -TURN);
            let (unit, phase) = (MouseWheelUnit::Point, TouchPhase::Move);
            self.act(Event::MouseWheel { unit, delta, phase, modifiers: Modifiers::NONE });
            self.rest();
        }
        Err(format!("the {role:?} `{name}` did not come into sight"))
    }

    /// Looks for a field of the species by its name, and returns its first control under the field that is typed into.
    ///
    /// # Errors
    /// If there is none.
    pub fn field(&mut self, name: &str, roles: &[Role]) -> Result<Control, String> {
        let find = self.find(Role::TextInput, "Find a field")?;
        self.write(&find, name);
        let is_below = |control: &Control| control.at.top() > find.at.bottom() && control.at.left() < FIELDS_WIDTH;
        let mut below: Vec<Control> =
            self.controls().into_iter().filter(|it| roles.contains(&it.role) && is_below(it)).collect();
        below.sort_by(|a, b| a.at.top().total_cmp(&b.at.top()));
        below.into_iter().next().ok_or_else(|| format!("the field `{name}` has no {roles:?}"))
    }

    /// Sets a number of the species.
    ///
    /// # Errors
    /// If there is no such field.
    pub fn set_number(&mut self, name: &str, shown: &str) -> Result<(), String> {
        let control = self.field(name, &[Role::SpinButton])?;
        self.write(&control, shown);
        Ok(())
    }

    /// Writes a text of the species.
    ///
    /// # Errors
    /// If there is no such field.
    pub fn set_text(&mut self, name: &str, text: &str) -> Result<(), String> {
        let control = self.field(name, &[Role::TextInput])?;
        self.write(&control, text);
        Ok(())
    }

    /// Chooses a variant of the species.
    ///
    /// # Errors
    /// If there is no such field or variant.
    pub fn choose(&mut self, name: &str, variant: &str) -> Result<(), String> {
        let control = self.field(name, &[Role::ComboBox])?;
        self.choose_of(&control, variant)
    }

    /// Chooses from a list.
    ///
    /// # Errors
    /// If the list does not have it.
    pub fn choose_of(&mut self, list: &Control, entry: &str) -> Result<(), String> {
        let before = self.controls();
        self.click(list.at.center());
        let is_new = |it: &Control| before.iter().all(|old| old.id != it.id);
        let entries = self.controls().into_iter().filter(|it| is_new(it) && it.role == Role::Button);
        let found = entries.into_iter().find(|it| it.name == entry);
        let found = found.ok_or_else(|| format!("`{}` has no entry `{entry}`", list.name))?;
        self.click(found.at.center());
        Ok(())
    }

    /// Sets a colour of the species, in bytes.
    ///
    /// # Errors
    /// If there is no such field.
    pub fn set_colour(&mut self, name: &str, colour: [u8; 3]) -> Result<(), String> {
        let control = self.field(name, &[Role::ColorWell])?;
        let before = self.controls();
        self.click(control.at.center());
        let is_new = |it: &Control| before.iter().all(|old| old.id != it.id);
        for (place, channel) in colour.into_iter().enumerate() {
            let controls = self.controls();
            let mut channels: Vec<&Control> =
                controls.iter().filter(|it| it.role == Role::SpinButton && is_new(it)).collect();
            channels.sort_by(|a, b| a.at.left().total_cmp(&b.at.left()));
            let control = channels.get(place).ok_or_else(|| format!("`{name}` has no channel {place}"))?;
            let control = (*control).clone();
            self.write(&control, &channel.to_string());
        }
        self.key(Modifiers::NONE, Key::Escape);
        Ok(())
    }
}

fn button(at: Pos2, pressed: bool) -> Event {
    Event::PointerButton { pos: at, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE }
}
