//! What a failure means to the shell.

use umbrage_lab::failure::Failure;

/// The exit code of the process: 2 for bad input, 1 for anything else.
#[must_use]
pub fn exit_code(failure: &Failure) -> u8 {
    match failure {
        Failure::Input(_) => 2,
        Failure::Other(_) => 1,
    }
}
