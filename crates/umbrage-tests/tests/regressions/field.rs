//! What people reported of their own scenes: speckled faces that the light runs along, lit walls
//! through narrow lenses. At the defaults, against rays.

use glam::DVec3;
use image::GrayAlphaImage;
use umbrage::config::Filter;
use umbrage::{DirectionalLight, Frustum, View};
use umbrage_render::{Frame, Outputs, RenderSettings, Renderer};
use umbrage_scene::{Primitive, Scene};
use umbrage_tests::boxes::{add, cuboid, ground, scene};
use umbrage_tests::stage::{Technique, gpu};
use umbrage_truth::{Hit, Truth};

const SIZE: [u32; 2] = [240, 180];

fn look(eye: [f64; 3], target: [f64; 3], fov: f64, near: f64) -> View {
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    let frustum = Frustum::perspective(fov.to_radians(), aspect, near, 800.0).expect("a lens");
    View::look_at_upright(eye.into(), target.into(), frustum).expect("a view")
}

/// A mask, and the truth about each of its pixels.
type Judged = (GrayAlphaImage, Vec<Option<Hit>>);

/// Masks at the defaults with maps of an edge, and the truth.
fn judged(scene: &Scene, views: &[View], sun: DVec3, edge: u32) -> Option<Vec<Judged>> {
    let filter = Technique::default().settings.config.filter;
    judged_by(filter, scene, views, sun, edge)
}

/// Masks by a filter, and the truth.
fn judged_by(filter: Filter, scene: &Scene, views: &[View], sun: DVec3, edge: u32) -> Option<Vec<Judged>> {
    let gpu = gpu()?;
    let settings = Technique::default().settings;
    let config = umbrage::ShadowConfig {
        map_sizes: vec![edge; 4],
        range: umbrage::config::Range::Camera,
        filter,
        ..settings.config.clone()
    };
    let settings = RenderSettings { size: SIZE, config, ..settings };
    let mut renderer = Renderer::new(gpu, scene, &settings).expect("a renderer");
    let pose = scene.pose(0.0).expect("a pose");
    let sun = DirectionalLight::new(sun).expect("a direction");
    let truth = Truth::build(scene, &pose, views[0].eye()).expect("rays can meet it");
    let each = |view: &View| {
        renderer.restart();
        let frame = Frame {
            pose: &pose,
            moved: None,
            view,
            light: sun.into(),
            more_lights: &[],
            shadows_on: true,
            tint: false,
        };
        let rendered = renderer.render(&frame, Outputs { mask: true, ..Outputs::default() }).expect("a frame");
        let truth = truth.mask(view, sun.direction(), SIZE, &|_| {}).expect("a truth");
        (rendered.mask.expect("a mask"), truth.hits().to_vec())
    };
    Some(views.iter().map(each).collect())
}

/// Pixels that are false light or false shadow with no edge of the true shadow within two pixels,
/// and how many of those there are.
fn away_from_edges(mask: &GrayAlphaImage, hits: &[Option<Hit>], counts: impl Fn(&Hit) -> bool) -> [usize; 3] {
    let [width, height] = SIZE.map(|size| size as i32);
    let lit = |x: i32, y: i32| {
        let inside = (0..width).contains(&x) && (0..height).contains(&y);
        inside.then(|| hits[(y * width + x) as usize].as_ref().map(|hit| hit.lit)).flatten()
    };
    let mut found = [0; 3];
    for (x, y) in (0..width).flat_map(|x| (0..height).map(move |y| (x, y))) {
        let Some(hit) = hits[(y * width + x) as usize].as_ref().filter(|hit| counts(hit)) else { continue };
        let around = (-2..=2).flat_map(|i| (-2..=2).map(move |j| (i, j)));
        if around.into_iter().any(|(i, j)| lit(x + i, y + j) != Some(hit.lit)) {
            continue;
        }
        let share = mask.get_pixel(x as u32, y as u32).0[0];
        found[0] += usize::from(!hit.lit && share >= 128);
        found[1] += usize::from(hit.lit && share < 128);
        found[2] += 1;
    }
    found
}

#[test]
fn faces_that_the_light_runs_along_are_dark() {
    let mut scene = scene();
    add(&mut scene, ground(0.0, 40.0));
    let mut towers = Primitive::default();
    for (i, [x, z]) in [[0.0, 0.0], [6.0, -4.0], [-7.0, -9.0], [3.0, -18.0]].into_iter().enumerate() {
        cuboid(&mut towers, DVec3::new(x, 0.0, z), DVec3::new(3.0, 3.0 + i as f64, 2.0));
    }
    add(&mut scene, towers);
    let views =
        [look([8.0, 7.0, 16.0], [0.0, 1.0, -4.0], 60.0, 1.0), look([-18.0, 3.0, 9.0], [0.0, 1.0, -4.0], 50.0, 1.0)];
    for sun in [DVec3::NEG_Y, DVec3::new(1e-9, -1.0, 0.0), DVec3::new(0.0, -1.0, 1e-7)] {
        let Some(judged) = judged(&scene, &views, sun, 512) else { return };
        for (mask, hits) in &judged {
            let grazed = |hit: &Hit| hit.normal.dot(sun).abs() < 1e-6;
            let of_faces = || mask.pixels().zip(hits).filter(|(_, hit)| hit.as_ref().is_some_and(grazed));
            let speckles = of_faces().filter(|(pixel, _)| pixel.0[0] > 0).count();
            assert_eq!(speckles, 0, "sun {sun}: of {}", of_faces().count());
            assert!(of_faces().count() > 1000, "the view shows such faces");
        }
    }
}

#[test]
fn narrow_lenses_show_lit_walls_lit() {
    let mut scene = scene();
    add(&mut scene, ground(0.0, 1500.0));
    let mut posts = Primitive::default();
    for k in 0..9 {
        let k = f64::from(k);
        cuboid(
            &mut posts,
            DVec3::new(3.0 * k - 13.0, 0.0, -600.0 - 5.0 * (k % 3.0)),
            DVec3::new(0.4, 1.0 + 0.3 * k, 0.4),
        );
    }
    add(&mut scene, posts);
    let views = [2.0, 0.5, 0.1].map(|fov| look([0.0, 30.0, 0.0], [-0.8, 0.8, -600.0], fov, 1.0));
    let Some(judged) = judged(&scene, &views, DVec3::new(-0.6, -0.7, -0.35), 1024) else { return };
    for (i, (mask, hits)) in judged.iter().enumerate() {
        let grey = |hit: &Hit| hit.normal.y < 0.5;
        let [light, shadow, all] = away_from_edges(mask, hits, grey);
        let lit_walls = mask.pixels().zip(hits).filter(|(_, hit)| hit.as_ref().is_some_and(|hit| hit.lit && grey(hit)));
        let greyed = lit_walls.filter(|(pixel, _)| pixel.0[0] < 250).count();
        eprintln!("view {i}: {light} false light, {shadow} false shadow of {all}, {greyed} grey");
        assert!(shadow * 200 <= all && light * 200 <= all, "view {i}: {light} and {shadow} of {all}");
    }
}

/// The roof that ends a wall is nearer to the light than the wall and does not shade it, however
/// wide the kernel that finds both.
#[test]
fn wide_discs_leave_lit_walls_lit_along_their_edges() {
    let mut scene = scene();
    add(&mut scene, ground(0.0, 30.0));
    let mut blocks = Primitive::default();
    for ([x, z], size) in
        [([-1.0, -1.0], [2.0, 2.0, 2.0]), ([4.0, -1.0], [0.6, 3.0, 0.6]), ([-5.0, -2.0], [2.0, 1.0, 4.0])]
    {
        cuboid(&mut blocks, DVec3::new(x, 0.0, z), size.into());
    }
    add(&mut scene, blocks);
    let views = [look([5.0, 4.0, 7.0], [0.0, 1.0, 0.0], 60.0, 0.1), look([2.5, 2.5, 3.5], [0.0, 1.5, 0.0], 60.0, 0.1)];
    let sun = DVec3::new(-0.25, -0.95, -0.12);
    for width in [0.2, 0.4, 0.6] {
        let filter = Filter::Disc { width_m: Some(width), rotated: false };
        let Some(judged) = judged_by(filter, &scene, &views, sun, 1024) else { return };
        for (i, (mask, hits)) in judged.iter().enumerate() {
            let is_wall = |hit: &Hit| hit.lit && hit.normal.y < 0.5;
            let shares = mask.pixels().zip(hits).filter(|(_, hit)| hit.as_ref().is_some_and(is_wall));
            let shares: Vec<u8> = shares.map(|(pixel, _)| pixel.0[0]).collect();
            let greyed = shares.iter().filter(|&&share| share < 240).count();
            // Before such texels said nothing, 371 to 514 of the nearer cube's 5,070 were.
            eprintln!("view {i}, {width} m: {greyed} of {}", shares.len());
            assert!(
                shares.len() > 1000 && greyed * 500 <= shares.len(),
                "view {i}, {width} m: {greyed} of {}",
                shares.len()
            );
        }
    }
}

/// A tyre of 64 facets around an axle along x, on the ground: rim, shoulder, tread, shoulder and
/// rim.
fn wheel(into: &mut Primitive, x: f64) {
    const PROFILE: [[f64; 2]; 6] = [[-0.3, 0.33], [-0.3, 0.54], [-0.21, 0.6], [0.21, 0.6], [0.3, 0.54], [0.3, 0.33]];
    const FACETS: usize = 64;
    let at = |i: usize, [along, radius]: [f64; 2]| {
        let (sine, cosine) = (std::f64::consts::TAU * i as f64 / FACETS as f64).sin_cos();
        DVec3::new(x + along, 0.6 + radius * sine, radius * cosine)
    };
    for (i, pair) in (0..FACETS).flat_map(|i| PROFILE.windows(2).map(move |pair| (i, pair))) {
        let corners = [at(i, pair[0]), at(i + 1, pair[0]), at(i + 1, pair[1]), at(i, pair[1])];
        let first = into.positions.len() as u32;
        let normal = (corners[1] - corners[0]).cross(corners[3] - corners[0]).normalize().as_vec3().to_array();
        into.positions.extend(corners.map(|corner| corner.as_vec3().to_array()));
        into.normals.extend([normal; 4]);
        into.indices.extend([0, 1, 2, 0, 2, 3].map(|k| first + k));
    }
}

/// Most pixels of wheels, two pixels or more from true edges, that are falsely lit or dark under
/// light along their axle. Asked: next to none. Measured: 49 and 0 of 19,184.
const MOST_ON_WHEELS: f64 = 0.003;

#[test]
fn treads_of_wheels_have_no_stripes_under_light_along_their_axle() {
    let mut scene = scene();
    add(&mut scene, ground(0.0, 30.0));
    let mut wheels = Primitive::default();
    wheel(&mut wheels, 0.0);
    wheel(&mut wheels, 2.0);
    add(&mut scene, wheels);
    let views = [
        look([1.0, 1.6, 4.0], [0.0, 0.6, 0.0], 45.0, 0.1),
        look([1.0, 1.6, -4.0], [0.0, 0.6, 0.0], 45.0, 0.1),
        look([0.5, 1.2, 1.6], [0.0, 0.6, 0.0], 45.0, 0.1),
    ];
    let of = |sun| judged(&scene, &views, sun, 1024);
    let Some(judged) = of(DVec3::new(-0.98, -0.15, -0.1)) else { return };
    let wrong = |masks: &[(GrayAlphaImage, Vec<Option<Hit>>)]| {
        let each = |(of, (_, hits)): (&(GrayAlphaImage, _), &(_, Vec<Option<Hit>>))| {
            away_from_edges(&of.0, hits, |hit| hit.object == 1)
        };
        let counts = masks.iter().zip(&judged).map(each);
        counts.fold([0; 3], |sum, count| [0, 1, 2].map(|i| sum[i] + count[i]))
    };
    let found = wrong(&judged);
    eprintln!("wheels: {found:?}");
    let share = |[light, shadow, all]: [usize; 3]| (light + shadow) as f64 / all as f64;
    assert!(found[2] > 10_000, "the views show wheels: {found:?}");
    assert!(share(found) <= MOST_ON_WHEELS, "{found:?}");
    // The comparison can say no: to the masks of another sun.
    let other = of(DVec3::new(-0.98, -0.15, 0.2)).expect("the device is there");
    assert!(share(wrong(&other)) > 3.0 * MOST_ON_WHEELS, "{:?}", wrong(&other));
}
