//! The depth range that exactly stabilised maps share, held so that stored depths do not move with
//! the camera.

/// Factor by which a held range may exceed the needed one before it is replaced.
const MOST_EXCESS: f64 = 4.0;

/// Share of a needed range by which a new one exceeds it at either end, so that a walking camera
/// does not change it at once.
const ROOM: f64 = 0.25;

/// The held range of depths along the light, in metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct HeldDepths {
    held: Option<(f64, f64)>,
}

impl HeldDepths {
    /// A range that contains `near..far`; the previous one if it does.
    pub fn hold(&mut self, near: f64, far: f64) -> (f64, f64) {
        let serves =
            |held: &(f64, f64)| held.0 <= near && far <= held.1 && held.1 - held.0 <= MOST_EXCESS * (far - near);
        let room = ROOM * (far - near);
        let depths = self.held.filter(serves).unwrap_or((near - room, far + room));
        self.held = Some(depths);
        depths
    }
}

#[cfg(test)]
mod tests {
    use super::HeldDepths;

    #[test]
    fn a_depth_range_stays_while_it_serves() {
        let mut held = HeldDepths::default();
        let first = held.hold(0.0, 100.0);
        assert_eq!(first, (-25.0, 125.0));
        assert_eq!(held.hold(20.0, 120.0), first);
        assert_ne!(held.hold(30.0, 130.0), first, "outgrown");
        assert_eq!(held.hold(50.0, 60.0), (47.5, 62.5), "much too long");
    }
}
