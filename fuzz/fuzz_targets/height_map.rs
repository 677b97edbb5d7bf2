//! libFuzzer's target of `umbrage_fuzz::Body::HeightMap`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| umbrage_fuzz::Body::HeightMap.run(bytes));
