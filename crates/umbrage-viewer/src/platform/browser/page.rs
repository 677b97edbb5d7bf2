//! The page around the canvas: its address, its clipboard, its messages.

use js_sys::{Array, Uint8Array};
use wasm_bindgen::{JsCast, JsValue};
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::{Blob, BlobPropertyBag, Document, Element, HtmlAnchorElement, HtmlElement, Response, Url};

use crate::Error;

/// The canvas of `index.html`.
pub(super) const CANVAS: &str = "canvas";
/// Element that is shown in the canvas's place where there is no viewer.
const MESSAGE: &str = "message";

pub(super) fn window() -> Option<web_sys::Window> {
    web_sys::window()
}

fn document() -> Option<Document> {
    window()?.document()
}

/// Returns an element of the page by its id.
pub(super) fn element(id: &str) -> Option<Element> {
    document()?.get_element_by_id(id)
}

/// Returns the value of `KEY=` in the address's query.
pub(super) fn query(key: &str) -> Option<String> {
    let query = window()?.location().search().ok()?;
    web_sys::UrlSearchParams::new_with_str(&query).ok()?.get(key)
}

/// Returns the scene of the address's query, and its fragment.
pub(crate) fn first_address() -> (Option<String>, String) {
    (query("scene"), fragment())
}

/// Returns the address's fragment, without `#`.
pub(super) fn fragment() -> String {
    let hash = window().and_then(|window| window.location().hash().ok()).unwrap_or_default();
    hash.trim_start_matches('#').to_owned()
}

/// Returns the page's address with another fragment. It becomes the page's address, without an
/// entry in the history for each move of a slider.
pub(crate) fn link(fragment: &str) -> Option<String> {
    let page = window()?;
    let whole = page.location().href().ok()?;
    let address = format!("{}#{fragment}", whole.split('#').next().unwrap_or_default());
    if whole != address {
        page.history().ok()?.replace_state_with_url(&JsValue::NULL, "", Some(&address)).ok()?;
    }
    Some(address)
}

/// Fetches the content of an address.
///
/// # Errors
/// The message of the server or the browser, with the address.
pub(super) async fn fetched(address: &str) -> Result<Vec<u8>, String> {
    let said = |error: JsValue| {
        let why = error.dyn_ref::<js_sys::Error>().map_or("the browser refuses".to_owned(), |e| e.message().into());
        format!("{address}: {why}; give the address of a scene on this page's own server, or drop a file here")
    };
    let page = window().ok_or_else(|| format!("{address}: there is no page to fetch it from"))?;
    let response: Response = JsFuture::from(page.fetch_with_str(address)).await.map_err(said)?.unchecked_into();
    if !response.ok() {
        return Err(format!("{address}: the server answers {} {}", response.status(), response.status_text()));
    }
    let buffer = JsFuture::from(response.array_buffer().map_err(said)?).await.map_err(said)?;
    Ok(Uint8Array::new(&buffer).to_vec())
}

/// Saves a file by way of the browser, and returns its name.
///
/// # Errors
/// The reason why the browser refuses it, for users.
pub(crate) fn save(name: &str, extension: &str, bytes: &[u8]) -> Result<String, String> {
    let name = format!("{name}.{extension}");
    let given = || -> Option<()> {
        let parts = Array::of1(&Uint8Array::from(bytes));
        let kind = BlobPropertyBag::new();
        kind.set_type("application/octet-stream");
        let blob = Blob::new_with_u8_array_sequence_and_options(&parts, &kind).ok()?;
        let address = Url::create_object_url_with_blob(&blob).ok()?;
        let anchor: HtmlAnchorElement = document()?.create_element("a").ok()?.dyn_into().ok()?;
        anchor.set_href(&address);
        anchor.set_download(&name);
        anchor.click();
        Url::revoke_object_url(&address).ok()
    };
    given().ok_or_else(|| format!("{name}: this browser keeps no files that a page makes"))?;
    Ok(name)
}

/// Copies text to the page's clipboard, because the controls cannot.
pub(crate) fn take_copies(output: &mut egui::PlatformOutput) {
    output.commands.retain(|command| {
        let egui::OutputCommand::CopyText(text) = command else { return true };
        if let Some(page) = window() {
            let copied = page.navigator().clipboard().write_text(text);
            // A page that may not is asked by the browser, which says so itself.
            spawn_local(async move { drop(JsFuture::from(copied).await) });
        }
        false
    });
}

/// Writes the state of the viewer on the page, for programs that read it: `cargo xtask test --web`.
pub(crate) fn tell(told: impl FnOnce() -> Vec<(&'static str, String)>) {
    let root = document().and_then(|document| document.document_element());
    let Some(Ok(root)) = root.map(Element::dyn_into::<HtmlElement>) else { return };
    let data = root.dataset();
    let memory = wasm_bindgen::memory().unchecked_into::<js_sys::WebAssembly::Memory>();
    let bytes = memory.buffer().unchecked_into::<js_sys::ArrayBuffer>().byte_length();
    for (key, value) in told().into_iter().chain([("memory", bytes.to_string())]) {
        if data.get(key).as_ref() != Some(&value) {
            drop(data.set(key, &value));
        }
    }
}

/// Shows the reason why there is no viewer, in its place.
pub(crate) fn give_up(error: &Error) {
    web_sys::console::error_1(&error.to_string().into());
    let Some(message) = element(MESSAGE) else { return };
    message.set_text_content(Some(&error.to_string()));
    drop(message.remove_attribute("hidden"));
    if let Some(canvas) = element(CANVAS) {
        drop(canvas.set_attribute("hidden", ""));
    }
}
