//! Tasks of the page, in place of a desktop's threads.

use std::time::Duration;

use wasm_bindgen::JsValue;
use wasm_bindgen_futures::{JsFuture, spawn_local};

/// Type that can be passed to [`spawn`]: any, because all tasks run on one thread.
pub trait Movable {}
impl<T> Movable for T {}

/// Time after which the page has drawn the last change.
const PAUSE: Duration = Duration::from_millis(20);

/// Runs a future whenever it can continue.
#[expect(clippy::unnecessary_wraps, reason = "as threads may run out")]
pub(crate) fn spawn<F: Future<Output = ()> + 'static>(
    _name: &str,
    make: impl FnOnce() -> F + Movable + 'static,
) -> std::io::Result<()> {
    spawn_local(make());
    Ok(())
}

/// Runs a future to its end, at some later time.
pub(crate) fn finish(future: impl Future<Output = ()> + 'static) {
    spawn_local(future);
}

/// Lets the page draw and handle events.
pub(crate) async fn pause() {
    sleep(PAUSE).await;
}

/// Waits for some time, in which the page goes on.
pub(crate) async fn sleep(time: Duration) {
    let timer = js_sys::Promise::new(&mut |resolve, _| {
        let milliseconds = i32::try_from(time.as_millis()).unwrap_or(i32::MAX);
        let timer = super::page::window()
            .and_then(|page| page.set_timeout_with_callback_and_timeout_and_arguments_0(&resolve, milliseconds).ok());
        if timer.is_none() {
            drop(resolve.call0(&JsValue::NULL));
        }
    });
    drop(JsFuture::from(timer).await);
}
