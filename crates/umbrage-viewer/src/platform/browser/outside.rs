//! Events of the page that `winit` does not report: dropped files, pasted text, a new address, a
//! tab that is visible again.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;

use js_sys::Uint8Array;
use wasm_bindgen::JsCast;
use wasm_bindgen::closure::Closure;
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::{ClipboardEvent, DragEvent, Event, EventTarget, KeyboardEvent};

use super::page;
use crate::platform::{Arrival, Wake};

/// Listens to the page.
pub(crate) struct Outside {
    arrivals: Rc<RefCell<Vec<Arrival>>>,
    /// Listeners, which listen until they are dropped.
    _listeners: Vec<Listener>,
}

struct Listener {
    target: EventTarget,
    event: &'static str,
    hear: Closure<dyn FnMut(Event)>,
}

impl Outside {
    /// Starts listening. `wake` is called after an event.
    pub fn listen(wake: Wake) -> Self {
        let arrivals = Rc::new(RefCell::new(Vec::new()));
        let post = Post { arrivals: Rc::clone(&arrivals), wake };
        let mut listeners = Vec::new();
        if let Some(window) = page::window() {
            let page: &EventTarget = window.as_ref();
            listeners.extend(post.of_page(page));
            if let Some(canvas) = page::element(page::CANVAS) {
                listeners.extend(of_canvas(canvas.as_ref()));
                let lost = post.clone();
                listeners.push(Listener::new(canvas.as_ref(), "webglcontextlost", move |_| {
                    lost.bring(Arrival::Lost("the browser took WebGL2 away".to_owned()));
                }));
            }
        }
        Self { arrivals, _listeners: listeners }
    }

    /// Takes the events that have arrived.
    pub fn arrivals(&self) -> Vec<Arrival> {
        std::mem::take(&mut self.arrivals.borrow_mut())
    }
}

#[derive(Clone)]
struct Post {
    arrivals: Rc<RefCell<Vec<Arrival>>>,
    wake: Wake,
}

impl Post {
    fn bring(&self, arrival: Arrival) {
        self.arrivals.borrow_mut().push(arrival);
        (self.wake)();
    }

    fn of_page(&self, page: &EventTarget) -> Vec<Listener> {
        let (pasted, dropped, moved, seen) = (self.clone(), self.clone(), self.clone(), Arc::clone(&self.wake));
        vec![
            Listener::new(page, "paste", move |event| {
                let text = event.dyn_ref::<ClipboardEvent>().and_then(ClipboardEvent::clipboard_data);
                if let Some(text) = text.and_then(|data| data.get_data("text").ok()) {
                    pasted.bring(Arrival::Pasted(text));
                }
            }),
            // A page that does not say so is left for the file that is dropped on it.
            Listener::new(page, "dragover", |event| event.prevent_default()),
            Listener::new(page, "drop", move |event| {
                event.prevent_default();
                dropped.take_files(&event);
            }),
            Listener::new(page, "hashchange", move |_| moved.bring(Arrival::Address(page::fragment()))),
            // Browsers call no page back that is not seen; what has happened meanwhile is drawn
            // now.
            Listener::new(page, "visibilitychange", move |_| seen()),
        ]
    }

    fn take_files(&self, event: &Event) {
        let files = event.dyn_ref::<DragEvent>().and_then(DragEvent::data_transfer).and_then(|data| data.files());
        // Several files are one scene after the other: the last is shown.
        let Some(file) = files.and_then(|files| files.get(files.length().saturating_sub(1))) else { return };
        let post = self.clone();
        spawn_local(async move {
            let name = file.name();
            post.bring(match JsFuture::from(file.array_buffer()).await {
                Ok(buffer) => Arrival::Dropped { name, bytes: Uint8Array::new(&buffer).to_vec() },
                Err(_) => Arrival::Said(true, format!("{name}: the browser does not let it be read")),
            });
        });
    }
}

/// Makes listeners that keep keys and gestures of the viewer from the browser.
fn of_canvas(canvas: &EventTarget) -> Vec<Listener> {
    let keep = |event: Event| event.prevent_default();
    vec![
        Listener::new(canvas, "wheel", keep),
        Listener::new(canvas, "contextmenu", keep),
        Listener::new(canvas, "keydown", |event| {
            let Some(key) = event.dyn_ref::<KeyboardEvent>() else { return };
            let is_browsers = key.ctrl_key() || key.meta_key() || matches!(&*key.key(), "F5" | "F11" | "F12");
            if !is_browsers {
                event.prevent_default();
            }
        }),
    ]
}

impl Listener {
    fn new(target: &EventTarget, event: &'static str, hear: impl FnMut(Event) + 'static) -> Self {
        let hear = Closure::new(hear);
        drop(target.add_event_listener_with_callback(event, hear.as_ref().unchecked_ref()));
        Self { target: target.clone(), event, hear }
    }
}

impl Drop for Listener {
    fn drop(&mut self) {
        drop(self.target.remove_event_listener_with_callback(self.event, self.hear.as_ref().unchecked_ref()));
    }
}
