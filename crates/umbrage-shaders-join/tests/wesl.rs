//! A WESL project imports the joined texts as a module of its own, and the modules without bindings
//! as a package.

use naga::valid::{Capabilities, ValidationFlags, Validator};
use umbrage_shaders::{Casters, Maps, ReceiverText, layout::FilterKind};
use umbrage_shaders_join::sources;
use wesl::syntax::PathOrigin;
use wesl::{CompileOptions, Feature, Features, FileResolver, ModulePath, Resolver, Router, VirtualResolver, Wesl};

const RECEIVER: &str = "
import package::umbrage::{umbrage_visibility, umbrage_query, umbrage_shadow};

@fragment fn fragment(@location(0) position: vec3f) -> @location(0) vec4f {
    let up = vec3f(0.0, 1.0, 0.0);
    var query = umbrage_query(position, up);
    query.light = 1u;
    return vec4f(umbrage_visibility(position, up), umbrage_shadow(query).visibility, 0.0, 1.0);
}";

const CASTER: &str = "
import package::umbrage::{umbrage_cast, UmbrageInstance, UmbrageCast};

@vertex fn vertex(@location(0) position: vec3f, instance: UmbrageInstance) -> UmbrageCast {
    return umbrage_cast(position, instance);
}";

const KERNEL: &str = "
import umbrage::lib::dither::threshold;
import umbrage::lib::kernel;
import umbrage::lib::tint;

@fragment fn fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let weight = kernel::weight_of(kernel::PCF5, floor(at.xy), at.xy, vec2f(kernel::radius(kernel::PCF5)));
    return vec4f(tint::of_split(u32(at.z)) * threshold(vec2i(at.xy)), weight.x * weight.y);
}";

/// What a project's main module compiles to, beside whatever else its resolver has.
fn compiled(resolver: impl Resolver, options: CompileOptions) -> Result<String, String> {
    let mut compiler = Wesl::new("").set_custom_resolver(resolver);
    compiler.set_options(options);
    let main: ModulePath = "package::main".parse().expect("a module path");
    compiler.compile(&main).map(|result| result.to_string()).map_err(|error| error.to_string())
}

/// A project of a main module, with a text of ours beside it.
fn beside(main: &str, text: &str) -> Result<String, String> {
    let mut resolver = VirtualResolver::new();
    resolver.add_module("package::main".parse().expect("a module path"), main.into());
    resolver.add_module("package::umbrage".parse().expect("a module path"), text.into());
    compiled(resolver, CompileOptions::default())
}

#[track_caller]
fn validated(wgsl: &str) -> naga::Module {
    let module = naga::front::wgsl::parse_str(wgsl).unwrap_or_else(|e| panic!("{}", e.emit_to_string(wgsl)));
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|e| panic!("{}", e.emit_to_string(wgsl)));
    module
}

/// Bindings of a module: groups and numbers, in order.
fn bindings(module: &naga::Module) -> Vec<(u32, u32)> {
    let mut found: Vec<(u32, u32)> =
        module.global_variables.iter().filter_map(|(_, it)| it.binding).map(|it| (it.group, it.binding)).collect();
    found.sort_unstable();
    found
}

#[test]
fn a_project_imports_a_receiver() {
    // What a filter does not use is left out, here the sampler.
    for (filter, expected) in [
        (None, &[(2, 0), (2, 1), (2, 2)][..]),
        (Some(FilterKind::Hard), &[(2, 0), (2, 1), (2, 2)]),
        (Some(FilterKind::Pcf3), &[(2, 0), (2, 1)]),
    ] {
        let text = ReceiverText { filter, ..Maps::default().into() };
        let wgsl = beside(RECEIVER, &umbrage_shaders::receiver(2, text)).unwrap_or_else(|error| panic!("{error}"));
        let module = validated(&wgsl);
        assert_eq!(module.entry_points.len(), 1);
        assert_eq!(bindings(&module), expected, "{filter:?}");
    }
}

#[test]
fn a_project_imports_a_caster() {
    let wgsl = beside(CASTER, &umbrage_shaders::caster(1, Casters::default(), ""));
    assert_eq!(bindings(&validated(&wgsl.unwrap_or_else(|error| panic!("{error}")))), [(1, 0)]);
}

#[test]
fn a_project_imports_modules_of_a_package() {
    let mut main = VirtualResolver::new();
    main.add_module("package::main".parse().expect("a module path"), KERNEL.into());
    let mut router = Router::new();
    router.mount_fallback_resolver(main);
    let package = ModulePath::new(PathOrigin::Package("umbrage".to_owned()), Vec::new());
    router.mount_resolver(package, FileResolver::new(sources()));
    let features = Features { default: Feature::Enable, ..Features::default() };
    let wgsl = compiled(router, CompileOptions { features, ..CompileOptions::default() });
    let module = validated(&wgsl.unwrap_or_else(|error| panic!("{error}")));
    assert_eq!((module.entry_points.len(), bindings(&module).len()), (1, 0));
}

/// The test must be able to say no: an item that no text has is not imported silently.
#[test]
fn an_item_that_is_not_there_is_refused() {
    let wrong = RECEIVER.replace("umbrage_visibility", "umbrage_visible");
    let refused = beside(&wrong, &umbrage_shaders::receiver(2, Maps::default()))
        .map(|wgsl| naga::front::wgsl::parse_str(&wgsl).err().map(|error| error.emit_to_string(&wgsl)));
    match refused {
        Err(message) | Ok(Some(message)) => assert!(message.contains("umbrage_visible"), "{message}"),
        Ok(None) => panic!("an unknown function was taken"),
    }
}
