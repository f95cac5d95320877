//! Damaged files, for tests of what reads them.

/// Puts the second of each three texts in the place of the first, where it stands first in
/// `good`; the error of `read` then has the third in it, and nothing that a terminal obeys.
pub(crate) fn assert_refused(
    good: &str,
    read: impl Fn(&[u8]) -> String,
    changes: &[(&str, &str, &str)],
) {
    for &(from, to, words) in changes {
        assert!(good.contains(from), "{from:?} is not in the file");
        let error = read(good.replacen(from, to, 1).as_bytes());
        assert!(error.contains(words), "{words:?} is not in {error}");
        assert!(!error.contains(char::is_control), "{error:?}");
    }
}
