// Normals of what the eye sees: the surface's own, and those that the picture's lights are asked with.

// The triangle's own unit normal, turned towards the eye. Call in uniform control flow.
fn geometric_normal(from_eye: vec3f) -> vec3f {
    let normal = cross(dpdx(from_eye), dpdy(from_eye));
    let line_of_sight = select(from_eye, frame.forward, frame.is_orthographic > 0.5);
    let turned = select(normal, -normal, dot(normal, line_of_sight) > 0.0);
    // Not normalize(): the product of two small steps may be too small to be squared.
    let largest = max(max(abs(turned.x), abs(turned.y)), abs(turned.z));
    if largest == 0.0 {
        return -normalize(line_of_sight);
    }
    return normalize(turned / largest);
}

// The vertices' unit normal, on the side that is seen.
fn shading_normal(normal: vec3f, front: bool) -> vec3f {
    return normalize(select(-normal, normal, front));
}

// The unit vector from a position towards a light.
fn towards(lamp: Lamp, position: vec3f) -> vec3f {
    let way = lamp.position - position;
    return select(lamp.to_light, way / max(length(way), 1e-20), lamp.range > 0.0);
}

// Facets of a smooth surface turn away from the light one by one, which would cut its terminator into jags. For the picture
// a facet that turns away is looked up as if it were grazed: its neighbours shade it or do not, and the smooth normal
// darkens it. Surfaces whose two normals agree are not concerned. The mask knows nothing of this.
fn lookup_normal(geometric: vec3f, smooth_normal: vec3f, to_light: vec3f) -> vec3f {
    // Cosine of about 84 degrees. Lower: jags come back. Higher: light leaks past terminators.
    const LEAST_FACING: f32 = 0.1;
    let facing = dot(geometric, to_light);
    let wanted = min(LEAST_FACING, dot(smooth_normal, to_light));
    return normalize(geometric + max(wanted - facing, 0.0) * to_light);
}
