//! Reports in a headless Chromium, where one is installed: at two widths, in light and dark, no script fails, no text
//! covers another, nothing is wider than the page, and charts zoom. Without Chromium the test says so.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::{Value, json};

/// Runs in the page after its own scripts: what it finds replaces the title of the page.
const PROBE: &str = include_str!("browser.js");

fn chromium() -> Option<PathBuf> {
    let places = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
    places.into_iter().map(PathBuf::from).find(|path| path.exists())
}

/// Runs the program in a folder.
fn girderway(folder: &Path, arguments: &[&str]) {
    let run = Command::new(env!("CARGO_BIN_EXE_girderway")).args(arguments).current_dir(folder).output();
    let run = run.expect("the program starts");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
}

/// What the probe finds in a page.
fn probe(browser: &Path, page: &Path, width: u32, is_dark: bool) -> Value {
    let text = std::fs::read_to_string(page).expect("a report");
    let early =
        "<script>window.failed = []; addEventListener('error', e => failed.push(e.message));</script></head>";
    let late = format!("<script>{PROBE}</script></body>");
    let probed = page.with_file_name(format!("probed-{width}-{is_dark}.html"));
    let (head, rest) = text.split_once("</head>").expect("a head");
    let (body, end) = rest.rsplit_once("</body>").expect("a body");
    std::fs::write(&probed, format!("{head}{early}{body}{late}{end}")).expect("a writable folder");
    let mut command = Command::new(browser);
    command.args([
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--disable-background-networking",
        "--dump-dom",
    ]);
    command.args(["--disable-sync", "--no-first-run", "--virtual-time-budget=5000"]);
    command.arg(format!("--user-data-dir={}", page.with_file_name("profile").display()));
    command.arg(format!("--window-size={width},1000"));
    if is_dark {
        command.arg("--blink-settings=preferredColorScheme=0");
    }
    let shown = command.arg(format!("file://{}", probed.display())).output().expect("Chromium starts");
    let dom = String::from_utf8_lossy(&shown.stdout);
    let found = dom
        .rsplit("FOUND")
        .nth(1)
        .filter(|_| dom.contains("FOUND{"))
        .unwrap_or_else(|| panic!("the probe has not run: {dom:.300}"));
    serde_json::from_str(
        &found.replace("&quot;", "\"").replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&"),
    )
    .expect("JSON of the probe")
}

#[test]
fn reports_are_whole_in_a_browser() {
    let Some(browser) = chromium() else {
        println!("not tested: no Chromium is installed (apt-get install chromium)");
        return;
    };
    let folder = tempfile::tempdir().expect("a temporary folder");
    girderway(folder.path(), &["init", "runway", "mine", "--quiet"]);
    girderway(folder.path(), &["run", "mine/scene.json", "-o", "run", "--quiet"]);
    girderway(folder.path(), &["design", "mine/design.json", "-o", "design", "--quiet"]);
    for name in ["run", "design"] {
        let page = folder.path().join(name).join("report.html");
        for (width, is_dark) in [(1400, false), (1400, true), (500, false)] {
            let found = probe(&browser, &page, width, is_dark);
            println!("{name} at {width}: {found}");
            assert_eq!(found["failed"], json!([]), "{name} at {width}: scripts");
            assert_eq!(found["overlaps"], json!([]), "{name} at {width}: texts");
            assert_eq!(found["beyond"], json!([]), "{name} at {width}: wider than the page");
            assert_eq!(found["sideways"], json!([]), "{name} at {width}: pictures that go on to the right");
            assert_eq!(found["letters"], json!([]), "{name} at {width}: sizes of letters");
            assert_eq!(found["unlabelled"], 0, "{name} at {width}: pictures without a label");
            assert_eq!(found["faint"], json!([]), "{name} at {width}: contrast below 4.5");
            assert!(found["pictures"].as_u64().expect("a number") > 0);
            if name == "run" {
                assert_eq!(found["zooms"], true, "{found}");
            }
            assert_eq!(found["dark"], is_dark);
            assert_eq!(found["keys"], true, "{name} at {width}: colours of the keys");
        }
    }
}
