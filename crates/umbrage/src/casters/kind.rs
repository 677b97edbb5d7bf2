//! Properties that casters share and that queries select by.

use crate::{Error, Result};

/// Layers that a caster is on, or that a light or a view shows: a set of up to
/// [`Layers::COUNT`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Layers(u32);

impl Layers {
    /// Number of layers.
    pub const COUNT: u32 = u32::BITS;

    /// Every layer.
    pub const ALL: Self = Self(u32::MAX);

    /// No layer.
    pub const NONE: Self = Self(0);

    /// One layer, counted from 0.
    ///
    /// # Errors
    /// [`Error::NoSuchLayer`] for [`Layers::COUNT`] and above.
    pub fn one(layer: u32) -> Result<Self> {
        1u32.checked_shl(layer).map(Self).ok_or(Error::NoSuchLayer { layer })
    }

    /// Layers from a mask: bit `i` stands for layer `i`.
    #[must_use]
    pub const fn from_bits(bits: u32) -> Self {
        Self(bits)
    }

    /// The layers as a mask: bit `i` stands for layer `i`.
    #[must_use]
    pub const fn bits(self) -> u32 {
        self.0
    }

    /// Returns whether the two sets share a layer.
    #[must_use]
    pub const fn meets(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }
}

impl Default for Layers {
    /// The first layer.
    fn default() -> Self {
        Self(1)
    }
}

impl std::ops::BitOr for Layers {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

/// Purpose for which the boxes of a set are queried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// Casting shadows.
    Caster,
    /// Showing shadows.
    Receiver,
}

/// Layers and flags of a caster. Casters of a set share few combinations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Kind {
    pub layers: Layers,
    pub casts: bool,
    pub receives: bool,
}

/// A query of a set: its layers, and its purpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Ask {
    pub layers: Layers,
    pub role: Role,
}

impl Ask {
    pub(super) fn is_for(self, kind: Kind) -> bool {
        let plays = match self.role {
            Role::Caster => kind.casts,
            Role::Receiver => kind.receives,
        };
        plays && kind.layers.meets(self.layers)
    }
}

/// All kinds of a set, by number.
#[derive(Clone, Debug, Default)]
pub(super) struct Kinds(Vec<Kind>);

impl Kinds {
    /// The number of a kind.
    pub fn number(&mut self, kind: Kind) -> Result<u16> {
        if let Some(number) = self.0.iter().rposition(|known| *known == kind) {
            return Ok(number as u16);
        }
        let number = u16::try_from(self.0.len()).map_err(|_| Error::TooManyCasterKinds)?;
        self.0.push(kind);
        Ok(number)
    }

    pub fn get(&self, number: u16) -> Kind {
        self.0[usize::from(number)]
    }

    /// Returns whether every kind is queried, so that none need be looked up.
    pub fn are_all_for(&self, ask: Ask) -> bool {
        self.0.iter().all(|&kind| ask.is_for(kind))
    }

    pub fn bytes(&self) -> usize {
        self.0.capacity() * size_of::<Kind>()
    }
}
