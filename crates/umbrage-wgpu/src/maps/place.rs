//! Where the map of a split lies, and the viewport that it is drawn with.

use umbrage_shaders::layout;

use super::storage::Tile;

/// The square of texels that clip space covers when a split is drawn: the map and a guard band
/// around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Viewport {
    /// Edge in texels.
    pub edge: u32,
    /// Texels from its left and upper edge to the map's.
    pub guard: u32,
}

impl Viewport {
    /// The widest guard band worth having, as a multiple of the map. Ours: a triangle that reaches
    /// from the map past one and a half maps more is clipped, and its edges may then move by 1/512
    /// texel between frames. A power of two, so that the step from texels to clip space stays
    /// exact.
    const WIDEST: u32 = 4;

    /// For a map of `size` texels. `largest` is the device's limit for viewports: its
    /// `max_texture_dimension_2d`, or 0 where they may not be larger than what is drawn to.
    pub fn around(size: u32, largest: u32) -> Self {
        let mut edge = size;
        while edge < Self::WIDEST * size && 2 * u64::from(edge) <= u64::from(largest) {
            edge *= 2;
        }
        Self { edge, guard: (edge - size) / 2 }
    }

    /// [`Viewport::around`] for a square of any size, whose edge is a power of two all the same.
    pub fn of_power(size: u32, largest: u32) -> Self {
        let power = size.next_power_of_two();
        if power > largest {
            return Self::around(size, largest);
        }
        let Self { edge, .. } = Self::around(power, largest.min(Self::WIDEST * size));
        Self { edge, guard: (edge - size) / 2 }
    }
}

/// Where a split's map lies, and the viewport that it is drawn with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    pub tile: Tile,
    pub viewport: Viewport,
}

impl Place {
    /// The members of the uniform that say so.
    pub fn into_split(self) -> layout::Split {
        let Tile { layer, corner, layer_texels } = self.tile;
        layout::Split {
            viewport_texels: self.viewport.edge as f32,
            guard_texels: self.viewport.guard as f32,
            corner: corner.map(|texels| texels as f32),
            layer_texels: layer_texels.map(|texels| texels as f32),
            layer,
            ..layout::Split::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Viewport;

    #[test]
    fn viewports_are_as_wide_as_the_device_allows() {
        let edges = |size, largest| {
            let Viewport { edge, guard } = Viewport::around(size, largest);
            (edge, guard)
        };
        assert_eq!(edges(1024, 8192), (4096, 1536));
        assert_eq!(edges(4096, 8192), (8192, 2048));
        assert_eq!(edges(8192, 8192), (8192, 0));
        assert_eq!(edges(5, 8192), (20, 7));
        assert_eq!(edges(1024, 0), (1024, 0));
    }
}
