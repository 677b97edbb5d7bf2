//! Entry point of the web page: `cargo xtask web` builds it, with `index.html` beside it.

#[cfg(target_arch = "wasm32")]
fn main() {
    umbrage_viewer::page::open();
}

/// Refuses to run outside of a browser. On a desktop `umbrage view` is the viewer.
#[cfg(not(target_arch = "wasm32"))]
fn main() {
    eprintln!("this is a page for a browser: build and serve it with `cargo xtask web`");
    std::process::exit(2);
}
