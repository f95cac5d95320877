//! What stands in a file, as an error message quotes it.

/// Characters that are quoted.
const LENGTH: usize = 80;

/// The first 80 characters of `text`, control characters escaped, and `…` if there are
/// more: a file may hold anything, and a terminal obeys what it is sent.
pub(crate) fn excerpt(text: &str) -> String {
    match text.char_indices().nth(LENGTH) {
        None => printable(text),
        Some((end, _)) => printable(&text[..end]) + "…",
    }
}

/// All of `text`, with control characters escaped.
pub(crate) fn printable(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '"' | '\'' | '\\' => escaped.push(character),
            _ => escaped.extend(character.escape_debug()),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_are_cut_and_terminals_are_not_obeyed() {
        assert_eq!(excerpt("as it \"is\", ½"), "as it \"is\", ½");
        assert_eq!(excerpt(&"é".repeat(80)), "é".repeat(80));
        assert_eq!(excerpt(&"é".repeat(81)), "é".repeat(80) + "…");
        assert_eq!(
            excerpt("\u{1b}[2J\t\r\0\u{202e}"),
            r"\u{1b}[2J\t\r\0\u{202e}"
        );
    }
}
