//! libFuzzer's target of `umbrage_fuzz::Body::Path`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| umbrage_fuzz::Body::Path.run(bytes));
