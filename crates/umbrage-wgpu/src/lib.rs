//! umbrage-wgpu.
