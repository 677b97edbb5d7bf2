//! Nothing but tests: shaders that are composed with `naga_oil` import umbrage's WGSL as modules.
