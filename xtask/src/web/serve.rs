//! A server of static files, for this machine only.

use std::{
    fs::File,
    path::{Component, Path, PathBuf},
    sync::Arc,
    thread,
};

use anyhow::{Context, Result, anyhow};
use tiny_http::{Header, Request, Response};

/// Number of requests that are answered at once. A browser asks for few files.
const THREADS: usize = 4;

/// A folder that is served.
pub struct Server {
    http: Arc<tiny_http::Server>,
    folder: PathBuf,
}

impl Server {
    /// Listens on the loopback interface. Port 0 is any free port.
    pub fn open(folder: &Path, port: u16) -> Result<Self> {
        let http = tiny_http::Server::http(("127.0.0.1", port))
            .map_err(|error| anyhow!("port {port}: {error}; give another with --port"))?;
        let folder = folder.canonicalize().with_context(|| format!("{} is not there", folder.display()))?;
        Ok(Self { http: Arc::new(http), folder })
    }

    /// Returns the address of the server.
    pub fn address(&self) -> String {
        format!("http://{}/", self.http.server_addr())
    }

    /// Answers requests for ever.
    pub fn run(&self) {
        thread::scope(|scope| {
            for _ in 0..THREADS {
                scope.spawn(|| self.http.incoming_requests().for_each(|request| answer(&self.folder, request)));
            }
        });
    }

    /// Answers requests in the background until the program ends, and returns the address.
    pub fn start(self) -> String {
        let address = self.address();
        thread::spawn(move || self.run());
        address
    }
}

fn answer(folder: &Path, request: Request) {
    let takes_brotli = takes_brotli(request.headers());
    let file = file_of(folder, request.url()).and_then(|path| {
        let packed = takes_brotli.then(|| File::open(packed(&path)).ok()).flatten();
        Some((packed.is_some(), packed.or_else(|| File::open(&path).ok())?, kind(&path)))
    });
    // Whoever asked may be gone.
    drop(match file {
        Some((true, file, kind)) => request.respond(Response::from_file(file).with_header(kind).with_header(brotli())),
        Some((false, file, kind)) => request.respond(Response::from_file(file).with_header(kind)),
        None => request.respond(Response::from_string("not found").with_status_code(404)),
    });
}

/// Returns whether a browser reads brotli.
fn takes_brotli(headers: &[Header]) -> bool {
    let accepted = headers.iter().filter(|header| header.field.equiv("Accept-Encoding"));
    accepted.flat_map(|header| header.value.as_str().split(',')).any(|encoding| encoding.trim() == "br")
}

/// Returns the place of a file's compressed copy.
fn packed(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".br");
    name.into()
}

fn brotli() -> Header {
    Header::from_bytes("Content-Encoding", "br").expect("these are headers")
}

/// Returns the file of an address; `None` outside of the folder.
fn file_of(folder: &Path, address: &str) -> Option<PathBuf> {
    let path = address.split(['?', '#']).next()?.trim_start_matches('/');
    let path = Path::new(if path.is_empty() { "index.html" } else { path });
    let is_plain = path.components().all(|part| matches!(part, Component::Normal(_)));
    let file = folder.join(path);
    (is_plain && file.is_file()).then_some(file)
}

/// Returns the content type. Browsers compile during loading only what is marked as WebAssembly.
fn kind(path: &Path) -> Header {
    let kind = match path.extension().and_then(|extension| extension.to_str()) {
        Some("html") => "text/html; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("wasm") => "application/wasm",
        Some("json") => "application/json",
        Some("glb") => "model/gltf-binary",
        Some("md" | "txt") => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    };
    Header::from_bytes("Content-Type", kind).expect("these are headers")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brotli_is_for_browsers_that_ask_for_it() {
        let header = |value: &str| Header::from_bytes("Accept-Encoding", value).expect("a header");
        assert!(takes_brotli(&[header("gzip, deflate, br, zstd")]) && takes_brotli(&[header("br")]));
        assert!(!takes_brotli(&[header("gzip, zebra")]) && !takes_brotli(&[]));
        assert_eq!(packed(Path::new("web/a.wasm")), Path::new("web/a.wasm.br"));
    }

    #[test]
    fn nothing_outside_of_the_folder_is_served() {
        let outer = tempfile::tempdir().expect("a folder");
        let folder = outer.path().join("web");
        std::fs::create_dir_all(folder.join("assets")).expect("a folder");
        for file in ["web/index.html", "web/assets/a.glb", "secret"] {
            std::fs::write(outer.path().join(file), "x").expect("a file");
        }
        for (address, file) in [("/", "index.html"), ("/?scene=a#b", "index.html"), ("/assets/a.glb", "assets/a.glb")] {
            assert_eq!(file_of(&folder, address), Some(folder.join(file)), "{address}");
        }
        for address in ["/../secret", "/assets/../../secret", "//etc/passwd", "/assets", "/none"] {
            let found = file_of(&folder, address);
            assert!(found.is_none() || found.is_some_and(|file| file.starts_with(&folder)), "{address}");
        }
        assert_eq!(file_of(&folder, "/../secret"), None);
    }
}
