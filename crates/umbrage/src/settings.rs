//! What the planner is told once: how many splits, where, how large and how they are fitted.

use crate::bounds::{LEAST_METRES, MOST_METRES};
use crate::{Bands, Error, Result, Warp};

/// The most splits a light can have.
pub const MAX_SPLITS: usize = 8;

/// Where the planes between splits stand. Source: \[PSSM06\] section 3.
#[derive(Clone, Debug, PartialEq)]
pub enum SplitScheme {
    /// `C_i = n + (f − n) i/m`: equal slices.
    Uniform,
    /// `C_i = n (f/n)^(i/m)`: equal ratios.
    Logarithmic,
    /// `λ C_i^log + (1 − λ) C_i^uni + δ_i`.
    Practical {
        /// Share of the logarithmic scheme, 0 to 1.
        lambda: f64,
        /// Metres added to the inner planes `C_1 .. C_{m−1}`: none, one for all, or one for each. The source adds δ to all
        /// planes, which would move near and far; ours moves the inner ones only.
        delta: Vec<f64>,
    },
    /// Inner planes `C_1 .. C_{m−1}` as view depths in metres, rising strictly.
    Manual(Vec<f64>),
    /// Where the scene in view is expected to be shown with the least error: chosen every frame among a few dozen depths, by the boxes of
    /// casters and receivers, the size of each map, and what it is fitted to. Stabilised planes are held until others promise an error
    /// smaller by a third, and all maps move in the frame that takes them. Maps with a warp are taken for plain ones. Needs a
    /// [`crate::DirectionalLight`] and a scene: [`crate::split_planes`] alone cannot place them. Ours.
    Fitted,
}

impl Default for SplitScheme {
    fn default() -> Self {
        Self::Practical { lambda: 0.5, delta: Vec::new() }
    }
}

/// What the shadowed range is fitted to where [`ShadowSettings::range`] does not say it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RangeFit {
    /// The camera's near and far, far capped by the receivers and by 1.5 times the depth of the deepest shadow. An orthographic
    /// camera's near moves up to the scene. Receivers far beyond all others that fill less than 0.01 % of the picture
    /// together have no say: they are lit.
    ///
    /// With [`Stabilize::Exact`] far is capped by distances instead of depths, which turning does not change, rounded up to
    /// steps of 9 % that move the last plane alone; the inner planes are placed for the view depth that the first frame asks
    /// for, and follow where a view asks for √2 times as much. The range ends at √2 times that depth at most. All of it
    /// recovers while the camera stands still.
    #[default]
    Camera,
    /// The view depths between which the view shows receivers: their boxes clipped to the frustum, as an empty foreground or a lens
    /// with a tiny near plane would spend splits on air. With [`Stabilize::Exact`] both ends move in geometric steps of 19 %, with
    /// hysteresis, and maps stand still in between. A logarithmic scheme goes best with it (`docs/notes/fitted-planes.md`).
    Visible,
}

/// What a map's rectangle is fitted to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fit {
    /// The corners of the slice alone. The near plane stays at the scene's, so no caster in between is lost.
    Independent,
    /// The slice, clipped to its receivers, and only where casters can throw a shadow on them. An exactly stabilised map's depth and
    /// list alone depend on them.
    #[default]
    Dependent,
}

/// Which of several maps answers for a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Selection {
    /// That of the slice in which its view depth lies: the papers' way.
    #[default]
    Depth,
    /// The first (finest) whose map contains it, filter and depth included: sharper where maps reach beyond their slices, and most
    /// so where view and light are nearly parallel. Lists hold all that can shade what a map covers and no earlier one takes.
    /// Source: \[PCSM\], "Non-optimized split selection"; our deviations: the filter's
    /// margin and the depth are part of the question, and the band that blends one map into the next lies along the map's edge.
    Map,
}

/// Whether shadows stand still while the camera moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stabilize {
    /// The tightest map for every frame; edges crawl when the camera moves.
    None,
    /// A rectangle that depends on the lens and the scene alone, moved in whole texels: static shadows do not change at all.
    #[default]
    Exact,
    /// The tight rectangle on axes that are fixed to the light, its extent rounded up to steps, moved in whole texels: tighter than
    /// [`Stabilize::Exact`], and as still but for the frames in which a step is taken. Source: \[PCSM\],
    /// "Approximated solution".
    Approximate(ExtentSteps),
}

impl Stabilize {
    /// The name of the kind, for messages.
    fn name(self) -> &'static str {
        match self {
            Self::None => "None",
            Self::Exact => "Exact",
            Self::Approximate(_) => "Approximate",
        }
    }
}

/// The steps in which an approximately stabilised map changes its extent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExtentSteps {
    /// Geometric steps of the extent in metres, so many to a doubling, 4 to 64: 24 are steps of 2^(1/24), 2.9 %. One step of hysteresis, and
    /// the rectangle may stand on any of 16 directions that are fixed to the light. Ours. Finer steps are sharper and taken more
    /// often.
    PerDoubling(u32),
    /// So many equal steps of the unsplit light frustum, 8 to 4096: `s_q = 64 / ceil(64 / s)` for 64 of them, as in \[PCSM\], Listing
    /// 4.1.2, to compare with. A near split of a long range falls to the first levels. The unsplit frustum has to stand
    /// still itself; the source does not say how, ours is the sphere around the whole range.
    Levels(u32),
}

impl Default for ExtentSteps {
    fn default() -> Self {
        Self::PerDoubling(24)
    }
}

/// Everything that is settled before the first frame. Checked once, by [`crate::Planner::new`]. Most of it comes from a
/// [`crate::ShadowConfig`] (`ShadowSettings::from(&config)`).
#[derive(Clone, Debug, PartialEq)]
pub struct ShadowSettings {
    /// Edge of each split's map in texels; one entry per split, 1 to [`MAX_SPLITS`] of them.
    pub map_sizes: Vec<u32>,
    /// Where the planes between splits stand.
    pub scheme: SplitScheme,
    /// View depths in metres that shadows cover, `C_0` and `C_m`. `None`: the camera's near and far, far capped by the
    /// receivers. Receivers nearer than the first use split 0; farther than the second they are lit.
    pub range: Option<(f64, f64)>,
    /// Where the range comes from if `range` is `None`; excludes a `range`.
    pub range_fit: RangeFit,
    /// What the rectangle is fitted to.
    pub fit: Fit,
    /// Which map answers for a point. [`Selection::Map`] excludes warps.
    pub selection: Selection,
    /// The shape of the borders between splits.
    pub bands: Bands,
    /// Whether shadows stand still.
    pub stabilize: Stabilize,
    /// How each map spreads its texels: none for plain maps, one for all, or one for each split. A warp follows the camera, so it
    /// cannot be combined with any stabilisation. Where a warp has nothing to gain (the light along the view, an orthographic
    /// camera) the split gets its plain map.
    pub warps: Vec<Warp>,
    /// How far the filter reaches from the sample, in texels (0.5 for one nearest texel, 1 for a bilinear comparison,
    /// 1.5 and 2.5 for tents of 3 and 5). Every map is widened by it.
    pub filter_radius: f64,
    /// Half the width of the filter's kernel in metres, where it is known: splits in which that is less than `filter_radius` texels are
    /// widened by as much as it is, and not less than 4 texels ([`crate::Split::filter_reach`]). `None`: all by `filter_radius`. Plain maps of a sun only.
    pub filter_half_width_m: Option<f64>,
    /// Share of each split's depth range over which it blends into the next; 0 is a hard border, at most 1. With
    /// [`Selection::Map`] the share of a map's half edge, along that edge.
    pub blend: f64,
    /// Share of the shadowed range over which shadows fade to lit at its far end; 0 to 1. They fade where there is something to fade
    /// into: where `range` ends before the camera's far plane. A range that the camera and the receivers decide has nothing
    /// visible behind it, and its shadows stay dark to the end.
    pub far_fade: f64,
    /// Whether depth is not clipped (`DEPTH_CLIP_CONTROL`): casters before the near plane are then flattened onto it by the
    /// hardware and the near plane may lie at the receivers. Otherwise near stands before the first caster.
    pub depth_clamp: bool,
    /// Pixels across the image for [`crate::Planner::plan`]; [`crate::PlanInputs::image_size`] is a frame's own.
    pub image_size: [u32; 2],
}

impl Default for ShadowSettings {
    fn default() -> Self {
        Self {
            map_sizes: vec![1024; 4],
            scheme: SplitScheme::default(),
            range: None,
            range_fit: RangeFit::default(),
            fit: Fit::default(),
            selection: Selection::default(),
            bands: Bands::default(),
            stabilize: Stabilize::default(),
            warps: Vec::new(),
            filter_radius: 1.5,
            filter_half_width_m: None,
            blend: 0.1,
            far_fade: 0.1,
            depth_clamp: false,
            image_size: [800, 600],
        }
    }
}

impl ShadowSettings {
    /// The number of splits.
    #[must_use]
    pub fn splits(&self) -> usize {
        self.map_sizes.len()
    }

    /// The warp of split `index`.
    #[must_use]
    pub fn warp(&self, index: usize) -> Warp {
        match self.warps[..] {
            [for_all] => for_all,
            _ => self.warps.get(index).copied().unwrap_or_default(),
        }
    }

    /// Checks every field.
    ///
    /// # Errors
    /// [`Error::InvalidSetting`] naming the first field that is wrong, [`Error::ConflictingSettings`] naming two that exclude each
    /// other.
    pub fn validate(&self) -> Result<()> {
        let m = self.splits();
        if !(1..=MAX_SPLITS).contains(&m) {
            return Err(Error::setting("map_sizes", format!("{m} splits; there may be 1 to {MAX_SPLITS}")));
        }
        // One texel besides the margins (`EDGE_TEXELS` and the filter's), and one for moving in whole texels.
        let least = 2.0 * self.filter_radius + if self.stabilize == Stabilize::None { 4.0 } else { 5.0 };
        for (i, &size) in self.map_sizes.iter().enumerate() {
            if size == 0 || size > 1 << 16 {
                return Err(Error::setting("map_sizes", format!("map {i} is {size} texels wide; give 1 to 65536")));
            }
            if f64::from(size) < least {
                return Err(Error::setting(
                    "map_sizes",
                    format!("map {i} is {size} texels wide, less than its filter's margin; give at least {least}"),
                ));
            }
        }
        let unit = |field, value: f64| {
            if (0.0..=1.0).contains(&value) {
                Ok(())
            } else {
                Err(Error::setting(field, format!("{value} is not in 0..=1")))
            }
        };
        unit("blend", self.blend)?;
        unit("far_fade", self.far_fade)?;
        if !(self.filter_radius >= 0.0 && self.filter_radius <= 64.0) {
            return Err(Error::setting("filter_radius", format!("{} texels; give 0 to 64", self.filter_radius)));
        }
        if let Some(half_width) = self.filter_half_width_m
            && !(0.0..=1e6).contains(&half_width)
        {
            return Err(Error::setting("filter_half_width_m", format!("{half_width} m; give 0 to 1000 km")));
        }
        if self.image_size.contains(&0) {
            return Err(Error::setting(
                "image_size",
                "the image has no pixels; give a width and a height of 1 or more",
            ));
        }
        let steps = match self.stabilize {
            Stabilize::Approximate(ExtentSteps::PerDoubling(count)) => Some((count, 4, 64, "steps to a doubling")),
            Stabilize::Approximate(ExtentSteps::Levels(count)) => Some((count, 8, 4096, "levels")),
            Stabilize::None | Stabilize::Exact => None,
        };
        if let Some((count, fewest, most, what)) = steps
            && !(fewest..=most).contains(&count)
        {
            return Err(Error::setting("stabilize", format!("{count} {what}; give {fewest} to {most}")));
        }
        if let Some((near, far)) = self.range {
            check_range(near, far)?;
            if self.range_fit != RangeFit::Camera {
                return Err(Error::ConflictingSettings {
                    first: "range",
                    second: "range_fit",
                    reason: format!("a range of {near}..{far} m leaves nothing to fit; leave one of them away"),
                });
            }
        }
        self.check_warps()?;
        self.check_bands()?;
        match &self.scheme {
            SplitScheme::Uniform | SplitScheme::Logarithmic | SplitScheme::Fitted => {}
            SplitScheme::Practical { lambda, delta } => {
                unit("lambda", *lambda)?;
                if !(delta.len() <= 1 || delta.len() == m - 1) {
                    return Err(Error::setting(
                        "delta",
                        format!("{} offsets for {} inner planes; give one, or one for each", delta.len(), m - 1),
                    ));
                }
                if let Some(bad) = delta.iter().find(|d| !(-MOST_METRES..=MOST_METRES).contains(*d)) {
                    return Err(Error::setting("delta", format!("{bad} m; give metres within ±10^12")));
                }
            }
            SplitScheme::Manual(planes) => {
                if planes.len() != m - 1 {
                    return Err(Error::setting(
                        "planes",
                        format!("{} inner planes for {m} splits; give {}", planes.len(), m - 1),
                    ));
                }
                if planes.iter().any(|p| !p.is_finite()) || planes.windows(2).any(|p| p[0] >= p[1]) {
                    return Err(Error::setting("planes", format!("{planes:?} do not rise strictly")));
                }
            }
        }
        Ok(())
    }

    /// What radial bands cannot be combined with, whatever the camera.
    fn check_bands(&self) -> Result<()> {
        let excludes = |second, reason: &str| {
            Err(Error::ConflictingSettings { first: "bands", second, reason: reason.to_owned() })
        };
        if self.bands == Bands::Planar {
            return Ok(());
        }
        if self.range_fit == RangeFit::Visible {
            return excludes(
                "range_fit",
                "radial bands stand still while the camera turns and a visible range does not; \
                 set range_fit to Camera, or bands to Planar",
            );
        }
        if self.selection == Selection::Map {
            return excludes(
                "selection",
                "maps that are chosen by what they contain have no bands; set selection to Depth, or bands to Planar",
            );
        }
        Ok(())
    }

    fn check_warps(&self) -> Result<()> {
        let m = self.splits();
        if !(self.warps.len() <= 1 || self.warps.len() == m) {
            return Err(Error::setting(
                "warps",
                format!("{} warps for {m} splits; give none, one for all, or one for each", self.warps.len()),
            ));
        }
        for warp in &self.warps {
            if let Warp::Tsm { focus } = *warp
                && !(focus > 0.0 && focus < 1.0)
            {
                return Err(Error::setting("warps", format!("the focus {focus} is not between 0 and 1")));
            }
        }
        if self.selection == Selection::Map
            && let Some(warp) = self.warps.iter().find(|warp| **warp != Warp::None)
        {
            return Err(Error::ConflictingSettings {
                first: "warps",
                second: "selection",
                reason: format!(
                    "the first map that contains a point need not be the finest there if it is a {warp:?} map; \
                     set selection to Depth, or leave the warp away"
                ),
            });
        }
        if self.stabilize != Stabilize::None
            && let Some(warp) = self.warps.iter().find(|warp| **warp != Warp::None)
        {
            return Err(Error::ConflictingSettings {
                first: "warps",
                second: "stabilize",
                reason: format!(
                    "a {warp:?} map follows the camera and cannot stand still as {} promises; \
                     set stabilize to None, or leave the warp away",
                    self.stabilize.name()
                ),
            });
        }
        Ok(())
    }
}

pub(crate) fn check_range(near: f64, far: f64) -> Result<()> {
    if !(LEAST_METRES..=MOST_METRES).contains(&near) {
        return Err(Error::setting("range", format!("near is {near}; give a view depth of 10^-9 to 10^12 m, above 0")));
    }
    if !(far > near && far <= MOST_METRES) {
        return Err(Error::setting(
            "range",
            format!("far is {far}; give a view depth greater than near ({near}) and at most 10^12 m"),
        ));
    }
    Ok(())
}
