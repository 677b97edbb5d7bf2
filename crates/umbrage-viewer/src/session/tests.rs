//! Tests of the state machine without a window, a device or a thread.

use umbrage::Frustum;
use umbrage::config::Preset;
use umbrage_lab::scene_request::LightChoice;

use super::*;
use crate::judge::{Finding, Question};
use crate::stage;
use crate::studio::{News, Order};

fn stage(scene: &str) -> Stage {
    pollster::block_on(stage::open(SceneRequest::new(scene, [64, 48]), None, |_| ())).expect(scene)
}

fn session() -> Session {
    let mut session = Session::new(ShadowConfig::default(), [640, 480]);
    session.enter(stage("chessboard"));
    session
}

/// Makes the studio's answer to an order, without its pictures.
fn drawn(order: &Order) -> News {
    News::Drawn(Box::new(Drawn {
        stage: Arc::clone(&order.stage),
        shot: order.shot.clone(),
        wants: order.wants,
        pose: Arc::clone(&order.stage.pose),
        lights: order.stage.lights.clone(),
        taken: Vec::new(),
        wall_ms: 1.0,
    }))
}

/// Draws until nothing is left to draw, and returns the number of pictures.
fn settle(session: &mut Session) -> usize {
    for count in 0..20 {
        let Some(order) = session.next_order() else { return count };
        session.hear(drawn(&order));
    }
    panic!("it goes on for ever");
}

#[test]
fn nothing_is_drawn_before_there_is_a_scene_and_once_when_nothing_changes() {
    let mut empty = Session::new(ShadowConfig::default(), [640, 480]);
    assert!(empty.next_order().is_none() && empty.next_question().is_none() && !empty.is_up_to_date());
    let mut session = session();
    let order = session.next_order().expect("a first picture");
    assert!(session.next_order().is_none(), "one at a time");
    session.hear(drawn(&order));
    assert_eq!(settle(&mut session), 1, "stabilised maps settle");
    assert!(session.is_up_to_date() && session.next_order().is_none());
    session.set_config(Preset::Sharp.config());
    assert_eq!(settle(&mut session), 1, "tight ones have nothing to settle");
}

#[test]
fn every_change_is_drawn() {
    type Change = fn(&mut Session);
    let changes: Vec<(&str, Change)> = vec![
        ("tint", |s| s.show.tint = true),
        ("shadows", |s| s.show.shadows = false),
        ("config", |s| s.set_config(Preset::Fast.config())),
        ("comparison", |s| s.other = Some(Preset::Papers.config())),
        ("camera", |s| s.fly(&Motion { turn: DVec2::new(0.1, 0.0), ..Motion::default() })),
        ("sun", |s| s.drag_sun(DVec2::new(0.1, 0.0))),
        ("size", |s| s.resize([320, 200])),
        ("time", |s| s.time_s = 3.0),
        ("held maps", |s| s.freeze(true)),
    ];
    for (what, change) in changes {
        let mut session = session();
        settle(&mut session);
        change(&mut session);
        let order = session.next_order().unwrap_or_else(|| panic!("{what} draws nothing"));
        assert!(order.wants.is_nothing(), "{what}: first the picture, then what takes time");
    }
    // And what changes no picture draws none.
    let mut session = session();
    settle(&mut session);
    session.show.frusta = true;
    session.show.tab = Some(Tab::Planes);
    assert!(session.next_order().is_none());
}

#[test]
fn what_takes_time_is_asked_for_while_nothing_moves() {
    let mut session = session();
    settle(&mut session);
    session.show.tab = Some(Tab::Maps);
    session.show.overlay = Some(Overlay::Errors);
    assert!(session.next_question().is_none(), "there is no mask yet");
    let order = session.next_order().expect("maps and a mask");
    assert!(order.wants.maps && order.wants.mask);
    session.hear(drawn(&order));
    settle(&mut session);
    let Some(Question::Overlay(of, Overlay::Errors)) = session.next_question() else { panic!("a question") };
    assert!(session.next_question().is_none() && session.is_judging(), "one at a time");
    // The camera moves on while rays are traced: the answer is of another picture.
    let shot = of.shot.clone();
    session.fly(&Motion { zoom: 1.0, ..Motion::default() });
    settle(&mut session);
    let sums = crate::judge::Sums::Errors { acne: 0.0, leak: 0.0, at_edges: 0.0, pixels: 1 };
    let picture = image::RgbaImage::new(1, 1);
    session.found(Finding::Laid(Box::new(Laid { shot, overlay: Overlay::Errors, picture, sums })));
    assert!(session.fitting_overlay().is_none() && !session.is_up_to_date());
    assert!(matches!(session.next_question(), Some(Question::Overlay(..))), "so it is asked again");
    session.found(Finding::Failed("no light".to_owned()));
    assert_eq!(session.show.overlay, None, "a failure is not asked for again");
    assert!(session.messages.iter().any(|message| message.is_error && message.text == "no light"));
}

#[test]
fn a_scene_that_does_not_open_leaves_the_one_that_is_there() {
    let mut session = session();
    let shown = session.stage.as_ref().expect("a scene").id;
    session.open(SceneRequest::new("no-such-scene.glb", [64, 48]), None, || ());
    while session.opening.is_some() {
        session.tick(0.01);
    }
    assert_eq!(session.stage.as_ref().expect("a scene").id, shown);
    let message = session.messages.back().expect("a message");
    assert!(message.is_error && message.text.contains("no-such-scene.glb"), "{message:?}");
    assert!(session.next_order().is_some(), "and it is drawn");
}

#[test]
fn pictures_of_a_scene_that_was_left_are_not_shown() {
    let mut session = session();
    let order = session.next_order().expect("a picture");
    session.enter(stage("robot-war"));
    session.hear(drawn(&order));
    assert!(session.drawn.is_none());
    assert_eq!(session.next_order().expect("the new scene").stage.id, session.stage.as_ref().expect("a scene").id);
}

#[test]
fn a_failure_is_said_once_and_tried_again_after_a_change() {
    let mut session = session();
    let order = session.next_order().expect("a picture");
    session.hear(News::Failed { shot: Box::new(order.shot), why: "out of memory".to_owned() });
    assert!(session.next_order().is_none());
    session.set_config(Preset::Fast.config());
    assert!(session.next_order().is_some());
    session.order_lost("the thread is gone");
    assert_eq!(session.messages.iter().filter(|message| message.is_error).count(), 2);
}

#[test]
fn held_maps_stay_and_one_map_at_a_time_cannot_be_held() {
    let mut session = session();
    let view = *session.camera.as_ref().expect("a camera").view();
    session.freeze(true);
    session.fly(&Motion { zoom: 2.0, ..Motion::default() });
    let shot = session.shot().expect("a shot");
    assert_eq!(shot.planned_for, Some(view));
    assert_ne!(shot.view, view);
    let mut reused = session.config.clone();
    reused.layout = Layout::Reused;
    session.set_config(reused);
    assert_eq!(session.shot().expect("a shot").planned_for, None, "and it says so");
    session.freeze(true);
    assert_eq!(session.frozen, None);
    assert_eq!(session.messages.len(), 2, "{:?}", session.messages);
}

#[test]
fn slow_pictures_are_small_while_something_moves() {
    let mut session = session();
    session.times.push_back(Times { wall: 900.0, ..Times::default() });
    session.fly(&Motion { zoom: 1.0, ..Motion::default() });
    assert_eq!(session.shot().expect("a shot").size, [320, 240]);
    session.tick(0.5);
    assert_eq!(session.shot().expect("a shot").size, [640, 480]);
    session.times.push_back(Times { wall: 9.0, ..Times::default() });
    session.fly(&Motion { zoom: 1.0, ..Motion::default() });
    assert_eq!(session.shot().expect("a shot").size, [640, 480]);
}

#[test]
fn the_sun_is_dragged_from_where_it_is_and_keeps_still_at_night() {
    let mut session = session();
    let before = session.shown_sun().expect("a sun");
    session.drag_sun(DVec2::ZERO);
    session.next_order().expect("a picture");
    let sun = session.shot().expect("a shot").sun.expect("by hand");
    assert!((sun.direction() - before.direction()).length() < 1e-9);
    session.sun = Sun::ByDate(crate::sun::Almanac { hour: 23.5, ..Default::default() });
    drop(session.next_order());
    assert_eq!(session.shot().expect("a shot").sun, Some(sun));
    session.sun = Sun::OfScene;
    drop(session.next_order());
    assert_eq!(session.shot().expect("a shot").sun, None);
}

#[test]
fn a_world_with_a_lamp_alone_has_no_sun_to_drag() {
    let lamp = umbrage_scene::SceneLight {
        name: "lamp".to_owned(),
        node: 0,
        kind: umbrage_scene::LightKind::Point,
        color: [1.0; 3],
        intensity: 1.0,
        range: Some(10.0),
    };
    let mut stage = stage("chessboard");
    stage.scene.lights = vec![lamp];
    stage.request.light = LightChoice::Named("lamp".to_owned());
    let request = stage.request.clone();
    stage.lights = lights::chosen(&request, &stage.scene, &stage.pose, None, &mut Vec::new()).expect("the lamp");
    let mut session = Session::new(ShadowConfig::default(), [64, 48]);
    session.enter(stage);
    assert_eq!(session.light_kinds(), [LightKind::Point]);
    session.drag_sun(DVec2::new(0.1, 0.1));
    assert_eq!(session.sun, Sun::OfScene);
    assert!(session.messages.iter().any(|message| message.text.contains("lamp")));
}

#[test]
fn points_are_where_the_view_shows_them() {
    let lens = Frustum::perspective(1.0, 1.5, 0.5, 200.0).expect("valid");
    let view = View::look_at_upright(DVec3::new(0.0, 3.0, 10.0), DVec3::ZERO, lens).expect("valid");
    let (origin, ray) = view.ray_through(0.25, 0.75);
    let (at, depth) = project(&view, origin + ray * 7.0).expect("in view");
    assert!((at - DVec2::new(0.25, 0.75)).length() < 1e-9 && (depth - 7.0).abs() < 1e-9);
    assert_eq!(project(&view, origin - ray), None);
}
