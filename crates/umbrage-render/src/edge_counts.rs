//! Counts of exact edges in a picture: the cause of each pixel's decision and the number of
//! triangles tested.

use image::{Rgba, RgbaImage};

/// Format of the four numbers of a pixel that `shaders/edge_counts.wgsl` writes.
pub(crate) const COUNTS_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Uint;

/// Cause of the decision at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum EdgeCause {
    /// No map was read: the surface is turned away from the light, or no map covers it.
    NotAsked,
    /// Lit: no texel around the point is dark.
    Lit,
    /// Dark: all texels that count are dark.
    Dark,
    /// Lit: triangles were tested and none is hit.
    Missed,
    /// Dark, or partly dark with several positions: triangles were tested and one is hit.
    Hit,
    /// Decided by the filter: a caster has no id.
    Filter,
}

impl EdgeCause {
    /// All causes, in the order of their numbers in the shader.
    pub const ALL: [Self; 6] = [Self::NotAsked, Self::Lit, Self::Dark, Self::Missed, Self::Hit, Self::Filter];

    /// Returns whether depth alone did not decide.
    #[must_use]
    pub const fn is_tested(self) -> bool {
        matches!(self, Self::Missed | Self::Hit | Self::Filter)
    }
}

/// Counts of one pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeCount {
    /// Cause of the decision. Of two maps that blend, the later cause in [`EdgeCause::ALL`].
    pub cause: EdgeCause,
    /// Number of maps that were read.
    pub maps: u16,
    /// Number of runs whose boxes were tested.
    pub runs: u16,
    /// Number of triangles that were tested.
    pub triangles: u16,
}

/// Counts of all pixels of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EdgeCounts {
    size: [u32; 2],
    /// Counts row by row; `None` for a pixel without a surface.
    pixels: Vec<Option<EdgeCount>>,
}

/// Sums of the counts of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EdgeSums {
    /// Number of pixels for which a map was read.
    pub points: u64,
    /// Number of these pixels by [`EdgeCause`], from [`EdgeCause::Lit`] on.
    pub by_cause: [u64; 5],
    /// Number of runs whose boxes were tested.
    pub runs: u64,
    /// Number of triangles that were tested.
    pub triangles: u64,
}

impl EdgeSums {
    /// Returns the number of points that depth alone did not decide.
    #[must_use]
    pub fn tested(&self) -> u64 {
        self.by_cause[2..].iter().sum()
    }

    /// Returns the number of points with one cause.
    #[must_use]
    pub fn of(&self, cause: EdgeCause) -> u64 {
        let number = EdgeCause::ALL.iter().position(|other| *other == cause).unwrap_or(0);
        number.checked_sub(1).map_or(0, |i| self.by_cause[i])
    }
}

impl std::ops::AddAssign for EdgeSums {
    fn add_assign(&mut self, other: Self) {
        self.points += other.points;
        self.by_cause.iter_mut().zip(other.by_cause).for_each(|(sum, more)| *sum += more);
        self.runs += other.runs;
        self.triangles += other.triangles;
    }
}

impl EdgeCounts {
    /// Reads the counts from the numbers that the shader wrote.
    pub(crate) fn read(size: [u32; 2], numbers: &[[u16; 4]]) -> Self {
        let pixel = |&[cause, maps, runs, triangles]: &[u16; 4]| {
            let cause = *EdgeCause::ALL.get(usize::from(cause.checked_sub(1)?))?;
            Some(EdgeCount { cause, maps, runs, triangles })
        };
        Self { size, pixels: numbers.iter().map(pixel).collect() }
    }

    /// Returns the picture's width and height in pixels.
    #[must_use]
    pub const fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the counts row by row; `None` for a pixel without a surface.
    #[must_use]
    pub fn pixels(&self) -> &[Option<EdgeCount>] {
        &self.pixels
    }

    /// Sums the counts of all pixels.
    #[must_use]
    pub fn sums(&self) -> EdgeSums {
        let mut sums = EdgeSums::default();
        for pixel in self.pixels.iter().flatten().filter(|pixel| pixel.cause != EdgeCause::NotAsked) {
            sums.points += 1;
            sums.by_cause[pixel.cause as usize - 1] += 1;
            sums.runs += u64::from(pixel.runs);
            sums.triangles += u64::from(pixel.triangles);
        }
        sums
    }

    /// Draws an overlay for the picture: transparent where depth decided, else the cause's colour
    /// of [`EdgeCounts::COLOURS`], more opaque the more triangles were tested.
    #[must_use]
    pub fn picture(&self) -> RgbaImage {
        RgbaImage::from_fn(self.size[0], self.size[1], |x, y| {
            let pixel = self.pixels[(y * self.size[0] + x) as usize];
            let Some(pixel) = pixel.filter(|pixel| pixel.cause.is_tested()) else { return Rgba([0; 4]) };
            let [r, g, b] = Self::COLOURS[pixel.cause as usize - EdgeCause::Missed as usize];
            // All of it from 32 tests on: four runs.
            let strength = 96 + 5 * pixel.triangles.min(31);
            Rgba([r, g, b, strength.min(255) as u8])
        })
    }

    /// Colours of points that depth did not decide: lit because no triangle is hit, dark because
    /// one is hit, and left to the filter.
    pub const COLOURS: [[u8; 3]; 3] = [[250, 225, 90], [40, 120, 255], [235, 40, 30]];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_become_causes_and_sums() {
        let numbers = [[0; 4], [1, 0, 0, 0], [2, 1, 0, 0], [3, 1, 0, 0], [4, 2, 3, 16], [5, 1, 1, 7], [6, 1, 2, 0]];
        let counts = EdgeCounts::read([7, 1], &numbers);
        assert_eq!(counts.pixels()[0], None);
        assert_eq!(counts.pixels()[1].map(|pixel| pixel.cause), Some(EdgeCause::NotAsked));
        let sums = counts.sums();
        assert_eq!(sums, EdgeSums { points: 5, by_cause: [1; 5], runs: 6, triangles: 23 });
        assert_eq!((sums.tested(), sums.of(EdgeCause::Hit), sums.of(EdgeCause::NotAsked)), (3, 1, 0));
        let picture = counts.picture();
        assert_eq!(picture.get_pixel(3, 0).0, [0; 4]);
        assert_eq!(picture.get_pixel(4, 0).0, [250, 225, 90, 176]);
        assert_eq!(picture.get_pixel(6, 0).0, [235, 40, 30, 96]);
        let mut twice = sums;
        twice += sums;
        assert_eq!((twice.points, twice.by_cause, twice.triangles), (10, [2; 5], 46));
    }
}
