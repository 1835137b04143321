//! Pages are parsed, not searched.

use super::*;
use crate::chart::{Chart, ChartAxis, Series, Style};
use crate::document::code::tests::decoded;
use html5gum::{DefaultEmitter, Token, Tokenizer};
use std::collections::{BTreeMap, BTreeSet};

fn chart() -> Chart {
    let path = |scale: f64| {
        let point = |i: usize| {
            [
                i as f64 * 0.1,
                scale * (std::f64::consts::PI * i as f64 / 600.0).sin().powi(2),
            ]
        };
        (0..=600).map(point).collect()
    };
    let x = ChartAxis::new("position of the trunnion", "ft");
    Chart::new(
        "Path of the trunnion",
        x,
        ChartAxis::new("deflection", "ft").downwards(),
    )
    .with(Series::new(
        "influence, exact",
        Style::Line,
        path(0.5457515),
    ))
    .with(Series::new("two rigid parts", Style::Line, path(1.198)))
    .with(Series::new(
        "rigid </script> rail",
        Style::Dashed,
        vec![[0.0, 0.05], [60.0, 0.05]],
    ))
    .mark(30.0, "midspan")
}

fn report() -> Report {
    let peaks = ReportTable {
        caption: "Largest deflection of the trunnion.".into(),
        columns: vec![
            TableColumn::new("model", ""),
            TableColumn::new("peak", "ft"),
            TableColumn::new("at", "ft"),
        ],
        rows: vec![
            vec!["influence, exact".into(), 0.5457515.into(), 30.0.into()],
            vec!["two rigid parts".into(), 1.198.into(), 30.25.into()],
            vec!["rigid rail".into(), 0.05.into(), TableCell::Empty],
        ],
    };
    let girder = ReportSection::new("Girder")
        .paragraph("One span of 60 ft with overhangs of 15 ft, solved as an Euler-Bernoulli beam.")
        .fact("Span", 60.0, "ft")
        .fact("Bending stiffness", 9.528 * 4.32e9, "lbf ft\u{b2}")
        .fact("Influence at midspan", 1.0932689616568709e-7, "ft/lbf")
        .fact("Status", "done <b>", "");
    let crossing = ReportSection::new("Crossing & <i>forces</i>")
        .paragraph("The trunnion's path for every model.")
        .fact("Load", 4.8e6, "lbf")
        .table(peaks)
        .figure(
            chart(),
            "Path of the trunnion; deflection positive downwards.",
        )
        .figure(
            chart().svg().expect("finite data"),
            "The same as a finished picture.",
        );
    Report {
        title: "Bogie on the girder".into(),
        subtitle: "Scene bogie, \"60 ft\" & more".into(),
        sections: vec![girder, crossing],
    }
}

const VOID: [&str; 6] = ["meta", "br", "hr", "img", "input", "link"];

/// Start tags with their attributes, and the text of the page outside style and script elements.
type Parsed = (Vec<(String, BTreeMap<String, String>)>, String);

/// Parses a page; fails where an element is not closed in order or a name is used twice.
fn parse(page: &str) -> Parsed {
    let (mut tags, mut text, mut open): (Vec<_>, String, Vec<String>) = Default::default();
    let utf8 = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).expect("the page is UTF-8");
    let mut emitter = DefaultEmitter::default();
    // Scripts and styles hold raw text.
    emitter.naively_switch_states(true);
    for token in Tokenizer::new_with_emitter(page, emitter) {
        match token.expect("reading from memory cannot fail") {
            Token::StartTag(tag) => {
                let name = utf8(&tag.name);
                let attributes: BTreeMap<_, _> = tag
                    .attributes
                    .iter()
                    .map(|(k, v)| (utf8(k), utf8(v)))
                    .collect();
                if !tag.self_closing && !VOID.contains(&name.as_str()) {
                    open.push(name.clone());
                }
                tags.push((name, attributes));
            }
            Token::EndTag(tag) => assert_eq!(open.pop(), Some(utf8(&tag.name)), "elements nest"),
            Token::String(part)
                if !matches!(open.last().map(String::as_str), Some("script" | "style")) =>
            {
                text.push_str(&utf8(&part));
            }
            Token::Error(error) => panic!("{error:?} after {tags:?}"),
            _ => {}
        }
    }
    assert!(open.is_empty(), "left open: {open:?}");
    let mut ids = BTreeSet::new();
    for (_, attributes) in &tags {
        if let Some(id) = attributes.get("id") {
            assert!(ids.insert(id.clone()), "id {id} is used twice");
        }
    }
    (tags, text)
}

fn page() -> String {
    let page = report().html(None).expect("the report is complete");
    if let Some(folder) = std::env::var_os("GIRDERWAY_CHARTS") {
        let file = std::path::Path::new(&folder).join("report.html");
        std::fs::write(file, &page).expect("the folder can be written");
    }
    page
}

#[test]
fn page_is_well_formed_and_holds_every_section() {
    let (tags, text) = parse(&page());
    let report = report();
    assert!(text.contains(&report.title) && text.contains(&report.subtitle));
    for (i, section) in report.sections.iter().enumerate() {
        let id = format!("section-{}", i + 1);
        assert!(
            tags.iter()
                .any(|(name, a)| name == "section" && a.get("id") == Some(&id))
        );
        assert!(
            tags.iter()
                .any(|(name, a)| name == "a" && a.get("href") == Some(&format!("#{id}")))
        );
        assert_eq!(
            text.matches(&section.heading).count(),
            2,
            "once in the contents, once above the section"
        );
        for paragraph in &section.paragraphs {
            assert!(text.contains(paragraph));
        }
    }
    for expected in [
        "Table 1.",
        "Figure 1.",
        "Figure 2.",
        "done <b>",
        "0.5458",
        "4.116 \u{d7} 10\u{b9}\u{2070}",
    ] {
        assert!(text.contains(expected), "{expected} is shown");
    }
    assert_eq!(tags.iter().filter(|(name, _)| name == "figure").count(), 2);
}

#[test]
fn page_refers_to_nothing_outside() {
    let page = page();
    assert!(!page.contains("http"), "no address");
    for (name, attributes) in parse(&page).0 {
        assert!(
            !["link", "img", "iframe", "object", "embed", "base"].contains(&name.as_str()),
            "{name}"
        );
        for key in ["src", "href", "xlink:href", "data", "action"] {
            assert!(
                attributes.get(key).is_none_or(|v| v.starts_with('#')),
                "{name} has {key}"
            );
        }
    }
}

#[test]
fn text_cannot_become_markup() {
    let hostile = "</script></style></title><script>alert(1)</script>\"'&<!--";
    let mut report = report();
    report.title = hostile.into();
    report.subtitle = hostile.into();
    let mut section = ReportSection::new(hostile)
        .paragraph(hostile)
        .fact(hostile, hostile, hostile);
    let mut chart = chart();
    chart.title = hostile.into();
    chart.series[0].label = hostile.into();
    chart.x_axis.label = hostile.into();
    section = section.figure(chart, hostile);
    let before = parse(&page())
        .0
        .iter()
        .filter(|(name, _)| name == "script")
        .count();
    report.sections.push(section);
    let (tags, text) = parse(&report.html(None).expect("the report is complete"));
    assert_eq!(
        tags.iter().filter(|(name, _)| name == "script").count(),
        before + 1,
        "the chart's data alone"
    );
    assert!(text.matches(hostile).count() >= 8);
}

#[test]
fn chart_data_survive_the_way_through_the_page() {
    let page = page();
    let (_, rest) = page
        .split_once("<script type=\"application/json\">")
        .expect("the chart has data");
    let (data, _) = rest.split_once("</script>").expect("the element ends");
    let data: serde_json::Value = serde_json::from_str(data).expect("the data are JSON");
    assert_eq!(data["series"][2]["label"], "rigid </script> rail");
    let values = decoded(&data["series"][0]["y"]);
    let [low, high] = [0, 1].map(|end| data["y"]["range"][end].as_f64().expect("a number"));
    assert!(
        (values[300] - 0.5457515).abs() <= 5e-5 * (high - low),
        "{}",
        values[300]
    );
    let places =
        decoded(&data["places"][data["series"][0]["x"].as_u64().expect("an index") as usize]);
    assert_eq!(places.len(), values.len());
    assert_eq!(data["y"]["flip"], true);
}

#[test]
fn nan_is_refused_by_place() {
    let with = |section: ReportSection| {
        let mut report = report();
        report.sections.push(section);
        report.html(None)
    };
    let bad = f64::NAN;
    assert_eq!(
        with(
            ReportSection::new("x")
                .fact("a", 1.0, "")
                .fact("b", bad, "")
        ),
        Err(Error::Fact {
            section: 2,
            fact: 1
        })
    );
    let mut table = ReportTable {
        caption: String::new(),
        columns: vec![TableColumn::new("a", "")],
        rows: vec![vec![bad.into()]],
    };
    let cell = Error::Cell {
        section: 2,
        table: 0,
        row: 0,
        column: 0,
    };
    assert_eq!(
        with(ReportSection::new("x").table(table.clone())),
        Err(cell)
    );
    table.rows[0].clear();
    let row = Error::Row {
        section: 2,
        table: 0,
        row: 0,
        found: 0,
        expected: 1,
    };
    assert_eq!(with(ReportSection::new("x").table(table)), Err(row));
    let mut chart = chart();
    chart.series[1].points[7][1] = bad;
    let source = crate::chart::Error::NotFinite {
        series: 1,
        point: 7,
    };
    assert_eq!(
        with(ReportSection::new("x").figure(chart, "")),
        Err(Error::Chart {
            section: 2,
            figure: 0,
            source
        })
    );
}

#[test]
fn numbers_read_well() {
    for (value, expected) in [
        (0.0, "0"),
        (-0.0, "0"),
        (1.0, "1"),
        (-2.5, "\u{2212}2.5"),
        (0.5457515, "0.5457515"),
        (0.00012345, "0.00012345"),
        (4.8e6, "4\u{202f}800\u{202f}000"),
        (12345.678, "12\u{202f}345.68"),
        (9999.5, "9999.5"),
        (9_999_999.96, "10\u{2077}"),
        (1.0932689616568709e-7, "1.093269 \u{d7} 10\u{207b}\u{2077}"),
        (-1e-300, "\u{2212}10\u{207b}\u{b3}\u{2070}\u{2070}"),
        (1.0 / 3.0, "0.3333333"),
        (0.1 + 0.2, "0.3"),
    ] {
        assert_eq!(number(value, 7).as_deref(), Some(expected), "{value:e}");
    }
    for (text, expected) in [
        (
            "error of a.b, 3.0e-7, of",
            "error of a.b, 3 \u{d7} 10\u{207b}\u{2077}, of",
        ),
        ("(-1e9); 2.0e-3.", "(\u{2212}10\u{2079}); 0.002."),
        (
            "file1e5.json column 2 tree.e1 e 1.5",
            "file1e5.json column 2 tree.e1 e 1.5",
        ),
    ] {
        assert_eq!(crate::document::number::with_numbers(text), expected);
    }
    assert_eq!(number(f64::NAN, 7), None);
    assert_eq!(number(f64::NEG_INFINITY, 7), None);
}

#[test]
fn pictures_move_only_where_there_are_some_and_stand_still_without_scripts() {
    use crate::document::animated::{Animation, AnimationTrack};
    let svg = crate::chart::Svg::new(
        8.0,
        4.0,
        "<g data-m=\"0\" transform=\"translate(1 2)\"></g>",
    );
    let animation = |x: f64| {
        let places = vec![[1.0, 2.0], [x, 2.0]];
        Animation {
            svg: svg.clone(),
            still_time: 0.5,
            times: vec![0.5, 1.0],
            tracks: vec![(0, AnimationTrack::Displacement(places))],
        }
    };
    let with = |animation: Animation| {
        let mut report = report();
        let picture = Picture::Animation(Box::new(animation));
        report
            .sections
            .push(ReportSection::new("x").figure(picture, "It moves."));
        report.html(None)
    };
    let scripts = |page: &str| {
        parse(page)
            .0
            .iter()
            .filter(|(name, _)| name == "script")
            .count()
    };
    let moving = with(animation(3.125)).expect("numbers");
    // its data, and what moves it
    assert_eq!(scripts(&moving), scripts(&page()) + 2);
    assert!(moving.contains("translate(1 2)") && !moving.contains("http"));
    let (tags, _) = parse(&moving);
    let data = tags
        .iter()
        .find(|(_, attributes)| attributes.contains_key("data-still"))
        .expect("data");
    assert_eq!(data.1["data-still"], "0.5");
    assert!(
        moving.contains(r#""x":{"s":-2,"n":2,"v":[100,213]},"y":{"s":-2,"n":2,"v":[200,0]}"#),
        "hundredths of pixels"
    );
    assert!(
        !tags
            .iter()
            .any(|(name, _)| name == "button" || name == "input"),
        "the script makes them"
    );
    assert_eq!(
        with(animation(f64::NAN)),
        Err(Error::Animation {
            section: 2,
            figure: 0
        })
    );
}

/// Rules of the style sheet inside the first block that begins with `start`.
fn block<'p>(page: &'p str, start: &str) -> &'p str {
    let (_, rest) = page
        .split_once(start)
        .unwrap_or_else(|| panic!("{start} is in the style"));
    let mut depth = 1;
    let end = rest.char_indices().find(|(_, c)| {
        depth += i32::from(*c == '{') - i32::from(*c == '}');
        depth == 0
    });
    &rest[..end.expect("the block ends").0]
}

#[test]
fn print_has_pages_of_its_own() {
    let mut report = report();
    report.sections[0] = std::mem::take(&mut report.sections[0]).ending_page();
    let page = report.html(None).expect("the report is complete");
    let print = block(&page, "@media print {");
    for rule in [
        "color-scheme: light",
        ".ends-page { break-after: page; }",
        "h2 {",
        "break-after: avoid",
    ] {
        assert!(print.contains(rule), "{rule}");
    }
    let whole = print
        .lines()
        .find(|line| line.contains("break-inside: avoid"))
        .expect("whole parts");
    assert!(
        ["figure", "tr", ".short"]
            .iter()
            .all(|part| whole.contains(part)),
        "{whole}"
    );
    // the colours of a dark screen never reach paper
    assert!(page.matches("prefers-color-scheme: dark").count() == 1);
    assert!(page.contains("@media screen and (prefers-color-scheme: dark)"));
    // both A4 and Letter: the printer chooses the size
    assert!(page.contains("@page {") && !page.contains("size: A4"));
    let sections: Vec<_> = parse(&page)
        .0
        .into_iter()
        .filter(|(name, _)| name == "section")
        .collect();
    let ends = |k: usize| {
        sections[k]
            .1
            .get("class")
            .is_some_and(|class| class == "ends-page")
    };
    assert!(ends(0) && !ends(1), "the first section ends its page");
}

#[test]
fn the_lower_margin_has_title_and_page_and_no_markup() {
    let mut report = report();
    report.title = "A \"50 t\" crane \\ </style>}".into();
    let page = report.html(None).expect("the report is complete");
    assert!(page.contains("counter(page) \" of \" counter(pages)"));
    assert!(page.contains(
        r#"content: "A \22 50 t\22  crane \5c  \3c \2f style\3e \7d  \2013  report.html""#
    ));
    parse(&page);
}

#[test]
fn cells_of_wide_tables_name_their_columns() {
    let table = |columns: usize, rows: usize| ReportTable {
        caption: String::new(),
        columns: (0..columns)
            .map(|k| TableColumn::new(format!("c{k}"), "kN"))
            .collect(),
        rows: vec![vec![1.0.into(); columns]; rows],
    };
    let section = ReportSection::new("x")
        .table(table(3, 2))
        .table(table(4, 24))
        .table(table(12, 25));
    let report = Report {
        title: "t".into(),
        subtitle: String::new(),
        sections: vec![section],
    };
    let (tags, _) = parse(&report.html(None).expect("numbers"));
    let labels: Vec<_> = tags
        .iter()
        .filter_map(|(_, attributes)| attributes.get("style"))
        .collect();
    assert_eq!(labels.len(), 2, "three columns fit on any screen");
    assert!(
        labels[0].starts_with("--c1:\"c0 (kN)\";--c2:\"c1 (kN)\";"),
        "{}",
        labels[0]
    );
    assert!(labels[1].ends_with("--c12:\"c11 (kN)\";"), "{}", labels[1]);
    let classes: Vec<&str> = tags
        .iter()
        .filter(|(name, _)| name == "div")
        .filter_map(|(_, attributes)| attributes.get("class").map(String::as_str))
        .collect();
    assert_eq!(
        classes,
        [
            "scroll short roomy",
            "scroll short roomy",
            "scroll roomy wide wider"
        ]
    );
}

/// Columns of numbers are aligned, whether they are numbers or their texts; texts with words or units are not. Keys between
/// backticks have letters of their own. A row that is wider than a page keeps its cells broken.
#[test]
fn numbers_are_aligned_and_keys_are_code() {
    let row =
        |value: &str, x: &str| vec![TableCell::from(value), TableCell::from(x), TableCell::Empty];
    let table = ReportTable {
        caption: String::new(),
        columns: ["value", "x", "none"]
            .map(|name| TableColumn::new(name, ""))
            .to_vec(),
        rows: vec![
            row("12 kN", "\u{2212}3.5"),
            row("1 kN", "2 \u{d7} 10\u{207b}\u{b9}\u{b2}"),
        ],
    };
    let long = ReportTable {
        rows: vec![row(&"long ".repeat(60), "1")],
        ..table.clone()
    };
    let section = ReportSection::new("x")
        .paragraph("Set `fy` <1>.")
        .table(table)
        .table(long);
    let report = Report {
        title: "t".into(),
        subtitle: String::new(),
        sections: vec![section],
    };
    let page = report.html(None).expect("texts");
    assert!(
        page.contains("Set <code>fy</code> &lt;1&gt;."),
        "keys are code"
    );
    assert_eq!(
        page.matches("<th scope=\"col\" class=\"number\">x</th>")
            .count(),
        2
    );
    assert!(!page.contains("class=\"number\">12 kN") && !page.contains("class=\"number\">none"));
    assert_eq!(
        page.matches("class=\"scroll short roomy\"").count(),
        1,
        "the long one is not"
    );
}
