//! Planes that several cameras share.

/// Writes planes in Bevy's view depths for cameras whose own planes are given with their standoff.
///
/// Each inner plane is the geometric mean of the cameras' own ones: the ratio by which slices are
/// longer than their camera would have them is then spread evenly. Where a depth is not above 0, as
/// an orthographic camera may have it, it is the arithmetic mean. The range is that of all.
pub(crate) fn planes<'a>(own: impl Iterator<Item = (&'a [f64], f64)> + Clone, planes: &mut Vec<f64>) {
    planes.clear();
    let count = own.clone().map(|(planes, _)| planes.len()).min().unwrap_or_default();
    for i in 0..count {
        let depths = own.clone().map(|(planes, standoff)| planes[i] - standoff);
        let number = own.clone().count() as f64;
        let plane = if i == 0 {
            depths.fold(f64::INFINITY, f64::min)
        } else if i + 1 == count {
            depths.fold(f64::NEG_INFINITY, f64::max)
        } else if depths.clone().all(|depth| depth > 0.0) {
            (depths.map(f64::ln).sum::<f64>() / number).exp()
        } else {
            depths.sum::<f64>() / number
        };
        planes.push(plane);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(own: &[(&[f64], f64)]) -> Vec<f64> {
        let mut written = vec![7.0];
        planes(own.iter().copied(), &mut written);
        written
    }

    #[test]
    fn planes_of_one_camera_are_its_own() {
        let written = of(&[(&[1.0, 4.0, 50.0], 0.0)]);
        assert!(written.iter().zip([1.0, 4.0, 50.0]).all(|(a, b)| (a - b).abs() < 1e-12), "{written:?}");
    }

    #[test]
    fn planes_are_between_those_of_the_cameras_and_rise() {
        let written = of(&[(&[1.0, 4.0, 9.0, 50.0], 0.0), (&[20.0, 21.0, 36.0, 400.0], 5.0)]);
        assert_eq!([written[0], written[3]], [1.0, 395.0]);
        assert!((written[1] - 8.0).abs() < 1e-12, "{written:?}");
        assert!(written.is_sorted_by(|a, b| a < b), "{written:?}");
        let behind = of(&[(&[1.0, 4.0, 9.0], 10.0), (&[1.0, 2.0, 9.0], 0.0)]);
        assert_eq!(behind, [-9.0, -2.0, 9.0]);
    }
}
