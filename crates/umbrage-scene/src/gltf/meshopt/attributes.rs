//! Mode 0: elements as differences of bytes, in groups of 16.

use super::Reader;

/// Number of elements in a group.
const GROUP: usize = 16;

/// Coding of the bytes of a group.
#[derive(Clone, Copy)]
enum Coding {
    Zeros,
    /// Numbers of so many bits. A number with all bits set is followed by a byte.
    Bits(u32),
    Bytes,
}

use Coding::{Bits, Bytes, Zeros};

/// Codings that the two header bits of a group choose from, in version 0 and in the control modes 0
/// and 1 of version 1.
const VERSION_0: [Coding; 4] = [Zeros, Bits(2), Bits(4), Bytes];
const CONTROL_0: [Coding; 4] = [Zeros, Bits(1), Bits(2), Bits(4)];
const CONTROL_1: [Coding; 4] = [Bits(1), Bits(2), Bits(4), Bytes];

/// Decodes `count` elements of `stride` bytes; `None` if the stream is invalid.
pub(super) fn decode(packed: &[u8], count: usize, stride: usize) -> Option<Vec<u8>> {
    let (&header, rest) = packed.split_first()?;
    let version = match header {
        0xa0 => 0,
        0xa1 => 1,
        _ => return None,
    };
    let modes = if version == 1 { stride / 4 } else { 0 };
    let least_tail = if version == 1 { 24 } else { 32 };
    let tail_length = stride + modes;
    let data_length = rest.len().checked_sub(tail_length.max(least_tail))?;
    let (data, tail) = rest.split_at(data_length);
    let tail = &tail[tail.len() - tail_length..];
    let (baseline, channels) = tail.split_at(stride);
    let mut last = baseline.to_vec();
    let mut reader = Reader { bytes: data };

    let block_elements = ((8192 / stride) & !(GROUP - 1)).min(256);
    let mut elements = Vec::with_capacity(count * stride);
    let mut differences = vec![0_u8; stride * block_elements];
    let mut remaining = count;
    while remaining > 0 {
        let block = remaining.min(block_elements);
        let groups = block.div_ceil(GROUP);
        let control = if version == 1 { reader.take(stride / 4)? } else { &[] };
        for byte in 0..stride {
            let out = &mut differences[byte * block_elements..][..groups * GROUP];
            let codings = match control.get(byte / 4).map(|packed| packed >> (2 * (byte % 4)) & 3) {
                None => VERSION_0,
                Some(0) => CONTROL_0,
                Some(1) => CONTROL_1,
                Some(2) => {
                    out.fill(0);
                    continue;
                }
                Some(_) => {
                    // Literal: as many as there are elements, without a header.
                    out[..block].copy_from_slice(reader.take(block)?);
                    continue;
                }
            };
            let headers = reader.take(groups.div_ceil(4))?;
            for (group, out) in out.chunks_exact_mut(GROUP).enumerate() {
                let coding = codings[usize::from(headers[group / 4] >> (2 * (group % 4)) & 3)];
                decode_group(&mut reader, coding, out)?;
            }
        }
        for element in 0..block {
            for channel in 0..stride / 4 {
                let packed = std::array::from_fn(|i| differences[(4 * channel + i) * block_elements + element]);
                let mode = channels.get(channel).copied().unwrap_or(0);
                let before: &mut [u8; 4] = last[4 * channel..].first_chunk_mut()?;
                *before = apply(*before, packed, mode)?;
                elements.extend_from_slice(before);
            }
        }
        remaining -= block;
    }
    reader.bytes.is_empty().then_some(elements)
}

/// Decodes the 16 bytes of a group.
fn decode_group(reader: &mut Reader<'_>, coding: Coding, out: &mut [u8]) -> Option<()> {
    let bits = match coding {
        Zeros => {
            out.fill(0);
            return Some(());
        }
        Bytes => {
            out.copy_from_slice(reader.take(GROUP)?);
            return Some(());
        }
        Bits(bits) => bits as usize,
    };
    let packed = reader.take(GROUP * bits / 8)?;
    let sentinel = (1_u8 << bits) - 1;
    for (i, out) in out.iter_mut().enumerate() {
        let byte = packed[i * bits / 8];
        let place = i * bits % 8;
        // Single bits start with the lowest, larger numbers with the highest ones.
        let shift = if bits == 1 { place } else { 8 - bits - place };
        *out = byte >> shift & sentinel;
        if *out == sentinel {
            *out = reader.byte()?;
        }
    }
    Some(())
}

/// Computes four bytes from those of the element before and their differences.
fn apply(before: [u8; 4], difference: [u8; 4], mode: u8) -> Option<[u8; 4]> {
    match (mode & 15, mode >> 4) {
        (0, 0) => {
            let unzigzag = |v: u8| (v >> 1) ^ (v & 1).wrapping_neg();
            Some(std::array::from_fn(|i| before[i].wrapping_add(unzigzag(difference[i]))))
        }
        (1, 0) => {
            let half = |bytes: [u8; 4], i: usize| u16::from_le_bytes([bytes[2 * i], bytes[2 * i + 1]]);
            let unzigzag = |v: u16| (v >> 1) ^ (v & 1).wrapping_neg();
            let [low, high] = [0, 1].map(|i| half(before, i).wrapping_add(unzigzag(half(difference, i))).to_le_bytes());
            Some([low[0], low[1], high[0], high[1]])
        }
        (2, rotation) => {
            // The specification gives the encoder's rotation, to the left.
            let difference = u32::from_le_bytes(difference).rotate_right(rotation.into());
            Some((u32::from_le_bytes(before) ^ difference).to_le_bytes())
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_example_of_the_specification() {
        let packed = [0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5];
        let mut out = [0; GROUP];
        let mut reader = Reader { bytes: &packed };
        assert_eq!(decode_group(&mut reader, Bits(4), &mut out), Some(()));
        let differences = out.map(|v| ((v >> 1) ^ (v & 1).wrapping_neg()).cast_signed());
        assert_eq!(differences, [-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0]);
        assert!(reader.bytes.is_empty());
    }

    #[test]
    fn single_bits_start_with_the_lowest() {
        let mut out = [9; GROUP];
        let mut reader = Reader { bytes: &[0b0000_0101, 0x80, 7, 8, 9] };
        assert_eq!(decode_group(&mut reader, Bits(1), &mut out), Some(()));
        assert_eq!(out, [7, 0, 8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 9]);
    }

    #[test]
    fn streams_that_are_none() {
        let whole: Vec<u8> = [0xa0, 0].into_iter().chain([0, 0, 0]).chain([0; 32]).collect();
        assert_eq!(decode(&whole, 3, 4), Some(vec![0; 12]));
        for wrong in [&whole[..20], &whole[1..], &[], &[0xa0]] {
            assert_eq!(decode(wrong, 3, 4), None);
        }
        let mut trailing = whole;
        trailing.insert(2, 0);
        assert_eq!(decode(&trailing, 3, 4), None, "a byte is left over");
    }
}
