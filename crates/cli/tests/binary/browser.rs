//! Headless Chromium, controlled by its own protocol over two pipes (`--remote-debugging-pipe`: file descriptors 3 and 4, messages end with a zero
//! byte).

use serde_json::{Value, json};
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Timeout for a page to draw; a busy machine is slow.
const TIMEOUT: Duration = Duration::from_secs(120);

/// A browser with one page.
pub(crate) struct Browser {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    session: Option<String>,
    last: u64,
    /// Errors and warnings on the page's console, and uncaught exceptions.
    pub(crate) complaints: Vec<String>,
    _profile: tempfile::TempDir,
}

impl Browser {
    /// Starts the program with a window of this many pixels.
    pub(crate) fn start(program: &str, [width, height]: [u32; 2]) -> Self {
        let profile = tempfile::tempdir().expect("a temporary folder");
        let folder = format!("--user-data-dir={}", profile.path().display());
        let options =
            ["--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--remote-debugging-pipe"];
        let script = r#"exec "$0" "$@" 3<&0 4>&1 >/dev/null 2>&1"#;
        let mut child = Command::new("sh")
            .args(["-c", script, program, &folder])
            .args(options)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("a shell");
        let (input, output) = (child.stdin.take().expect("a pipe"), child.stdout.take().expect("a pipe"));
        let output = BufReader::new(output);
        let mut browser =
            Self { child, input, output, session: None, last: 0, complaints: Vec::new(), _profile: profile };
        let target = browser.call("Target.createTarget", json!({ "url": "about:blank" }))["targetId"].clone();
        let attached = browser.call("Target.attachToTarget", json!({ "targetId": target, "flatten": true }));
        browser.session = Some(attached["sessionId"].as_str().expect("a session").to_owned());
        for domain in ["Page", "Runtime", "Log"] {
            browser.call(&format!("{domain}.enable"), json!({}));
        }
        let metrics = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
        browser.call("Emulation.setDeviceMetricsOverride", metrics);
        browser
    }

    fn message(&mut self) -> Value {
        let mut bytes = Vec::new();
        self.output.read_until(0, &mut bytes).expect("the browser answers");
        bytes.pop();
        serde_json::from_slice(&bytes).expect("the browser is running and says JSON")
    }

    fn call(&mut self, method: &str, params: Value) -> Value {
        self.last += 1;
        let mut message = json!({ "id": self.last, "method": method, "params": params });
        if let Some(session) = &self.session {
            message["sessionId"] = json!(session);
        }
        let written = self.input.write_all(format!("{message}\0").as_bytes()).and_then(|()| self.input.flush());
        written.expect("the browser listens");
        loop {
            let mut answer = self.message();
            if answer["id"] == self.last {
                assert!(answer["error"].is_null(), "{method}: {}", answer["error"]);
                return answer["result"].take();
            }
            self.note(&answer);
        }
    }

    fn note(&mut self, event: &Value) {
        let params = &event["params"];
        let complains = match event["method"].as_str() {
            Some("Runtime.exceptionThrown") => true,
            Some("Runtime.consoleAPICalled") => {
                ["error", "warning", "assert"].contains(&params["type"].as_str().unwrap_or(""))
            }
            Some("Log.entryAdded") => ["error", "warning"].contains(&params["entry"]["level"].as_str().unwrap_or("")),
            _ => false,
        };
        if complains {
            self.complaints.push(params.to_string());
        }
    }

    /// The value of an expression in the page.
    #[track_caller]
    pub(crate) fn value(&mut self, expression: &str) -> Value {
        let parameters = json!({ "expression": expression, "returnByValue": true, "awaitPromise": true });
        let mut answer = self.call("Runtime.evaluate", parameters);
        assert!(answer["exceptionDetails"].is_null(), "{expression}: {}", answer["exceptionDetails"]);
        answer["result"]["value"].take()
    }

    /// Opens a page from the file system.
    #[track_caller]
    pub(crate) fn open(&mut self, page: &Path, address: &str) {
        self.call("Page.navigate", json!({ "url": "about:blank" }));
        self.call("Page.navigate", json!({ "url": format!("file://{}#{address}", page.display()) }));
        self.ready();
    }

    /// Navigates to another address of the same page.
    #[track_caller]
    pub(crate) fn navigate(&mut self, address: &str) {
        self.value(&format!("document.body.dataset.state = 'asked'; location.hash = {}", json!(address)));
        self.ready();
    }

    /// Waits until the page has drawn.
    #[track_caller]
    pub(crate) fn ready(&mut self) {
        let begun = Instant::now();
        loop {
            match self.value("document.body?.dataset.state ?? ''").as_str() {
                Some("ready") => return,
                Some("fault") => panic!("{}", self.value("document.querySelector('#fault').textContent")),
                state => assert!(begun.elapsed() < TIMEOUT, "the page is {state:?}"),
            }
            sleep(Duration::from_millis(20));
        }
    }

    /// Text of an element.
    #[track_caller]
    pub(crate) fn text(&mut self, selector: &str) -> String {
        let content = self.value(&format!("document.querySelector({}).textContent", json!(selector)));
        content.as_str().expect("a text").to_owned()
    }

    /// Numbers of the rows with this name next to the panes: one for each result.
    #[track_caller]
    pub(crate) fn numbers(&mut self, name: &str) -> Vec<f64> {
        let cells = format!(
            "[...document.querySelectorAll('aside td[data-name]')].filter((td) => td.dataset.name === {})",
            json!(name)
        );
        let values = self.value(&format!("{cells}.map((td) => td.dataset.value)"));
        let values = values.as_array().unwrap_or_else(|| panic!("no rows {name}")).clone();
        values.iter().map(|v| v.as_str().and_then(|text| text.parse().ok()).unwrap_or(f64::NAN)).collect()
    }

    pub(crate) fn key(&mut self, key: &str) {
        for kind in ["keyDown", "keyUp"] {
            self.call("Input.dispatchKeyEvent", json!({ "type": kind, "key": key }));
        }
        self.ready();
    }

    /// Moves the mouse to a position in the window, or clicks there.
    pub(crate) fn mouse(&mut self, [x, y]: [f64; 2], clicks: bool) {
        let mut event = |kind: &str| {
            let event = json!({ "type": kind, "x": x, "y": y, "button": "left", "clickCount": u32::from(kind != "mouseMoved") });
            self.call("Input.dispatchMouseEvent", event);
        };
        event("mouseMoved");
        if clicks {
            event("mousePressed");
            event("mouseReleased");
        }
        // The reaction to a move is drawn with the next frame.
        self.value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))");
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // The shell has become the browser, which ends its own helpers.
        let _ = self.input.write_all(format!("{}\0", json!({ "id": 0, "method": "Browser.close" })).as_bytes());
        let begun = Instant::now();
        while begun.elapsed() < Duration::from_secs(5) {
            if let Ok(Some(_)) = self.child.try_wait() {
                return;
            }
            sleep(Duration::from_millis(20));
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
