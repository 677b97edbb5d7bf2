//! libFuzzer's target of `umbrage_fuzz::Body::Gltf`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| umbrage_fuzz::Body::Gltf.run(bytes));
