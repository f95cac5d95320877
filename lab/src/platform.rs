//! What differs between a window and a web page: files, the clock, the address.

use std::cell::RefCell;
use std::rc::Rc;

/// Files on their way in: name and content, or why there is none.
#[derive(Clone, Default)]
pub struct Inbox(Rc<RefCell<Vec<Arrived>>>);

/// A file that has come in.
pub type Arrived = (String, Result<Vec<u8>, String>);

impl Inbox {
    /// The next file.
    pub fn next(&self) -> Option<Arrived> {
        self.0.borrow_mut().pop()
    }

    /// Puts a file in.
    pub fn put(&self, name: String, content: Result<Vec<u8>, String>) {
        self.0.borrow_mut().push((name, content));
    }

    /// Takes in files that were dropped on the window or the page.
    pub fn take_dropped(&self, ctx: &egui::Context) {
        for file in ctx.input_mut(|input| std::mem::take(&mut input.raw.dropped_files)) {
            self.receive(ctx, file);
        }
    }
}

pub use here::{Stopwatch, choose_file, save};

#[cfg(not(target_arch = "wasm32"))]
mod here {
    use std::fs;
    use std::path::Path;
    use std::time::Instant;

    use host_sim::files;

    use super::Inbox;

    impl Inbox {
        pub(super) fn receive(&self, _ctx: &egui::Context, file: egui::DroppedFileHandle) {
            self.put(file.path().display().to_string(), file.bytes());
        }
    }

    /// Measures time.
    pub struct Stopwatch(Instant);

    impl Stopwatch {
        /// Starts now.
        pub fn start() -> Self {
            Self(Instant::now())
        }

        /// Seconds since the start.
        pub fn seconds(&self) -> f64 {
            self.0.elapsed().as_secs_f64()
        }
    }

    /// Writes a file into the folder `out/lab`; tells where it is.
    ///
    /// # Errors
    /// A sentence for the user.
    pub fn save(name: &str, bytes: &[u8]) -> Result<String, String> {
        let path = Path::new("out/lab").join(name);
        let written = fs::create_dir_all("out/lab").and_then(|()| files::write(&path, bytes));
        match written {
            Ok(()) => Ok(format!("written to {}", path.display())),
            Err(error) => Err(format!("{} cannot be written: {error}", path.display())),
        }
    }

    /// Reads the file at `path`, as the user has typed it.
    pub fn choose_file(path: &str, inbox: &Inbox, _ctx: &egui::Context) {
        let bytes = fs::read(path).map_err(|error| format!("cannot be read: {error}"));
        inbox.put(path.into(), bytes);
    }
}

#[cfg(target_arch = "wasm32")]
mod here {
    use js_sys::{Array, Uint8Array};
    use wasm_bindgen::prelude::*;
    use wasm_bindgen_futures::{JsFuture, spawn_local};
    use web_sys::{Blob, HtmlAnchorElement, HtmlInputElement, Url};

    use super::Inbox;

    impl Inbox {
        pub(super) fn receive(&self, ctx: &egui::Context, file: egui::DroppedFileHandle) {
            let (inbox, ctx) = (self.clone(), ctx.clone());
            spawn_local(async move {
                let bytes = file.bytes_async().await;
                inbox.put(file.path().display().to_string(), bytes);
                ctx.request_repaint();
            });
        }
    }

    /// Measures time.
    pub struct Stopwatch(f64);

    fn now() -> f64 {
        let clock = web_sys::window().and_then(|window| window.performance());
        clock.map_or(0.0, |clock| clock.now())
    }

    impl Stopwatch {
        /// Starts now.
        pub fn start() -> Self {
            Self(now())
        }

        /// Seconds since the start.
        pub fn seconds(&self) -> f64 {
            (now() - self.0) / 1000.0
        }
    }

    /// Offers a file for download.
    ///
    /// # Errors
    /// A sentence for the user.
    pub fn save(name: &str, bytes: &[u8]) -> Result<String, String> {
        let offer = || -> Result<(), JsValue> {
            let parts = Array::of1(&Uint8Array::from(bytes));
            let url = Url::create_object_url_with_blob(&Blob::new_with_u8_array_sequence(&parts)?)?;
            let document = web_sys::window().and_then(|window| window.document());
            let document = document.ok_or("there is no document")?;
            let anchor: HtmlAnchorElement = document.create_element("a")?.dyn_into()?;
            anchor.set_href(&url);
            anchor.set_download(name);
            anchor.click();
            Url::revoke_object_url(&url)
        };
        match offer() {
            Ok(()) => Ok(format!("{name} is among the browser's downloads")),
            Err(error) => Err(format!("{name} cannot be offered for download: {error:?}")),
        }
    }

    /// Lets the user choose a file.
    pub fn choose_file(_path: &str, inbox: &Inbox, ctx: &egui::Context) {
        let (inbox, ctx) = (inbox.clone(), ctx.clone());
        let open = || -> Result<(), JsValue> {
            let document = web_sys::window().and_then(|window| window.document());
            let document = document.ok_or("there is no document")?;
            let input: HtmlInputElement = document.create_element("input")?.dyn_into()?;
            input.set_type("file");
            let chosen = input.clone();
            let changed = Closure::once_into_js(move || {
                let Some(file) = chosen.files().and_then(|files| files.get(0)) else {
                    return;
                };
                spawn_local(async move {
                    let bytes = JsFuture::from(file.array_buffer()).await;
                    let bytes = bytes
                        .map(|buffer| Uint8Array::new(&buffer).to_vec())
                        .map_err(|error| format!("cannot be read: {error:?}"));
                    inbox.put(file.name(), bytes);
                    ctx.request_repaint();
                });
            });
            input.set_onchange(Some(changed.unchecked_ref()));
            input.click();
            Ok(())
        };
        if let Err(error) = open() {
            web_sys::console::error_1(&error);
        }
    }
}
