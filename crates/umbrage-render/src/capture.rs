//! Reading textures back from the GPU.

use crate::{Error, Gpu, Result, waiting};

/// A texture being read back. The copy is recorded; its bytes can be read once the commands have
/// run.
pub(crate) struct Capture {
    buffer: wgpu::Buffer,
    row_bytes: usize,
    padded_row_bytes: usize,
}

impl Capture {
    /// Records the copy of the upper left `size` pixels of a layer.
    pub fn record(
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        texture: &wgpu::Texture,
        layer: u32,
        size: [u32; 2],
    ) -> Result<Self> {
        let aspect =
            if texture.format().has_depth_aspect() { wgpu::TextureAspect::DepthOnly } else { wgpu::TextureAspect::All };
        let pixel_bytes =
            texture.format().block_copy_size(Some(aspect)).expect("pictures and depth have pixels of a fixed size");
        let row_bytes = size[0] * pixel_bytes;
        let padded_row_bytes = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let bytes = u64::from(padded_row_bytes) * u64::from(size[1]);
        gpu.check_buffer("the pixels", bytes)?;
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("Capture::buffer"),
            size: bytes,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        encoder.copy_texture_to_buffer(
            wgpu::TexelCopyTextureInfo {
                texture,
                mip_level: 0,
                origin: wgpu::Origin3d { x: 0, y: 0, z: layer },
                aspect,
            },
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded_row_bytes),
                    rows_per_image: Some(size[1]),
                },
            },
            wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        );
        Ok(Self { buffer, row_bytes: row_bytes as usize, padded_row_bytes: padded_row_bytes as usize })
    }

    /// Waits for the commands and returns the rows without their padding.
    pub async fn read(self, gpu: &Gpu) -> Result<Vec<u8>> {
        let padded = read_buffer(gpu, &self.buffer).await?;
        if self.row_bytes == self.padded_row_bytes {
            return Ok(padded);
        }
        Ok(padded.chunks(self.padded_row_bytes).flat_map(|row| &row[..self.row_bytes]).copied().collect())
    }
}

impl Gpu {
    /// Reads the pixels of a texture, row after row, once all submitted commands have run.
    ///
    /// # Errors
    /// [`Error::BufferSize`] or [`Error::Device`] if they cannot be read back.
    pub async fn pixels(&self, texture: &wgpu::Texture) -> Result<Vec<u8>> {
        let size = [texture.width(), texture.height()];
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("pixels") });
        let capture = Capture::record(self, &mut encoder, texture, 0, size)?;
        self.queue.submit([encoder.finish()]);
        capture.read(self).await
    }
}

/// Waits until everything submitted has run, and returns a mappable buffer's content.
pub(crate) async fn read_buffer(gpu: &Gpu, buffer: &wgpu::Buffer) -> Result<Vec<u8>> {
    waiting::mapped(gpu, buffer).await?;
    let unread = |message: String| Error::Device { during: waiting::READING, message };
    let bytes = buffer.get_mapped_range(..).map_err(|error| unread(error.to_string()))?.to_vec();
    buffer.unmap();
    Ok(bytes)
}
