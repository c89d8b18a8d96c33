//! Helpers for reading a list of token trees by position.

use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};

/// The tokens of a stream, or of what stands between two brackets.
pub(super) fn list(stream: TokenStream) -> Vec<TokenTree> {
    stream.into_iter().collect()
}

/// The identifier at `i`, a raw one without its `r#`.
pub(super) fn identifier(tokens: &[TokenTree], i: usize) -> Option<String> {
    match tokens.get(i)? {
        TokenTree::Ident(ident) => Some(ident.to_string().trim_start_matches("r#").to_owned()),
        _ => None,
    }
}

/// Is this punctuation at `i`?
pub(super) fn is_punct(tokens: &[TokenTree], i: usize, c: char) -> bool {
    matches!(tokens.get(i), Some(TokenTree::Punct(punct)) if punct.as_char() == c)
}

/// Is `::` at `i`?
pub(super) fn is_path_separator(tokens: &[TokenTree], i: usize) -> bool {
    let joint = match tokens.get(i) {
        Some(TokenTree::Punct(punct)) => punct.spacing() == proc_macro2::Spacing::Joint,
        _ => false,
    };
    joint && is_punct(tokens, i, ':') && is_punct(tokens, i + 1, ':')
}

/// The group at `i`, if it has these brackets.
pub(super) fn group(tokens: &[TokenTree], i: usize, delimiter: Delimiter) -> Option<&Group> {
    match tokens.get(i)? {
        TokenTree::Group(group) if group.delimiter() == delimiter => Some(group),
        _ => None,
    }
}

/// The line of the file, from 1.
pub(super) fn line(token: &TokenTree) -> usize {
    token.span().start().line
}
