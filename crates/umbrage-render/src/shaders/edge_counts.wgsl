// What exact edges do for each pixel: behind forward.wgsl, with a receiver's text that counts.

// Red: 1 more than the cause, 0 where no surface is. Green: maps that were asked. Blue: runs. Alpha: triangles.
@fragment
fn fs_counts_opaque(in: Surface) -> @location(0) vec4u {
    let query = query_of(in, geometric_normal(in.from_eye));
    if !is_drawn(in) {
        discard;
    }
    return counts_at(in, query);
}

@fragment
fn fs_counts_masked(in: Surface) -> @location(0) vec4u {
    let query = query_of(in, geometric_normal(in.from_eye));
    if tested_alpha(in.uv, in.color.a) < material.alpha_cutoff || !is_drawn(in) {
        discard;
    }
    return counts_at(in, query);
}

fn counts_at(in: Surface, query: UmbrageQuery) -> vec4u {
    _ = shadow_of(in, query);
    let counts = umbrage_edge_counts();
    return vec4u(counts.x + 1u, counts.yzw);
}
