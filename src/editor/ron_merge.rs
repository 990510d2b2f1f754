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
            (Shape::List(own), Shape::List(old), Shape::List(new))
                if is_same_variant && own.len() == old.len() && old.len() == new.len() =>
            {
                own.iter().zip(old).zip(new).try_for_each(|((own, old), new)| self.merge(own, old, new, edits))
            }
            _ => {
                edits.push(Edit { place: own.span.clone(), text: new_text.to_owned() });
                Some(())
            }
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
        let insert = |at: usize, text: String| Edit { place: at..at, text };
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
    fn texts_that_do_not_fit_are_refused() {
        assert_eq!(merge("(a: 1", "(a: 1)", "(a: 2)"), None);
        assert_eq!(merge("(a: 1)", "(a: 1)", "(b: 2)"), None);
    }
}
