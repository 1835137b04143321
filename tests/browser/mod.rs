//! Reports in a headless Chromium: on a desktop, on a phone and on paper, in light and dark, no
//! script fails, no text covers another, nothing is wider than the page, long parts are folded on a phone, and charts
//! zoom.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::{Value, json};

/// Runs in the page after its own scripts: what it finds replaces the title of the page.
const PROBE: &str = include_str!("probe.js");

fn chromium() -> PathBuf {
    let places = [
        "/usr/bin/chromium",
        "/usr/bin/chromium-browser",
        "/usr/bin/google-chrome",
    ];
    places
        .into_iter()
        .map(PathBuf::from)
        .find(|path| path.exists())
        .expect("Chromium is installed (apt-get install chromium)")
}

/// Runs the program in a folder.
fn girderway(folder: &Path, arguments: &[&str]) {
    let run = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args(arguments)
        .current_dir(folder)
        .output();
    let run = run.expect("the program starts");
    assert!(
        run.status.success(),
        "{}",
        String::from_utf8_lossy(&run.stderr)
    );
}

/// How a page is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Medium {
    Desktop,
    DarkDesktop,
    Phone,
    DarkPhone,
    /// As a screen shows the page by its rules for print, as wide as those leave it on A4.
    Paper,
}

impl Medium {
    const ALL: [Medium; 5] = [
        Medium::Desktop,
        Medium::DarkDesktop,
        Medium::Phone,
        Medium::DarkPhone,
        Medium::Paper,
    ];

    /// Width of the page, pixels.
    const fn width(self) -> u32 {
        match self {
            Medium::Desktop | Medium::DarkDesktop => 1400,
            Medium::Phone | Medium::DarkPhone => 400,
            Medium::Paper => 680,
        }
    }

    /// Size of the smallest letters in pictures, pixels: on paper four points and more.
    const fn least_letters(self) -> f64 {
        if matches!(self, Medium::Paper) {
            5.6
        } else {
            6.5
        }
    }

    const fn is_dark(self) -> bool {
        matches!(self, Medium::DarkDesktop | Medium::DarkPhone)
    }

    const fn is_phone(self) -> bool {
        matches!(self, Medium::Phone | Medium::DarkPhone)
    }
}

/// What the probe finds in a page, which a frame shows at its width.
fn probe(browser: &Path, page: &Path, medium: Medium) -> Value {
    let mut text = std::fs::read_to_string(page).expect("a report");
    if medium == Medium::Paper {
        text = text.replace("@media print", "@media all");
    }
    let early = format!(
        "<script>window.letters = {}; window.failed = []; addEventListener('error', e => \
         failed.push(e.message));</script></head>",
        medium.least_letters()
    );
    let late = format!("<script>{{{PROBE}}}</script></body>");
    let (head, rest) = text.split_once("</head>").expect("a head");
    let (body, end) = rest.rsplit_once("</body>").expect("a body");
    let probed = page.with_file_name("probed.html");
    std::fs::write(&probed, format!("{head}{early}{body}{late}{end}")).expect("a writable folder");
    let framed = page.with_file_name("framed.html");
    let frame = format!(
        "<!DOCTYPE html><body style=\"margin: 0\"><script>addEventListener('message', e => \
         document.body.append(e.data));</script><iframe src=\"probed.html\" style=\"width: {}px; height: 900px; border: \
         0\"></iframe></body>",
        medium.width()
    );
    std::fs::write(&framed, frame).expect("a writable folder");
    let mut command = Command::new(browser);
    command.args([
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--disable-background-networking",
        "--dump-dom",
    ]);
    command.args([
        "--disable-sync",
        "--no-first-run",
        "--virtual-time-budget=5000",
    ]);
    command.arg(format!(
        "--user-data-dir={}",
        page.with_file_name("profile").display()
    ));
    command.arg("--window-size=1500,1000");
    if medium.is_dark() {
        command.arg("--blink-settings=preferredColorScheme=0");
    }
    let shown = command
        .arg(format!("file://{}", framed.display()))
        .output()
        .expect("Chromium starts");
    let dom = String::from_utf8_lossy(&shown.stdout);
    let found = dom
        .rsplit("FOUND")
        .nth(1)
        .filter(|_| dom.contains("FOUND{"))
        .unwrap_or_else(|| panic!("the probe has not run: {dom:.300}"));
    serde_json::from_str(
        &found
            .replace("&quot;", "\"")
            .replace("&lt;", "<")
            .replace("&gt;", ">")
            .replace("&amp;", "&"),
    )
    .expect("JSON of the probe")
}

/// Height of a page on a phone as it opens, pixels: some ten screens.
const LONGEST: u64 = 8000;
/// Parts of a report that are open on a phone.
const OPEN: u64 = 2;

#[test]
fn reports_are_whole_in_a_browser() {
    let browser = chromium();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let example = |name: &str| format!("{}/../examples/{name}", env!("CARGO_MANIFEST_DIR"));
    girderway(folder.path(), &["init", "runway", "mine", "--quiet"]);
    let reports = [
        ("runway", "run", "mine/scene.json".to_owned()),
        ("design", "design", "mine/design.json".to_owned()),
        ("bogie", "run", example("bogie/scene.json")),
        ("crane", "run", example("bridge_crane/scene.json")),
    ];
    for (name, command, file) in reports {
        girderway(folder.path(), &[command, &file, "-o", name, "--quiet"]);
        let page = folder.path().join(name).join("report.html");
        for medium in Medium::ALL {
            let found = probe(&browser, &page, medium);
            println!("{name} {medium:?}: {found}");
            assert_eq!(found["failed"], json!([]), "{name} {medium:?}: scripts");
            assert_eq!(found["overlaps"], json!([]), "{name} {medium:?}: texts");
            assert_eq!(
                found["beyond"],
                json!([]),
                "{name} {medium:?}: wider than the page"
            );
            assert_eq!(
                found["scrolls"], false,
                "{name} {medium:?}: goes on to the right"
            );
            assert_eq!(
                found["sideways"],
                json!([]),
                "{name} {medium:?}: pictures that go on to the right"
            );
            assert_eq!(
                found["letters"],
                json!([]),
                "{name} {medium:?}: sizes of letters"
            );
            assert_eq!(
                found["unlabelled"], 0,
                "{name} {medium:?}: pictures without a label"
            );
            assert_eq!(
                found["faint"],
                json!([]),
                "{name} {medium:?}: contrast below 4.5"
            );
            assert!(found["pictures"].as_u64().expect("a number") > 0);
            let parts = found["parts"].as_u64().expect("a number");
            let folded = if medium.is_phone() { parts - OPEN } else { 0 };
            assert_eq!(
                found["folded"].as_u64(),
                Some(folded),
                "{name} {medium:?}: parts that are folded"
            );
            assert_eq!(
                found["opens"], true,
                "{name} {medium:?}: a part to which the contents lead"
            );
            let height = found["height"].as_u64().expect("a number");
            assert!(
                !medium.is_phone() || height < LONGEST,
                "{name} {medium:?}: {height} pixels"
            );
            if name == "runway" && medium != Medium::Paper {
                assert_eq!(found["zooms"], true, "{found}");
            }
            assert_eq!(found["dark"], medium.is_dark());
            assert_eq!(
                found["keys"], true,
                "{name} {medium:?}: colours of the keys"
            );
        }
    }
}
