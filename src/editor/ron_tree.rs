//! Where the values of a RON text stand in it: a tree of places, without what the values mean.
//!
//! It knows as much of RON as settings need: structs, variants, tuples, lists, strings, comments. A map is one value.

use std::ops::Range;

/// A value and its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Node {
    /// All of it, with the name of a variant before it.
    pub span: Range<usize>,
    /// The name before its bracket; empty where there is none.
    pub head: Range<usize>,
    pub shape: Shape,
}

/// What a value consists of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A number, a word, a string or a map.
    Plain,
    /// Named fields.
    Struct(Vec<(String, Node)>),
    /// A list, a tuple, or a tuple variant.
    List(Vec<Node>),
}

impl Node {
    /// A field by its name.
    pub fn field(&self, name: &str) -> Option<&Self> {
        match &self.shape {
            Shape::Struct(fields) => fields.iter().find(|(own, _)| own == name).map(|(_, node)| node),
            Shape::Plain | Shape::List(_) => None,
        }
    }
}

/// The value of a whole text; none where it is no RON.
pub fn parse(text: &str) -> Option<Node> {
    let mut reader = Reader { text, at: 0 };
    reader.skip_blank();
    while reader.rest().starts_with("#!") {
        reader.at += reader.rest().find(']')? + 1;
        reader.skip_blank();
    }
    let node = reader.value()?;
    reader.skip_blank();
    reader.rest().is_empty().then_some(node)
}

/// Whether there is a comment in a text.
pub fn has_comments(text: &str) -> bool {
    let mut reader = Reader { text, at: 0 };
    while !reader.rest().is_empty() {
        let before = reader.at;
        if reader.skip_comment() {
            return true;
        }
        if reader.string().is_none() {
            reader.at = before + reader.rest().chars().next().map_or(1, char::len_utf8);
        }
    }
    false
}

/// The first place from `at` on that is neither white nor in a comment.
pub fn behind_blank(text: &str, at: usize) -> usize {
    let mut reader = Reader { text, at };
    reader.skip_blank();
    reader.at
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Reader<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn take(&mut self, sign: char) -> bool {
        let is_next = self.rest().starts_with(sign);
        self.at += if is_next { sign.len_utf8() } else { 0 };
        is_next
    }

    fn skip_blank(&mut self) {
        loop {
            self.at += self.rest().len() - self.rest().trim_start().len();
            if !self.skip_comment() {
                return;
            }
        }
    }

    fn skip_comment(&mut self) -> bool {
        if self.rest().starts_with("//") {
            self.at += self.rest().find('\n').unwrap_or(self.rest().len());
            return true;
        }
        if !self.rest().starts_with("/*") {
            return false;
        }
        let mut depth = 0;
        while !self.rest().is_empty() {
            let (step, deeper) = match self.rest() {
                rest if rest.starts_with("/*") => (2, 1),
                rest if rest.starts_with("*/") => (2, -1),
                rest => (rest.chars().next().map_or(1, char::len_utf8), 0),
            };
            self.at += step;
            depth += deeper;
            if depth == 0 {
                break;
            }
        }
        true
    }

    fn value(&mut self) -> Option<Node> {
        self.skip_blank();
        let start = self.at;
        let node = |span: Range<usize>, head, shape| Some(Node { span, head, shape });
        if self.string().is_some() {
            return node(start..self.at, start..start, Shape::Plain);
        }
        let head = self.word();
        let behind_head = self.at;
        self.skip_blank();
        match self.rest().chars().next() {
            Some('(') => {
                let shape = self.parentheses()?;
                node(start..self.at, head, shape)
            }
            Some('[') if head.is_empty() => {
                self.at += 1;
                let items = self.items(']')?;
                node(start..self.at, head, Shape::List(items))
            }
            Some('{') if head.is_empty() => {
                self.skip_map()?;
                node(start..self.at, head, Shape::Plain)
            }
            _ if !head.is_empty() => {
                self.at = behind_head;
                node(head, start..start, Shape::Plain)
            }
            _ => None,
        }
    }

    /// A name or a number.
    fn word(&mut self) -> Range<usize> {
        let is_of_word = |sign: char| sign.is_alphanumeric() || "_+-.#".contains(sign);
        let length = self.rest().find(|sign| !is_of_word(sign)).unwrap_or(self.rest().len());
        self.at += length;
        self.at - length..self.at
    }

    fn parentheses(&mut self) -> Option<Shape> {
        self.at += 1;
        self.skip_blank();
        let inside = self.at;
        let name = self.word();
        self.skip_blank();
        let is_struct =
            (!name.is_empty() && self.rest().starts_with(':')) || self.rest().starts_with(')') && name.is_empty();
        self.at = inside;
        if !is_struct {
            return self.items(')').map(Shape::List);
        }
        let mut fields = Vec::new();
        loop {
            self.skip_blank();
            if self.take(')') {
                return Some(Shape::Struct(fields));
            }
            let name = self.word();
            self.skip_blank();
            if name.is_empty() || !self.take(':') {
                return None;
            }
            fields.push((self.text[name].to_owned(), self.value()?));
            self.skip_blank();
            if !self.take(',') && !self.rest().starts_with(')') {
                return None;
            }
        }
    }

    fn items(&mut self, end: char) -> Option<Vec<Node>> {
        let mut items = Vec::new();
        loop {
            self.skip_blank();
            if self.take(end) {
                return Some(items);
            }
            items.push(self.value()?);
            self.skip_blank();
            if !self.take(',') && !self.rest().starts_with(end) {
                return None;
            }
        }
    }

    fn skip_map(&mut self) -> Option<()> {
        let mut depth = 0;
        loop {
            self.skip_blank();
            if self.string().is_some() {
                continue;
            }
            let sign = self.rest().chars().next()?;
            self.at += sign.len_utf8();
            depth += i32::from(matches!(sign, '{' | '(' | '[')) - i32::from(matches!(sign, '}' | ')' | ']'));
            if depth == 0 {
                return Some(());
            }
        }
    }

    /// A string or a letter in quotes, if one is next.
    fn string(&mut self) -> Option<()> {
        let rest = self.rest();
        let end = if let Some(raw) = rest.strip_prefix('r').filter(|raw| raw.starts_with(['"', '#'])) {
            let hashes = raw.len() - raw.trim_start_matches('#').len();
            let inside = raw[hashes..].strip_prefix('"')?;
            let close = format!("\"{}", "#".repeat(hashes));
            1 + hashes + 1 + inside.find(&close)? + close.len()
        } else {
            let quote = rest.chars().next().filter(|sign| "\"'".contains(*sign))?;
            let mut is_escaped = false;
            let close = rest[1..].char_indices().find(|(_, sign)| {
                let closes = *sign == quote && !is_escaped;
                is_escaped = *sign == '\\' && !is_escaped;
                closes
            })?;
            1 + close.0 + 1
        };
        self.at += end;
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_found_with_their_places() {
        let text = "// A tree. (not: this)\n(name: \"a (b) // c\", /* x: */ growth: Oak(height_m: -1.5e3, list: [1, 2,], at: (0.1, 0.2)), kind: Plain)";
        let tree = parse(text).unwrap();
        let at = |node: &Node| &text[node.span.clone()];
        assert_eq!(at(tree.field("name").unwrap()), "\"a (b) // c\"");
        let growth = tree.field("growth").unwrap();
        assert_eq!(&text[growth.head.clone()], "Oak");
        assert_eq!(at(growth.field("height_m").unwrap()), "-1.5e3");
        let Shape::List(items) = &growth.field("list").unwrap().shape else { panic!("a list") };
        assert_eq!(items.iter().map(at).collect::<Vec<_>>(), ["1", "2"]);
        assert!(matches!(&growth.field("at").unwrap().shape, Shape::List(items) if items.len() == 2));
        assert_eq!(at(tree.field("kind").unwrap()), "Plain");
        assert!(tree.field("not").is_none() && tree.field("x").is_none());
    }

    #[test]
    fn what_is_no_ron_is_refused_without_a_panic() {
        for text in ["", "(", "(a: )", "(a: 1", "(a 1)", "[1 2]", "(a: 1) b", "{", "\"", "/*", "(ä: 1, ö)"] {
            assert_eq!(parse(text), None, "{text}");
        }
        assert!(parse("#![enable(implicit_some)]\n(a: {1: 2}, b: r#\"\"q\"\"#)").is_some());
    }

    #[test]
    fn comments_are_told_from_strings() {
        assert!(has_comments("(a: 1) // why") && has_comments("(a: /* why */ 1)"));
        assert!(!has_comments("(a: \"http://x\", b: r#\"// \"#)") && !has_comments("ä"));
    }

    #[test]
    fn every_shipped_species_is_read() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/species");
        for file in std::fs::read_dir(folder).unwrap() {
            let path = file.unwrap().path();
            let text = std::fs::read_to_string(&path).unwrap();
            assert!(parse(&text).is_some_and(|tree| tree.field("name").is_some()), "{}", path.display());
        }
    }
}
