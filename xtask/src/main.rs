//! `cargo xtask demo | test | bless`.
fn main() {}
