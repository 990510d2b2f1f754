//! Splits Rust source into tokens, as far as `use` declarations and paths ask for it.

use std::{iter::Peekable, str::CharIndices};

/// A token.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Token {
    /// A name, a keyword or a number.
    Word(String),
    /// `::`
    Colons,
    /// Any other sign.
    Sign(char),
}

/// Splits source into words and signs. Comments, strings, characters and lifetimes are left out.
pub fn tokens(text: &str) -> Vec<Token> {
    let mut tokens = Vec::new();
    let mut chars = text.char_indices().peekable();
    while let Some((at, c)) = chars.next() {
        let next = chars.peek().map(|&(_, c)| c);
        match c {
            '/' if next == Some('/') => while chars.next_if(|&(_, c)| c != '\n').is_some() {},
            '/' if next == Some('*') => skip_block_comment(&mut chars),
            '"' => skip_string(&mut chars),
            'r' | 'b' | 'c' if raw_string(&text[at..]).is_some() => {
                let length = raw_string(&text[at..]).unwrap_or(0);
                while chars.next_if(|&(next, _)| next < at + length).is_some() {}
            }
            '\'' => skip_character_or_lifetime(text, at, &mut chars),
            ':' if next == Some(':') => {
                chars.next();
                tokens.push(Token::Colons);
            }
            _ if c.is_alphanumeric() || c == '_' => {
                let mut end = at + c.len_utf8();
                while let Some((next, c)) = chars.next_if(|&(_, c)| c.is_alphanumeric() || c == '_') {
                    end = next + c.len_utf8();
                }
                // A byte or C string, or a byte: the prefix belongs to it.
                let is_prefix = matches!(&text[at..end], "b" | "c") && text[end..].starts_with(['"', '\'']);
                if !is_prefix {
                    tokens.push(Token::Word(text[at..end].into()));
                }
            }
            _ if c.is_whitespace() => {}
            _ => tokens.push(Token::Sign(c)),
        }
    }
    tokens
}

fn skip_block_comment(chars: &mut Peekable<CharIndices>) {
    chars.next();
    let (mut depth, mut before) = (1, ' ');
    for (_, c) in chars.by_ref() {
        match (before, c) {
            ('/', '*') => depth += 1,
            ('*', '/') => depth -= 1,
            _ => {
                before = c;
                continue;
            }
        }
        before = ' ';
        if depth == 0 {
            return;
        }
    }
}

fn skip_string(chars: &mut Peekable<CharIndices>) {
    while let Some((_, c)) = chars.next() {
        match c {
            '\\' => drop(chars.next()),
            '"' => return,
            _ => {}
        }
    }
}

/// Length of the raw or byte string that `text` starts with.
fn raw_string(text: &str) -> Option<usize> {
    let prefix = ["br", "cr", "r"].into_iter().find(|prefix| text.starts_with(prefix))?;
    let rest = &text[prefix.len()..];
    let hashes = rest.len() - rest.trim_start_matches('#').len();
    let body = rest[hashes..].strip_prefix('"')?;
    let end = body.find(&format!("\"{}", "#".repeat(hashes)))?;
    Some(prefix.len() + hashes + 1 + end + 1 + hashes)
}

fn skip_character_or_lifetime(text: &str, at: usize, chars: &mut Peekable<CharIndices>) {
    let mut following = text[at + 1..].chars();
    match (following.next(), following.next()) {
        (Some('\\'), _) => {
            chars.next();
            chars.next();
            while chars.next().is_some_and(|(_, c)| c != '\'') {}
        }
        (Some(_), Some('\'')) => drop((chars.next(), chars.next())),
        _ => while chars.next_if(|&(_, c)| c.is_alphanumeric() || c == '_').is_some() {},
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_strings_and_lifetimes_hide_no_code_and_show_none() {
        let text = r##"
            // hidden::a;
            /* hidden::b; /* nested */ hidden::c; */
            one("hidden::d; \" // ");
            two(r#"hidden::e; " "#);
            three('"');
            four::<'a>('\'', b"hidden", 'h', '\u{1F600}');
            five
        "##;
        let words: Vec<String> = tokens(text)
            .into_iter()
            .filter_map(|token| match token {
                Token::Word(word) => Some(word),
                _ => None,
            })
            .collect();
        assert_eq!(words, ["one", "two", "three", "four", "five"]);
        let path = [Token::Word("a".into()), Token::Colons, Token::Word("B2".into()), Token::Sign(';')];
        assert_eq!(tokens("a::B2;"), path);
    }
}
