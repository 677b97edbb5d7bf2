//! Tasks of the page: what a desktop does on threads.

use wasm_bindgen::JsValue;
use wasm_bindgen_futures::{JsFuture, spawn_local};

/// What may be handed to [`spawn`]: anything, as all runs on one thread.
pub trait Movable {}
impl<T> Movable for T {}

/// Milliseconds after which the page has drawn what was changed last.
const PAUSE_MS: i32 = 20;

/// Runs a future whenever it can go on.
#[expect(clippy::unnecessary_wraps, reason = "as threads may run out")]
pub(crate) fn spawn<F: Future<Output = ()> + 'static>(
    _name: &str,
    make: impl FnOnce() -> F + Movable + 'static,
) -> std::io::Result<()> {
    spawn_local(make());
    Ok(())
}

/// Runs a future to its end, some time.
pub(crate) fn finish(future: impl Future<Output = ()> + 'static) {
    spawn_local(future);
}

/// Lets the page draw and hear.
pub(crate) async fn pause() {
    let timer = js_sys::Promise::new(&mut |resolve, _| {
        let timer = super::page::window()
            .and_then(|page| page.set_timeout_with_callback_and_timeout_and_arguments_0(&resolve, PAUSE_MS).ok());
        if timer.is_none() {
            drop(resolve.call0(&JsValue::NULL));
        }
    });
    drop(JsFuture::from(timer).await);
}
