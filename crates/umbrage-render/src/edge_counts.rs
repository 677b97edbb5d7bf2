//! What exact edges did for a picture: which pixels were decided by what, and how many triangles
//! were asked.

use image::{Rgba, RgbaImage};

/// Four numbers of a pixel, as `shaders/edge_counts.wgsl` writes them.
pub(crate) const COUNTS_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Uint;

/// What decided a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum EdgeCause {
    /// It is turned away from the light, or no map covers it.
    NotAsked,
    /// No texel round it is dark: lit.
    Lit,
    /// All texels that count are dark: dark.
    Dark,
    /// Triangles were asked, and none is hit: lit.
    Missed,
    /// Triangles were asked, and one is hit: dark, or with several positions in part.
    Hit,
    /// A caster without a name: the filter answered.
    Filter,
}

impl EdgeCause {
    /// All causes, in the order of their numbers in the shader.
    pub const ALL: [Self; 6] = [Self::NotAsked, Self::Lit, Self::Dark, Self::Missed, Self::Hit, Self::Filter];

    /// Whether depth alone did not decide.
    #[must_use]
    pub const fn is_tested(self) -> bool {
        matches!(self, Self::Missed | Self::Hit | Self::Filter)
    }
}

/// What was done for a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeCount {
    /// What decided; of two maps that blend the later one in [`EdgeCause::ALL`].
    pub cause: EdgeCause,
    /// Maps that were asked.
    pub maps: u16,
    /// Runs whose boxes were tested.
    pub runs: u16,
    /// Triangles that were tested.
    pub triangles: u16,
}

/// What was done for the pixels of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EdgeCounts {
    size: [u32; 2],
    /// Row by row; none where no surface is.
    pixels: Vec<Option<EdgeCount>>,
}

/// What was done for a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EdgeSums {
    /// Pixels for which a map was asked.
    pub points: u64,
    /// Of these, by [`EdgeCause`] from [`EdgeCause::Lit`] on.
    pub by_cause: [u64; 5],
    /// Runs whose boxes were tested.
    pub runs: u64,
    /// Triangles that were tested.
    pub triangles: u64,
}

impl EdgeSums {
    /// Points that depth alone did not decide.
    #[must_use]
    pub fn tested(&self) -> u64 {
        self.by_cause[2..].iter().sum()
    }

    /// Points of one cause.
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
    /// From what the shader wrote.
    pub(crate) fn read(size: [u32; 2], numbers: &[[u16; 4]]) -> Self {
        let pixel = |&[cause, maps, runs, triangles]: &[u16; 4]| {
            let cause = *EdgeCause::ALL.get(usize::from(cause.checked_sub(1)?))?;
            Some(EdgeCount { cause, maps, runs, triangles })
        };
        Self { size, pixels: numbers.iter().map(pixel).collect() }
    }

    /// Pixels across and down.
    #[must_use]
    pub const fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Row by row; none where no surface is.
    #[must_use]
    pub fn pixels(&self) -> &[Option<EdgeCount>] {
        &self.pixels
    }

    /// All pixels together.
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

    /// To be laid over the picture: nothing where depth decided, else the cause's
    /// [`EdgeCounts::COLOURS`], the stronger the more triangles were tested.
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

    /// Colours of what depth did not decide: lit as no triangle is hit, dark as one is, and left to
    /// the filter.
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
