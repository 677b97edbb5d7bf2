//! What lies inside the unit square: lines and polygons cut at the edges of their frame.

/// Room for rounding, so that what lies on the frame itself is not cut.
const SLACK: f64 = 1e-9;

/// The parts of a line that lie inside the unit square; NaN breaks it.
pub(super) fn line(points: &[(f64, f64)]) -> Vec<Vec<(f64, f64)>> {
    let mut pieces: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut open = false;
    for pair in points.windows(2) {
        match segment(pair[0], pair[1]) {
            Some((from, to)) => {
                match pieces.last_mut() {
                    Some(piece) if open && piece.last() == Some(&from) => piece.push(to),
                    _ => pieces.push(vec![from, to]),
                }
                open = to == pair[1];
            }
            None => open = false,
        }
    }
    pieces
}

/// The part of a segment inside the unit square (Liang and Barsky). `None`: nothing is.
fn segment((x0, y0): (f64, f64), (x1, y1): (f64, f64)) -> Option<((f64, f64), (f64, f64))> {
    if [x0, y0, x1, y1].iter().any(|v| v.is_nan()) {
        return None;
    }
    let (lo, hi) = (-SLACK, 1.0 + SLACK);
    let (mut from, mut to) = (0.0, 1.0);
    for (start, step) in [(x0, x1 - x0), (y0, y1 - y0)] {
        if step == 0.0 {
            if !(lo..=hi).contains(&start) {
                return None;
            }
            continue;
        }
        let (a, b) = ((lo - start) / step, (hi - start) / step);
        from = f64::max(from, a.min(b));
        to = f64::min(to, a.max(b));
    }
    if from > to {
        return None;
    }
    let at = |t: f64| match t {
        0.0 => (x0, y0),
        1.0 => (x1, y1),
        t => (x0 + t * (x1 - x0), y0 + t * (y1 - y0)),
    };
    Some((at(from), at(to)))
}

/// The part of a polygon inside the unit square (Sutherland and Hodgman); empty if nothing is.
pub(super) fn polygon(corners: &[(f64, f64)]) -> Vec<(f64, f64)> {
    // Distance inside each of the four edges.
    let edges: [fn((f64, f64)) -> f64; 4] = [|p| p.0, |p| 1.0 - p.0, |p| p.1, |p| 1.0 - p.1];
    let mut ring = corners.to_vec();
    for inside in edges {
        let mut kept = Vec::with_capacity(ring.len() + 2);
        for (k, &b) in ring.iter().enumerate() {
            let a = ring[(k + ring.len() - 1) % ring.len()];
            let (da, db) = (inside(a), inside(b));
            if (da < 0.0) != (db < 0.0) {
                let t = da / (da - db);
                kept.push((a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1)));
            }
            if db >= 0.0 {
                kept.push(b);
            }
        }
        ring = kept;
    }
    ring
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_outside_its_frame_is_cut_at_it() {
        let pieces = line(&[(-1.0, 0.5), (2.0, 0.5)]);
        assert_eq!(pieces.len(), 1);
        assert!(pieces[0][0].0.abs() < 1e-6 && (pieces[0][1].0 - 1.0).abs() < 1e-6, "{pieces:?}");
        assert!(line(&[(-1.0, 2.0), (2.0, 2.0)]).is_empty());
        assert!(line(&[(-1.0, 0.5), (0.4, 2.0)]).is_empty(), "it passes the corner outside");
    }

    #[test]
    fn nan_breaks_a_line_and_a_corner_outside_does_too() {
        assert_eq!(line(&[(0.1, 0.1), (0.2, 0.2), (f64::NAN, 0.3), (0.4, 0.4), (0.5, 0.5)]).len(), 2);
        assert_eq!(line(&[(0.1, 0.5), (0.5, 1.5), (0.9, 0.5)]).len(), 2);
        assert_eq!(line(&[(0.1, 0.5), (0.5, 1.0), (0.9, 0.5)]).len(), 1);
    }

    #[test]
    fn a_polygon_is_cut_to_its_frame() {
        let area = |ring: &[(f64, f64)]| {
            let pairs = ring.iter().zip(ring.iter().cycle().skip(1));
            0.5 * pairs.map(|(a, b)| a.0 * b.1 - b.0 * a.1).sum::<f64>().abs()
        };
        let inside = [(0.2, 0.2), (0.8, 0.2), (0.5, 0.9)];
        assert_eq!(polygon(&inside), inside);
        let around = [(-1.0, -1.0), (3.0, -1.0), (3.0, 3.0), (-1.0, 3.0)];
        assert!((area(&polygon(&around)) - 1.0).abs() < 1e-12);
        let half = [(-1.0, 0.0), (0.5, 0.0), (0.5, 1.0), (-1.0, 1.0)];
        assert!((area(&polygon(&half)) - 0.5).abs() < 1e-12);
        assert!(polygon(&[(2.0, 0.0), (3.0, 0.0), (3.0, 1.0)]).is_empty());
        assert!(polygon(&[]).is_empty());
    }
}
