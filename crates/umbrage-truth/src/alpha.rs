//! Alpha-tested surfaces: base colour alpha × texture alpha × vertex alpha against the cutoff, as a
//! GPU samples it at level 0, bilinear, without mip levels.

use umbrage_scene::{AlphaMode, Material, Primitive, Scene, TextureFilter, Wrap};

/// The alpha of one primitive, copied out of the scene so that the judge borrows nothing.
#[derive(Debug)]
pub(crate) struct AlphaTest {
    cutoff: f64,
    base: f64,
    /// Index into the list of pictures that [`AlphaTest::passes`] is given.
    picture: Option<usize>,
    indices: Vec<u32>,
    /// Texture coordinates of the vertices; empty means (0, 0) everywhere.
    uvs: Vec<[f32; 2]>,
    /// Alpha of the vertices; empty means 1 everywhere.
    vertex_alpha: Vec<f32>,
}

/// The alpha channel of a texture.
#[derive(Debug)]
pub(crate) struct AlphaPicture {
    size: [usize; 2],
    wrap: [Wrap; 2],
    filter: TextureFilter,
    alpha: Vec<u8>,
}

impl AlphaTest {
    /// Makes the alpha test of a primitive; `None` if its material has none. `picture` is the index
    /// of the texture's alpha.
    pub(crate) fn new(primitive: &Primitive, material: &Material, picture: Option<usize>) -> Option<Self> {
        let AlphaMode::Mask { cutoff } = material.alpha else { return None };
        Some(Self {
            cutoff: f64::from(cutoff),
            base: f64::from(material.base_color[3]),
            picture,
            indices: primitive.indices.clone(),
            uvs: primitive.uvs.clone(),
            vertex_alpha: primitive.colors.iter().map(|color| color[3]).collect(),
        })
    }

    /// Returns whether the surface is there: its alpha reaches the cutoff. `weights` are the
    /// barycentric coordinates of the point in triangle `triangle`.
    pub(crate) fn passes(&self, pictures: &[AlphaPicture], triangle: usize, weights: [f64; 3]) -> bool {
        let corners: [usize; 3] = std::array::from_fn(|i| self.indices[3 * triangle + i] as usize);
        let mut alpha = self.base;
        if !self.vertex_alpha.is_empty() {
            alpha *= corners.iter().zip(weights).map(|(&c, w)| w * f64::from(self.vertex_alpha[c])).sum::<f64>();
        }
        if let Some(picture) = self.picture {
            let mut uv = [0.0; 2];
            if !self.uvs.is_empty() {
                for (&corner, weight) in corners.iter().zip(weights) {
                    uv[0] += weight * f64::from(self.uvs[corner][0]);
                    uv[1] += weight * f64::from(self.uvs[corner][1]);
                }
            }
            alpha *= pictures[picture].sample(uv);
        }
        alpha >= self.cutoff
    }
}

impl AlphaPicture {
    /// Copies the alpha channel of one of the scene's textures.
    pub(crate) fn new(scene: &Scene, texture: usize) -> Self {
        let texture = &scene.textures[texture];
        Self {
            size: [texture.width as usize, texture.height as usize],
            wrap: texture.wrap,
            filter: texture.filter,
            alpha: texture.rgba.chunks_exact(4).map(|texel| texel[3]).collect(),
        }
    }

    /// Samples alpha in `[0, 1]`, bilinearly or from the nearest texel. Texel centres lie at
    /// half-integers; v points down.
    fn sample(&self, uv: [f64; 2]) -> f64 {
        if self.filter == TextureFilter::Nearest {
            let axis =
                |i: usize| wrapped((uv[i] * self.size[i] as f64).floor() as i64, self.size[i] as i64, self.wrap[i]);
            return f64::from(self.alpha[axis(1) * self.size[0] + axis(0)]) / 255.0;
        }
        let axis = |i: usize| {
            let at = uv[i] * self.size[i] as f64 - 0.5;
            let low = at.floor();
            let texel = |k: f64| wrapped(k as i64, self.size[i] as i64, self.wrap[i]);
            (texel(low), texel(low + 1.0), at - low)
        };
        let ((x0, x1, fx), (y0, y1, fy)) = (axis(0), axis(1));
        let texel = |x: usize, y: usize| f64::from(self.alpha[y * self.size[0] + x]) / 255.0;
        let top = texel(x0, y0) * (1.0 - fx) + texel(x1, y0) * fx;
        let bottom = texel(x0, y1) * (1.0 - fx) + texel(x1, y1) * fx;
        top * (1.0 - fy) + bottom * fy
    }
}

fn wrapped(texel: i64, size: i64, wrap: Wrap) -> usize {
    let inside = match wrap {
        Wrap::Repeat => texel.rem_euclid(size),
        Wrap::Clamp => texel.clamp(0, size - 1),
        Wrap::Mirror => {
            let within = texel.rem_euclid(2 * size);
            if within < size { within } else { 2 * size - 1 - within }
        }
    };
    inside as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(wrap: Wrap) -> AlphaPicture {
        AlphaPicture { size: [2, 1], wrap: [wrap, wrap], filter: TextureFilter::Linear, alpha: vec![0, 255] }
    }

    #[test]
    fn the_nearest_texel_has_no_slope() {
        let nearest = |wrap| AlphaPicture { filter: TextureFilter::Nearest, ..picture(wrap) };
        assert_eq!([0.01, 0.49, 0.51, 0.99].map(|u| nearest(Wrap::Repeat).sample([u, 0.5])), [0.0, 0.0, 1.0, 1.0]);
        assert_eq!([-0.01, 1.01].map(|u| nearest(Wrap::Repeat).sample([u, 0.5])), [1.0, 0.0]);
        assert_eq!([-0.01, 1.01].map(|u| nearest(Wrap::Clamp).sample([u, 0.5])), [0.0, 1.0]);
        assert_eq!([-0.01, 1.01].map(|u| nearest(Wrap::Mirror).sample([u, 0.5])), [0.0, 1.0]);
    }

    #[test]
    fn bilinear_between_texel_centres_and_across_the_border() {
        let repeat = picture(Wrap::Repeat);
        assert_eq!(repeat.sample([0.25, 0.5]), 0.0);
        assert_eq!(repeat.sample([0.75, 0.5]), 1.0);
        assert!((repeat.sample([0.5, 0.5]) - 0.5).abs() < 1e-15);
        // The border texel mixes with its neighbour on the other side, with itself, or with itself
        // again.
        assert!((repeat.sample([0.0, 0.5]) - 0.5).abs() < 1e-15);
        assert_eq!(picture(Wrap::Clamp).sample([0.0, 0.5]), 0.0);
        assert_eq!(picture(Wrap::Mirror).sample([0.0, 0.5]), 0.0);
    }

    #[test]
    fn wrap_modes_repeat_stay_or_run_back() {
        for k in -9..9 {
            assert_eq!(wrapped(k, 3, Wrap::Repeat) as i64, (k + 9) % 3);
            assert_eq!(wrapped(k, 3, Wrap::Clamp) as i64, k.clamp(0, 2));
        }
        let mirrored: Vec<usize> = (-4..8).map(|k| wrapped(k, 3, Wrap::Mirror)).collect();
        assert_eq!(mirrored, [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0, 1]);
    }
}
