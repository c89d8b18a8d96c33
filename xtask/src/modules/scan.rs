//! What one module's tokens say: what it defines, which modules it holds, and which names it uses.

use super::tokens::{group, identifier, is_path_separator, is_punct, line, list};
use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// Keywords that are followed by the name of what they define.
const DEFINITIONS: [&str; 8] = [
    "fn", "struct", "enum", "union", "trait", "type", "const", "static",
];

/// Items that end with a semicolon though they may hold braces.
const END_WITH_SEMICOLON: [&str; 4] = ["use", "const", "static", "type"];

/// What a module's own tokens say; the tokens of a module in the same file are in [`Child::body`].
#[derive(Default)]
pub(super) struct Scan {
    pub items: Vec<String>,
    pub children: Vec<Child>,
    pub imports: Vec<Import>,
    pub paths: Vec<Path>,
    /// Items declared `pub`, methods and constants of `impl` blocks included.
    pub public_items: usize,
}

/// `mod name;` or `mod name { body }`
pub(super) struct Child {
    pub name: String,
    pub body: Option<TokenStream>,
}

/// One name, or all, that a `use` brings in.
pub(super) struct Import {
    pub path: Path,
    /// `None` where it is `*`.
    pub name: Option<String>,
    /// With any `pub`.
    pub is_export: bool,
}

/// A path of two segments or more, as it is written.
#[derive(Clone, Debug)]
pub(super) struct Path {
    pub segments: Vec<String>,
    pub line: usize,
}

impl Scan {
    pub(super) fn of(stream: TokenStream) -> Self {
        let mut scan = Self::default();
        scan.block(&list(stream), true);
        scan
    }

    /// `top` is false inside brackets, where nothing is defined that another module could name.
    fn block(&mut self, tokens: &[TokenTree], top: bool) {
        let mut i = 0;
        let mut visibility = Visibility::Private;
        while i < tokens.len() {
            if let Some((attribute, after)) = attribute(tokens, i) {
                if is_test_only(&attribute) {
                    i = after_item(tokens, after);
                } else {
                    if identifier(&attribute, 0).as_deref() != Some("doc") {
                        self.block(&attribute, false);
                        self.quoted_paths(&attribute);
                    }
                    i = after;
                }
                continue;
            }
            if let TokenTree::Group(inner) = &tokens[i] {
                self.block(&list(inner.stream()), false);
                i += 1;
                visibility = Visibility::Private;
                continue;
            }
            if is_path_separator(tokens, i) {
                // What follows is another crate's (`::std::…`) or belongs to a type (`<T as Trait>::…`).
                i = path(tokens, i + 2).1.max(i + 2);
                continue;
            }
            let Some(word) = identifier(tokens, i) else {
                // Between `pub` and its item stands no more than the ABI of `extern "C"`.
                if !matches!(tokens[i], TokenTree::Literal(_)) {
                    visibility = Visibility::Private;
                }
                i += 1;
                continue;
            };
            match word.as_str() {
                "pub" => (visibility, i) = Visibility::read(tokens, i),
                "use" => {
                    let end = semicolon(tokens, i);
                    let is_export = visibility != Visibility::Private;
                    self.import(&tokens[i + 1..end], &[], is_export);
                    i = end + 1;
                    visibility = Visibility::Private;
                }
                "mod" if top && identifier(tokens, i + 1).is_some() => {
                    let body = group(tokens, i + 2, Delimiter::Brace);
                    self.public_items += usize::from(visibility == Visibility::Public);
                    self.children.push(Child {
                        name: identifier(tokens, i + 1).unwrap_or_default(),
                        body: body.map(proc_macro2::Group::stream),
                    });
                    i += 3;
                    visibility = Visibility::Private;
                }
                "macro_rules" if top && is_punct(tokens, i + 1, '!') => {
                    self.items.extend(identifier(tokens, i + 2));
                    i += 3;
                }
                keyword if DEFINITIONS.contains(&keyword) => {
                    // Of `const fn` the second keyword counts.
                    let name = identifier(tokens, i + 1).filter(|name| !is_qualifier(name));
                    if let Some(name) = name {
                        self.public_items += usize::from(visibility == Visibility::Public);
                        if top {
                            self.items.push(name);
                        }
                        visibility = Visibility::Private;
                        i += 2;
                    } else {
                        i += 1;
                    }
                }
                _ => {
                    let (found, after) = path(tokens, i);
                    if found.segments.len() > 1 {
                        self.paths.push(found);
                    }
                    if !is_qualifier(&word) {
                        visibility = Visibility::Private;
                    }
                    i = after;
                }
            }
        }
    }

    /// The tree behind `use`, or one between its braces.
    fn import(&mut self, tokens: &[TokenTree], prefix: &[String], is_export: bool) {
        for tree in tokens.split(|token| matches!(token, TokenTree::Punct(p) if p.as_char() == ','))
        {
            let Some(first) = tree.first() else { continue };
            if is_path_separator(tree, 0) {
                continue;
            }
            let (mut own, i) = path(tree, 0);
            own.segments.splice(0..0, prefix.iter().cloned());
            own.line = line(first);
            if let Some(braces) = group(tree, i, Delimiter::Brace) {
                self.import(&list(braces.stream()), &own.segments, is_export);
                continue;
            }
            let is_glob = is_punct(tree, i, '*');
            if own.segments.len() > 1 && own.segments.last().is_some_and(|s| s == "self") {
                own.segments.pop();
            }
            let renamed = identifier(tree, i).filter(|word| word == "as");
            let name = match renamed {
                Some(_) => identifier(tree, i + 1),
                None => own.segments.last().cloned(),
            };
            self.imports.push(Import {
                name: name.filter(|_| !is_glob),
                path: own,
                is_export,
            });
        }
    }

    /// Paths in the strings of an attribute, as in `#[serde(with = "crate::time")]`.
    fn quoted_paths(&mut self, tokens: &[TokenTree]) {
        for token in tokens {
            match token {
                TokenTree::Group(inner) => self.quoted_paths(&list(inner.stream())),
                TokenTree::Literal(literal) => {
                    let text = literal.to_string();
                    let quoted = text.trim_matches('"').parse::<TokenStream>();
                    if text.contains("::")
                        && let Ok(stream) = quoted
                    {
                        let (mut found, _) = path(&list(stream), 0);
                        found.line = line(token);
                        if found.segments.len() > 1 {
                            self.paths.push(found);
                        }
                    }
                }
                _ => {}
            }
        }
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Visibility {
    Private,
    /// `pub(…)`
    Restricted,
    Public,
}

impl Visibility {
    /// Reads `pub` or `pub(…)` at `i`, and where the tokens go on.
    fn read(tokens: &[TokenTree], i: usize) -> (Self, usize) {
        let restriction = group(tokens, i + 1, Delimiter::Parenthesis).map(|g| list(g.stream()));
        let restricted = restriction.is_some_and(|inner| {
            let word = identifier(&inner, 0);
            let word = word.as_deref();
            word == Some("in")
                || inner.len() == 1 && matches!(word, Some("crate" | "super" | "self"))
        });
        if restricted {
            (Self::Restricted, i + 2)
        } else {
            (Self::Public, i + 1)
        }
    }
}

/// Words between `pub` and the keyword of an item, or between two keywords.
fn is_qualifier(word: &str) -> bool {
    matches!(
        word,
        "fn" | "const" | "unsafe" | "async" | "extern" | "static" | "mut"
    )
}

/// The tokens inside `#[…]` or `#![…]` at `i`, and the place after it.
fn attribute(tokens: &[TokenTree], i: usize) -> Option<(Vec<TokenTree>, usize)> {
    if !is_punct(tokens, i, '#') {
        return None;
    }
    let open = i + 1 + usize::from(is_punct(tokens, i + 1, '!'));
    let inner = group(tokens, open, Delimiter::Bracket)?;
    Some((list(inner.stream()), open + 1))
}

/// `#[test]`, `#[cfg(test)]`, `#[cfg(all(test, …))]`; not `#[cfg(not(test))]`.
fn is_test_only(attribute: &[TokenTree]) -> bool {
    fn needs_test(tokens: &[TokenTree]) -> bool {
        let all = identifier(tokens, 0).as_deref() == Some("all");
        match group(tokens, 1, Delimiter::Parenthesis) {
            Some(inner) if all => list(inner.stream())
                .split(|token| matches!(token, TokenTree::Punct(p) if p.as_char() == ','))
                .any(needs_test),
            Some(_) => false,
            None => identifier(tokens, 0).as_deref() == Some("test"),
        }
    }
    match identifier(attribute, 0).as_deref() {
        Some("test") => attribute.len() == 1,
        Some("cfg") => group(attribute, 1, Delimiter::Parenthesis)
            .is_some_and(|inner| needs_test(&list(inner.stream()))),
        _ => false,
    }
}

/// The place after the item that begins at `i`, further attributes included.
fn after_item(tokens: &[TokenTree], mut i: usize) -> usize {
    let mut to_semicolon = false;
    while i < tokens.len() {
        if let Some((_, after)) = attribute(tokens, i) {
            i = after;
            continue;
        }
        if let Some(word) = identifier(tokens, i) {
            let is_function = identifier(tokens, i + 1).as_deref() == Some("fn");
            to_semicolon |= END_WITH_SEMICOLON.contains(&word.as_str()) && !is_function;
        }
        let is_body = group(tokens, i, Delimiter::Brace).is_some();
        if is_punct(tokens, i, ';') || is_body && !to_semicolon {
            return i + 1;
        }
        i += 1;
    }
    i
}

/// The path at `i`, up to a `<`, `{` or `*` if there is one, and the place after it.
fn path(tokens: &[TokenTree], i: usize) -> (Path, usize) {
    let mut segments = Vec::new();
    let mut end = i;
    while let Some(word) = identifier(tokens, end) {
        segments.push(word);
        end += 1;
        if !is_path_separator(tokens, end) {
            break;
        }
        end += 2;
    }
    let line = tokens.get(i).map_or(0, line);
    (Path { segments, line }, end)
}

/// The next semicolon at or after `i`, or the end.
fn semicolon(tokens: &[TokenTree], i: usize) -> usize {
    (i..tokens.len())
        .find(|&j| is_punct(tokens, j, ';'))
        .unwrap_or(tokens.len())
}
