//! umbrage-shaders.
