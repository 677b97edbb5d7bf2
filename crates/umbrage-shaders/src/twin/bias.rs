//! `lib/bias.wesl` on the CPU: the decision whether the surface in a map's texel shades a receiver.

use super::crease::Crease;
use crate::layout::Split;

/// `bias::MAX_SLOPE`: tangent of the steepest angle between light and normal to which a plane is
/// followed.
pub const MAX_SLOPE: f32 = 50.0;
/// `bias::TEXEL_BIAS`: constant bias in texels.
pub const TEXEL_BIAS: f32 = 0.25;
/// `bias::CORNER_SLOPE`: least rise of a surface in front of its plane, in texels per texel of
/// offset.
pub const CORNER_SLOPE: f32 = 0.5;
/// `bias::FOLD`: radians by which ground may bend within the filter's reach.
pub const FOLD: f32 = 0.03;
/// `bias::MOST_CORNER_SLOPE`: most rise of a surface in front of its plane, in texels per texel of
/// offset.
pub const MOST_CORNER_SLOPE: f32 = 12.0;
/// `bias::MOST_STEEP`: most slope of another surface that is continued to the receiver.
pub const MOST_STEEP: f32 = 12.0;
/// `bias::PAST`: distance behind its plane at which a surface may round off, as a multiple of one
/// texel plus its rise per texel.
pub const PAST: f32 = 2.0;
/// `bias::PAST_TEXELS`: distance in texels in front of the receiver at which a surface from past
/// the plane has to arrive to shade it.
pub const PAST_TEXELS: f32 = 8.0;
/// `bias::CREASE_SLOPE`: least slope of a surface that makes a crease.
pub const CREASE_SLOPE: f32 = 1.9;
/// `bias::CREASE_SHARE`: least slope of such a surface as a share of the receiver's own slope.
pub const CREASE_SHARE: f32 = 0.9;
/// `bias::OWN_TEXELS`: distance in texels in front of the receiver's plane within which a texel
/// certainly belongs to its own surface.
pub const OWN_TEXELS: f32 = 0.05;
/// `bias::ROUNDING`: share of the numbers involved that `f32` may have lost.
pub const ROUNDING: f32 = 1.907_348_6e-6;
/// `bias::SNAP_TEXELS`: step in texels of the grid to which casters are snapped.
pub const SNAP_TEXELS: f32 = 0.003_906_25;

/// `bias::Tolerance`: tolerances of a lookup, in depth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tolerance {
    /// Most rise of the receiver's own surface in front of its plane, per texel of offset.
    pub bend: f32,
    /// Distance behind its plane at which the receiver's own surface may round off.
    pub past: f32,
    /// Distance in front of the plane within which another surface is continued to the receiver,
    /// per metre of offset.
    pub steep: f32,
    /// Distance in front of the receiver at which a surface from past the plane has to arrive to
    /// shade it.
    pub arrival: f32,
    /// Least slope of a surface that makes a crease, per metre of offset.
    pub crease: f32,
    /// Distance in front of the plane within which a texel certainly belongs to the receiver's own
    /// surface.
    pub own: f32,
    /// Constant bias, which is subtracted in [`Receiver::depth`].
    pub constant: f32,
    /// The part of the constant bias for arithmetic and the texture's format.
    pub rounding: f32,
}

/// `bias::Receiver`: a receiver as a filter needs it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Receiver {
    /// Position in texels of the light's plane.
    pub texel: [f32; 2],
    /// Depth in `[0, 1]`, with every constant bias subtracted.
    pub depth: f32,
    /// Change of depth per texel along u and v on the receiver's plane.
    pub slope: [f32; 2],
    /// Change of the map's own depth per texel along u and v at one distance from the light.
    pub tilt: [f32; 2],
    /// Metres per texel along u and v.
    pub texel_m: [f32; 2],
    /// Metres along the light between depth 0 and depth 1.
    pub range_m: f32,
    /// A and B of a local light's depth if its map stores depth that is linear in w; `depth` is
    /// then −B/w. Otherwise 0.
    pub linear: [f32; 2],
    /// Tolerances of the lookup.
    pub tolerance: Tolerance,
    /// The crease behind which the receiver lies.
    pub crease: Crease,
}

/// `bias::MapPoint`: position of a point in a map, and properties of the map there.
#[derive(Clone, Copy, Debug)]
struct MapPoint {
    texel: [f32; 2],
    depth: f32,
    along_u: [f32; 3],
    along_v: [f32; 3],
    texel_m: [f32; 2],
    tilt: [f32; 2],
    range_m: f32,
    rounding_m: f32,
    linear: [f32; 2],
}

/// `bias::receiver`: the receiver at `position`, in metres from the frame's origin. `normal` is the
/// unit normal of the surface, `to_light` the unit vector towards the light.
#[must_use]
pub fn receiver(split: &Split, position: [f32; 3], normal: [f32; 3], to_light: [f32; 3]) -> Receiver {
    let at =
        if split.w_row == [0.0; 4] { plain_point(split, position) } else { warped_point(split, position, to_light) };
    let cosine = dot(normal, to_light);
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let steepness = 1.0 / cosine.max(sine / MAX_SLOPE);
    let tangent = sine * steepness;
    let slope = [dot(normal, at.along_u) * steepness, dot(normal, at.along_v) * steepness];
    let longer = at.texel_m[0].max(at.texel_m[1]);
    let bias_m = longer * (TEXEL_BIAS + SNAP_TEXELS * tangent) + at.rounding_m;
    Receiver {
        texel: at.texel,
        depth: at.depth - bias_m / at.range_m,
        slope: [0, 1].map(|i| slope[i] * at.texel_m[i] / at.range_m),
        tilt: at.tilt,
        texel_m: at.texel_m,
        range_m: at.range_m,
        linear: at.linear,
        tolerance: Tolerance {
            constant: bias_m / at.range_m,
            rounding: at.rounding_m / at.range_m,
            own: (OWN_TEXELS * longer + at.rounding_m) / at.range_m,
            ..tolerance(tangent, at.texel_m, at.range_m)
        },
        crease: Crease::default(),
    }
}

/// `bias::tolerance`: tolerances for the tangent between the receiver's normal and the light.
#[must_use]
pub fn tolerance(tangent: f32, texel_m: [f32; 2], range_m: f32) -> Tolerance {
    let corner = (FOLD * (1.0 + tangent * tangent)).clamp(CORNER_SLOPE, MOST_CORNER_SLOPE);
    let [shorter, longer] = [texel_m[0].min(texel_m[1]), texel_m[0].max(texel_m[1])];
    Tolerance {
        bend: corner * shorter / range_m,
        past: PAST * (1.0 + corner) * longer / range_m,
        steep: (MOST_STEEP - tangent).max(0.0) / range_m,
        arrival: PAST_TEXELS * longer / range_m,
        crease: CREASE_SLOPE.max(CREASE_SHARE * tangent) / range_m,
        ..Tolerance::default()
    }
}

fn plain_point(split: &Split, position: [f32; 3]) -> MapPoint {
    let [u, v, depth] = [split.u_row, split.v_row, split.depth_row].map(|row| along(row, position));
    MapPoint {
        texel: [u, v],
        depth,
        along_u: xyz(split.u_row).map(|x| x * split.texel_m[0]),
        along_v: xyz(split.v_row).map(|x| x * split.texel_m[1]),
        texel_m: split.texel_m,
        tilt: [0.0; 2],
        range_m: split.depth_range_m,
        rounding_m: ROUNDING * (largest(position) + split.depth_range_m) + split.depth_step_m,
        linear: [0.0; 2],
    }
}

fn warped_point(split: &Split, position: [f32; 3], to_light: [f32; 3]) -> MapPoint {
    let w = along(split.w_row, position);
    let texel = [along(split.u_row, position) / w, along(split.v_row, position) / w];
    let quotient = along(split.depth_row, position) / w;
    let gradient = |row: [f32; 4], value: f32| -> [f32; 3] {
        std::array::from_fn(|axis| (row[axis] - value * split.w_row[axis]) / w)
    };
    let u = gradient(split.u_row, texel[0]);
    let v = gradient(split.v_row, texel[1]);
    let z = gradient(split.depth_row, quotient);
    let across_v = cross(v, to_light);
    let across_u = cross(to_light, u);
    let (by_u, by_v) = (dot(u, across_v), dot(v, across_u));
    let step_u = across_v.map(|x| x / by_u);
    let step_v = across_u.map(|x| x / by_v);
    let texel_m = [length(step_u), length(step_v)];
    let range_m = if split.depth_offset > 0.0 { -1.0 / dot(z, to_light) } else { split.depth_range_m * w };
    let lost_z = length(xyz(split.depth_row)) * largest(position) + split.depth_row[3].abs();
    let lost_w = length(xyz(split.w_row)) * largest(position) + split.w_row[3].abs();
    let steps_m = split.depth_step_m / split.depth_range_m * range_m;
    let is_linear = split.is_linear != 0;
    MapPoint {
        texel,
        depth: if is_linear { quotient } else { quotient + split.depth_offset },
        along_u: step_u.map(|x| x / texel_m[0]),
        along_v: step_v.map(|x| x / texel_m[1]),
        texel_m,
        tilt: [dot(z, step_u), dot(z, step_v)],
        range_m,
        rounding_m: ROUNDING * range_m / w * (lost_z + quotient.abs() * lost_w + w) + steps_m,
        linear: if is_linear { [split.depth_offset, -split.depth_row[3]] } else { [0.0; 2] },
    }
}

impl Receiver {
    /// `bias::without_plane`: the receiver without its plane, for filters that read up to `reach`
    /// texels from it along each axis.
    #[must_use]
    pub fn without_plane(mut self, reach: [f32; 2]) -> Self {
        self.depth -= self.slope[0].abs() * reach[0] + self.slope[1].abs() * reach[1];
        self.slope = [0.0; 2];
        self.tolerance.bend = 0.0;
        self.tolerance.steep = 0.0;
        self.tolerance.crease = 1e30;
        self.tolerance.rounding = 1e30;
        self
    }

    /// `bias::crease_at`: the crease behind which the receiver lies, if the texel at `offset`
    /// belongs to the surface that makes one. `beyond` is the depth in the next texels on u and on
    /// v, away from the receiver, `farther` the depth in those behind them.
    #[must_use]
    pub fn crease_at(&self, offset: [f32; 2], stored: f32, beyond: [f32; 2], farther: [f32; 2]) -> Crease {
        let changes = beyond.map(|next| next - stored);
        let side = |i: usize| if offset[i] >= 0.0 { 1.0 } else { -1.0 };
        let own = |i: usize| (self.tilt[i] + self.slope[i]) * side(i);
        let rises = [[0, 1].map(|i| own(i) - changes[i]), [0, 1].map(|i| own(i) - (farther[i] - beyond[i]))];
        let unsure = self.tolerance.rounding + 0.5 * SNAP_TEXELS * (changes[0].abs() + changes[1].abs());
        let least = if self.linear[1] > 0.0 { 1e30 } else { self.tolerance.crease };
        let before = self.before_plane(offset, stored);
        Crease::of(before, offset, rises, self.texel_m.map(|texel| least * texel), unsure)
    }

    /// `bias::before_plane`: distance of a texel's surface in front of the receiver's plane,
    /// without any bias.
    #[must_use]
    pub fn before_plane(&self, offset: [f32; 2], stored: f32) -> f32 {
        self.plane_at(offset) - stored
    }

    fn plane_at(&self, offset: [f32; 2]) -> f32 {
        let along = dot2([0, 1].map(|i| self.tilt[i] + self.slope[i]), offset);
        self.depth + self.tolerance.constant + along
    }

    /// `bias::lies_before`: returns whether the texel's surface lies in front of the receiver's
    /// plane by more than `by`, without any bias.
    #[must_use]
    pub fn lies_before(&self, offset: [f32; 2], stored: f32, by: f32) -> bool {
        stored < self.as_stored(self.plane_at(offset) - by)
    }

    /// `bias::is_own`: returns whether the texel certainly belongs to the receiver's own surface.
    #[must_use]
    pub fn is_own(&self, offset: [f32; 2], stored: f32) -> bool {
        stored >= 1.0 || !self.lies_before(offset, stored, self.tolerance.own) && !self.is_past(offset, stored)
    }

    /// `bias::beyond_before_plane`: distance in front of the receiver's plane of the next texels on
    /// u and on v, `steps` texels farther from the receiver than the texel at `offset`. `beyond` is
    /// what they store.
    #[must_use]
    pub fn beyond_before_plane(&self, offset: [f32; 2], steps: f32, beyond: [f32; 2]) -> [f32; 2] {
        [0, 1].map(|i| {
            let side = if offset[i] >= 0.0 { steps } else { -steps };
            self.plane_at(offset) + (self.tilt[i] + self.slope[i]) * side - beyond[i]
        })
    }

    /// `bias::goes_on`: returns whether a surface goes on in parallel to the receiver's plane from
    /// a texel to the next ones on u and on v. `before` and `next` are their distances in front of
    /// the plane.
    #[must_use]
    pub fn goes_on(&self, before: f32, next: [f32; 2]) -> [bool; 2] {
        next.map(|next| (next - before).abs() <= self.tolerance.bend + self.tolerance.rounding)
    }

    /// `bias::is_straight`: returns whether three texels in a row store depths that lie on a line,
    /// along u and along v.
    #[must_use]
    pub fn is_straight(&self, first: [f32; 2], second: [f32; 2], third: [f32; 2]) -> [bool; 2] {
        [0, 1].map(|i| {
            let unsure = self.tolerance.rounding + SNAP_TEXELS * (second[i] - first[i]).abs();
            (first[i] - 2.0 * second[i] + third[i]).abs() <= 2.0 * unsure
        })
    }

    /// Returns whether the depth in a texel, `offset` texels from the receiver, shades it: the
    /// whole decision. `beyond` is the depth in the next texels on u and on v, away from the
    /// receiver.
    #[must_use]
    pub fn is_shaded(&self, offset: [f32; 2], stored: f32, beyond: [f32; 2]) -> bool {
        self.crease.is_across(offset, self.before_plane(offset, stored))
            || !self.lies_behind(offset, stored)
                && !self.same_surface(offset, stored)
                && !self.meets_receiver(offset, stored, beyond)
    }

    /// `bias::lies_behind`: returns whether the texel lies behind the receiver.
    #[must_use]
    pub fn lies_behind(&self, offset: [f32; 2], stored: f32) -> bool {
        stored >= self.as_stored(self.level(offset))
    }

    /// `bias::same_surface`: returns whether the texel belongs to the receiver's own surface.
    #[must_use]
    pub fn same_surface(&self, offset: [f32; 2], stored: f32) -> bool {
        !self.is_past(offset, stored) && self.reference(offset, [0.0; 2]) <= stored
    }

    /// `bias::meets_receiver`: returns whether the texel belongs to a surface that meets the
    /// receiver, or arrives behind it.
    #[must_use]
    pub fn meets_receiver(&self, offset: [f32; 2], stored: f32, beyond: [f32; 2]) -> bool {
        let past = self.is_past(offset, stored);
        let arrives = stored - dot2(beyond.map(|next| next - stored), offset.map(f32::abs));
        let before = if past { self.tolerance.arrival } else { 0.0 };
        let aside_m = (offset[0] * self.texel_m[0]).hypot(offset[1] * self.texel_m[1]);
        let steepest = self.bent(offset, [0.0; 2], self.tolerance.steep * aside_m);
        (past || stored >= steepest) && arrives >= self.as_stored(self.depth - before)
    }

    /// `bias::is_past`: returns whether the texel lies so far behind the receiver's plane that the
    /// receiver's surface must have ended before it.
    #[must_use]
    pub fn is_past(&self, offset: [f32; 2], stored: f32) -> bool {
        stored > self.as_stored(self.level(offset) + dot2(self.slope, offset) + self.tolerance.past)
    }

    /// `bias::reference`: the least depth of the receiver's own surface at `offset` texels, or up
    /// to `reach` texels from there.
    #[must_use]
    pub fn reference(&self, offset: [f32; 2], reach: [f32; 2]) -> f32 {
        self.bent(offset, reach, self.tolerance.bend * offset[0].hypot(offset[1]))
    }

    fn bent(&self, offset: [f32; 2], reach: [f32; 2], nearer: f32) -> f32 {
        let lowest = dot2(self.slope, offset) - dot2(self.slope.map(f32::abs), reach);
        let level = self.level(offset) - dot2(self.tilt.map(f32::abs), reach);
        self.as_stored(level + (lowest - nearer).min(0.0))
    }

    pub(super) fn level(&self, offset: [f32; 2]) -> f32 {
        self.depth + dot2(self.tilt, offset)
    }

    pub(super) fn as_stored(&self, depth: f32) -> f32 {
        let held = depth.clamp(-self.linear[0], 1.0 - self.linear[0]);
        if self.linear[1] > 0.0 { linear_depth(self.linear, self.linear[1] / (-held).max(1e-30)) } else { held }
    }
}

/// `bias::linear_depth`: the value that a map of linear depth stores `w` metres along the light's
/// axis.
#[must_use]
pub fn linear_depth([a, b]: [f32; 2], w: f32) -> f32 {
    ((w - b / a) * (a * (a - 1.0) / b)).clamp(0.0, 1.0)
}

fn along(row: [f32; 4], position: [f32; 3]) -> f32 {
    dot(xyz(row), position) + row[3]
}

fn xyz([x, y, z, _]: [f32; 4]) -> [f32; 3] {
    [x, y, z]
}

fn largest(position: [f32; 3]) -> f32 {
    position.into_iter().fold(0.0, |most, x| x.abs().max(most))
}

fn dot2(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[0] + a[1] * b[1]
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn length(a: [f32; 3]) -> f32 {
    dot(a, a).sqrt()
}
