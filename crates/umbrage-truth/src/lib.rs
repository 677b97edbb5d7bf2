//! umbrage-truth.
