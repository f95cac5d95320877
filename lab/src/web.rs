//! The page: starts the lab on its canvas, and tells the page around it how it stands.

use std::cell::RefCell;
use std::rc::Rc;

use wasm_bindgen::prelude::*;
use wasm_bindgen_futures::spawn_local;
use web_sys::{Document, HtmlCanvasElement, HtmlElement, Location};

use crate::app::{App, Report};

struct Page {
    app: App,
    /// An address that the user has entered since the last frame.
    entered: Rc<RefCell<Option<String>>>,
    body: HtmlElement,
    location: Location,
    told: Option<Report>,
    address: String,
    /// Frames and seconds since the rate was told last.
    rate: (u32, f64),
}

#[wasm_bindgen(start)]
fn start() -> Result<(), JsValue> {
    let window = web_sys::window().ok_or("there is no window")?;
    let document: Document = window.document().ok_or("there is no document")?;
    let canvas = document
        .get_element_by_id("lab")
        .ok_or("there is no canvas `lab`")?;
    let canvas: HtmlCanvasElement = canvas.dyn_into()?;
    let body = document.body().ok_or("there is no body")?;
    let location = window.location();
    let address = location.hash()?;

    let entered = Rc::new(RefCell::new(None));
    let (cell, place) = (entered.clone(), location.clone());
    let changed = Closure::<dyn Fn()>::new(move || *cell.borrow_mut() = place.hash().ok());
    window.add_event_listener_with_callback("hashchange", changed.as_ref().unchecked_ref())?;
    changed.forget();

    spawn_local(async move {
        let page = Page {
            app: App::welcome(&decoded(&address)),
            entered,
            body,
            location,
            told: None,
            address: String::new(),
            rate: (0, 0.0),
        };
        let runner = eframe::WebRunner::new();
        let options = eframe::WebOptions::default();
        let started = runner
            .start(canvas, options, Box::new(|_| Ok(Box::new(page))))
            .await;
        if let Err(error) = started {
            web_sys::console::error_1(&error);
        }
    });
    Ok(())
}

/// An address without its percent signs.
fn decoded(address: &str) -> String {
    js_sys::decode_uri_component(address).map_or_else(|_| address.into(), String::from)
}

impl eframe::App for Page {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        if let Some(address) = self.entered.take() {
            let address = decoded(&address);
            if address.trim_start_matches('#') != self.address {
                self.app = App::from_address(&address);
            }
        }
        self.app.ui(ui);
        let seconds = ui.input(|input| input.unstable_dt);
        if self.tell(seconds).is_err() {
            web_sys::console::error_1(&"the page cannot be told how the lab stands".into());
        }
    }
}

impl Page {
    /// Writes the state into attributes of the body, and the scenario into the address.
    fn tell(&mut self, seconds: f32) -> Result<(), JsValue> {
        self.rate.0 += 1;
        self.rate.1 += f64::from(seconds);
        if self.rate.1 >= 1.0 {
            let rate = f64::from(self.rate.0) / self.rate.1;
            self.body
                .set_attribute("data-frames-per-second", &format!("{rate:.0}"))?;
            self.rate = (0, 0.0);
        }
        let report = self.app.report();
        if self.told.as_ref() != Some(&report) {
            for (name, value) in [
                ("data-state", report.state),
                ("data-digest", &report.digest),
                ("data-ticks", &report.ticks.to_string()),
                ("data-map", &report.map),
                ("data-error", &report.error),
            ] {
                self.body.set_attribute(name, value)?;
            }
            self.told = Some(report);
        }
        let address = self.app.address();
        if address != self.address {
            let first = self.address.is_empty();
            self.address = address;
            if !first || self.location.hash()?.len() > 1 {
                let window = web_sys::window().ok_or("there is no window")?;
                let url = format!("#{}", self.address);
                window
                    .history()?
                    .replace_state_with_url(&JsValue::NULL, "", Some(&url))?;
            }
        }
        Ok(())
    }
}
