//! Conversions from plain arrays and from the types of `mint`, the common exchange format of Rust's
//! mathematical libraries.

use glam::{DVec3, Vec3};

use crate::{DirectionalLight, Error};

impl TryFrom<[f64; 3]> for DirectionalLight {
    type Error = Error;

    /// A light from its direction of travel, as [`DirectionalLight::new`].
    fn try_from(direction: [f64; 3]) -> Result<Self, Error> {
        Self::new(direction.into())
    }
}

impl TryFrom<[f32; 3]> for DirectionalLight {
    type Error = Error;

    /// A light from its direction of travel, as [`DirectionalLight::new`].
    fn try_from(direction: [f32; 3]) -> Result<Self, Error> {
        Self::new(Vec3::from(direction).as_dvec3())
    }
}

impl TryFrom<DVec3> for DirectionalLight {
    type Error = Error;

    /// A light from its direction of travel, as [`DirectionalLight::new`].
    fn try_from(direction: DVec3) -> Result<Self, Error> {
        Self::new(direction)
    }
}

#[cfg(feature = "mint")]
mod with_mint {
    use crate::{Aabb, DirectionalLight, Error, Matrix};

    macro_rules! conversions {
        ($float:ty) => {
            impl From<mint::ColumnMatrix4<$float>> for Matrix {
                fn from(matrix: mint::ColumnMatrix4<$float>) -> Self {
                    <[[$float; 4]; 4]>::from(matrix).into()
                }
            }

            impl From<mint::RowMatrix4<$float>> for Matrix {
                fn from(matrix: mint::RowMatrix4<$float>) -> Self {
                    Self(Self::from(<[[$float; 4]; 4]>::from(matrix)).0.transpose())
                }
            }

            impl From<[mint::Point3<$float>; 2]> for Aabb {
                /// A box from its two extreme corners.
                fn from(corners: [mint::Point3<$float>; 2]) -> Self {
                    corners.map(<[$float; 3]>::from).into()
                }
            }

            impl TryFrom<mint::Vector3<$float>> for DirectionalLight {
                type Error = Error;

                /// A light from its direction of travel, as [`DirectionalLight::new`].
                fn try_from(direction: mint::Vector3<$float>) -> Result<Self, Error> {
                    <[$float; 3]>::from(direction).try_into()
                }
            }
        };
    }

    conversions!(f64);
    conversions!(f32);
}
