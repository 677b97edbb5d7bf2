//! Contact shadows: detail for which maps are too coarse, from the image's own depth.

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, DVec3};

use crate::{Error, Result};

/// Options of the search for contact shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactOptions {
    /// Distance from a surface towards the light within which casters are searched, in metres.
    pub length_m: f32,
    /// Assumed thickness of visible surfaces in metres: a ray that passes farther than this behind
    /// a surface is not blocked by it.
    pub thickness_m: f32,
}

impl Default for ContactOptions {
    fn default() -> Self {
        Self { length_m: 0.3, thickness_m: 0.15 }
    }
}

impl ContactOptions {
    /// Checks every field.
    ///
    /// # Errors
    /// [`Error::InvalidFrameOption`] naming the first field that is wrong.
    pub fn validate(&self) -> Result<()> {
        for (field, value) in [("length_m", self.length_m), ("thickness_m", self.thickness_m)] {
            if !(value > 0.0 && value.is_finite()) {
                let value = f64::from(value);
                return Err(Error::InvalidFrameOption { field, value, expected: "finite metres above 0" });
            }
        }
        Ok(())
    }
}

/// The camera of one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactFrame {
    /// Matrix from positions relative to the camera, along the world's axes, to the clip space in
    /// which the depth was drawn. Any depth convention of a GPU, including reversed and infinite
    /// ones.
    pub clip_from_eye: DMat4,
    /// Position of the camera in world metres.
    pub eye: DVec3,
    /// Viewing direction of the camera, a unit vector.
    pub forward: DVec3,
    /// World point to which positions in the application's shaders are relative, as
    /// [`crate::FrameOptions::origin`].
    pub origin: DVec3,
    /// Height of the depth texture in pixels.
    pub height: u32,
}

/// `UmbrageContact` in `shaders/pass/contact.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
struct Uniform {
    clip_from_eye: [[f32; 4]; 4],
    eye_from_clip: [[f32; 4]; 4],
    eye: [f32; 3],
    length_m: f32,
    forward: [f32; 3],
    thickness_m: f32,
    pixel_m: f32,
    perspective: f32,
    _padding: [u32; 2],
}

impl Uniform {
    fn new(frame: &ContactFrame, options: &ContactOptions) -> Result<Self> {
        options.validate()?;
        let bad = |field, expected| Err(Error::InvalidFrameOption { field, value: f64::NAN, expected });
        let inverse = frame.clip_from_eye.inverse();
        if !(frame.clip_from_eye.is_finite() && inverse.is_finite()) {
            return bad("clip_from_eye", "a finite matrix that has an inverse");
        }
        if !((frame.eye - frame.origin).is_finite() && frame.forward.is_normalized()) {
            return bad("eye", "finite, with a unit vector for forward");
        }
        let perspective = frame.clip_from_eye.row(3).truncate().length() > 0.0;
        // What y of clip space grows by for a metre across the view, where w is 1.
        let up = frame.clip_from_eye.row(1).truncate().length();
        Ok(Self {
            clip_from_eye: frame.clip_from_eye.as_mat4().to_cols_array_2d(),
            eye_from_clip: inverse.as_mat4().to_cols_array_2d(),
            eye: (frame.eye - frame.origin).as_vec3().to_array(),
            length_m: options.length_m,
            forward: frame.forward.as_vec3().to_array(),
            thickness_m: options.thickness_m,
            pixel_m: (2.0 / (up * f64::from(frame.height.max(1)))) as f32,
            perspective: f32::from(u8::from(perspective)),
            _padding: [0; 2],
        })
    }
}

/// A uniform and a bind group layout for `umbrage_contact_visibility` ([`contact_wgsl`]). The
/// application draws its image's depth first, with one sample per pixel, into a texture that it can
/// bind as `texture_depth_2d`. Not available on GL and WebGL2, which cannot load from such a
/// texture.
#[derive(Debug)]
pub struct ContactShadows {
    uniform: wgpu::Buffer,
    layout: wgpu::BindGroupLayout,
}

impl ContactShadows {
    /// Creates the uniform and the layout.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let visibility = wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE;
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("ContactShadows::layout"),
            entries: &[
                entry(
                    0,
                    wgpu::BindingType::Buffer {
                        ty: wgpu::BufferBindingType::Uniform,
                        has_dynamic_offset: false,
                        min_binding_size: wgpu::BufferSize::new(size_of::<Uniform>() as u64),
                    },
                ),
                entry(
                    1,
                    wgpu::BindingType::Texture {
                        sample_type: wgpu::TextureSampleType::Depth,
                        view_dimension: wgpu::TextureViewDimension::D2,
                        multisampled: false,
                    },
                ),
            ],
        });
        let uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("ContactShadows::uniform"),
            size: size_of::<Uniform>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self { uniform, layout }
    }

    /// Writes a frame's camera to the GPU. Takes effect with the next submission to `queue`.
    ///
    /// # Errors
    /// [`Error::InvalidFrameOption`] naming the wrong field. Nothing has been written then.
    pub fn prepare(&self, queue: &wgpu::Queue, frame: &ContactFrame, options: &ContactOptions) -> Result<()> {
        queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&Uniform::new(frame, options)?));
        Ok(())
    }

    /// Layout of the bind group that [`contact_wgsl`] declares.
    #[must_use]
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// The bind group, with the depth of the image.
    #[must_use]
    pub fn bind_group(&self, device: &wgpu::Device, depth: &wgpu::TextureView) -> wgpu::BindGroup {
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("ContactShadows::bind_group"),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: self.uniform.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(depth) },
            ],
        })
    }
}

/// WGSL to put before a shader that computes contact shadows, with or without
/// [`crate::ShadowMaps::receiver_wgsl`]. `group` is the index at which the application binds
/// [`ContactShadows::bind_group`]. Multiply the result of `umbrage_contact_visibility(position,
/// normal, to_light, noise) -> f32` with the visibility from the maps, or take the minimum of both.
#[must_use]
pub fn contact_wgsl(group: u32) -> String {
    umbrage_shaders::contact(group)
}

#[cfg(test)]
mod tests {
    use umbrage::{Frustum, View};

    use super::*;

    fn frame(frustum: Frustum) -> ContactFrame {
        let view = View::look_at_upright(DVec3::new(1e5, 3.0, 9.0), DVec3::new(1e5, 0.0, 0.0), frustum).expect("valid");
        ContactFrame {
            clip_from_eye: view.clip_from_relative(view.eye()),
            eye: view.eye(),
            forward: view.forward(),
            origin: DVec3::new(1e5, 0.0, 0.0),
            height: 600,
        }
    }

    #[test]
    fn a_pixel_is_as_large_as_the_lens_says() {
        let perspective = frame(Frustum::perspective(1.0, 1.5, 0.1, f64::INFINITY).expect("valid"));
        let uniform = Uniform::new(&perspective, &ContactOptions::default()).expect("valid");
        assert!((f64::from(uniform.pixel_m) - 2.0 * 0.5_f64.tan() / 600.0).abs() < 1e-8);
        assert_eq!((uniform.perspective, uniform.eye), (1.0, [0.0, 3.0, 9.0]));
        let orthographic = frame(Frustum::orthographic(30.0, 20.0, 0.1, 100.0).expect("valid"));
        let uniform = Uniform::new(&orthographic, &ContactOptions::default()).expect("valid");
        assert!((f64::from(uniform.pixel_m) - 20.0 / 600.0).abs() < 1e-8);
        assert_eq!(uniform.perspective, 0.0);
    }

    #[test]
    fn what_cannot_be_used_is_named() {
        let good = frame(Frustum::perspective(1.0, 1.5, 0.1, 100.0).expect("valid"));
        let options = ContactOptions::default();
        let refused = |frame: ContactFrame, options: ContactOptions| match Uniform::new(&frame, &options) {
            Err(Error::InvalidFrameOption { field, .. }) => field,
            other => panic!("{other:?}"),
        };
        assert_eq!(refused(good, ContactOptions { length_m: 0.0, ..options }), "length_m");
        assert_eq!(refused(good, ContactOptions { thickness_m: f32::NAN, ..options }), "thickness_m");
        assert_eq!(refused(ContactFrame { clip_from_eye: DMat4::ZERO, ..good }, options), "clip_from_eye");
        assert_eq!(refused(ContactFrame { forward: DVec3::ZERO, ..good }, options), "eye");
    }
}
