//! What the checks say: at once, or kept until their turn comes.

use std::cell::RefCell;
use std::io::Write;

thread_local! {
    static KEPT: RefCell<Option<Vec<u8>>> = const { RefCell::new(None) };
}

/// Writes, or keeps, where [`keep`] runs. Nobody need read any more: a check goes on, and
/// its exit status tells.
pub(crate) fn write(bytes: &[u8], mut to: impl Write) {
    KEPT.with_borrow_mut(|kept| match kept {
        Some(kept) => kept.extend_from_slice(bytes),
        None => drop(to.write_all(bytes)),
    });
}

/// Runs something; returns what it says with what it returns.
pub(crate) fn keep<T>(run: impl FnOnce() -> T) -> (T, Vec<u8>) {
    KEPT.set(Some(Vec::new()));
    let result = run();
    (result, KEPT.take().unwrap_or_default())
}

/// Whether [`keep`] runs, in this thread.
pub(crate) fn is_kept() -> bool {
    KEPT.with_borrow(Option::is_some)
}

#[cfg(test)]
mod tests {
    #[test]
    fn what_is_said_can_be_kept() {
        let ((), said) = super::keep(|| {
            println!("one");
            crate::shell::command("echo").arg("two").run().unwrap();
            eprint!("three");
        });
        assert_eq!(said, b"one\n$ echo two\ntwo\nthree");
        assert!(!super::is_kept());
    }
}
