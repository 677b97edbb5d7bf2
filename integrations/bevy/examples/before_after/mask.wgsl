#import bevy_pbr::forward_io::VertexOutput
#import bevy_pbr::mesh_view_bindings::view
#import bevy_pbr::shadows::fetch_directional_shadow

@fragment
fn fragment(in: VertexOutput, @builtin(front_facing) is_front: bool) -> @location(0) vec4<f32> {
    let depth_row = vec4<f32>(
        view.view_from_world[0].z,
        view.view_from_world[1].z,
        view.view_from_world[2].z,
        view.view_from_world[3].z,
    );
    let view_z = dot(depth_row, in.world_position);
    let normal = normalize(in.world_normal) * select(-1.0, 1.0, is_front);
    let visibility = fetch_directional_shadow(0u, in.world_position, normal, view_z, in.position.xy);
    return vec4<f32>(vec3<f32>(visibility), 1.0);
}
