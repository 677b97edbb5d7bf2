//! How often optimal planes are searched for.

use super::ends::Range;
use crate::View;

/// Frames of a camera that moves from one search to the next. A search looks at all casters in view
/// and at a thousand slices, most of a plan's time, and seldom finds planes that are worth moving
/// to. With more frames planes follow later, with fewer a plan takes longer on average.
const FRAMES: u32 = 8;

/// Cosine of the angle by which the camera turns at most from one search to the next: 15 degrees.
const MOST_TURN: f64 = 0.966;

/// The last search for planes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Search {
    view: View,
    range: Range,
    /// Frames since then.
    frames: u32,
    /// View of the last frame.
    last: View,
}

/// Decides in which frames planes are searched for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Pace(Option<Search>);

impl Pace {
    /// Returns whether planes are to be searched for in the frame of this view and range, and
    /// counts the frame. `reach` is the depth of the first plane in metres: a camera that has moved
    /// so far since the last search sees something else.
    ///
    /// A camera that stands still asks for a search in each frame in which a plan is made at all,
    /// as what is held must not depend on how long it has stood.
    pub fn is_due(&mut self, view: &View, range: Range, reach: f64) -> bool {
        let waits = self.0.filter(|search| {
            search.range == range
                && search.frames + 1 < FRAMES
                && search.last != *view
                && search.view.frustum() == view.frustum()
                && search.view.forward().dot(view.forward()) > MOST_TURN
                && search.view.eye().distance(view.eye()) < reach.abs()
        });
        self.0 = Some(match waits {
            Some(search) => Search { frames: search.frames + 1, last: *view, ..search },
            None => Search { view: *view, range, frames: 0, last: *view },
        });
        waits.is_none()
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::Frustum;

    fn view(along: f64, yaw: f64) -> View {
        let eye = DVec3::new(along, 2.0, 0.0);
        let lens = Frustum::perspective(1.0, 1.5, 0.1, 100.0).expect("a lens");
        View::look_at_upright(eye, eye + DVec3::new(yaw.sin(), 0.0, -yaw.cos()), lens).expect("a view")
    }

    #[test]
    fn a_walk_searches_now_and_then_and_a_jump_at_once() {
        let (mut pace, range) = (Pace::default(), Range::new(0.1, 100.0));
        let searched: Vec<u32> =
            (0..20).filter(|&i| pace.is_due(&view(0.02 * f64::from(i), 0.0), range, 5.0)).collect();
        assert_eq!(searched, [0, 8, 16]);
        assert!(pace.is_due(&view(20.0, 0.0), range, 5.0), "a jump");
        assert!(!pace.is_due(&view(20.02, 0.1), range, 5.0));
        assert!(pace.is_due(&view(20.04, 0.4), range, 5.0), "a turn");
        assert!(pace.is_due(&view(20.06, 0.4), Range::new(0.1, 120.0), 5.0), "another range");
    }

    #[test]
    fn what_is_held_settles_where_the_camera_stands() {
        let (mut pace, range) = (Pace::default(), Range::new(0.1, 100.0));
        for i in 0..5 {
            pace.is_due(&view(0.02 * f64::from(i), 0.0), range, 5.0);
        }
        assert!(pace.is_due(&view(0.08, 0.0), range, 5.0));
        let settled = pace;
        assert!(pace.is_due(&view(0.08, 0.0), range, 5.0) && pace == settled);
    }
}
