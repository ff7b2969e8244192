//! `servoid fit --cost interval` and `--profile`.

use crate::contract::{has, list, number};
use crate::desk::Desk;
use crate::width::fits_a_terminal;

fn desk() -> Desk {
    let desk = Desk::new();
    desk.done("simulate --seconds 5 --seed 1 --angle-noise 0.05 --out noisy.csv");
    desk.done("simulate --seconds 5 --seed 2 --out other.csv");
    desk
}

#[test]
fn the_noise_before_the_counter_is_told() {
    let desk = desk();
    let fit = desk.json("fit noisy.csv --cost interval");
    assert_eq!(fit["cost_kind"], "interval");
    let (noise, std) = (
        number(&fit, "sigma_counts"),
        number(&fit, "sigma_std_counts"),
    );
    assert!((noise - 0.05).abs() < 5.0 * std, "{noise} with {std}");
    let text = desk.done("fit noisy.csv --cost interval").stdout;
    assert!(text.contains("noise before the counter"), "{text}");
    // Several recordings have one noise, and each its own start.
    let both = desk.json("fit noisy.csv other.csv --cost interval");
    let between = number(&both, "sigma_counts");
    assert!((0.01..0.05).contains(&between), "{between}");
    assert!(desk.json("fit noisy.csv").get("sigma_counts").is_none());
    // Other searches and windows minimise it with a noise that is given.
    for flags in ["--algorithm nelder_mead --budget 500", "--window 0.5"] {
        let fit = desk.json(&format!("fit noisy.csv --cost interval {flags}"));
        assert!(fit.get("sigma_counts").is_none(), "{flags}: {fit}");
    }
}

#[test]
fn profiles_are_told_drawn_and_written() {
    let desk = desk();
    for cost in ["squared", "interval"] {
        let line =
            format!("fit noisy.csv --profile --cost {cost} --report page.html --json p.json");
        let text = desk.done(&line).stdout;
        assert!(
            text.contains("profile likelihood: 95 % intervals"),
            "{text}"
        );
        fits_a_terminal("fit", &text);
        assert!(
            desk.read("page.html")
                .contains("signed root of the deviance")
        );
        for profile in list(&desk.read_json("p.json"), "profiles") {
            has(
                profile,
                "name: text, unit: text, best: number, low: number, high: number, points: list",
            );
            let (low, best, high) = (
                number(profile, "low"),
                number(profile, "best"),
                number(profile, "high"),
            );
            assert!(low < best && best < high, "{profile}");
        }
    }
    // The page of a saved result is the same.
    desk.done("report p.json --out again.html");
    assert!(
        desk.read("again.html")
            .contains("signed root of the deviance")
    );
}

#[test]
fn what_has_no_likelihood_has_no_profile() {
    let desk = desk();
    for (flags, says) in [
        ("--cost iae", "no likelihood"),
        ("--algorithm pso", "leave out --algorithm"),
    ] {
        desk.refused(
            &format!("fit noisy.csv --profile {flags}"),
            2,
            &["--profile", says],
        );
    }
    desk.refused(
        "fit noisy.csv other.csv --own gain --profile",
        2,
        &["--profile", "leave out --own"],
    );
}

#[test]
fn errors_of_the_recording_stand_beside_standard_errors() {
    let desk = desk();
    let fit = desk.json("fit other.csv");
    let gain = &list(&fit, "parameters")[0];
    let causes: Vec<&str> = (list(gain, "systematic").iter())
        .filter_map(|one| one["cause"].as_str())
        .collect();
    assert_eq!(causes, ["latency", "encoder_edges", "command_scale"]);
    let scale = &list(gain, "systematic")[2];
    let expected = number(gain, "value") * (1.0 / 1.01 - 1.0);
    assert!(
        (number(scale, "change") / expected - 1.0).abs() < 1e-6,
        "{scale}"
    );
    // The digits end where the largest of them begins.
    let text = desk.done("fit other.csv").stdout;
    let line = text
        .lines()
        .find(|line| line.starts_with("  gain  "))
        .unwrap();
    assert!(line.contains("58.36 ") && line.contains(", std "), "{line}");
    assert!(text.contains("10 us latency"), "{text}");
}
