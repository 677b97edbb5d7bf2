//! Storage of maps, the passes that draw them, and the format of a texel.

use super::names::named;

named! {
    /// Format of a map's texels.
    pub enum DepthFormat as "depth format" {
        /// 32-bit float, 4 bytes
        #[default]
        D32Float = "d32f",
        /// 16-bit, 2 bytes
        D16Unorm = "d16",
        /// 32-bit float in a colour texture, compared by hand; 4 bytes and a depth buffer beside it
        R32Float = "r32f",
    }
}

impl DepthFormat {
    /// Bytes of one texel, without the depth buffer beside a colour texture.
    #[must_use]
    pub const fn texel_bytes(self) -> u64 {
        match self {
            Self::D32Float | Self::R32Float => 4,
            Self::D16Unorm => 2,
        }
    }

    /// Returns whether maps are colour textures and not depth textures: casters then need a
    /// fragment shader.
    #[must_use]
    pub const fn is_colour(self) -> bool {
        matches!(self, Self::R32Float)
    }
}

named! {
    /// Storage of maps in textures.
    pub enum Storage as "storage" {
        /// Layers of one texture
        #[default]
        Array = "array",
        /// Tiles of one texture
        Atlas = "atlas",
        /// A texture for each map
        Separate = "separate",
        /// Faces of a cube: six maps of one size at most
        Cube = "cube",
        /// One map, used for one split after the other
        Reused = "reused",
    }
}

named! {
    /// Passes that draw the maps.
    pub enum Generation as "generation" {
        /// One pass for each split
        #[default]
        PerSplit = "per-split",
        /// Map and picture slice by slice, one map for all
        Multipass = "multipass",
        /// As many splits at once as the device has views, by multiview
        Layered = "layered",
        /// All splits at once, by instancing into tiles
        Instanced = "instanced",
        /// All splits at once, by both: tiles in layers
        Mixed = "mixed",
    }
}

named! {
    /// Cache mode of a sun's maps: the depth drawn by static casters may be kept from frame to
    /// frame.
    #[non_exhaustive]
    pub enum Cache as "cache" {
        /// Every map is drawn again in every frame
        #[default]
        Off = "off",
        /// Static casters are drawn where a map has not shown them yet, moving ones in every frame
        Kept = "kept",
    }
}

/// Storage of maps and the passes that draw them: the nine pairs that go together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Layout {
    /// Layers of one texture, one pass for each split.
    #[default]
    Array,
    /// Tiles of one texture, one pass for each split.
    Atlas,
    /// A texture for each map, one pass for each split. Each takes one of the textures that a
    /// shader can sample.
    Separate,
    /// Faces of a cube map, one pass for each split.
    Cube,
    /// One map for one split after the other; the image is drawn slice by slice in between.
    Reused,
    /// Layers of one texture, several at once by multiview.
    LayeredArray,
    /// Faces of a cube map, several at once by multiview.
    LayeredCube,
    /// Tiles of one texture, all at once by instancing; clip distances keep tiles apart.
    InstancedAtlas,
    /// Layers that hold two tiles or more, all at once by multiview and instancing.
    MixedArray,
}

impl Layout {
    /// All layouts.
    pub const ALL: [Self; 9] = [
        Self::Array,
        Self::Atlas,
        Self::Separate,
        Self::Cube,
        Self::Reused,
        Self::LayeredArray,
        Self::LayeredCube,
        Self::InstancedAtlas,
        Self::MixedArray,
    ];

    /// The storage of maps.
    #[must_use]
    pub const fn storage(self) -> Storage {
        match self {
            Self::Array | Self::LayeredArray | Self::MixedArray => Storage::Array,
            Self::Atlas | Self::InstancedAtlas => Storage::Atlas,
            Self::Separate => Storage::Separate,
            Self::Cube | Self::LayeredCube => Storage::Cube,
            Self::Reused => Storage::Reused,
        }
    }

    /// The passes that draw the maps.
    #[must_use]
    pub const fn generation(self) -> Generation {
        match self {
            Self::Array | Self::Atlas | Self::Separate | Self::Cube => Generation::PerSplit,
            Self::Reused => Generation::Multipass,
            Self::LayeredArray | Self::LayeredCube => Generation::Layered,
            Self::InstancedAtlas => Generation::Instanced,
            Self::MixedArray => Generation::Mixed,
        }
    }

    /// The layout of a generation and a storage; `None` for pairs that do not go together.
    #[must_use]
    pub fn of(generation: Generation, storage: Storage) -> Option<Self> {
        Self::ALL.into_iter().find(|layout| (layout.generation(), layout.storage()) == (generation, storage))
    }
}

named! {
    /// Rule for unsupported features.
    pub enum Fallbacks as "rule for fallbacks" {
        /// They are replaced by supported ones, and a note says so
        #[default]
        Allow = "allow",
        /// They are an error
        Forbid = "forbid",
    }
}

named! {
    /// Source of the coordinates at which receivers look up a map.
    pub enum Coordinates as "source of coordinates" {
        /// Each pixel makes them from its world position
        #[default]
        World = "world",
        /// Each vertex makes them for every split, and they are interpolated
        Vertex = "split",
        /// Each pixel makes them from the picture's depth, in a pass of its own
        Deferred = "deferred",
    }
}
