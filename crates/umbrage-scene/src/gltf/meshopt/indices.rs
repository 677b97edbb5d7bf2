//! Modes 1 and 2: lists of triangles, which share edges, and other indices.

use super::Reader;

/// Ring of the last sixteen values, most recent first.
struct Recent<T> {
    entries: [Option<T>; 16],
    /// Slot of the next value.
    next: usize,
}

impl<T: Copy> Recent<T> {
    const fn new() -> Self {
        Self { entries: [None; 16], next: 0 }
    }

    fn push(&mut self, entry: T) {
        self.entries[self.next] = Some(entry);
        self.next = (self.next + 1) % 16;
    }

    /// Returns the value `back` places ago; `None` if there have not been as many.
    fn get(&self, back: u8) -> Option<T> {
        self.entries[(self.next + 15 - usize::from(back)) % 16]
    }
}

/// State while indices are read.
struct Indices<'b> {
    data: Reader<'b>,
    /// The next index that is new.
    next: u32,
    /// The last index that was stored explicitly.
    last: u32,
    vertices: Recent<u32>,
}

impl Indices<'_> {
    fn new_index(&mut self) -> u32 {
        let index = self.next;
        self.next = self.next.wrapping_add(1);
        index
    }

    fn explicit(&mut self) -> Option<u32> {
        let v = variable_length(&mut self.data)?;
        self.last = self.last.wrapping_add((v >> 1) ^ (v & 1).wrapping_neg());
        Some(self.last)
    }

    /// Reads an index by a code of four bits: 0 is new, 15 is explicit, others are recent.
    fn coded(&mut self, code: u8) -> Option<u32> {
        match code {
            0 => Some(self.new_index()),
            15 => self.explicit(),
            back => self.vertices.get(back - 1),
        }
    }
}

/// Reads unsigned LEB128 of at most five bytes.
fn variable_length(data: &mut Reader<'_>) -> Option<u32> {
    let mut value = 0_u32;
    for shift in [0, 7, 14, 21, 28] {
        let byte = data.byte()?;
        value |= u32::from(byte & 0x7f) << shift;
        if byte < 0x80 {
            return Some(value);
        }
    }
    None
}

/// Decodes the indices of a list of triangles; `None` if the stream is invalid.
pub(super) fn triangles(packed: &[u8], count: usize) -> Option<Vec<u32>> {
    let rest = packed.strip_prefix(&[0xe1])?;
    let (codes, rest) = rest.split_at_checked(count / 3)?;
    let (data, table) = rest.split_at_checked(rest.len().checked_sub(16)?)?;
    let mut state = Indices { data: Reader { bytes: data }, next: 0, last: 0, vertices: Recent::new() };
    let mut edges: Recent<(u32, u32)> = Recent::new();
    let mut indices = Vec::with_capacity(count);
    for &code in codes {
        let (high, low) = (code >> 4, code & 15);
        let [a, b, c] = if high < 15 {
            let (a, b) = edges.get(high)?;
            let c = match low {
                13 | 14 => {
                    state.last = if low == 13 { state.last.wrapping_sub(1) } else { state.last.wrapping_add(1) };
                    state.last
                }
                0 => state.new_index(),
                15 => state.explicit()?,
                // Here 0 is the most recent, which is never meant.
                back => state.vertices.get(back)?,
            };
            if low == 0 || low >= 13 {
                state.vertices.push(c);
            }
            [a, b, c]
        } else {
            let (a_is_new, rest) = match low {
                14 | 15 => (low == 14, state.data.byte()?),
                from_table => (true, *table.get(usize::from(from_table))?),
            };
            if low >= 14 && rest == 0 {
                state.next = 0;
            }
            let (z, w) = (rest >> 4, rest & 15);
            if low < 14 && (z == 15 || w == 15) {
                return None;
            }
            let a = if a_is_new { state.new_index() } else { state.explicit()? };
            let b = state.coded(z)?;
            let c = state.coded(w)?;
            state.vertices.push(a);
            if z == 0 || z == 15 {
                state.vertices.push(b);
            }
            if w == 0 || w == 15 {
                state.vertices.push(c);
            }
            edges.push((b, a));
            [a, b, c]
        };
        edges.push((c, b));
        edges.push((a, c));
        indices.extend([a, b, c]);
    }
    state.data.bytes.is_empty().then_some(indices)
}

/// Decodes a sequence of indices; `None` if the stream is invalid.
pub(super) fn sequence(packed: &[u8], count: usize) -> Option<Vec<u32>> {
    const TAIL: usize = 4;
    let rest = packed.strip_prefix(&[0xd1])?;
    let mut data = Reader { bytes: rest.get(..rest.len().checked_sub(TAIL)?)? };
    let mut last = [0_u32; 2];
    // A byte makes one index at least.
    let mut indices = Vec::with_capacity(count.min(data.bytes.len()));
    for _ in 0..count {
        let v = variable_length(&mut data)?;
        let last = &mut last[(v & 1) as usize];
        let difference = if v & 2 == 0 { v >> 2 } else { !(v >> 2) };
        *last = last.wrapping_add(difference);
        indices.push(*last);
    }
    data.bytes.is_empty().then_some(indices)
}

/// Returns little-endian bytes, two or four for each index.
pub(super) fn bytes(indices: &[u32], stride: usize) -> Vec<u8> {
    if stride == 2 {
        indices.iter().flat_map(|&index| (index as u16).to_le_bytes()).collect()
    } else {
        indices.iter().flat_map(|&index| index.to_le_bytes()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variable_lengths_of_the_specification() {
        for (bytes, value) in [(&[0x7f][..], 0x7f), (&[0x81, 0x04], 0x201), (&[0xff, 0xa0, 0x05], 0x1_507f)] {
            assert_eq!(variable_length(&mut Reader { bytes }), Some(value));
        }
        assert_eq!(variable_length(&mut Reader { bytes: &[0x80, 0x80] }), None);
        assert_eq!(variable_length(&mut Reader { bytes: &[0x80; 6] }), None);
    }

    #[test]
    fn a_strip_of_three_triangles() {
        // Three new corners, then twice an edge and a new one; the first code takes entry 0 of the
        // table, which is 0x00.
        let packed: Vec<u8> = [0xe1, 0xf0, 0x10, 0x10].into_iter().chain([0; 16]).collect();
        // Edges are pushed (b, a), (c, b), (a, c): back 1 is (c, b).
        assert_eq!(triangles(&packed, 9), Some(vec![0, 1, 2, 2, 1, 3, 3, 1, 4]));
        assert_eq!(triangles(&packed[..packed.len() - 1], 9), None);
        assert_eq!(triangles(&[0xe1, 0x00].into_iter().chain([0; 16]).collect::<Vec<u8>>(), 3), None, "no edge yet");
    }

    #[test]
    fn two_baselines() {
        // 5 by the first, 9 by the second, 6 by the first, 8 by the second.
        let packed = [0xd1, 5 << 2, 9 << 2 | 1, 1 << 2, 0b11, 0, 0, 0, 0];
        assert_eq!(sequence(&packed, 4), Some(vec![5, 9, 6, 8]));
        assert_eq!(sequence(&packed, 3), None, "a byte is left over");
        assert_eq!(sequence(&packed, 5), None);
    }
}
