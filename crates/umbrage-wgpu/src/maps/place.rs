//! Place of a split's map, and the viewport with which it is drawn.

use umbrage_shaders::layout;

use super::storage::Tile;

/// The square of texels that clip space covers when a split is drawn: the map and a guard band
/// around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Viewport {
    /// Edge in texels.
    pub edge: u32,
    /// Texels from the viewport's left and upper edge to the map's.
    pub guard: u32,
}

impl Viewport {
    /// The widest useful guard band, as a multiple of the map. Not from a paper: a triangle that
    /// extends more than one and a half maps beyond the map is clipped, and its edges may then move
    /// by 1/512 texel between frames. A power of two, so that the step from texels to clip space
    /// stays exact.
    const WIDEST: u32 = 4;

    /// The viewport for a map of `size` texels. `largest` is the device's limit for viewports: its
    /// `max_texture_dimension_2d`, or 0 if viewports may not be larger than their target.
    pub fn around(size: u32, largest: u32) -> Self {
        let mut edge = size;
        while edge < Self::WIDEST * size && 2 * u64::from(edge) <= u64::from(largest) {
            edge *= 2;
        }
        Self { edge, guard: (edge - size) / 2 }
    }

    /// [`Viewport::around`] for a square of any size, with an edge that is still a power of two.
    pub fn of_power(size: u32, largest: u32) -> Self {
        let power = size.next_power_of_two();
        if power > largest {
            return Self::around(size, largest);
        }
        let Self { edge, .. } = Self::around(power, largest.min(Self::WIDEST * size));
        Self { edge, guard: (edge - size) / 2 }
    }
}

/// Place of a split's map, and the viewport with which it is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    pub tile: Tile,
    pub viewport: Viewport,
}

impl Place {
    /// A split's uniform with the members that describe this place.
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
