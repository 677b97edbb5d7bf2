//! Waiting in a browser: the page goes on and is called back.

use futures_channel::oneshot;
use wasm_bindgen::{JsCast, JsValue};
use wasm_bindgen_futures::JsFuture;

use super::READING;
use crate::{Error, Gpu, Result};

/// True if a wait costs nothing but its own time. Here each wait costs a turn of the page's event
/// loop.
pub(crate) const BLOCKS: bool = false;

/// Milliseconds between two polls of a device that makes no callbacks by itself.
const TURN_MS: i32 = 2;

/// Waits until everything submitted has run.
pub(crate) async fn idle(gpu: &Gpu) -> Result<()> {
    let (sender, receiver) = oneshot::channel();
    gpu.queue.on_submitted_work_done(move || {
        // The receiver is gone if nobody waits any more.
        let _nobody_waits = sender.send(());
    });
    called(gpu, "waiting for the device", receiver).await
}

/// Waits until everything submitted has run and a buffer can be read.
pub(crate) async fn mapped(gpu: &Gpu, buffer: &wgpu::Buffer) -> Result<()> {
    let (sender, receiver) = oneshot::channel();
    buffer.map_async(wgpu::MapMode::Read, .., move |result| drop(sender.send(result)));
    let result = called(gpu, READING, receiver).await?;
    result.map_err(|error| Error::Device { during: READING, message: error.to_string() })
}

/// Waits for a callback of the device.
async fn called<T>(gpu: &Gpu, during: &'static str, mut receiver: oneshot::Receiver<T>) -> Result<T> {
    let never = |_| Error::Device { during, message: "the device never answered".to_owned() };
    if gpu.adapter_info.backend == wgpu::Backend::BrowserWebGpu {
        return receiver.await.map_err(never);
    }
    // WebGL has fences, which somebody has to look at.
    loop {
        let _none_runs_there = gpu.device.poll(wgpu::PollType::Poll);
        if let Some(result) = receiver.try_recv().map_err(never)? {
            return Ok(result);
        }
        turn().await;
    }
}

/// Lets the page's event loop run.
async fn turn() {
    let timer = js_sys::Promise::new(&mut |resolve, _| {
        // A page without timers has nothing to wait with: the loop then spins.
        let set: Option<js_sys::Function> =
            js_sys::Reflect::get(&js_sys::global(), &"setTimeout".into()).ok().and_then(|f| f.dyn_into().ok());
        if let Some(set) = set {
            drop(set.call2(&JsValue::NULL, &resolve, &TURN_MS.into()));
        }
    });
    drop(JsFuture::from(timer).await);
}
