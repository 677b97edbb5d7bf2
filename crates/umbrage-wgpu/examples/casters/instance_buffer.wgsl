struct Row {
    @location(5) x: vec4f,
    @location(6) y: vec4f,
    @location(7) z: vec4f,
    @location(8) w: vec4f,
}

@vertex fn vertex(@location(0) local: vec3f, row: Row, instance: UmbrageInstance) -> UmbrageCast {
    let world_from_local = mat4x4f(row.x, row.y, row.z, row.w);
    return umbrage_cast((world_from_local * vec4f(local, 1.0)).xyz, instance);
}
