//! An engine that composes its shaders with `naga_oil` imports the joined texts as modules.

use std::collections::HashMap;

use naga_oil::compose::{ComposableModuleDescriptor, Composer, NagaModuleDescriptor, ShaderLanguage, ShaderType};
use umbrage_shaders::layout::FilterKind;
use umbrage_shaders::{Casters, Maps, ReceiverText};

const RECEIVER: &str = "
#import umbrage::{umbrage_visibility, umbrage_query, umbrage_shadow}

@fragment fn fragment(@location(0) position: vec3f) -> @location(0) vec4f {
    let up = vec3f(0.0, 1.0, 0.0);
    var query = umbrage_query(position, up);
    query.light = 1u;
    return vec4f(umbrage_visibility(position, up), umbrage_shadow(query).visibility, 0.0, 1.0);
}";

const CASTER: &str = "
@vertex fn vertex(@location(0) position: vec3f, instance: UmbrageInstance) -> UmbrageCast {
    return umbrage_cast(position, instance);
}";

/// Composes a shader with a text of ours as the module `umbrage`. The composer validates both.
fn composed(shader: &str, shader_type: ShaderType, text: &str) -> Result<naga::Module, String> {
    let mut composer = Composer::default();
    let module = ComposableModuleDescriptor {
        source: text,
        file_path: "umbrage.wgsl",
        language: ShaderLanguage::Wgsl,
        as_name: Some("umbrage".to_owned()),
        additional_imports: &[],
        shader_defs: HashMap::new(),
    };
    if let Err(error) = composer.add_composable_module(module) {
        return Err(error.emit_to_string(&composer));
    }
    let module = composer.make_naga_module(NagaModuleDescriptor {
        source: shader,
        file_path: "shader.wgsl",
        shader_type,
        ..NagaModuleDescriptor::default()
    });
    module.map_err(|error| error.emit_to_string(&composer))
}

/// Bindings of a module: groups and numbers, in order.
fn bindings(module: &naga::Module) -> Vec<(u32, u32)> {
    let mut found: Vec<(u32, u32)> =
        module.global_variables.iter().filter_map(|(_, it)| it.binding).map(|it| (it.group, it.binding)).collect();
    found.sort_unstable();
    found
}

#[test]
fn a_shader_imports_a_receiver() {
    // What a filter does not use is left out, here the sampler.
    for (filter, expected) in [
        (None, &[(2, 0), (2, 1), (2, 2)][..]),
        (Some(FilterKind::Hard), &[(2, 0), (2, 1), (2, 2)]),
        (Some(FilterKind::Pcf3), &[(2, 0), (2, 1)]),
    ] {
        let text = ReceiverText { filter, ..Maps::default().into() };
        let module = composed(RECEIVER, ShaderType::Wgsl, &umbrage_shaders::receiver(2, text));
        let module = module.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(module.entry_points.len(), 1);
        assert_eq!(bindings(&module), expected, "{filter:?}");
    }
}

/// A caster's text declares an alias, `UmbrageTexel`, and `naga_oil` takes no module with one: it
/// stands before the shader that is composed.
#[test]
fn a_caster_stands_before_a_shader() {
    let text = umbrage_shaders::caster(1, Casters::default(), "");
    let receiver = umbrage_shaders::receiver(2, Maps::default());
    let module = composed(&(text.clone() + CASTER), ShaderType::Wgsl, &receiver);
    assert_eq!(bindings(&module.unwrap_or_else(|error| panic!("{error}"))), [(1, 0)]);
    // If this fails, `naga_oil` takes aliases, and the book may say so.
    let imports = format!("#import umbrage::{{umbrage_cast, UmbrageInstance, UmbrageCast}}\n{CASTER}");
    let refused = composed(&imports, ShaderType::Wgsl, &text).expect_err("an alias");
    assert!(refused.contains("UmbrageTexel"), "{refused}");
}

/// The test must be able to say no.
#[test]
fn a_function_that_is_not_there_is_refused() {
    let wrong = RECEIVER.replace("umbrage_visibility", "umbrage_visible");
    let refused = composed(&wrong, ShaderType::Wgsl, &umbrage_shaders::receiver(2, Maps::default()));
    let message = refused.expect_err("an unknown function");
    assert!(message.contains("umbrage_visible"), "{message}");
}
