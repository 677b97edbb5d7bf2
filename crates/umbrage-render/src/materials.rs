//! Textures, samplers and one bind group per material.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::mem::Discriminant;

use umbrage_scene::{AlphaMode, Material, Scene, Texture, TextureFilter, Wrap};
use wgpu::util::{BufferInitDescriptor, DeviceExt, TextureDataOrder};

use crate::mipmaps::{self, Alpha};
use crate::{Error, Gpu, Result, layouts};

/// Material parameters as the shaders see them, `Material` in `scene.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct MaterialUniform {
    /// Linear RGBA.
    pub base_color: [f32; 4],
    /// Linear RGB.
    pub emissive: [f32; 3],
    /// Least alpha that is drawn; 0 where alpha is not tested.
    pub alpha_cutoff: f32,
}

/// A material on the GPU.
#[derive(Clone)]
pub(crate) struct GpuMaterial {
    pub bind_group: wgpu::BindGroup,
    pub alpha: AlphaMode,
    pub double_sided: bool,
}

/// All materials of a scene and the layout that their bind groups share.
pub(crate) struct Materials {
    pub layout: wgpu::BindGroupLayout,
    pub list: Vec<GpuMaterial>,
    /// Bytes of all textures with their mip levels.
    pub bytes: u64,
}

impl Materials {
    /// Uploads every texture with its mipmaps and makes the bind groups.
    pub fn new(gpu: &Gpu, scene: &Scene) -> Result<Self> {
        let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("Materials::layout"),
            entries: &[
                layouts::fragment(
                    0,
                    wgpu::BindingType::Buffer {
                        ty: wgpu::BufferBindingType::Uniform,
                        has_dynamic_offset: false,
                        min_binding_size: wgpu::BufferSize::new(size_of::<MaterialUniform>() as u64),
                    },
                ),
                layouts::texture(1, wgpu::TextureSampleType::Float { filterable: true }),
                layouts::fragment(2, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)),
                layouts::fragment(3, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)),
                layouts::fragment(4, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)),
            ],
        });
        // Those too that no material names: a scene is right or it is not.
        for (index, texture) in scene.textures.iter().enumerate() {
            check_texture(gpu, index, texture)?;
        }
        let mut bytes = 0;
        // A texture's levels depend on what is made of its alpha. Few textures serve materials of
        // both kinds.
        let mut views = HashMap::new();
        for (index, material) in scene.materials.iter().enumerate() {
            let Some(of) = material.base_color_texture else { continue };
            let texture = scene.textures.get(of).ok_or_else(|| Error::Scene {
                what: "material",
                index,
                reason: format!("there is no texture {of}, only {}", scene.textures.len()),
            })?;
            if let Entry::Vacant(vacant) = views.entry((of, use_of_alpha(material))) {
                let (view, size) = upload_texture(gpu, texture, use_of_alpha(material));
                vacant.insert(view);
                bytes += size;
            }
        }
        let white =
            Texture { width: 1, height: 1, rgba: vec![255; 4], wrap: [Wrap::Repeat; 2], filter: TextureFilter::Linear };
        let (white_view, _) = upload_texture(gpu, &white, Alpha::Ignored);
        let mut shared = Shared::default();
        let list = scene
            .materials
            .iter()
            .map(|material| {
                let found = material.base_color_texture.and_then(|of| {
                    let view = views.get(&(of, use_of_alpha(material)))?;
                    Some((view, &scene.textures[of]))
                });
                let (view, texture) = found.unwrap_or((&white_view, &white));
                shared.material(gpu, &layout, material, (view, texture))
            })
            .collect();
        Ok(Self { layout, list, bytes })
    }
}

fn use_of_alpha(material: &Material) -> Alpha {
    match material.alpha {
        AlphaMode::Opaque => Alpha::Ignored,
        AlphaMode::Mask { .. } | AlphaMode::Blend => Alpha::Used,
    }
}

/// Refuses a texture without pixels, with the wrong number of bytes, or larger than the device
/// takes.
fn check_texture(gpu: &Gpu, index: usize, texture: &Texture) -> Result<()> {
    let (width, height) = (texture.width, texture.height);
    let limit = gpu.device.limits().max_texture_dimension_2d;
    if width == 0 || height == 0 || texture.rgba.len() as u64 != 4 * u64::from(width) * u64::from(height) {
        return Err(Error::Scene {
            what: "texture",
            index,
            reason: format!("{} bytes are not {width}x{height} pixels of four", texture.rgba.len()),
        });
    }
    if width > limit || height > limit {
        return Err(Error::TextureSize { index, width, height, limit });
    }
    Ok(())
}

fn upload_texture(gpu: &Gpu, texture: &Texture, alpha: Alpha) -> (wgpu::TextureView, u64) {
    let (width, height) = (texture.width, texture.height);
    let data = mipmaps::all_levels(texture, alpha).concat();
    let on_gpu = gpu.device.create_texture_with_data(
        &gpu.queue,
        &wgpu::TextureDescriptor {
            label: Some("Materials::base_color"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: mipmaps::level_count(width, height),
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8UnormSrgb,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        TextureDataOrder::LayerMajor,
        &data,
    );
    (on_gpu.create_view(&wgpu::TextureViewDescriptor::default()), data.len() as u64)
}

/// Key by which materials are told apart: the bits of the uniform, the alpha mode, the texture, and
/// the sides.
type Look = ([u32; 8], Discriminant<AlphaMode>, Option<usize>, bool);

/// Key by which samplers are told apart.
type Sampling = ([Wrap; 2], TextureFilter, u16);

/// Bind groups and samplers shared by equal materials. A file may have many equal materials.
#[derive(Default)]
struct Shared {
    materials: HashMap<Look, GpuMaterial>,
    samplers: HashMap<Sampling, Samplers>,
}

impl Shared {
    fn material(
        &mut self,
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        material: &Material,
        (view, texture): (&wgpu::TextureView, &Texture),
    ) -> GpuMaterial {
        let uniform = MaterialUniform {
            base_color: material.base_color,
            emissive: material.emissive,
            alpha_cutoff: if let AlphaMode::Mask { cutoff } = material.alpha { cutoff } else { 0.0 },
        };
        let mode = std::mem::discriminant(&material.alpha);
        let look = (bytemuck::cast(uniform), mode, material.base_color_texture, material.double_sided);
        if let Some(known) = self.materials.get(&look) {
            return known.clone();
        }
        let sampling = (texture.wrap, texture.filter, anisotropy(material, texture));
        let samplers = self.samplers.entry(sampling).or_insert_with(|| Samplers::new(gpu, sampling));
        let made = gpu_material(gpu, layout, (material, &uniform), view, samplers);
        self.materials.insert(look, made.clone());
        made
    }
}

/// Anisotropy of a texture's sampler: the most samples along the direction of foreshortening.
fn anisotropy(material: &Material, texture: &Texture) -> u16 {
    let is_plain = texture.width.max(texture.height) == 1;
    // WebGPU has no anisotropy with a nearest filter. One texel needs none. Leaves have none:
    // with it and a depth pass they cost several times as much (docs/notes/cost.md).
    match (texture.filter, material.alpha) {
        (TextureFilter::Nearest, _) | (_, AlphaMode::Mask { .. }) => 1,
        _ if is_plain => 1,
        (TextureFilter::Linear, _) => 8,
    }
}

/// Samplers of a texture: for colour, for the alpha test of a mask, and for the coverage of a
/// pixel.
struct Samplers {
    smooth: wgpu::Sampler,
    exact: wgpu::Sampler,
    coverage: wgpu::Sampler,
}

impl Samplers {
    fn new(gpu: &Gpu, (wrap, filter, anisotropy_clamp): Sampling) -> Self {
        let address = wrap.map(|wrap| match wrap {
            Wrap::Repeat => wgpu::AddressMode::Repeat,
            Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
            Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
        });
        let mag_filter = match filter {
            TextureFilter::Nearest => wgpu::FilterMode::Nearest,
            TextureFilter::Linear => wgpu::FilterMode::Linear,
        };
        let both = wgpu::SamplerDescriptor {
            address_mode_u: address[0],
            address_mode_v: address[1],
            mag_filter,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        };
        let sampler = |descriptor| gpu.device.create_sampler(&descriptor);
        Self {
            smooth: sampler(wgpu::SamplerDescriptor {
                label: Some("Materials::smooth_sampler"),
                mipmap_filter: wgpu::MipmapFilterMode::Linear,
                anisotropy_clamp,
                ..both.clone()
            }),
            coverage: sampler(wgpu::SamplerDescriptor {
                label: Some("Materials::coverage_sampler"),
                mipmap_filter: wgpu::MipmapFilterMode::Linear,
                ..both.clone()
            }),
            // The decision of a mask is the same at every distance, so one filter serves both.
            exact: sampler(wgpu::SamplerDescriptor {
                label: Some("Materials::exact_sampler"),
                min_filter: mag_filter,
                ..both
            }),
        }
    }
}

fn gpu_material(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    (material, uniform): (&Material, &MaterialUniform),
    view: &wgpu::TextureView,
    samplers: &Samplers,
) -> GpuMaterial {
    let buffer = gpu.device.create_buffer_init(&BufferInitDescriptor {
        label: Some("Materials::uniform"),
        contents: bytemuck::bytes_of(uniform),
        usage: wgpu::BufferUsages::UNIFORM,
    });
    let bind_group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("Materials::bind_group"),
        layout,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(view) },
            wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::Sampler(&samplers.smooth) },
            wgpu::BindGroupEntry { binding: 3, resource: wgpu::BindingResource::Sampler(&samplers.exact) },
            wgpu::BindGroupEntry { binding: 4, resource: wgpu::BindingResource::Sampler(&samplers.coverage) },
        ],
    });
    GpuMaterial { bind_group, alpha: material.alpha, double_sided: material.double_sided }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn equal_materials_are_one() {
        let Some(gpu) = crate::gpu::of_tests() else { return };
        let kinds = [
            Material::default(),
            Material { base_color: [0.5, 1.0, 1.0, 1.0], ..Material::default() },
            Material { double_sided: true, ..Material::default() },
            Material { alpha: AlphaMode::Blend, ..Material::default() },
        ];
        let named = |i: usize| Material { name: format!("material {i}"), ..kinds[i % kinds.len()].clone() };
        let scene = Scene { materials: (0..100_000).map(named).collect(), ..Scene::default() };
        let made = Materials::new(&gpu, &scene).expect("materials");
        #[expect(clippy::mutable_key_type, reason = "a bind group is hashed by its identity")]
        let groups: HashSet<&wgpu::BindGroup> = made.list.iter().map(|material| &material.bind_group).collect();
        assert_eq!((made.list.len(), groups.len()), (100_000, kinds.len()));
        assert!(made.list.iter().zip(&scene.materials).all(|(made, asked)| made.alpha == asked.alpha));
    }
}
