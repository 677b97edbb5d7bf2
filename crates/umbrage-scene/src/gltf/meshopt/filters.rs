//! Filters that are applied to decoded elements.

/// Converts octahedral coordinates to unit vectors. The fourth component stays.
pub(super) fn octahedral(bytes: &mut [u8], stride: usize) {
    let decode = |[x, y, one]: [f32; 3], most: f32| {
        let (mut x, mut y) = (x / one, y / one);
        let z = 1.0 - x.abs() - y.abs();
        let fold = z.min(0.0);
        x -= fold.copysign(x);
        y -= fold.copysign(y);
        let length = (x * x + y * y + z * z).sqrt();
        [x, y, z].map(|c| (c / length * most).round())
    };
    if stride == 4 {
        for element in bytes.as_chunks_mut::<4>().0 {
            let [x, y, one, _] = element.map(|c| f32::from(c.cast_signed()));
            let unit = decode([x, y, one], 127.0);
            (0..3).for_each(|i| element[i] = (unit[i] as i8).cast_unsigned());
        }
    } else {
        for element in bytes.as_chunks_mut::<8>().0 {
            let [x, y, one, _] = shorts(element).map(f32::from);
            let unit = decode([x, y, one], 32_767.0);
            (0..3).for_each(|i| put(element, i, unit[i] as i16));
        }
    }
}

/// Converts three components and the number of the largest to unit quaternions.
pub(super) fn quaternion(bytes: &mut [u8]) {
    for element in bytes.as_chunks_mut::<8>().0 {
        let stored = shorts(element);
        let one = f32::from(stored[3] | 3);
        let [x, y, z] = [0, 1, 2].map(|i| f32::from(stored[i]) / one * std::f32::consts::FRAC_1_SQRT_2);
        let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
        let largest = usize::from(stored[3].cast_unsigned() & 3);
        for (i, component) in [w, x, y, z].into_iter().enumerate() {
            put(element, (largest + i) % 4, (component * 32_767.0).round() as i16);
        }
    }
}

/// Converts an exponent of 8 bits and a mantissa of 24, both signed, to floats.
pub(super) fn exponential(bytes: &mut [u8]) {
    for element in bytes.as_chunks_mut::<4>().0 {
        let stored = i32::from_le_bytes(*element);
        let (exponent, mantissa) = (stored >> 24, stored << 8 >> 8);
        // In f64, where neither the power nor the product is rounded.
        let value = f64::from(mantissa) * f64::from(exponent).exp2();
        *element = (value as f32).to_le_bytes();
    }
}

/// Converts Y, Co, Cg and alpha to colours. The highest bit of alpha tells the number of bits.
pub(super) fn color(bytes: &mut [u8], stride: usize) {
    if stride == 4 {
        for element in bytes.as_chunks_mut::<4>().0 {
            let [y, co, cg, alpha] = *element;
            let chroma = [co, cg].map(|c| i32::from(c.cast_signed()));
            *element = rgba(y.into(), chroma, alpha.into(), 255.0).map(|c| c as u8);
        }
    } else {
        for element in bytes.as_chunks_mut::<8>().0 {
            let [y, co, cg, alpha] = shorts(element);
            let unsigned = |c: i16| i32::from(c.cast_unsigned());
            let color = rgba(unsigned(y), [co, cg].map(i32::from), unsigned(alpha).cast_unsigned(), 65_535.0);
            (0..4).for_each(|i| put(element, i, (color[i] as u16).cast_signed()));
        }
    }
}

fn rgba(y: i32, [co, cg]: [i32; 2], alpha: u32, most: f32) -> [f32; 4] {
    // All bits up to the highest of alpha; an alpha of 0 is none that an encoder writes.
    let all = if alpha == 0 { 1 } else { (2 << alpha.ilog2()) - 1_u32 };
    let a = alpha & (all >> 1);
    let a = a << 1 | a & 1;
    let scale = most / all as f32;
    [y + co - cg, y + cg, y - co - cg, a.cast_signed()].map(|c| (c as f32 * scale).round())
}

fn shorts(element: &[u8; 8]) -> [i16; 4] {
    std::array::from_fn(|i| i16::from_le_bytes([element[2 * i], element[2 * i + 1]]))
}

fn put(element: &mut [u8; 8], i: usize, value: i16) {
    element[2 * i..2 * i + 2].copy_from_slice(&value.to_le_bytes());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_quaternions_floats_and_colours() {
        let mut up = [0_i8, 0, 127, 5].map(i8::cast_unsigned);
        octahedral(&mut up, 4);
        assert_eq!(up.map(u8::cast_signed), [0, 0, 127, 5]);
        // Octahedral (1, 1) of the lower half is straight down.
        let mut down: Vec<u8> = [511_i16, 511, 511, -1].iter().flat_map(|c| c.to_le_bytes()).collect();
        octahedral(&mut down, 8);
        assert_eq!(shorts(down.first_chunk().expect("eight bytes")), [0, 0, -32_767, -1]);

        // No rotation: the largest is the fourth, of 12 bits.
        let mut none: Vec<u8> = [0_i16, 0, 0, 2047].iter().flat_map(|c| c.to_le_bytes()).collect();
        quaternion(&mut none);
        assert_eq!(shorts(none.first_chunk().expect("eight bytes")), [0, 0, 0, 32_767]);

        let stored = |exponent: i32, mantissa: i32| (exponent << 24 | mantissa & 0xff_ffff).to_le_bytes();
        for (exponent, mantissa, value) in [(0, 7, 7.0), (-2, -3, -0.75), (10, 1, 1024.0), (-100, 1, 0.5_f32.powi(100))]
        {
            let mut bytes = stored(exponent, mantissa);
            exponential(&mut bytes);
            assert_eq!(f32::from_le_bytes(bytes), value);
        }

        // Grey of 8 bits, opaque: 255 in 8 bits is 127 with the highest bit set.
        let mut grey = [100, 0, 0, 255];
        color(&mut grey, 4);
        assert_eq!(grey, [100, 100, 100, 255]);
    }
}
