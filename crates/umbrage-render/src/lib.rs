//! umbrage-render.
