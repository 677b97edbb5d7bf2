//! Pictures that take the first light's shadows from a mask.
//!
//! A forward picture asks for shadows once per fragment, and fragments are run for whole blocks of
//! pixels: where triangles are small, several times per pixel. A mask asks once per pixel, or once
//! per surface of a pixel.

mod g_buffer;
mod per_pixel;

use umbrage::config::{Coordinates, Edges, Layout};
use umbrage_wgpu::{MaskFrame, MaskNormals, ShadowMask, Shadows};

pub(crate) use self::g_buffer::GBuffer;
pub(crate) use self::per_pixel::PerPixel;
use crate::contact::Contact;
use crate::draw_list::{Drawable, Drawn};
use crate::formats::{LIT_FORMAT, MARK_FORMAT};
use crate::forward::{Bindings, Forward, Samples, Shading};
use crate::materials::Materials;
use crate::targets::PictureTarget;
use crate::view_list::ViewList;
use crate::{Gpu, Result};

/// Most pixels of a picture with several samples: a G-buffer of more than half a gigabyte costs
/// more than it saves.
const MOST_PIXELS: u64 = 1 << 22;

/// Pipelines, and the textures that they draw to.
pub(crate) enum ThroughMask {
    /// One sample per pixel.
    PerPixel(Box<PerPixel>),
    /// Several samples per pixel.
    GBuffer(Box<GBuffer>),
}

/// Whether pictures can take the first light's shadows from a mask and lose nothing by it: one
/// light, and nothing that a pixel's neighbours or vertices have to tell.
///
/// Pictures of several samples go through a G-buffer on software drivers alone. Those run the whole
/// shader for hidden fragments of such pictures, and for every block of pixels that a triangle
/// touches. A GPU does neither, and is kept busier by the G-buffer's memory.
pub(crate) fn suits(
    gpu: &Gpu,
    shadows: &Shadows,
    size: [u32; 2],
    (samples, contact, shading): (Samples, Option<&Contact>, Shading),
) -> bool {
    let (config, maps) = (shadows.config(), shadows.maps());
    let fits = size.map(u64::from).iter().product::<u64>() <= MOST_PIXELS;
    shading == Shading::WithShadows
        && (samples == Samples::One || is_software(gpu) && fits)
        && contact.is_none()
        && gpu.depth_loads()
        && shadows.lights().len() == 1
        && maps.layout() != Layout::Reused
        && maps.edges() == Edges::Sampled
        && config.coordinates != Coordinates::Vertex
        && !config.filter.is_prefiltered()
}

/// Software drivers run what a branch leaves out.
fn is_software(gpu: &Gpu) -> bool {
    gpu.adapter_info.device_type == wgpu::DeviceType::Cpu
}

impl ThroughMask {
    /// # Errors
    /// [`crate::Error::Shadows`] if the device cannot make a mask.
    pub fn new(
        gpu: &Gpu,
        shadows: &Shadows,
        (forward, materials): (&Forward, &Materials),
        samples: Samples,
    ) -> Result<Self> {
        Ok(match samples {
            Samples::One => Self::PerPixel(Box::new(PerPixel::new(gpu, shadows, forward, materials)?)),
            Samples::Four => Self::GBuffer(Box::new(GBuffer::new(gpu, shadows, (forward, materials), samples)?)),
        })
    }

    /// Hands the frame's camera over, and makes what is drawn to for pictures of this size.
    ///
    /// # Errors
    /// [`crate::Error::Shadows`] if the camera has no inverse.
    pub fn prepare(&mut self, gpu: &Gpu, frame: &MaskFrame, size: [u32; 2], picture: &PictureTarget) -> Result<()> {
        match self {
            Self::PerPixel(through) => through.prepare(gpu, frame, size, picture),
            Self::GBuffer(through) => through.prepare(gpu, frame, size),
        }
    }

    /// Lets go of what belongs to a picture that is made anew.
    pub fn forget_picture(&mut self) {
        match self {
            Self::PerPixel(through) => through.forget_picture(),
            Self::GBuffer(through) => through.forget_picture(),
        }
    }

    /// Draws everything solid in a pass that has its depth.
    pub fn draw_solid(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        bindings: Bindings<'_>,
        drawable: &Drawable<'_>,
        solid: &ViewList,
    ) -> Drawn {
        match self {
            Self::PerPixel(through) => through.draw_solid(pass, bindings, drawable, solid),
            Self::GBuffer(through) => through.draw_shown(pass, bindings),
        }
    }
}

/// The mask of a device, and whether it takes two draws: on a GPU one is less work.
fn mask(gpu: &Gpu, shadows: &Shadows) -> Result<(ShadowMask, bool)> {
    // Bent normals may be turned away from the eye.
    let (device, maps, normals) = (&gpu.device, shadows.maps(), MaskNormals::TextureAsIs);
    let in_two_draws = is_software(gpu);
    let mask = match in_two_draws {
        true => ShadowMask::in_two_draws(device, maps, LIT_FORMAT, normals, MARK_FORMAT)?,
        false => ShadowMask::new(device, maps, LIT_FORMAT, normals)?,
    };
    Ok((mask, in_two_draws))
}
