//! `lib/crease.wesl` on the CPU: the line in which another surface meets the receiver's surface,
//! and behind which it shades that surface.

/// `crease::REACH`: distance in texels behind a crease within which its other side counts.
pub const REACH: f32 = 2.0;
/// `crease::WIDTH`: share of a texel within which a texel counts as one of the crease itself.
pub const WIDTH: f32 = 0.1;
/// `crease::MOST_FALL`: most fall of a surface along one axis as a multiple of its rise along the
/// other.
pub const MOST_FALL: f32 = 0.6;

/// `crease::Crease`: the passage of another surface over the receiver. Heights are depths in front
/// of the receiver's plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Crease {
    /// Height of the other surface over the receiver.
    pub height: f32,
    /// Change of that height per texel along u and v; 0 if no surface passes over the receiver.
    pub rise: [f32; 2],
    /// Uncertainty of a height, from rounding.
    pub unsure: f32,
}

impl Crease {
    /// `crease::crease_of`: the crease of a surface that lies `before` the receiver's plane at
    /// `offset` texels from the receiver. It rises by `away` to the next texels on u and on v, away
    /// from the receiver, and by `farther` from these to the next.
    #[must_use]
    pub fn of(before: f32, offset: [f32; 2], [away, farther]: [[f32; 2]; 2], least: [f32; 2], unsure: f32) -> Self {
        let of_axis = |i: usize| {
            let aside = offset[i].abs();
            (farther[i] - away[i]).min(0.0) * 0.5 * aside * (aside + 1.0) - away[i] * aside
        };
        let height = before + of_axis(0) + of_axis(1);
        let is_steep = (away[0] / least[0]).powi(2) + (away[1] / least[1]).powi(2) >= 1.0;
        let falls_little =
            |i: usize| (farther[i] - away[i]).abs() <= 2.0 * unsure && -away[i] <= MOST_FALL * away[1 - i];
        let rises = before >= -unsure && (0..2).all(|i| away[i] >= -unsure || falls_little(i));
        let is_over = height >= -unsure && height <= REACH * away[0].hypot(away[1]);
        let is_there = is_steep && rises && is_over;
        let rise = [0, 1].map(|i| if offset[i] >= 0.0 { away[i] } else { -away[i] });
        Self { height, rise: if is_there { rise } else { [0.0; 2] }, unsure }
    }

    /// `crease::is_there`: returns whether a surface passes over the receiver.
    #[must_use]
    pub fn is_there(&self) -> bool {
        self.rise != [0.0; 2]
    }

    /// `crease::is_across`: returns whether the other surface stands between the receiver and a
    /// texel at `offset`, whose surface lies `before` the receiver's plane, or is that surface.
    #[must_use]
    pub fn is_across(&self, offset: [f32; 2], before: f32) -> bool {
        let height = self.height + self.rise[0] * offset[0] + self.rise[1] * offset[1];
        let width = WIDTH * (self.rise[0].abs() + self.rise[1].abs()) + self.unsure;
        self.is_there() && (height <= width || before + width >= height)
    }
}

#[cfg(test)]
mod tests {
    use super::Crease;

    /// Stored height `x` texels from a wall without thickness that stands along v on a floor seen
    /// from 45°: 2 for each texel behind the wall, and 0 in front of it.
    fn height(x: f32) -> f32 {
        (2.0 * x).max(0.0)
    }

    /// The crease found by the texel at `at` for a receiver at `x` texels behind the wall.
    fn crease(x: f32, at: f32) -> Crease {
        let away = [height(at + (at - x).signum()) - height(at), 0.0];
        Crease::of(height(at), [at - x, 0.3], [away; 2], [1.0; 2], 0.001)
    }

    #[test]
    fn a_wall_parts_what_is_behind_it_from_what_is_before_it() {
        for x in [0.0, 0.01, 0.4, 1.0, 1.9] {
            let crease = crease(x, x + 0.6);
            assert!(crease.is_there() && (crease.height - 2.0 * x).abs() < 1e-5, "{x}: {crease:?}");
            // The ground before the wall, and the wall itself.
            assert!(crease.is_across([-x - 0.1, 0.0], 0.0) && crease.is_across([1.5, 0.0], height(x + 1.5)));
            // A hole in the wall lights.
            assert!(!crease.is_across([1.5, 0.0], 0.0), "{x}: {crease:?}");
        }
    }

    #[test]
    fn what_lies_before_a_wall_or_far_behind_it_is_not_parted_from_anything() {
        assert!(!crease(-0.01, 0.5).is_there(), "the wall passes behind it");
        assert!(!crease(2.1, 2.6).is_there());
        assert!(!Crease::of(2.0, [0.5, 0.5], [[0.0, 0.0]; 2], [1.0; 2], 0.0).is_there(), "a roof over it");
        assert!(!Crease::of(0.4, [0.5, 0.5], [[0.4, 0.4]; 2], [1.0; 2], 0.0).is_there(), "a fold");
        assert!(!Crease::of(2.0, [0.5, 0.5], [[2.0, -1.3]; 2], [1.0; 2], 0.0).is_there(), "an edge that hangs");
        let end = |fall: f32| Crease::of(2.0, [0.5, 0.5], [[2.0, -1.0], [2.0, -1.0 - fall]], [1.0; 2], 0.001);
        assert!(end(0.0).is_there() && !end(0.5).is_there(), "a wall that goes on, and one that ends");
        let round = |curve: f32| Crease::of(1.0, [0.7, 0.0], [[1.3, 0.0], [1.3 - curve, 0.0]], [1.0; 2], 0.0);
        assert!(round(0.0).is_there() && !round(0.3).is_there(), "a round foot");
        assert!(!Crease::default().is_across([1.0, 0.0], 0.0));
    }
}
