//! glTF extensions that a file may require.

/// Extensions that are read.
const READ: [&str; 11] = [
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "KHR_materials_pbrSpecularGlossiness",
];

/// Extensions that do not affect where a surface is.
const HARMLESS: [&str; 22] = [
    "AGI_stk_metadata",
    "CESIUM_primitive_outline",
    "EXT_instance_features",
    "EXT_mesh_features",
    "EXT_mesh_manifold",
    "EXT_structural_metadata",
    "FB_geometry_metadata",
    "GODOT_single_root",
    "GRIFFEL_bim_data",
    "KHR_animation_pointer",
    "KHR_interactivity",
    "KHR_materials_common",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "MSFT_lod",
    "MSFT_packing_normalRoughnessMetallic",
    "MSFT_packing_occlusionRoughnessMetallic",
    "MX_mesh_metadata",
    "OMI_spawn_point",
    "UNITY_materials_shadergraph",
    "VRM",
    "VRMC_vrm",
];

/// Parts of names by which whole families of extensions are known to be harmless.
const HARMLESS_PARTS: [&str; 9] =
    ["_materials_", "_texture_", "_lights_", "_image_", "_audio", "_xmp", "_physics_", "VRMC_", "_collider"];

/// Returns whether an extension is read here.
pub(super) fn is_read(name: &str) -> bool {
    READ.contains(&name)
}

/// Returns whether a file keeps its shape without an extension that it requires and that is not
/// read.
pub(super) fn is_harmless(name: &str) -> bool {
    HARMLESS.contains(&name) || HARMLESS_PARTS.iter().any(|part| name.contains(part))
}
