//! Reads `use` declarations and paths out of Rust source, without a parser of the whole language.

use super::tokens::{Token, tokens};

/// One name that a `use` declaration brings in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Import {
    /// The path as written, such as `["super", "age", "Stage"]`; the last is `*` for a glob.
    pub path: Vec<String>,
    /// What it is called here.
    pub name: String,
    /// Whether other files see it: `pub use`, `pub(crate) use` and their like.
    pub is_public: bool,
}

/// A file's product code: what it imports, declares, and the paths and names that it writes elsewhere.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Code {
    /// All names of `use` declarations.
    pub imports: Vec<Import>,
    /// Items defined in the file: types, functions, constants, macros and the names of inline modules.
    pub items: Vec<String>,
    /// Modules declared with `mod name;`.
    pub modules: Vec<String>,
    /// Paths outside `use` declarations, of one segment or more. Each `super` out of an inline module is taken off.
    pub paths: Vec<Vec<String>>,
}

const ITEM_KEYWORDS: [&str; 9] = ["fn", "struct", "enum", "union", "trait", "type", "const", "static", "mod"];

struct Reader {
    tokens: Vec<Token>,
    at: usize,
    code: Code,
    /// For each open brace whether it is that of an inline module.
    braces: Vec<bool>,
}

impl Reader {
    fn peek(&self, ahead: usize) -> Option<&Token> {
        self.tokens.get(self.at + ahead)
    }

    fn is_word(&self, ahead: usize, word: &str) -> bool {
        matches!(self.peek(ahead), Some(Token::Word(own)) if own == word)
    }

    fn is_sign(&self, ahead: usize, sign: char) -> bool {
        self.peek(ahead) == Some(&Token::Sign(sign))
    }

    fn word(&self, ahead: usize) -> Option<String> {
        match self.peek(ahead) {
            Some(Token::Word(word)) => Some(word.clone()),
            _ => None,
        }
    }

    /// Index just behind the bracket that closes the one at `from`.
    fn behind_bracket(&self, from: usize) -> usize {
        let mut depth = 0;
        for (index, token) in self.tokens.iter().enumerate().skip(from) {
            match token {
                Token::Sign('(' | '[' | '{') => depth += 1,
                Token::Sign(')' | ']' | '}') => depth -= 1,
                _ => {}
            }
            if depth == 0 {
                return index + 1;
            }
        }
        self.tokens.len()
    }

    /// Skips `#[cfg(...test...)]` with the module behind it, if that is what comes next.
    fn skip_test_module(&mut self) -> bool {
        if !(self.is_sign(0, '#') && self.is_sign(1, '[') && self.is_word(2, "cfg")) {
            return false;
        }
        let behind = self.behind_bracket(self.at + 1);
        let words = self.tokens[self.at..behind].iter();
        let is_test = words.clone().any(|token| *token == Token::Word("test".into()))
            && !words.clone().any(|token| *token == Token::Word("not".into()));
        if !is_test {
            return false;
        }
        // The item: up to its `;` or its braces.
        let mut end = behind;
        while end < self.tokens.len() {
            match self.tokens[end] {
                Token::Sign(';') => {
                    end += 1;
                    break;
                }
                Token::Sign('{') if self.tokens[behind..end].contains(&Token::Word("use".into())) => {
                    end = self.behind_bracket(end);
                }
                Token::Sign('{') => {
                    end = self.behind_bracket(end);
                    break;
                }
                Token::Sign('(' | '[') => end = self.behind_bracket(end),
                _ => end += 1,
            }
        }
        self.at = end;
        true
    }

    fn read(mut self) -> Code {
        let mut is_public = false;
        while self.at < self.tokens.len() {
            if self.skip_test_module() {
                continue;
            }
            match self.tokens[self.at].clone() {
                Token::Word(word) if word == "pub" => {
                    is_public = true;
                    self.at = if self.is_sign(1, '(') { self.behind_bracket(self.at + 1) } else { self.at + 1 };
                    continue;
                }
                Token::Word(word) if word == "use" => {
                    self.at += 1;
                    self.read_use(Vec::new(), is_public);
                }
                Token::Word(word) if word == "mod" && self.is_sign(2, ';') => {
                    self.code.modules.extend(self.word(1));
                    self.at += 3;
                }
                Token::Word(word) if word == "mod" && self.is_sign(2, '{') => {
                    self.code.items.extend(self.word(1));
                    self.braces.push(true);
                    self.at += 3;
                }
                Token::Word(word) if word == "macro_rules" && self.is_sign(1, '!') => {
                    self.code.items.extend(self.word(2));
                    self.at += 3;
                }
                Token::Word(word) if ITEM_KEYWORDS.contains(&word.as_str()) && self.is_top_level() => {
                    self.code.items.extend(self.word(1));
                    self.at += 2;
                }
                Token::Word(_) => self.read_path(),
                Token::Sign('{') => {
                    self.braces.push(false);
                    self.at += 1;
                }
                Token::Sign('}') => {
                    self.braces.pop();
                    self.at += 1;
                }
                _ => self.at += 1,
            }
            is_public = false;
        }
        self.code
    }

    fn is_top_level(&self) -> bool {
        self.braces.iter().all(|&is_module| is_module)
    }

    /// How many inline modules are open.
    fn depth(&self) -> usize {
        self.braces.iter().filter(|&&is_module| is_module).count()
    }

    /// Takes one `super` off for each inline module that is open; `None` where the path ends inside this file.
    fn seen_from_file(&self, mut path: Vec<String>) -> Option<Vec<String>> {
        for _ in 0..self.depth() {
            match path.first().map(String::as_str) {
                Some("super") => drop(path.remove(0)),
                Some("crate") => return Some(path),
                _ => return None,
            }
        }
        if self.depth() > 0 && path.first().is_none_or(|first| first != "super") {
            path.insert(0, "self".into());
        }
        Some(path)
    }

    fn read_path(&mut self) {
        // A field or a method is no path.
        let is_member = self.at > 0 && self.tokens[self.at - 1] == Token::Sign('.');
        let mut path: Vec<String> = self.word(0).into_iter().collect();
        self.at += 1;
        while self.peek(0) == Some(&Token::Colons) {
            let Some(word) = self.word(1) else { break };
            path.push(word);
            self.at += 2;
        }
        if !is_member {
            let path = self.seen_from_file(path);
            self.code.paths.extend(path);
        }
    }

    /// Reads a tree of names up to its `;`, `,` or `}`.
    fn read_use(&mut self, prefix: Vec<String>, is_public: bool) {
        let mut path = prefix;
        loop {
            match self.peek(0).cloned() {
                Some(Token::Word(word)) => {
                    path.push(word);
                    self.at += 1;
                }
                Some(Token::Sign('*')) => {
                    path.push("*".into());
                    self.at += 1;
                }
                Some(Token::Sign('{')) => {
                    self.at += 1;
                    while !self.is_sign(0, '}') && self.peek(0).is_some() {
                        self.read_use(path.clone(), is_public);
                        if self.is_sign(0, ',') {
                            self.at += 1;
                        }
                    }
                    self.at += 1;
                    return;
                }
                _ => {}
            }
            match self.peek(0) {
                Some(Token::Colons) => self.at += 1,
                Some(Token::Word(word)) if word == "as" => {
                    let name = self.word(1).unwrap_or_default();
                    self.at += 2;
                    self.push_import(path, name, is_public);
                    return;
                }
                _ => {
                    if path.len() > 1 && path.last().is_some_and(|last| last == "self") {
                        path.pop();
                    }
                    let name = path.last().cloned().unwrap_or_default();
                    self.push_import(path, name, is_public);
                    return;
                }
            }
        }
    }

    fn push_import(&mut self, path: Vec<String>, name: String, is_public: bool) {
        if let Some(path) = self.seen_from_file(path) {
            self.code.imports.push(Import { path, name, is_public });
        }
    }
}

/// Reads the product code of a file.
pub fn read(text: &str) -> Code {
    Reader { tokens: tokens(text), at: 0, code: Code::default(), braces: Vec::new() }.read()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths(text: &str) -> Vec<String> {
        read(text).imports.iter().map(|import| import.path.join("::")).collect()
    }

    #[test]
    fn nested_lists_are_flattened() {
        let text = "use crate::{dynamics::{a, b::{self, C as D}}, wind::*}; use std::fmt;";
        let found = ["crate::dynamics::a", "crate::dynamics::b", "crate::dynamics::b::C", "crate::wind::*", "std::fmt"];
        assert_eq!(paths(text), found);
        assert_eq!(read(text).imports[2].name, "D");
    }

    #[test]
    fn chains_of_super_are_kept_and_inline_modules_take_theirs_off() {
        let text =
            "use super::super::a::B; mod inner { use super::{super::c::D, E}; fn f() { super::super::g::h(); } }";
        assert_eq!(paths(text), ["super::super::a::B", "super::c::D", "self::E"]);
        assert!(read(text).paths.contains(&vec!["super".into(), "g".into(), "h".into()]));
    }

    #[test]
    fn test_code_is_left_out() {
        let text = "use crate::a; #[cfg(test)] use crate::b::{C, D}; #[cfg(all(test, feature = \"render\"))]\nmod tests \
                    { use crate::e; } #[cfg(test)] mod more; #[cfg(not(test))] use crate::f;";
        assert_eq!(paths(text), ["crate::a", "crate::f"]);
        assert!(read(text).modules.is_empty());
    }

    #[test]
    fn items_modules_and_paths_are_told_apart() {
        let text = "pub(super) mod child; pub use child::Item; pub struct Own; \
                    impl Own { fn method(&self) { child::call(self.field); const LOCAL: u8 = 1; } }";
        let code = read(text);
        assert_eq!((code.modules, code.items), (vec!["child".to_string()], vec!["Own".to_string()]));
        assert!(code.imports[0].is_public);
        assert!(code.paths.contains(&vec!["child".into(), "call".into()]));
        assert!(!code.paths.contains(&vec!["field".into()]));
    }
}
