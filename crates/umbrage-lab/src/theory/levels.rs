//! Mip levels at the borders of splits: \[PCSM\] Figures 4.1.10 to 4.1.14, on a plane.

use glam::{DVec2, DVec3};
use image::{Rgb, RgbImage};
use umbrage::config::{Crop, Preset, Range, Stability, Transition};
use umbrage::{DirectionalLight, Frustum, Planner, PlannerOptions, ShadowConfig, ShadowPlan, Split, View};

use super::{Error, Result, setting::Setting};
use crate::{
    page::html::{Figure, Section},
    page::plot::{Axis, Chart, Series, Style},
};

/// Width and height of the pictures in pixels, few enough to be seen one by one.
const SIZE: [u32; 2] = [96, 72];
/// Distance of the plane below the eye in metres.
const DOWN: f64 = 3.0;
/// End of the last split in metres.
const FAR: f64 = 60.0;
/// Number of splits.
const SPLITS: usize = 4;
/// Last mip level of a map of 512 texels that umbrage makes.
const LAST_LEVEL: f64 = 7.0;
/// Direction in which the light travels.
const LIGHT: DVec3 = DVec3::new(0.6, -1.0, -0.35);

/// Choice of the split in which a pixel's differences are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// Each pixel's own split, as the hardware does by default.
    Naive,
    /// Last split of the quad, as in \[PSVSM07\].
    Quad,
    /// The pixel's own split for all of its neighbours, as in the analytic way of \[PCSM\].
    Analytic,
}

/// A plane in pixels, each with its place and its split.
pub(super) struct Ground {
    plan: ShadowPlan,
    pixels: Vec<Option<(DVec3, usize)>>,
}

impl Ground {
    pub fn new(setting: &Setting) -> Result<Self> {
        let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
        let frustum = Frustum::perspective(setting.fov.to_radians(), aspect, setting.near, FAR)?;
        // Tilted, so that borders run askew through quads.
        let view = View::look_at(DVec3::ZERO, DVec3::new(0.0, -0.4, -1.0), DVec3::new(0.3, 1.0, 0.0), frustum)?;
        let settings = ShadowConfig {
            map_sizes: vec![setting.map_size; SPLITS],
            range: Range::Metres { near: setting.near, far: FAR },
            crop: Crop::SceneIndependent,
            stability: Stability::Exact,
            transition: Transition::Hard,
            ..Preset::Papers.config()
        };
        let everything = [setting.surroundings()];
        let options = PlannerOptions { image_size: SIZE, ..PlannerOptions::default() };
        let mut planner = Planner::with_options(&settings, options)?;
        let plan = planner.plan(&view, &DirectionalLight::new(LIGHT)?, &everything, &everything)?.clone();
        let pixels = (0..SIZE[0] * SIZE[1])
            .map(|i| {
                let place = place(&view, [i % SIZE[0], i / SIZE[0]])?;
                let depth = view.view_depth(place);
                Some((place, plan.splits.iter().position(|split| depth < split.far)?))
            })
            .collect();
        Ok(Self { plan, pixels })
    }

    fn at(&self, x: u32, y: u32) -> Option<(DVec3, usize)> {
        self.pixels[(y * SIZE[0] + x) as usize]
    }

    fn texel(&self, split: usize, place: DVec3) -> DVec2 {
        let split: &Split = &self.plan.splits[split];
        split.map_from_world(place).truncate()
    }

    /// Returns the mip level of a pixel; `None` above the horizon, beyond the last split, and in
    /// quads with such pixels.
    pub fn level(&self, way: Way, [x, y]: [u32; 2]) -> Option<f64> {
        let [left, top] = [x & !1, y & !1];
        let quad = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| self.at(left + i, top + j));
        let last = quad.iter().copied().collect::<Option<Vec<_>>>()?.iter().map(|pixel| pixel.1).max()?;
        let own = self.at(x, y)?.1;
        let in_map = |x, y| {
            let (place, split) = self.at(x, y)?;
            let split = match way {
                Way::Naive => split,
                Way::Quad => last,
                Way::Analytic => own,
            };
            Some(self.texel(split, place))
        };
        let dx = in_map(left + 1, y)? - in_map(left, y)?;
        let dy = in_map(x, top + 1)? - in_map(x, top)?;
        Some(dx.length().max(dy.length()).log2().clamp(0.0, LAST_LEVEL))
    }

    /// Returns whether a pixel's quad has pixels of several splits.
    #[cfg(test)]
    fn is_mixed(&self, [x, y]: [u32; 2]) -> bool {
        let splits: Vec<_> = (0..4).filter_map(|i| Some(self.at((x & !1) + i % 2, (y & !1) + i / 2)?.1)).collect();
        splits.windows(2).any(|pair| pair[0] != pair[1])
    }
}

/// Returns the point of the plane at a pixel's centre.
fn place(view: &View, [x, y]: [u32; 2]) -> Option<DVec3> {
    let frustum = view.frustum();
    let across = |i: u32, of: u32| (f64::from(i) + 0.5) / f64::from(of);
    let right = frustum.left + (frustum.right - frustum.left) * across(x, SIZE[0]);
    let up = frustum.top - (frustum.top - frustum.bottom) * across(y, SIZE[1]);
    let ray = view.world_from_view_rotation() * DVec3::new(right, up, -1.0);
    (ray.y < 0.0).then(|| view.eye() + ray * (DOWN / -ray.y))
}

/// Returns a colour for a level, from blue by green to red.
fn colour(level: f64) -> Rgb<u8> {
    let share = level / LAST_LEVEL;
    let part = |middle: f64| (255.0 * (1.5 - 4.0 * (share - middle).abs()).clamp(0.0, 1.0)) as u8;
    Rgb([part(0.75), part(0.5), part(0.25)])
}

fn picture(ground: &Ground, way: Way) -> Result<Vec<u8>> {
    let picture = RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| match ground.level(way, [x, y]) {
        Some(level) => colour(level),
        None => Rgb([225, 225, 225]),
    });
    crate::picture::png(&picture).map_err(|error| Error::Picture { reason: error.to_string() })
}

pub(super) fn section(setting: &Setting) -> Result<Section> {
    let ground = Ground::new(setting)?;
    let named = [
        (
            Way::Naive,
            "naive",
            "Differences of places in each pixel's own map (Figures 4.1.11 and 4.1.12): wrong along every border that cuts a quad.",
        ),
        (
            Way::Quad,
            "one split per quad",
            "One split for all four pixels of a quad (Figure 4.1.13): the border moves by a pixel at most.",
        ),
        (Way::Analytic, "analytic", "Differences of positions, scaled to each pixel's own split (Figure 4.1.14)."),
    ];
    let pictures = named
        .iter()
        .map(|(way, name, caption)| {
            Ok(Figure::pixels(&picture(&ground, *way)?, &format!("mip levels, {name}"), *caption))
        })
        .collect::<Result<Vec<_>>>()?;
    // A column on the side, where borders do not lie along rows of quads alone.
    let column = SIZE[0] / 4;
    let mut chart =
        Chart::new("Level down a column of pixels", Axis::linear("row of pixels"), Axis::linear("mip level"));
    for (way, name, _) in &named {
        let points = (0..SIZE[1]).filter_map(|y| Some((f64::from(y), ground.level(*way, [column, y])?))).collect();
        let style = if *way == Way::Naive { Style::Line } else { Style::LineAndPoints };
        chart = chart.series(Series::new(*name, style, points));
    }
    Ok(Section::new("The mip level across a border of splits")
        .text(
            "Hardware chooses a level by how far a place in the map moves from pixel to pixel ([PCSM] Figure 4.1.10), which it finds by \
             subtracting neighbours in a quad of four. A plane 3 m below a tilted eye, 96 × 72 pixels, four splits up to 60 m; blue is level 0, red \
             level 7.",
        )
        .figures(&pictures)
        .figure(&Figure::svg(chart.to_svg()?, "The three ways down one column. Levels rise within a split and fall at its border; the naive way's peaks are the seam.")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_differ_where_quads_are_cut_and_nowhere_else() {
        let ground = Ground::new(&Setting::default()).expect("a plane");
        let (mut cut, mut wrong) = (0, 0);
        for pixel in (0..SIZE[0] * SIZE[1]).map(|i| [i % SIZE[0], i / SIZE[0]]) {
            let levels = [Way::Naive, Way::Quad, Way::Analytic].map(|way| ground.level(way, pixel));
            let [Some(naive), Some(quad), Some(analytic)] = levels else { continue };
            if ground.is_mixed(pixel) {
                cut += 1;
                // One map's texels are no more than some times larger than the next one's.
                assert!((quad - analytic).abs() < 3.0, "{pixel:?}: {quad} {analytic}");
                wrong += usize::from((naive - analytic).abs() > 1.0);
            } else {
                assert_eq!((naive, quad), (analytic, analytic), "{pixel:?}");
            }
        }
        assert!(cut > 40 && wrong > cut / 2, "{wrong} of {cut}");
    }
}
