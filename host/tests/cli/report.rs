//! Results as pages.

use crate::desk::Desk;
use crate::width::unfolded;
use serde_json::Value;

/// Most bytes of the page of twenty seconds at 1 kHz.
const MOST: usize = 8_000_000;

/// A page that stands alone: whole, small enough, and nothing in it could be fetched.
pub fn is_alone(page: &str) {
    assert!(page.starts_with("<!doctype html>") && page.trim_end().ends_with("</html>"));
    assert!(page.len() < MOST, "{} bytes", page.len());
    assert!(page.contains("Content-Security-Policy\" content=\"default-src 'none';"));
    let words = without_scripts(page);
    for outside in ["http:", "https:", "src=", "@import", "url(", "NaN", "inf "] {
        assert!(!words.contains(outside), "the page mentions {outside}");
    }
    for link in words.split("href=\"").skip(1) {
        assert!(link.starts_with('#'), "a link leads to {}", &link[..40]);
    }
    let drawings = drawings(page);
    let places = words.matches("class=\"plot\"").count();
    let drawings = drawings.as_object().expect("drawings by their places");
    assert_eq!(drawings.len(), places, "each place has its drawing");
    for (id, drawing) in drawings {
        let place = format!("class=\"plot\" id=\"{id}\"");
        assert!(words.contains(&place), "{id} has a place");
        assert!(drawing["chart"]["data"].is_array() || drawing["timeline"]["measured"].is_string());
    }
}

fn without_scripts(page: &str) -> String {
    let mut parts = page.split("<script");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |words, part| {
        words + part.rsplit_once("</script>").map_or("", |(_, rest)| rest)
    })
}

/// The drawings of a page by their places.
fn drawings(page: &str) -> Value {
    let begin = "<script type=\"application/json\" id=\"drawings\">";
    let from = page.find(begin).expect("drawings") + begin.len();
    let text = &page[from..];
    serde_json::from_str(&text[..text.find("</script>").expect("an end")]).expect("JSON")
}

/// Steady speeds of a motor that loses 0.3 V at every one of them.
fn steady_speeds() -> String {
    let volts = (-8i32..=8).filter(|volts| *volts != 0).map(f64::from);
    let rows: Vec<String> = volts
        .map(|volts| format!("{volts},{:.4}\n", (volts - 0.3 * volts.signum()) / 0.05))
        .collect();
    format!("voltage_V,speed_rad_s\n{}", rows.concat())
}

#[test]
fn every_result_becomes_the_same_page_at_once_and_from_its_file() {
    let desk = Desk::with_recording();
    desk.done("simulate --seconds 4 --hide coulomb --out friction.csv");
    desk.done("simulate --seconds 4 --hide coulomb --seed 2 --out other.csv");
    desk.write("curve.csv", steady_speeds());
    for (verb, holds) in [
        (
            "diagnose curve.csv",
            vec![
                "Voltage against steady speed",
                "A constant 0.300 V",
                "brush_drop",
            ],
        ),
        (
            "fit rec.csv",
            vec!["Measured and model", "Is the rest noise?", "gain margin"],
        ),
        (
            "fit friction.csv --with coulomb --validate other.csv",
            vec!["What each effect brings", "never fitted"],
        ),
        (
            "diagnose friction.csv --validate other.csv",
            vec![
                "The error falls",
                "coulomb",
                "What was tried here",
                "cannot tell",
            ],
        ),
        ("diagnose friction.csv", vec!["held out", "its end, from"]),
        (
            "compare rec.csv --seeds 2 --budget 40 --algorithm ga,pso,firefly",
            vec!["Cost against evaluations", "firefly"],
        ),
        (
            "paper --seeds 1 --iterations 10 --seconds 2",
            vec!["Table 1 of the paper", "paper&#39;s pso"],
        ),
    ] {
        desk.done(&format!("{verb} --json result.json --report at-once.html"));
        let outcome = desk.done("report result.json --out from-file.html");
        assert!(outcome.stdout.contains("from-file.html"), "{outcome}");
        let page = desk.read("at-once.html");
        is_alone(&page);
        assert_eq!(page, desk.read("from-file.html"), "{verb}");
        for words in holds {
            let plain = words.replace("&#39;", "'");
            assert!(page.contains(&plain), "{verb}: no {plain}");
        }
    }
}

#[test]
fn a_report_tells_what_it_drew_from() {
    let desk = Desk::with_recording();
    desk.done("fit rec.csv --json fit.json");
    let summary = desk.json("report fit.json --out page.html");
    assert_eq!(summary["schema"], "servoid.report/1");
    assert_eq!(summary["recording"], "rec.csv");
    assert_eq!(summary["page"], "page.html");
}

#[test]
fn a_recording_that_has_moved_is_looked_for_beside_the_result_and_asked_for() {
    let desk = Desk::with_recording();
    desk.done("fit rec.csv --json fit.json");
    desk.write("elsewhere/fit.json", desk.read("fit.json"));
    desk.write("elsewhere/rec.csv", desk.read("rec.csv"));
    desk.write("elsewhere/motor.toml", desk.read("motor.toml"));
    std::fs::remove_file(desk.path("rec.csv")).expect("it was there");
    desk.done("report elsewhere/fit.json --out found.html");
    assert!(desk.read("found.html").contains("id=\"timeline\""));
    let outcome = desk.done("report fit.json --out without.html");
    assert!(outcome.stderr.contains("--recording"), "{outcome}");
    let page = desk.read("without.html");
    is_alone(&page);
    assert!(page.contains("--recording") && !page.contains("id=\"timeline\""));
    desk.done("report fit.json --recording elsewhere/rec.csv --out named.html");
    assert_eq!(desk.read("named.html"), desk.read("found.html"));
}

#[test]
fn what_is_no_result_is_refused_and_nothing_is_written() {
    let desk = Desk::with_recording();
    desk.done("fit rec.csv --json fit.json");
    let fit = desk.read("fit.json");
    desk.write("empty.json", "");
    desk.write("half.json", &fit[..fit.len() / 2]);
    desk.write("other.json", "{\"schema\": \"servoid.plan/1\"}");
    desk.write("none.json", "[1, 2]");
    desk.write("old.json", fit.replace("\"model\"", "\"mobel\""));
    desk.write(
        "worse.json",
        fit.replace("\"kb_v_s_rad\": 0", "\"kb_v_s_rad\": -0"),
    );
    desk.write(
        "text.json",
        fit.replace("\"rms_counts\": 0", "\"rms_counts\": \"x\", \"r\": 0"),
    );
    std::fs::create_dir(desk.path("folder")).expect("a folder");
    for (name, says) in [
        ("missing.json", "cannot be read"),
        ("empty.json", "empty.json:1:"),
        ("half.json", "half.json:"),
        ("other.json", "servoid.plan/1"),
        ("none.json", "schema is `missing`"),
        ("old.json", "model"),
        ("worse.json", "kb_v_s_rad"),
        ("text.json", "x"),
        ("rec.csv", "rec.csv:1:"),
        ("folder", "device.json"),
    ] {
        desk.refused(&format!("report {name} --out page.html"), 1, &[name, says]);
    }
    desk.refused("report fit.json --out fit.json", 2, &["--out fit.json"]);
    desk.refused(
        "report fit.json --recording rec.csv --out rec.csv",
        2,
        &["--out rec.csv"],
    );
    // Also the recording that nobody names but the result.
    for out in ["rec.csv", "motor.toml"] {
        let line = format!("report fit.json --out {out}");
        desk.refused(&line, 2, &["--out", out, "of this run"]);
    }
}

#[test]
fn another_recording_than_the_result_s_is_drawn_with_a_warning() {
    let desk = Desk::new();
    let simulate = "simulate --seconds 4 --hide coulomb";
    desk.done(&format!("{simulate} --out rec.csv"));
    desk.done(&format!("{simulate} --seed 2 --out other.csv"));
    desk.done(&format!("{simulate} --seed 3 --out third.csv"));
    desk.done("simulate --seconds 0.1 --out short.csv");
    desk.done("fit rec.csv --with coulomb --validate other.csv --json fit.json");
    desk.done("diagnose rec.csv --json cut.json");
    desk.done("diagnose rec.csv --validate other.csv --json two.json");
    let page = |line: &str| {
        let shown = desk.done(&format!("report {line} --out page.html"));
        (shown.stderr, desk.read("page.html"))
    };
    let is_not = "is not the recording";
    for result in ["fit.json", "cut.json", "two.json"] {
        let (stderr, text) = page(&format!("{result} --recording rec.csv"));
        assert!(
            !stderr.contains(is_not) && !text.contains(is_not),
            "{result}: {stderr}"
        );
        let (stderr, text) = page(&format!("{result} --recording third.csv"));
        assert!(
            stderr.contains("third.csv is not") && text.contains("third.csv is not"),
            "{result}: {stderr}"
        );
    }
    for result in ["fit.json", "two.json"] {
        let (stderr, text) = page(&format!("{result} --validate third.csv"));
        assert!(
            stderr.contains("third.csv is not") && text.contains("third.csv is not"),
            "{result}: {stderr}"
        );
    }
    let (stderr, _) = page("cut.json --recording short.csv");
    assert!(stderr.contains("too short"), "{stderr}");
}

#[test]
fn a_page_calls_look_alikes_what_the_terminal_calls_them() {
    let desk = Desk::new();
    desk.done("simulate --hide coulomb --out rec.csv");
    let text = desk
        .done("diagnose rec.csv --json diagnosis.json --report page.html")
        .stdout;
    let diagnosis = desk.read_json("diagnosis.json");
    let page = desk.read("page.html");
    let flat = unfolded(&text);
    for step in diagnosis["steps"].as_array().expect("steps") {
        let names = |key: &str| -> Vec<&str> {
            let list = step[key].as_array().expect("names").iter();
            list.filter_map(Value::as_str).collect()
        };
        let refined = names("refined_by");
        assert!(
            !refined.is_empty(),
            "friction can always be refined: {step:#}"
        );
        let said = format!("{} would refine it", refined.join(" or "));
        assert!(flat.contains(&said) && page.contains(&said), "{said}");
    }
}

/// The numbers of the terminal stand on the page as they are, and its verdict.
#[test]
fn terminal_and_page_say_the_same() {
    let desk = Desk::new();
    desk.done("simulate --hide coulomb --out rubs.csv");
    desk.done("simulate --hide coulomb --seed 2 --out other.csv");
    for line in [
        "fit rubs.csv --with coulomb --kt-equals-kb",
        "fit rubs.csv --with coulomb --cost interval",
        "fit rubs.csv other.csv --with coulomb",
        "fit rubs.csv",
    ] {
        let text = desk.done(&format!("{line} --report page.html")).stdout;
        let page = desk.read("page.html");
        let parameters = text.split("in brackets:").nth(1).expect("parameters");
        let lines = parameters
            .lines()
            .skip(1)
            .take_while(|line| line.starts_with("  "));
        let mut compared = 0;
        for line in lines {
            let mut words = line.split_whitespace();
            let (name, value) = (
                words.next().expect("a name"),
                words.next().expect("a value"),
            );
            assert!(page.contains(&format!("<td>{name}</td>")), "{line}");
            if value.starts_with(|first: char| first.is_ascii_digit() || first == '-') {
                compared += 1;
                assert!(page.contains(&format!("<td>{value}</td>")), "{line}");
            }
        }
        assert!(compared >= 1, "{text}");
    }
    let text = desk
        .done("diagnose rubs.csv --validate other.csv --report page.html --json d.json")
        .stdout;
    let summary = desk.read_json("d.json")["summary"]
        .as_str()
        .expect("a verdict")
        .to_owned();
    let first = summary.split(". ").next().expect("a sentence");
    assert!(
        unfolded(&text).contains(&unfolded(first)),
        "{first}: {text}"
    );
    assert!(desk.read("page.html").contains(first), "{first}");
}
