//! Links: the command, and the fragment of an address, that show the current scene, view and
//! settings.
//!
//! `umbrage view chessboard --time=2 --preset=fast --filter=pcf7` is
//! `#chessboard&time=2&preset=fast&filter=pcf7` in a browser.

use glam::DVec3;
use percent_encoding::{AsciiSet, CONTROLS, percent_decode_str, utf8_percent_encode};
use umbrage::ShadowConfig;
use umbrage::config::{Preset, SETTINGS};
use umbrage_lab::failure::Failure;
use umbrage_lab::scene_request::{CameraChoice, LightChoice, SceneRequest};

use crate::session::Session;
use crate::share::Spelled;

/// Characters that are escaped in a fragment because it may not contain them, or because they would
/// end a part.
const RESERVED: &AsciiSet = &CONTROLS.add(b' ').add(b'"').add(b'#').add(b'%').add(b'&').add(b'<').add(b'>').add(b'`');
/// Characters that are escaped in the scene, so that no name looks like an option.
const IN_NAMES: &AsciiSet = &RESERVED.add(b'=');

/// Returns the command that shows the current scene, view and settings.
#[must_use]
pub fn command_line(session: &Session) -> String {
    let quoted = |word: String| if word.contains(char::is_whitespace) { format!("'{word}'") } else { word };
    let words: Vec<String> = std::iter::once("umbrage view".to_owned()).chain(words(session).map(quoted)).collect();
    words.join(" ")
}

/// Returns the fragment of an address that shows the current scene, view and settings, without its
/// `#`.
#[must_use]
pub fn fragment(session: &Session) -> String {
    let part = |word: String| match word.strip_prefix("--") {
        Some(option) => utf8_percent_encode(option, RESERVED).to_string(),
        None => utf8_percent_encode(&word, IN_NAMES).to_string(),
    };
    words(session).map(part).collect::<Vec<_>>().join("&")
}

/// Returns the scene and the options.
fn words(session: &Session) -> impl Iterator<Item = String> {
    let vector = |v: DVec3| format!("{},{},{}", v.x, v.y, v.z);
    let mut words = Vec::new();
    if let (Some(stage), Some(camera)) = (&session.stage, &session.camera) {
        words.push(stage.request.scene.clone());
        let view = camera.view();
        if *view != stage.view || matches!(stage.request.camera, CameraChoice::LookAt { .. }) {
            words.push(format!("--eye={}", vector(view.eye())));
            words.push(format!("--target={}", vector(camera.pivot())));
            words.extend(camera.fov_degrees().map(|fov| format!("--fov={fov}")));
            words.push(format!("--near={}", view.frustum().near));
            words.push(format!("--far={}", view.frustum().far));
        } else if let CameraChoice::Named(name) = &stage.request.camera {
            words.push(format!("--camera={name}"));
        }
        if session.time_s != 0.0 {
            words.push(format!("--time={}", session.time_s));
        }
        let own = session.sun == crate::sun::Sun::OfScene;
        let given = matches!(stage.request.light, LightChoice::Given(_));
        if let (true, Some(sun)) = (!own || given, session.shown_sun()) {
            words.push(format!("--sun={}", vector(sun.direction())));
        }
    }
    words.extend(session.show.tint.then(|| "--tint".to_owned()));
    words.extend(session.playing.then(|| "--run".to_owned()));
    words.extend(Spelled::of(&session.config).options());
    words.into_iter()
}

/// Content of a link.
#[derive(Clone, Debug, PartialEq)]
pub struct Linked {
    /// The scene, its camera, light and time.
    pub request: SceneRequest,
    /// Technique of the shadows.
    pub config: ShadowConfig,
    /// True if splits are coloured: `tint`.
    pub tint: bool,
    /// True if the panels are hidden: `bare`.
    pub bare: bool,
    /// True if time runs: `run`.
    pub runs: bool,
    /// Settings that were changed to make room for others.
    pub notes: Vec<String>,
}

/// Reads the fragment of an address. `scene` is shown if it names none.
///
/// # Errors
/// The part that is wrong, and the remedy, for users.
pub fn read(fragment: &str, scene: &str, size: [u32; 2]) -> Result<Linked, String> {
    let mut view = Look::default();
    let mut request = SceneRequest::new(scene, size);
    let (mut preset, mut given) = (Preset::default(), Vec::new());
    let (mut tint, mut bare, mut runs) = (false, false, false);
    for (index, part) in fragment.split('&').filter(|part| !part.is_empty()).enumerate() {
        let is_option = part.contains('=');
        let part = percent_decode_str(part).decode_utf8().map_err(|_| format!("{part}: is no UTF-8"))?;
        match part.split_once('=').filter(|_| is_option) {
            None if part == "tint" => tint = true,
            None if part == "bare" => bare = true,
            None if part == "run" => runs = true,
            None if index == 0 => request.scene = part.into_owned(),
            Some(("preset", name)) => preset = name.parse().map_err(|why| format!("preset: {why}"))?,
            Some(("camera", name)) => view.named = Some(name.to_owned()),
            Some(("eye", value)) => view.eye = Some(vector("eye", value)?),
            Some(("target", value)) => view.target = Some(vector("target", value)?),
            Some(("sun", value)) => request.light = LightChoice::Given(vector("sun", value)?),
            Some(("fov", value)) => request.fov = Some(number("fov", value)?),
            Some(("near", value)) => request.near = Some(number("near", value)?),
            Some(("far", value)) => request.far = Some(number("far", value)?),
            Some(("time", value)) => request.time_s = number("time", value)?,
            Some((key, value)) if SETTINGS.iter().any(|setting| setting.key == key) => {
                given.push((key.to_owned(), value.to_owned()));
            }
            _ => return Err(format!("{part}: is nothing that a link may say; copy a link again")),
        }
    }
    let request = request.with_camera(view.choice()?).map_err(|failure| failure.to_string())?;
    let mut config = preset.config();
    let notes = config.apply(&given).map_err(|error| Failure::of_settings(&error, &given).to_string())?;
    Ok(Linked { request, config, tint, bare, runs, notes })
}

/// Camera of a link.
#[derive(Default)]
struct Look {
    named: Option<String>,
    eye: Option<DVec3>,
    target: Option<DVec3>,
}

impl Look {
    fn choice(self) -> Result<CameraChoice, String> {
        match (self.eye, self.target, self.named) {
            (Some(eye), Some(target), None) => Ok(CameraChoice::LookAt { eye, target }),
            (None, None, Some(name)) => Ok(CameraChoice::Named(name)),
            (None, None, None) => Ok(CameraChoice::Default),
            (_, _, Some(_)) => Err("camera and eye: give one of them".to_owned()),
            _ => Err("eye and target: give both, or none".to_owned()),
        }
    }
}

fn number(key: &str, text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| format!("{key}={text}: is no number"))
}

fn vector(key: &str, text: &str) -> Result<DVec3, String> {
    let numbers: Result<Vec<f64>, String> = text.split(',').map(|part| number(key, part)).collect();
    let numbers: [f64; 3] =
        numbers?.try_into().map_err(|_| format!("{key}={text}: give three numbers with commas between them"))?;
    Ok(DVec3::from_array(numbers))
}

#[cfg(test)]
mod tests {
    use umbrage::config::Preset;

    use super::*;
    use crate::camera::Motion;
    use crate::stage;

    fn session(request: SceneRequest) -> Session {
        let mut session = Session::new(ShadowConfig::default(), [640, 480]);
        session.enter(pollster::block_on(stage::open(request, None, |_| ())).expect("a world"));
        session
    }

    #[test]
    fn a_link_shows_what_was_shown() {
        let mut session = session(SceneRequest::new("chessboard", [640, 480]));
        session.set_config(Preset::Fast.config());
        session.config.apply(&[("filter".to_owned(), "pcf7".to_owned())]).expect("a filter");
        (session.time_s, session.show.tint) = (2.5, true);
        session.fly(&Motion { zoom: 1.0, turn: glam::DVec2::new(0.1, 0.05), ..Motion::default() });
        session.drag_sun(glam::DVec2::new(0.1, 0.0));
        assert!(session.next_order().is_some(), "the sun is chosen with the order");
        let linked = read(&fragment(&session), "robot-war", [640, 480]).expect("its own link");
        assert_eq!((&linked.config, linked.tint, linked.notes.len()), (&session.config, true, 0));
        assert_eq!((linked.request.scene.as_str(), linked.request.time_s), ("chessboard", 2.5));
        let there = self::session(linked.request);
        let (shown, meant) = (there.camera.expect("a camera"), session.camera.expect("a camera"));
        assert_eq!(shown.view().eye(), meant.view().eye());
        assert!(shown.view().forward().dot(meant.view().forward()) > 1.0 - 1e-12);
        assert_eq!(shown.view().frustum(), meant.view().frustum());
    }

    #[test]
    fn names_with_what_separates_parts_come_back() {
        let mut session = session(SceneRequest::new("chessboard", [64, 48]));
        let mut stage = pollster::block_on(stage::open(SceneRequest::new("chessboard", [64, 48]), None, |_| ()));
        if let Ok(stage) = &mut stage {
            stage.request.scene = "a & b/100 %#ü=1.glb".to_owned();
        }
        session.enter(stage.expect("a world"));
        let linked = read(&fragment(&session), "robot-war", [64, 48]).expect("its own link");
        assert_eq!(linked.request.scene, "a & b/100 %#ü=1.glb");
        let run = read("chessboard&bare&run", "robot-war", [64, 48]).expect("a link");
        assert!((run.bare, run.runs, run.tint) == (true, true, false) && run.request.scene == "chessboard");
        assert_eq!(read("", "robot-war", [64, 48]).expect("nothing").request.scene, "robot-war");
    }

    #[test]
    fn what_is_wrong_with_a_link_is_said() {
        for (link, why) in [
            ("chessboard&eye=1,2", "three numbers"),
            ("chessboard&eye=1,2,3", "give both"),
            ("chessboard&eye=1,2,3&target=0,0,0&camera=near", "one of them"),
            ("chessboard&fov=wide", "fov=wide"),
            ("chessboard&time=NaN", "time=NaN"),
            ("chessboard&near=10&far=1&camera=near", "not less"),
            ("chessboard&filter=fog", "--filter fog"),
            ("chessboard&preset=best", "preset"),
            ("chessboard&colour=red", "colour=red"),
            ("chessboard&robot-war", "robot-war"),
            ("%ff", "UTF-8"),
        ] {
            let error = read(link, "robot-war", [64, 48]).expect_err(link);
            assert!(error.contains(why), "{link}: {error}");
        }
    }
}
