//! A real Chromium, driven by the WebDriver protocol, and a file server for it.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// How long anything may take.
const PATIENCE: Duration = Duration::from_secs(120);

/// A browser with one page.
pub(crate) struct Browser {
    driver: Child,
    session: String,
    _profile: tempfile::TempDir,
}

impl Browser {
    /// Starts a browser with a window of this size.
    pub(crate) fn start(width: u32, height: u32) -> Self {
        let mut driver = Command::new("chromedriver")
            .arg("--port=0")
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("chromedriver starts; `cargo xtask test --only lab-web` installs it");
        let mut lines = BufReader::new(driver.stdout.take().unwrap()).lines();
        let port: u16 = loop {
            let line = lines.next().expect("chromedriver tells its port").unwrap();
            let port = line.split_once("successfully on port ");
            if let Some((_, port)) = port {
                break port.trim_end_matches('.').parse().unwrap();
            }
        };
        // It must be able to go on writing.
        std::thread::spawn(move || lines.for_each(drop));
        let profile = tempfile::tempdir().unwrap();
        let arguments = [
            "--headless".to_owned(),
            "--no-sandbox".into(),
            "--disable-gpu".into(),
            // Containers have little of what it would use instead.
            "--disable-dev-shm-usage".into(),
            "--use-angle=swiftshader".into(),
            "--enable-unsafe-swiftshader".into(),
            "--disable-quic".into(),
            "--no-first-run".into(),
            "--disable-background-networking".into(),
            "--disable-component-update".into(),
            "--disable-sync".into(),
            format!("--window-size={width},{height}"),
            format!("--user-data-dir={}", profile.path().display()),
        ];
        let wanted = json!({"capabilities": {"alwaysMatch": {
            "browserName": "chrome",
            "goog:loggingPrefs": {"browser": "ALL"},
            "goog:chromeOptions": {"args": arguments},
        }}});
        let root = format!("http://127.0.0.1:{port}/session");
        let made = post(&root, &wanted);
        let id = made["sessionId"].as_str().expect("a session has an id");
        Self {
            driver,
            session: format!("{root}/{id}"),
            _profile: profile,
        }
    }

    /// Shows pages as on a screen of this size, which may be narrower than any window.
    pub(crate) fn set_screen(&self, width: u32, height: u32) {
        let metrics = json!({
            "width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 500,
        });
        let command = json!({"cmd": "Emulation.setDeviceMetricsOverride", "params": metrics});
        post(&format!("{}/goog/cdp/execute", self.session), &command);
    }

    pub(crate) fn open(&self, url: &str) {
        // Also when only the part behind # differs, from scratch.
        post(
            &format!("{}/url", self.session),
            &json!({"url": "about:blank"}),
        );
        post(&format!("{}/url", self.session), &json!({"url": url}));
    }

    /// Runs JavaScript; `return` gives a value.
    pub(crate) fn run(&self, script: &str, arguments: Value) -> Value {
        let body = json!({"script": script, "args": arguments});
        post(&format!("{}/execute/sync", self.session), &body)
    }

    /// An attribute `data-NAME` of the page.
    pub(crate) fn data(&self, name: &str) -> String {
        let script = "return document.body.getAttribute('data-' + arguments[0])";
        self.run(script, json!([name]))
            .as_str()
            .unwrap_or_default()
            .to_owned()
    }

    /// Waits until an attribute is as wanted, and returns it.
    pub(crate) fn wait(&self, name: &str, is_wanted: impl Fn(&str) -> bool) -> String {
        let begin = Instant::now();
        loop {
            let value = self.data(name);
            if is_wanted(&value) {
                return value;
            }
            assert!(
                begin.elapsed() < PATIENCE,
                "data-{name} stayed {value:?}; console: {:#?}",
                self.console()
            );
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    /// Drops a file on the page.
    pub(crate) fn drop_file(&self, name: &str, content: &[u8]) {
        let script = "
            const data = new DataTransfer();
            data.items.add(new File([new Uint8Array(arguments[1])], arguments[0]));
            const canvas = document.getElementById('lab');
            for (const kind of ['dragover', 'drop']) {
                canvas.dispatchEvent(new DragEvent(kind, {
                    dataTransfer: data, bubbles: true, cancelable: true,
                }));
            }";
        self.run(script, json!([name, content]));
    }

    /// What the page and the browser have complained of.
    pub(crate) fn console(&self) -> Vec<String> {
        let entries = post(
            &format!("{}/se/log", self.session),
            &json!({"type": "browser"}),
        );
        let entries = entries.as_array().cloned().unwrap_or_default();
        let severe = entries.iter().filter(|entry| entry["level"] == "SEVERE");
        severe.map(|entry| entry["message"].to_string()).collect()
    }

    /// A picture of the page, as PNG. A browser on a busy machine may not have one at once.
    pub(crate) fn picture(&self) -> Vec<u8> {
        let url = format!("{}/screenshot", self.session);
        let mut answer = Value::Null;
        for _ in 0..3 {
            let request = ureq::get(&url).config().http_status_as_error(false).build();
            answer = request.call().unwrap().body_mut().read_json().unwrap();
            if let Some(picture) = answer["value"].as_str() {
                return base64(picture);
            }
            std::thread::sleep(Duration::from_millis(500));
        }
        panic!("there is no picture: {answer}");
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = ureq::delete(&self.session).call();
        let _ = self.driver.kill();
        let _ = self.driver.wait();
    }
}

fn post(url: &str, body: &Value) -> Value {
    let agent: ureq::Agent = ureq::Agent::config_builder()
        .http_status_as_error(false)
        .timeout_global(Some(PATIENCE))
        .build()
        .into();
    let mut answer = agent.post(url).send_json(body).unwrap();
    let status = answer.status();
    let answer: Value = answer.body_mut().read_json().unwrap();
    assert!(status.is_success(), "{url}: {answer}");
    answer["value"].clone()
}

fn base64(text: &str) -> Vec<u8> {
    const DIGITS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut bytes = Vec::new();
    for chunk in text.trim_end_matches('=').as_bytes().chunks(4) {
        let digit = |digit: &u8| DIGITS.iter().position(|known| known == digit).unwrap() as u32;
        let word = chunk.iter().fold(0, |word, it| word << 6 | digit(it));
        let word = word << (6 * (4 - chunk.len()));
        bytes.extend(&word.to_be_bytes()[1..chunk.len()]);
    }
    bytes
}

/// Serves a folder on a port of its own, as long as the program runs; returns its address.
pub(crate) fn serve(folder: PathBuf) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = format!("http://{}/", listener.local_addr().unwrap());
    std::thread::spawn(move || {
        for stream in listener.incoming().flatten() {
            let folder = folder.clone();
            std::thread::spawn(move || answer(stream, &folder));
        }
    });
    address
}

fn answer(mut stream: TcpStream, folder: &Path) {
    let mut request = [0; 8192];
    let length = stream.read(&mut request).unwrap_or(0);
    let request = String::from_utf8_lossy(&request[..length]);
    let path = request
        .split(' ')
        .nth(1)
        .unwrap_or("/")
        .trim_start_matches('/');
    let path = if path.is_empty() { "index.html" } else { path };
    let kind = match path.rsplit('.').next() {
        Some("html") => "text/html",
        Some("js") => "text/javascript",
        Some("css") => "text/css",
        Some("svg") => "image/svg+xml",
        Some("png") => "image/png",
        Some("wasm") => "application/wasm",
        _ => "application/octet-stream",
    };
    let (status, body) = match std::fs::read(folder.join(path)) {
        Ok(body) => ("200 OK", body),
        Err(_) => ("404 Not Found", Vec::new()),
    };
    let length = body.len();
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n"
    );
    let _ = stream
        .write_all(head.as_bytes())
        .and_then(|()| stream.write_all(&body));
}
