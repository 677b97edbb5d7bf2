//! The command `umbrage`.
fn main() {}
