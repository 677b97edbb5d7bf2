//! Textures that materials use: the picture of each, and the largest size that the budget allows.

use std::collections::{BTreeMap, HashMap};

use gltf::json::texture::{MagFilter, WrappingMode};
use gltf::json::validation::Checked;

use super::Document;
use super::images::Image;
use crate::error::element;
use crate::picture::MOST_PIXELS_AN_EDGE;
use crate::{Result, Texture, TextureFilter, Wrap};

/// Bytes of textures that every file may have, and bytes for each byte of its encoded pictures.
/// Ours: photographs take up to some 40 bytes a byte on the whole. A picture that takes more is so
/// plain that it loses little by being smaller.
const BYTES_OF_EVERY_FILE: u64 = 128 << 20;
const BYTES_PER_ENCODED_BYTE: u64 = 40;

/// Extensions that name another picture in a texture besides the texture's own.
const SOURCES: [&str; 2] = ["EXT_texture_webp", "KHR_texture_basisu"];

/// Wrap modes and filter of a texture.
type Sampling = ([Wrap; 2], TextureFilter);

/// A texture of the file that is wanted.
struct Wish {
    sampling: Sampling,
    image: Result<Image>,
}

/// Textures of a scene, and the results of loading those of the file.
#[derive(Default)]
pub(super) struct Textures {
    pub(super) list: Vec<Texture>,
    /// Result for each index in the file: an index into `list`, or the reason why there is none.
    pub(super) places: BTreeMap<usize, Result<usize>>,
}

impl Textures {
    /// Loads the textures with these indices in the file. `users` are the names of the elements
    /// that use them. Unreadable pictures are no error here: the user of a texture decides.
    pub(super) fn load(document: &Document<'_>, users: &BTreeMap<usize, String>) -> Result<Self> {
        let mut wishes = BTreeMap::new();
        for (&index, user) in users {
            wishes.insert(index, wish(document, index, user)?);
        }
        let fit = Fit::of(document, &wishes);
        let mut textures = Self::default();
        // The same picture with the same sampling is stored once.
        let mut known = HashMap::new();
        for (index, Wish { sampling, image }) in wishes {
            let place = match image {
                Ok(image) => match known.get(&(image.index, sampling)) {
                    Some(&place) => Ok(place),
                    None => textures.add(document, &image, sampling, &fit).inspect(|&place| {
                        known.insert((image.index, sampling), place);
                    }),
                },
                Err(error) => Err(error),
            };
            textures.places.insert(index, place);
        }
        Ok(textures)
    }

    fn add(&mut self, document: &Document<'_>, image: &Image, sampling: Sampling, fit: &Fit) -> Result<usize> {
        let halvings = image.halvings(fit.longest_edge);
        let pixels = image.decode(document, halvings)?;
        let ((wrap, filter), (width, height)) = (sampling, pixels.dimensions());
        if halvings > 0 {
            let [from_width, from_height] = image.size;
            document.notes.add(
                &image.element,
                format!(
                    "scaled from {from_width}×{from_height} to {width}×{height} pixels: the textures of this file may take \
                     {} MiB",
                    fit.budget >> 20
                ),
            );
        }
        self.list.push(Texture { width, height, rgba: pixels.into_raw(), wrap, filter });
        Ok(self.list.len() - 1)
    }
}

/// Size limit by which all textures of a file fit into the budget.
struct Fit {
    budget: u64,
    /// Longest edge of a picture in pixels. Longer edges are halved, so only the largest pictures
    /// lose pixels.
    longest_edge: u32,
}

impl Fit {
    fn of(document: &Document<'_>, wishes: &BTreeMap<usize, Wish>) -> Self {
        let mut images: HashMap<(usize, Sampling), &Image> = HashMap::new();
        for wish in wishes.values() {
            if let Ok(image) = &wish.image {
                images.insert((image.index, wish.sampling), image);
            }
        }
        let encoded: u64 = images.values().map(|image| image.encoded).sum();
        let for_content = encoded.saturating_mul(BYTES_PER_ENCODED_BYTE).saturating_add(BYTES_OF_EVERY_FILE);
        let budget = document.options.texture_bytes.min(for_content);
        let bytes = |longest_edge: u32| -> u64 {
            images.values().map(|image| image.pixel_bytes(image.halvings(longest_edge))).sum()
        };
        let mut longest_edge = MOST_PIXELS_AN_EDGE;
        while longest_edge > 1 && bytes(longest_edge) > budget {
            longest_edge /= 2;
        }
        Self { budget, longest_edge }
    }
}

/// Returns the sampling of a texture and its first picture with a readable header.
fn wish(document: &Document<'_>, index: usize, user: &str) -> Result<Wish> {
    let texture = document.get(&document.root.textures, index, "textures", user)?;
    let user = element("textures", index, texture.name.as_deref().unwrap_or_default());
    let sampling = match texture.sampler {
        Some(sampler) => {
            let sampler = document.get(&document.root.samplers, sampler.value(), "samplers", &user)?;
            let wrap = |mode| match mode {
                Checked::Valid(WrappingMode::Repeat) => Ok(Wrap::Repeat),
                Checked::Valid(WrappingMode::ClampToEdge) => Ok(Wrap::Clamp),
                Checked::Valid(WrappingMode::MirroredRepeat) => Ok(Wrap::Mirror),
                Checked::Invalid => Err(document.invalid(user.as_str(), "has an unknown wrapping mode")),
            };
            let filter = match sampler.mag_filter {
                Some(Checked::Valid(MagFilter::Nearest)) => TextureFilter::Nearest,
                _ => TextureFilter::Linear,
            };
            ([wrap(sampler.wrap_s)?, wrap(sampler.wrap_t)?], filter)
        }
        None => Sampling::default(),
    };
    // The `gltf` crate's way of saying that there is no `source`.
    let own = Some(texture.source.value()).filter(|&source| source != u32::MAX as usize);
    let extension = |name: &&str| texture.extensions.as_ref()?.others.get(*name)?.get("source")?.as_u64();
    let others = SOURCES.iter().filter_map(extension).filter_map(|source| usize::try_from(source).ok());
    let mut image = Err(document.invalid(user.as_str(), "has no picture of a kind that is read"));
    for source in own.into_iter().chain(others) {
        image = Image::open(document, source, &user);
        if image.is_ok() {
            break;
        }
    }
    Ok(Wish { sampling, image })
}
