//! What is wrong with an option that says how a file is read.

use thiserror::Error;

/// An option that cannot be what it is.
#[derive(Debug, Error)]
#[allow(missing_docs)] // each variant's message is its documentation
pub enum OptionError {
    #[error("{option} does not apply to {what}; leave it out")]
    DoesNotApply {
        option: &'static str,
        what: &'static str,
    },
    #[error("{option} {found}: expected {expected}")]
    Setting {
        option: &'static str,
        found: f64,
        expected: &'static str,
    },
}

/// # Errors
/// One of these options is given to `what`, to which none applies.
pub(crate) fn none_given<const N: usize>(
    options: [(&'static str, bool); N],
    what: &'static str,
) -> Result<(), OptionError> {
    match options.into_iter().find(|(_, given)| *given) {
        None => Ok(()),
        Some((option, _)) => Err(OptionError::DoesNotApply { option, what }),
    }
}
