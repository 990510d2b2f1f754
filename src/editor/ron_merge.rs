//! Writes changed settings into the text that a person wrote: what did not change keeps its place, its form and its comments.
//!
//! The RON crate reads and writes values, without comments. So the old and the new settings are both written by it, and
//! what differs between these two texts is changed in the person's own.

use std::ops::Range;

use super::ron_tree::{Node, Shape, behind_blank, has_comments, parse};

/// A text with changes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Merged {
    pub text: String,
    /// Whether comments stood inside of what was written anew.
    pub loses_comments: bool,
}

/// `own` with the changes that lead from `old` to `new`, two texts of one writer. None where they do not fit: the result has to
/// be read again and compared, for a text may be written in ways that are not known here.
pub fn merge(own: &str, old: &str, new: &str) -> Option<Merged> {
    let texts = Texts { own, old, new };
    let mut edits = Vec::new();
    texts.merge(&parse(own)?, &parse(old)?, &parse(new)?, &mut edits)?;
    let loses_comments = edits.iter().any(|edit| has_comments(&own[edit.place.clone()]));
    // From the end on, so that places before an edit stay true. Of two at one place the first is to stand first.
    edits.sort_by_key(|edit: &Edit| edit.place.start);
    let mut text = own.to_owned();
    edits.into_iter().rev().for_each(|edit| text.replace_range(edit.place, &edit.text));
    Some(Merged { text, loses_comments })
}

struct Edit {
    place: Range<usize>,
    text: String,
}

struct Texts<'a> {
    own: &'a str,
    old: &'a str,
    new: &'a str,
}

impl Texts<'_> {
    fn merge(&self, own: &Node, old: &Node, new: &Node, edits: &mut Vec<Edit>) -> Option<()> {
        let new_text = &self.new[new.span.clone()];
        if &self.old[old.span.clone()] == new_text {
            return Some(());
        }
        let heads = [&self.own[own.head.clone()], &self.old[old.head.clone()], &self.new[new.head.clone()]];
        // The writer leaves out the names of structs; a person may have written them.
        let is_same_variant = heads[1] == heads[2] && (heads[0] == heads[1] || heads[1].is_empty());
        match (&own.shape, &old.shape, &new.shape) {
            (Shape::Struct(_), Shape::Struct(old_fields), Shape::Struct(fields)) if is_same_variant => {
                let is_same = |((a, _), (b, _)): (&(String, Node), &(String, Node))| a == b;
                if old_fields.len() != fields.len() || !old_fields.iter().zip(fields).all(is_same) {
                    return None;
                }
                self.merge_fields(own, old_fields, fields, edits)
            }
            (Shape::List(items), Shape::List(old), Shape::List(new)) if is_same_variant && items.len() == old.len() => {
                self.merge_items(own, items, old, new, edits)
            }
            _ => {
                edits.push(Edit { place: own.span.clone(), text: new_text.to_owned() });
                Some(())
            }
        }
    }

    /// Items that stay keep their place: what came or went is between the equal ones at the beginning and at the end.
    fn merge_items(&self, list: &Node, own: &[Node], old: &[Node], new: &[Node], edits: &mut Vec<Edit>) -> Option<()> {
        let is_same = |(old, new): &(&Node, &Node)| self.old[old.span.clone()] == self.new[new.span.clone()];
        let shorter = old.len().min(new.len());
        let before = old.iter().zip(new).take_while(is_same).count();
        let behind = old.iter().rev().zip(new.iter().rev()).take(shorter - before).take_while(is_same).count();
        let end = shorter - behind;
        for number in before..end {
            self.merge(&own[number], &old[number], &new[number], edits)?;
        }
        if old.len() > new.len() {
            edits.push(Edit { place: self.place_of_items(own, end..old.len() - behind), text: String::new() });
        }
        if new.len() > old.len() {
            self.add_items(list, own, end, &new[end..new.len() - behind], edits);
        }
        Some(())
    }

    /// Items of a list with the commas that go with them. The remark behind the item before stays.
    fn place_of_items(&self, own: &[Node], items: Range<usize>) -> Range<usize> {
        let behind_comma = |item: &Node| {
            let comma = behind_blank(self.own, item.span.end);
            self.own[comma..].starts_with(',').then_some(comma + 1)
        };
        let last = &own[items.end - 1];
        let before = items.start.checked_sub(1).map(|number| &own[number]);
        match (before.map(|before| (before, behind_comma(before))), behind_comma(last)) {
            (Some((_, Some(from))), Some(to)) => self.end_of_remark(from)..to,
            (Some((before, _)), _) => before.span.end..last.span.end,
            (None, to) => {
                let end = own.get(items.end).map_or(to.unwrap_or(last.span.end), |next| next.span.start);
                own[0].span.start..end
            }
        }
    }

    /// Adds items before that of a number, each on a line of its own where the others have one.
    fn add_items(&self, list: &Node, own: &[Node], number: usize, new: &[Node], edits: &mut Vec<Edit>) {
        let Some(neighbour) = number.checked_sub(1).or(Some(0)).and_then(|number| own.get(number)) else {
            let items: Vec<&str> = new.iter().map(|item| &self.new[item.span.clone()]).collect();
            edits.push(insert(list.span.end - 1, items.join(", ")));
            return;
        };
        let line = indent_of_line(self.own, neighbour.span.start);
        let separator = line.map_or(" ".to_owned(), |indent| format!("\n{indent}"));
        let items = new.iter().map(|item| {
            let text = &self.new[item.span.clone()];
            match (line, indent_of_line(self.new, item.span.start)) {
                (Some(indent), Some(writers)) => text.replace(&format!("\n{writers}"), &format!("\n{indent}")),
                _ => text.to_owned(),
            }
        });
        if number == 0 {
            let text: String = items.map(|item| format!("{item},{separator}")).collect();
            edits.push(insert(neighbour.span.start, text));
            return;
        }
        let text: String = items.map(|item| format!("{separator}{item},")).collect();
        let comma = behind_blank(self.own, neighbour.span.end);
        if self.own[comma..].starts_with(',') {
            let at = if line.is_some() { self.end_of_remark(comma + 1) } else { comma + 1 };
            edits.push(insert(at, text));
        } else {
            let text = text.strip_suffix(',').unwrap_or(&text);
            edits.push(insert(neighbour.span.end, format!(",{text}")));
        }
    }

    fn merge_fields(
        &self,
        own: &Node,
        old: &[(String, Node)],
        new: &[(String, Node)],
        edits: &mut Vec<Edit>,
    ) -> Option<()> {
        let mut added = Vec::new();
        for ((name, new), (_, old)) in new.iter().zip(old) {
            let text = &self.new[new.span.clone()];
            match own.field(name) {
                Some(own) => self.merge(own, old, new, edits)?,
                // The person left it out: it had the default.
                None if &self.old[old.span.clone()] == text => {}
                None => added.push(format!("{name}: {text}")),
            }
        }
        if !added.is_empty() {
            self.add(own, &added, edits);
        }
        Some(())
    }

    /// Adds fields behind the last one, in lines of their own if that one has its own.
    fn add(&self, own: &Node, added: &[String], edits: &mut Vec<Edit>) {
        let Shape::Struct(fields) = &own.shape else { return };
        let Some((_, last)) = fields.last() else {
            edits.push(insert(own.span.end - 1, added.join(", ")));
            return;
        };
        let line = &self.own[..last.span.end];
        let line = &line[line.rfind('\n').map_or(0, |end| end + 1)..];
        let first_of_line = line.trim_start().chars().next().unwrap_or(' ');
        let owns_lines = first_of_line.is_alphabetic() && self.own[own.span.clone()].contains('\n');
        let comma = behind_blank(self.own, last.span.end);
        let has_comma = self.own[comma..].starts_with(',');
        if !owns_lines {
            let at = if has_comma { comma + 1 } else { last.span.end };
            let text = if has_comma { format!(" {}", added.join(", ")) } else { format!(", {}", added.join(", ")) };
            edits.push(insert(at, text));
            return;
        }
        if !has_comma {
            edits.push(insert(last.span.end, ",".into()));
        }
        let behind = if has_comma { comma + 1 } else { last.span.end };
        let indent: String = line.chars().take_while(|sign| sign.is_whitespace()).collect();
        let lines: String = added.iter().map(|field| format!("\n{indent}{field},")).collect();
        edits.push(insert(self.end_of_remark(behind), lines));
    }

    /// Behind the remark that ends a line, if that is all that is left of the line.
    fn end_of_remark(&self, at: usize) -> usize {
        let rest = self.own[at..].split('\n').next().unwrap_or_default();
        let rest = rest.strip_suffix('\r').unwrap_or(rest);
        if rest.trim_start().starts_with("//") { at + rest.len() } else { at }
    }
}

fn insert(at: usize, text: String) -> Edit {
    Edit { place: at..at, text }
}

/// The white space before what begins at a place; none where something else stands on the line before it.
fn indent_of_line(text: &str, at: usize) -> Option<&str> {
    let line = text[..at].rfind('\n').map_or(0, |end| end + 1);
    let before = &text[line..at];
    (line > 0 && before.trim().is_empty()).then_some(before)
}

#[cfg(test)]
mod tests {
    use super::*;

    const OLD: &str =
        "(name: \"oak\", age: (years: 120.0, rate: 0.02), orders: [(a: 1), (a: 2)], colour: (0.1, 0.2, 0.3))";

    fn merged(own: &str, from: &str, to: &str) -> String {
        merge(own, OLD, &OLD.replace(from, to)).unwrap().text
    }

    fn merged_name(own: &str) -> String {
        merged(own, "oak", "elm")
    }

    #[test]
    fn a_changed_value_is_changed_in_its_place() {
        let own = "// An oak.\n(\n    name: \"oak\", // its name\n    age: (years: 120 /* old */, rate: 2e-2),\n    orders: [(a: 1), (a: 2)],\n)\n";
        assert_eq!(merged(own, "120.0", "80.0"), own.replace("120 /*", "80.0 /*"));
        assert_eq!(merged(own, "a: 2", "a: 3"), own.replace("a: 2", "a: 3"));
        assert_eq!(merged(own, "0.9", "0.9"), own);
        // Another number of orders: the list is written anew, all else stays.
        assert_eq!(merged(own, "(a: 1), (a: 2)", "(a: 1)"), own.replace("(a: 1), (a: 2)", "(a: 1)"));
    }

    #[test]
    fn a_value_that_was_left_out_is_added_behind_the_others() {
        let own = "(\n    // Its age.\n    age: (years: 120), // about\n)";
        assert_eq!(
            merged(own, "\"oak\"", "\"elm\""),
            "(\n    // Its age.\n    age: (years: 120), // about\n    name: \"elm\",\n)"
        );
        assert_eq!(merged(own, "0.02", "0.03"), own.replace("years: 120", "years: 120, rate: 0.03"));
        assert_eq!(merged("(\n  age: ()\n)", "0.02", "0.03"), "(\n  age: (rate: 0.03)\n)");
        assert_eq!(merged("(\n  age: ()\n)", "oak", "elm"), "(\n  age: (),\n  name: \"elm\",\n)");
        assert_eq!(merged("()", "oak", "elm"), "(name: \"elm\")");
        assert_eq!(merged("(age: (),)", "oak", "elm"), "(age: (), name: \"elm\")");
    }

    #[test]
    fn another_variant_takes_the_whole_place() {
        let (old, new) = ("(growth: Oak(height_m: 1.0))", "(growth: Fir(floors: 2))");
        let merged = merge("(growth: Oak(), /* x */)", old, new).unwrap();
        assert_eq!(merged, Merged { text: "(growth: Fir(floors: 2), /* x */)".into(), loses_comments: false });
        assert!(merge("(growth: Oak(/* x */))", old, new).unwrap().loses_comments);
        assert_eq!(merged_name("Tree(name: \"oak\" /* x */)"), "Tree(name: \"elm\" /* x */)");
    }

    #[test]
    fn items_that_stay_keep_their_comments_when_others_come_and_go() {
        let own = "(areas: [\n    // The first.\n    (a: 1), // one\n    (a: 2), // two\n    (a: 3),\n])";
        let list = |items: &[i32]| {
            let items: Vec<String> = items.iter().map(|item| format!("\n  (a: {item}),")).collect();
            format!("(areas: [{}\n])", items.concat())
        };
        let merged = |items: &[i32]| merge(own, &list(&[1, 2, 3]), &list(items)).unwrap();
        assert_eq!(merged(&[1, 2]).text, own.replace("\n    (a: 3),", ""));
        assert_eq!(merged(&[2, 3]).text, own.replace("(a: 1), // one\n    ", ""));
        assert!(merged(&[2, 3]).loses_comments && !merged(&[1, 2]).loses_comments);
        assert_eq!(merged(&[1, 2, 3, 4]).text, own.replace("(a: 3),", "(a: 3),\n    (a: 4),"));
        assert_eq!(merged(&[1, 5, 2, 3]).text, own.replace("(a: 1), // one", "(a: 1), // one\n    (a: 5),"));
        assert_eq!(merged(&[0, 1, 2, 3]).text, own.replace("(a: 1)", "(a: 0),\n    (a: 1)"));
        assert_eq!(merged(&[1, 9, 3]).text, own.replace("a: 2", "a: 9"));
        let inline = |own: &str, from: &str, to: &str| merge(own, from, to).unwrap().text;
        assert_eq!(inline("([1, 2])", "([1, 2])", "([1, 2, 3])"), "([1, 2, 3])");
        assert_eq!(inline("([1, 2,])", "([1, 2])", "([1, 2, 3])"), "([1, 2, 3,])");
        assert_eq!(inline("([])", "([])", "([1, 2])"), "([1, 2])");
        assert_eq!(inline("([1, 2,])", "([1, 2])", "([])"), "([])");
    }

    #[test]
    fn texts_that_do_not_fit_are_refused() {
        assert_eq!(merge("(a: 1", "(a: 1)", "(a: 2)"), None);
        assert_eq!(merge("(a: 1)", "(a: 1)", "(b: 2)"), None);
    }
}
