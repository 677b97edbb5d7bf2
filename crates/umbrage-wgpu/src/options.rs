//! What is settled when the maps are made, and what may change with every frame.

use glam::DVec3;
use umbrage::{Bands, Selection};
use umbrage_shaders::layout::{BiasKind, FilterKind, TransitionKind};
use umbrage_shaders::twin;

use crate::{Error, Result};

/// How a map stores depth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DepthFormat {
    /// Four bytes a texel.
    #[default]
    D32Float,
    /// Two bytes a texel and a step of 1/65535 of the depth range, which every comparison allows for.
    D16Unorm,
    /// Four bytes a texel in a colour texture, compared by hand with four loads; a depth buffer beside it. Where depth textures can
    /// be compared with only (GL, WebGL2) this one can be loaded from, too.
    R32Float,
}

impl DepthFormat {
    /// Whether maps are colours and not depth: casters then need a fragment shader ([`crate::ShadowMaps::caster_targets`]).
    #[must_use]
    pub fn is_colour(self) -> bool {
        self == Self::R32Float
    }

    /// wgpu's name for it.
    #[must_use]
    pub fn texture_format(self) -> wgpu::TextureFormat {
        match self {
            Self::D32Float => wgpu::TextureFormat::Depth32Float,
            Self::D16Unorm => wgpu::TextureFormat::Depth16Unorm,
            Self::R32Float => wgpu::TextureFormat::R32Float,
        }
    }

    /// Bytes of one texel.
    #[must_use]
    pub fn texel_bytes(self) -> u64 {
        match self {
            Self::D32Float | Self::R32Float => 4,
            Self::D16Unorm => 2,
        }
    }

    /// The step between stored depths as a share of the depth range; 0 where it is no coarser than `f32`.
    pub(crate) fn step(self) -> f64 {
        match self {
            Self::D32Float | Self::R32Float => 0.0,
            Self::D16Unorm => 1.0 / 65535.0,
        }
    }
}

/// How soft a shadow's edge is, and what a sample costs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Filter {
    /// One nearest texel, one comparison: answers are 0 or 1.
    Hard,
    /// One linear comparison: 2×2 texels in one hardware tap.
    Pcf2,
    /// A tent of three texels in four hardware taps.
    #[default]
    Pcf3,
    /// A tent of five texels in nine hardware taps.
    Pcf5,
    /// A tent of seven texels in sixteen hardware taps.
    Pcf7,
    /// A disc in 32 hardware taps, of a radius of 3 texels or of [`Softness::width_m`].
    Disc,
    /// A disc as wide as the penumbra of a sun of [`Softness::sun_angle`], found from 32 texels around the receiver. On GL, where depth
    /// cannot be loaded, it is [`Filter::Disc`]. Where casters are flattened onto the near plane
    /// (`umbrage::ShadowSettings::depth_clamp`) they seem nearer than they are and penumbrae come out too narrow.
    Pcss,
    /// Exponential: one moment. The cheapest of the maps that are blurred before they are asked ([`crate::ShadowMaps::filter`]); lit where
    /// a caster stands close to what it shades.
    Esm,
    /// Variance: two moments. Light leaks where casters stand behind each other.
    Vsm,
    /// Variance of an exponential: two moments, and far fewer leaks.
    Evsm2,
    /// Variance of two exponentials: four moments, and fewer leaks still.
    Evsm4,
    /// Four moments of depth itself: few leaks, close to casters too. On a device without filterable 32-bit floats the slowest.
    Msm,
}

/// Texels that a disc of no given width reaches: its radius and a tap's own.
const DISC_REACH: f64 = twin::DISC_RADIUS as f64 + 1.0;

/// Texels that the narrowest disc reaches: that of one tap, and the tap's own.
const LEAST_REACH: f64 = 2.0;

impl Filter {
    /// How far the filter reaches from the sample at most, in texels: what `umbrage::ShadowSettings::filter_radius` wants.
    #[must_use]
    pub const fn radius_texels(self) -> f64 {
        match self {
            Self::Hard => 0.5,
            Self::Pcf2 => 1.0,
            Self::Pcf3 => 1.5,
            Self::Pcf5 => 2.5,
            Self::Pcf7 => 3.5,
            // The widest disc, 15 texels, and the reach of a tap on its rim.
            Self::Disc | Self::Pcss => 16.0,
            // The widest blur, 15 texels, and the reach of a linear sample.
            Self::Esm | Self::Vsm | Self::Evsm2 | Self::Evsm4 | Self::Msm => 16.0,
        }
    }

    /// How far the filter reaches around a sample: at most in texels, for `umbrage::ShadowSettings::filter_radius`, and in metres where that is known,
    /// for `umbrage::ShadowSettings::filter_half_width_m`. Planned with both, splits in which a disc is narrow lose less of their maps to
    /// it than [`Filter::radius_texels`]; it stays inside what they keep free whatever the frame's softness says.
    #[must_use]
    pub fn reach(self, softness: &Softness) -> (f64, Option<f64>) {
        match (self, softness.width_m) {
            (Self::Disc, None) => (DISC_REACH, None),
            (Self::Disc, Some(width)) => (self.radius_texels(), Some(0.5 * f64::from(width))),
            (Self::Pcss, _) => (
                self.radius_texels(),
                Some((0.5 * f64::from(softness.sun_angle)).tan() * f64::from(twin::MOST_BLOCKER_M)),
            ),
            _ => (self.radius_texels(), None),
        }
    }

    /// Texels around a sample that the shader may read where a map was planned to keep `planned` free.
    pub(crate) fn reach_within(self, planned: f64) -> f64 {
        match self {
            Self::Disc | Self::Pcss => planned.clamp(LEAST_REACH, self.radius_texels()),
            _ => self.radius_texels(),
        }
    }

    /// What one fragment reads of one map: texels, or for filters that blur first filtered samples. Inside a blend band it is twice as much.
    #[must_use]
    pub const fn samples(self) -> u32 {
        match self {
            Self::Hard => 1,
            Self::Pcf2 => 4,
            Self::Pcf3 => 16,
            Self::Pcf5 => 36,
            Self::Pcf7 => 64,
            Self::Disc => 4 * 32,
            Self::Pcss => 4 * 32 + 32,
            Self::Esm | Self::Vsm | Self::Evsm2 | Self::Evsm4 | Self::Msm => 1,
        }
    }

    /// Whether [`Softness::width_m`] changes it: what is one texel, one tap, or as wide as a penumbra, has no width of its own.
    #[must_use]
    pub const fn has_width(self) -> bool {
        matches!(self, Self::Pcf3 | Self::Pcf5 | Self::Pcf7 | Self::Disc) || self.is_prefiltered()
    }

    /// Numbers that a texel stores instead of depth, for filters that blur before they compare; 0 for those that compare first.
    #[must_use]
    pub const fn moments(self) -> u32 {
        match self {
            Self::Hard | Self::Pcf2 | Self::Pcf3 | Self::Pcf5 | Self::Pcf7 | Self::Disc | Self::Pcss => 0,
            Self::Esm => 1,
            Self::Vsm | Self::Evsm2 => 2,
            Self::Evsm4 | Self::Msm => 4,
        }
    }

    /// Whether it needs [`crate::ShadowMaps::filter`] between the casters and the receivers.
    #[must_use]
    pub const fn is_prefiltered(self) -> bool {
        self.moments() > 0
    }

    /// Looks at the map for one answer of one split: hardware comparisons, loads, or one sample of moments (of up to 16 trilinear taps
    /// where a pixel sees the map at an angle). A pixel in a blend band asks two splits.
    #[must_use]
    pub const fn samples_per_answer(self) -> u32 {
        match self {
            Self::Hard | Self::Pcf2 | Self::Esm | Self::Vsm | Self::Evsm2 | Self::Evsm4 | Self::Msm => 1,
            Self::Pcf3 => 4,
            Self::Pcf5 => 9,
            Self::Pcf7 => 16,
            Self::Disc => 32,
            Self::Pcss => 64,
        }
    }

    /// The smallest map that holds the filter once, in texels.
    pub(crate) fn least_size(self) -> u32 {
        match self {
            Self::Hard => 1,
            Self::Pcf2 => 3,
            Self::Pcf3 => 4,
            Self::Pcf5 => 6,
            Self::Pcf7 => 8,
            Self::Disc | Self::Pcss | Self::Esm | Self::Vsm | Self::Evsm2 | Self::Evsm4 | Self::Msm => 33,
        }
    }

    pub(crate) fn kind(self) -> FilterKind {
        match self {
            Self::Hard => FilterKind::Hard,
            Self::Pcf2 => FilterKind::Pcf2,
            Self::Pcf3 => FilterKind::Pcf3,
            Self::Pcf5 => FilterKind::Pcf5,
            Self::Pcf7 => FilterKind::Pcf7,
            Self::Disc => FilterKind::Disc,
            Self::Pcss => FilterKind::Pcss,
            Self::Esm => FilterKind::Esm,
            Self::Vsm => FilterKind::Vsm,
            Self::Evsm2 => FilterKind::Evsm2,
            Self::Evsm4 => FilterKind::Evsm4,
            Self::Msm => FilterKind::Msm,
        }
    }

    pub(crate) fn sampler_mode(self) -> wgpu::FilterMode {
        match self {
            Self::Hard => wgpu::FilterMode::Nearest,
            _ => wgpu::FilterMode::Linear,
        }
    }
}

/// How soft edges are, for filters that leave a choice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Softness {
    /// Full width of the filter across the light in metres, the same in every split, so that an edge is as soft on both sides of a
    /// border; `None`: as many texels as the filter's name says, and for filters of moments 8 texels of the finest map. Where it asks for less than two texels it gets two, and for more
    /// than the filter reaches ([`Filter::radius_texels`]) that; a radius that exceeds the widest map is an error
    /// ([`Error::FilterTooWide`]). For the filters that [`Filter::has_width`] names.
    pub width_m: Option<f32>,
    /// Angle in radians across the sun, for [`Filter::Pcss`]: 0 to a right angle. The real one is 0.0093 (0.53°) wide.
    pub sun_angle: f32,
    /// Whether the pattern of a disc turns from pixel to pixel, which makes noise out of bands. Needs
    /// a query that knows its pixel (`umbrage_fragment_query`).
    pub turned: bool,
    /// Share of light that filters of moments take for a leak, 0 to 0.9: what is less is shadow. More hides leaks and widens shadows.
    pub bleeding: f32,
}

impl Softness {
    /// Angle across the sun as seen from the earth, radians.
    pub const SUN: f32 = 0.0093;
}

impl Default for Softness {
    fn default() -> Self {
        Self { width_m: None, sun_angle: Self::SUN, turned: false, bleeding: 0.2 }
    }
}

impl Softness {
    /// Checks every field.
    ///
    /// # Errors
    /// [`Error::InvalidFrameOption`] naming the first field that is wrong.
    pub fn validate(&self) -> Result<()> {
        if let Some(width) = self.width_m
            && !(width > 0.0 && width.is_finite())
        {
            let value = f64::from(width);
            return Err(Error::InvalidFrameOption { field: "width_m", value, expected: "finite metres above 0" });
        }
        if !(0.0..=std::f32::consts::FRAC_PI_2).contains(&self.sun_angle) {
            return Err(Error::InvalidFrameOption {
                field: "sun_angle",
                value: f64::from(self.sun_angle),
                expected: "radians from 0 to a right angle",
            });
        }
        if !(0.0..=0.9).contains(&self.bleeding) {
            let value = f64::from(self.bleeding);
            return Err(Error::InvalidFrameOption { field: "bleeding", value, expected: "in 0..=0.9" });
        }
        Ok(())
    }
}

/// How one split goes over into the next, over the band that `umbrage::ShadowSettings::blend` gives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Transition {
    /// Both are asked and mixed.
    #[default]
    Blend,
    /// Each pixel asks one of both, chosen by noise: half the samples. Needs a query that knows its
    /// pixel (`umbrage_fragment_query`).
    Dither,
    /// Each pixel asks the split of its view depth.
    Hard,
}

impl Transition {
    pub(crate) fn kind(self) -> TransitionKind {
        match self {
            Self::Blend => TransitionKind::Blend,
            Self::Dither => TransitionKind::Dither,
            Self::Hard => TransitionKind::Hard,
        }
    }
}

/// How much of a map of moments a pixel covers, where neighbouring pixels may use different splits. Depth maps are compared with at level 0
/// and need to know none of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Derivatives {
    /// From how the position changes from pixel to pixel, which no split's border interrupts, by each pixel's own split.
    #[default]
    Analytic,
    /// All four pixels of a quad use the split of the farthest, so that differences between them mean something (\[PSVSM07\]'s way,
    /// right for any four splits).
    Quad,
}

/// Where maps are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Storage {
    /// What goes with the generation; [`Storage::Array`] where that is `Auto`, too.
    #[default]
    Auto,
    /// Layers of one texture as wide as the largest map: memory is that of the largest times the number of maps.
    Array,
    /// Tiles of one texture: memory is that of the rectangle into which the maps were packed.
    Atlas,
    /// A texture for each map: memory is that of the maps, and each takes one of the textures that a shader can sample
    /// (`max_sampled_textures_per_shader_stage`).
    Separate,
    /// Faces of a cube map: six maps of one size at most.
    Cube,
    /// One map that is used for one split after the other, with the picture drawn in between: memory is that of the largest map. There is
    /// never a second map to blend with.
    Reused,
}

impl Storage {
    /// Its name, as reports have it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Array => "array",
            Self::Atlas => "atlas",
            Self::Separate => "separate",
            Self::Cube => "cube",
            Self::Reused => "reused",
        }
    }
}

/// How maps are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Generation {
    /// What goes with the storage: [`Generation::Multipass`] with [`Storage::Reused`], else [`Generation::PerSplit`].
    #[default]
    Auto,
    /// One pass for each split, and after each the part of the picture that lies in its slice; with [`Storage::Reused`].
    Multipass,
    /// One pass for each split; with [`Storage::Array`], [`Storage::Atlas`], [`Storage::Separate`] or [`Storage::Cube`].
    PerSplit,
    /// One pass for as many splits as the device has views, by multiview into the layers of an array or the faces of a cube: every
    /// caster is submitted once, and thrown out of the views that it does not belong to.
    Layered,
    /// One pass for all splits, by instancing into the tiles of an atlas: every caster is submitted once, in as many instances as it
    /// has splits. Clip distances keep tiles apart.
    Instanced,
    /// One pass for all splits, by multiview into layers of an array that hold two tiles or more, and by instancing into the tiles.
    Mixed,
}

impl Generation {
    /// Its name, as reports have it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Multipass => "multipass",
            Self::PerSplit => "per-split",
            Self::Layered => "layered",
            Self::Instanced => "instanced",
            Self::Mixed => "mixed",
        }
    }
}

/// How a receiver is kept from shading itself. Both follow from the texel (from its Jacobian in a warped map), the slope and the filter's
/// width, in metres; neither has a number to choose, neither needs screen derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ReceiverBias {
    /// Every texel is compared with the plane of the receiver at its own centre. Wants the surface's true normal.
    #[default]
    Plane,
    /// All texels are compared with one depth: the receiver's, nearer to the light by the slope times the filter's reach. Forgives
    /// normals that point a few degrees aside (interpolated ones), at the price of shadows that begin as far from what throws them as
    /// the filter is wide, more on steep surfaces.
    Slope,
}

impl ReceiverBias {
    pub(crate) fn kind(self) -> BiasKind {
        match self {
            Self::Plane => BiasKind::Plane,
            Self::Slope => BiasKind::Slope,
        }
    }
}

/// What kind of light a place among [`ShadowMapsOptions::lights`] is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LightSlot {
    /// A sun or a spot light: one map for each split.
    #[default]
    Single,
    /// A sun alone: receivers' text has no local lights in it.
    Sun,
    /// A point light: six maps for each split, one for each face of a cube. Takes a sun or a spot light, too.
    Cube,
}

impl LightSlot {
    /// How many times the maps of `map_sizes` it has.
    #[must_use]
    pub const fn faces(self) -> usize {
        match self {
            Self::Single | Self::Sun => 1,
            Self::Cube => 6,
        }
    }
}

impl From<umbrage::Light> for LightSlot {
    fn from(light: umbrage::Light) -> Self {
        match light {
            umbrage::Light::Directional(_) => Self::Sun,
            umbrage::Light::Spot(_) => Self::Single,
            umbrage::Light::Point(_) => Self::Cube,
        }
    }
}

/// What receivers' text is made for. `None`: the text has all of it, and every frame or plan may say otherwise. What is fixed makes a
/// shader that compiles faster and runs faster; a frame or a plan that says otherwise is then an error
/// ([`Error::ConflictingOptions`]). The filter, the storage and the kinds of lights are fixed always.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fixed {
    /// How a sun's splits are chosen: `umbrage::ShadowSettings::selection`. Left out of the text where all lights are
    /// [`LightSlot::Sun`].
    pub selection: Option<Selection>,
    /// What a sun's splits are counted by: `umbrage::ShadowSettings::bands`. Likewise.
    pub bands: Option<Bands>,
    /// Whether a sun's maps are warped: all of them, or none.
    pub warped: Option<bool>,
    /// [`FrameOptions::transition`].
    pub transition: Option<Transition>,
    /// [`FrameOptions::bias`].
    pub bias: Option<ReceiverBias>,
}

impl Fixed {
    /// Whether a plan and a frame say what the text was made for.
    pub(crate) fn check(&self, plan: &umbrage::ShadowPlan, options: &FrameOptions) -> Result<()> {
        fn agree<T: PartialEq + std::fmt::Debug>(name: &str, fixed: Option<T>, said: T) -> Result<()> {
            match fixed {
                Some(fixed) if fixed != said => Err(Error::ConflictingOptions {
                    first: format!("{name} fixed to {fixed:?}"),
                    second: format!("{name} {said:?}"),
                    reason: "the receivers' text was made without it; change ShadowMapsOptions::fixed or what says otherwise",
                }),
                _ => Ok(()),
            }
        }
        let bands = if plan.radial_eye.is_some() { Bands::Radial } else { Bands::Planar };
        // A local light's maps are chosen by depth, whatever suns do; texts that know local lights have both.
        if plan.light.is_none_or(|light| light.position().is_none()) {
            agree("selection", self.selection, plan.selection)?;
            agree("bands", self.bands, bands)?;
        }
        agree("transition", self.transition, options.transition)?;
        agree("bias", self.bias, options.bias)?;
        let suns = plan.splits.iter().filter(|split| split.light_position.is_none());
        suns.map(|split| split.warp.is_some()).try_for_each(|warped| agree("warped", self.warped, warped))
    }
}

/// What is fixed when [`crate::ShadowMaps`] are made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShadowMapsOptions {
    /// Edge of each split's map in texels, nearest split first: the same list as `umbrage::ShadowSettings::map_sizes`.
    pub map_sizes: Vec<u32>,
    /// How maps store depth.
    pub depth_format: DepthFormat,
    /// How maps are read.
    pub filter: Filter,
    /// Samples of depth in a texel, 1 or 4: with 4 the edges of casters are smooth before anything is blurred. For filters of moments; the
    /// pipelines that draw casters take [`crate::ShadowMaps::caster_multisample`].
    pub samples: u32,
    /// Whether what the device cannot do may be replaced by what it can ([`crate::ShadowMaps::notes`], [`crate::MomentStorage`]); if not, it is an
    /// error.
    pub fallbacks: bool,
    /// Where maps are kept.
    pub storage: Storage,
    /// How maps are drawn.
    pub generation: Generation,
    /// The lights that throw shadows at once: one sun or spot light by default. Each has maps of its own, of the same sizes, in the same
    /// texture. Several lights and point lights need [`Storage::Array`] and [`Generation::PerSplit`].
    pub lights: Vec<LightSlot>,
    /// What receivers' text is made for.
    pub fixed: Fixed,
}

impl ShadowMapsOptions {
    /// The generation and the storage that these options come to on a device that can do everything.
    ///
    /// # Errors
    /// [`Error::ConflictingOptions`] naming two that exclude each other.
    pub fn path(&self) -> Result<(Generation, Storage)> {
        let chosen = crate::maps::choose::choose(self, crate::maps::choose::Abilities::ALL)?;
        Ok((chosen.generation, chosen.storage))
    }
}

impl Default for ShadowMapsOptions {
    fn default() -> Self {
        Self {
            map_sizes: vec![1024; 4],
            depth_format: DepthFormat::default(),
            filter: Filter::default(),
            samples: 1,
            fallbacks: true,
            storage: Storage::default(),
            generation: Generation::default(),
            lights: vec![LightSlot::Single],
            fixed: Fixed::default(),
        }
    }
}

/// What may change with every frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameOptions {
    /// The world point, in metres, that the positions in the app's shaders are relative to. Keep it within a kilometre or
    /// two of the eye, and move it in whole steps: between two steps static shadows stand still.
    pub origin: DVec3,
    /// Whether there are shadows; without them every surface that faces the light is lit.
    pub enabled: bool,
    /// Whether `umbrage_shadow` answers with a debug colour for each split.
    pub tint: bool,
    /// How dark a shadow is, 0 (not at all) to 1 (no light).
    pub strength: f32,
    /// What the light of a place in full shadow is multiplied by: linear red, green and blue, 0 to 1. In the WGSL it is in
    /// `UmbrageShadow.light`; `visibility` knows nothing of it.
    pub shadow_colour: [f32; 3],
    /// How receivers are kept from shading themselves.
    pub bias: ReceiverBias,
    /// How soft edges are.
    pub softness: Softness,
    /// How splits meet.
    pub transition: Transition,
    /// How filters of moments know what a pixel covers.
    pub derivatives: Derivatives,
}

impl Default for FrameOptions {
    fn default() -> Self {
        Self {
            origin: DVec3::ZERO,
            enabled: true,
            tint: false,
            strength: 1.0,
            shadow_colour: [0.0; 3],
            bias: ReceiverBias::default(),
            softness: Softness::default(),
            transition: Transition::default(),
            derivatives: Derivatives::default(),
        }
    }
}

impl FrameOptions {
    /// Checks every field.
    ///
    /// # Errors
    /// [`Error::InvalidFrameOption`] naming the first field that is wrong.
    pub fn validate(&self) -> Result<()> {
        if let Some(value) = self.origin.to_array().into_iter().find(|v| !v.is_finite()) {
            return Err(Error::InvalidFrameOption { field: "origin", value, expected: "three finite numbers" });
        }
        if !(0.0..=1.0).contains(&self.strength) {
            return Err(Error::InvalidFrameOption {
                field: "strength",
                value: f64::from(self.strength),
                expected: "in 0..=1",
            });
        }
        if let Some(value) = self.shadow_colour.into_iter().find(|part| !(0.0..=1.0).contains(part)) {
            return Err(Error::InvalidFrameOption {
                field: "shadow_colour",
                value: f64::from(value),
                expected: "three parts in 0..=1",
            });
        }
        self.softness.validate()
    }
}
