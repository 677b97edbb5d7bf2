//! What a fragment pays for each filter, counted in the receiver's text and not on a clock: the
//! instructions that are left when every call is replaced by what it calls, as drivers do. Loops
//! count once, branches all.
//!
//! `cargo test -p umbrage-shaders --test cost -- --nocapture` prints the table of
//! docs/notes/cost.md.

use std::collections::HashMap;

use naga::{Block, Function, Handle, Module, Statement};
use umbrage_shaders::layout::{BiasKind, FilterKind, MetricKind, SelectionKind, TransitionKind};
use umbrage_shaders::{Lights, Maps, MomentMaps, Projection, ReceiverText};

const FRAGMENT: &str = "
@fragment fn fragment(@builtin(position) at: vec4f, @location(0) position: vec3f) -> @location(0) vec4f {
    let normal = normalize(cross(dpdx(position), dpdy(position)));
    let query = umbrage_fragment_query(position, normal, dpdx(position), dpdy(position), at.xy);
    return vec4f(umbrage_shadow(query).visibility);
}";

/// Instructions of functions with all that they call.
struct Counter<'m> {
    module: &'m Module,
    known: HashMap<Handle<Function>, usize>,
}

impl Counter<'_> {
    fn function(&mut self, handle: Handle<Function>) -> usize {
        if let Some(&count) = self.known.get(&handle) {
            return count;
        }
        let module = self.module;
        let count = self.block(&module.functions[handle].body);
        self.known.insert(handle, count);
        count
    }

    fn block(&mut self, block: &Block) -> usize {
        block.iter().map(|statement| self.statement(statement)).sum()
    }

    fn statement(&mut self, statement: &Statement) -> usize {
        match statement {
            Statement::Emit(range) => range.clone().count(),
            Statement::Block(block) => self.block(block),
            Statement::If { accept, reject, .. } => 1 + self.block(accept) + self.block(reject),
            Statement::Switch { cases, .. } => 1 + cases.iter().map(|case| self.block(&case.body)).sum::<usize>(),
            Statement::Loop { body, continuing, .. } => 1 + self.block(body) + self.block(continuing),
            Statement::Call { function, .. } => self.function(*function),
            Statement::Return { .. } => 0,
            _ => 1,
        }
    }
}

/// Instructions of the fragment shader of a text.
fn instructions(source: &str) -> usize {
    let module = naga::front::wgsl::parse_str(source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
    let mut counter = Counter { module: &module, known: HashMap::new() };
    let entry = module.entry_points.iter().find(|entry| entry.name == "fragment").expect("there is a fragment shader");
    counter.block(&entry.function.body)
}

/// The text of the default but for the filter: optimal planes, chosen by what maps contain,
/// blended, by the receiver's plane.
fn text(filter: FilterKind) -> ReceiverText {
    let moments = matches!(filter, FilterKind::Esm | FilterKind::Vsm | FilterKind::Evsm4 | FilterKind::Msm);
    ReceiverText {
        filter: Some(filter),
        selection: Some(SelectionKind::Map),
        metric: Some(MetricKind::ViewDepth),
        transition: Some(TransitionKind::Blend),
        bias: Some(BiasKind::Plane),
        projection: Projection::Plain,
        lights: Lights::Suns,
        sliced: false,
        ..Maps { moments: moments.then_some(MomentMaps::Sampled), frames: 1, ..Maps::default() }.into()
    }
}

fn of(filter: FilterKind) -> usize {
    instructions(&(umbrage_shaders::receiver(0, text(filter)) + FRAGMENT))
}

#[test]
#[allow(clippy::print_stdout, reason = "the table of docs/notes/cost.md, under --nocapture")]
fn the_default_costs_little_more_than_one_comparison() {
    let one = of(FilterKind::Pcf2) as f64;
    println!("| filter | instructions | of pcf2's |\n|---|---|---|");
    for filter in FilterKind::ALL {
        println!("| {filter:?} | {} | {:.2} |", of(filter), of(filter) as f64 / one);
    }
    let ratio = of(FilterKind::Pcf3) as f64 / one;
    assert!(ratio <= MOST, "the default's receiver has {ratio:.2} times the instructions of a single comparison's");
}

/// Instructions of the default's receiver, a tent of three texels, over those of a single 2×2
/// comparison.
const MOST: f64 = 1.3;

#[test]
fn open_choices_are_paid_for() {
    let all = instructions(&(umbrage_shaders::receiver(0, ReceiverText::default()) + FRAGMENT));
    assert!(all > 2 * of(FilterKind::Pcf3), "{all} in the text with everything in it");
}

#[test]
fn calls_count_as_often_as_they_are_made() {
    let with = |calls: &str| {
        format!("fn f(x: f32) -> f32 {{ return x * x + 1.0; }} @fragment fn fragment() {{ var a = 2.0; {calls} }}")
    };
    let [none, one, two] = ["", "a = f(a);", "a = f(a); a = f(a);"].map(|calls| instructions(&with(calls)));
    assert!(none < one && two - one == one - none, "{none}, {one}, {two}");
}
