//! Exit codes of failures.

use umbrage_lab::failure::Failure;

/// Returns the exit code of the process: 2 for bad input, 1 for any other failure.
#[must_use]
pub fn exit_code(failure: &Failure) -> u8 {
    match failure {
        Failure::Input(_) => 2,
        Failure::Other(_) => 1,
    }
}
