//! What is for compilers goes through them, and does what the model does.

use super::super::samples::{Known, linear, result, subject};
use super::super::{Format, Side};
use super::numbers::{STEPS, command, speeds};
use super::{of_everything, stated, texts, write};
use servoid_formula::Point;
use servoid_plant as bench;
use shared::effects::Kind;
use std::fs;
use std::path::PathBuf;
use std::process::Command;
use testing::left_out::tool;

fn passes(mut command: Command, case: &str, text: &str) {
    let done = command.output().expect("it starts");
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(
        done.status.success() && said.is_empty(),
        "{case}: {said}\n{text}"
    );
}

#[test]
fn headers_and_modules_compile_without_a_warning() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let (mut c, mut rust, mut python) = (String::new(), String::new(), Vec::new());
    for (k, (format, _, _, written)) in texts().into_iter().enumerate() {
        // All in one, since a compiler takes longer to start than to read them.
        match format {
            "c" => {
                // All headers meet in one file: each law's functions get a name of their own.
                let text = (written.text).replace("servoid_swing", &format!("servoid_swing_{k}"));
                fs::write(path(&format!("m{k}.h")), text).expect("a file");
                c += &format!(
                    "#include \"m{k}.h\"\nstatic const float s{k}[] = {{ SERVOID_STEP_W_BY_V, SERVOID_SAMPLE }};\n"
                );
                c += &format!(
                    "float f{k}(void);\nfloat f{k}(void) {{ return s{k}[0] + s{k}[1]; }}\n#undef SERVOID_MOTOR_H\n"
                );
                for line in written
                    .text
                    .lines()
                    .filter(|line| line.starts_with("#define SERVOID_"))
                {
                    let name = line.split(' ').nth(1).expect("a name");
                    c += &format!("#undef {name}\n");
                }
            }
            "rust" => {
                rust += &format!(
                    "/// Of one result.\npub mod m{k} {{\n{}\n}}\n",
                    written.text
                )
            }
            "python" => {
                let name = format!("m{k}.py");
                fs::write(path(&name), &written.text).expect("a file");
                python.push(path(&name));
            }
            _ => {}
        }
    }
    if let Some(mut interpreter) = tool("python3") {
        interpreter
            .args(["-W", "error", "-m", "py_compile"])
            .args(&python);
        passes(interpreter, "python", "");
    }
    if let Some(mut gcc) = tool("gcc") {
        fs::write(path("all.c"), &c).expect("a file");
        gcc.args([
            "-fsyntax-only",
            "-std=c99",
            "-Wall",
            "-Wextra",
            "-Werror",
            "-pedantic",
        ]);
        gcc.arg(path("all.c"));
        passes(gcc, "c", "");
    }
    if let Some(mut rustc) = tool("rustc") {
        let text =
            format!("//! All of them.\n#![no_std]\n#![deny(warnings, missing_docs)]\n{rust}");
        fs::write(path("all.rs"), text).expect("a file");
        rustc.args([
            "--edition",
            "2024",
            "--crate-type",
            "lib",
            "--emit",
            "metadata",
            "--extern",
        ]);
        rustc.arg(format!("libm={}", libm().display()));
        rustc.arg("-o").arg(path("all.rmeta")).arg(path("all.rs"));
        passes(rustc, "rust", "");
    }
}

/// The crate that the laws in Rust need, as it was built for this test.
fn libm() -> PathBuf {
    let own = std::env::current_exe().expect("this test");
    let folder = own.parent().expect("its folder");
    let files = fs::read_dir(folder).expect("its folder");
    let paths = files.map(|file| file.expect("a file").path());
    let is_libm = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("liblibm-") && name.ends_with(".rmeta")
    };
    paths.into_iter().find(is_libm).expect("libm was built")
}

#[test]
fn a_law_gives_in_c_and_in_python_what_it_gives_here() {
    for kind in [stated(), of_everything()] {
        gives_the_same(kind);
    }
}

fn gives_the_same(kind: Kind) {
    let found = result(&bench::Machine::gearmotor(), &[kind], Known::All);
    let subject = subject(&found, Side::Motor);
    let values = &subject.terms[0].values;
    let definition = &servoid_formula::law_of(kind).expect("a law").definition;
    let mut points = Vec::new();
    for speed in [-30.0, -2.0, 0.0, 5.0, 40.0] {
        for angle in [0.0, 1.0, 4.0] {
            for current in [-3.0, 0.5, 1.9] {
                points.push(Point {
                    speed,
                    angle,
                    current,
                    transmitted: current,
                    command: 1.0,
                    time: 0.0,
                    temperature: 30.0 + 10.0 * current,
                    states: [0.3, 0.7],
                });
            }
        }
    }
    let expected: Vec<f64> = points
        .iter()
        .flat_map(|point| {
            let rates = definition.rates(values, point);
            std::iter::once(definition.value(values, point))
                .chain(rates.into_iter().take(definition.states.len()))
        })
        .collect();
    let arguments = |p: &Point| {
        let all = [p.speed, p.angle, p.current, p.transmitted, p.command];
        let states = p.states.into_iter().take(definition.states.len());
        let temperature = definition.is_of_temperature().then_some(p.temperature);
        let all = all.into_iter().chain(states).chain(temperature);
        all.map(|x| format!("{x:?}")).collect::<Vec<_>>().join(", ")
    };
    let functions: Vec<String> = ["", "_rate", "_rate2"]
        .iter()
        .take(1 + definition.states.len())
        .map(|what| format!("{}{what}", definition.name))
        .collect();
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let text = |name: &str| {
        write(Format::by_name(name).expect("a format"), &subject)
            .expect(name)
            .text
    };
    let matches = |out: Vec<u8>, language: &str| {
        let out = String::from_utf8(out).expect("text");
        let got: Vec<f64> = out
            .split_whitespace()
            .map(|x| x.parse().expect("a number"))
            .collect();
        assert_eq!(got.len(), expected.len(), "{language}");
        for (got, expected) in got.iter().zip(&expected) {
            assert!(
                (got - expected).abs() <= 1e-12 * expected.abs().max(1.0),
                "{language}: {got} {expected}"
            );
        }
    };
    if let Some(mut gcc) = tool("gcc") {
        fs::write(path("motor.h"), text("c")).expect("a header");
        let calls = points.iter().map(arguments).flat_map(|a| {
            let call = move |name: &String| format!("printf(\"%.17g\\n\", servoid_{name}({a}));\n");
            functions.iter().map(call).collect::<Vec<_>>()
        });
        let main = format!(
            "#include <stdio.h>\n#include \"motor.h\"\nint main(void) {{\n{}return 0; }}\n",
            calls.collect::<String>()
        );
        fs::write(path("main.c"), main).expect("a program");
        gcc.args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-o"]);
        gcc.arg(path("main")).arg(path("main.c")).arg("-lm");
        passes(gcc, "c", "");
        matches(
            Command::new(path("main")).output().expect("it runs").stdout,
            "c",
        );
    }
    if let Some(mut interpreter) = tool("python3") {
        // What of numpy the law calls, where numpy is not installed.
        fs::write(
            path("numpy.py"),
            "from math import *\nabs, minimum, maximum = abs, min, max\n\n\ndef sign(x):\n    return (x > 0) - (x < 0)\n",
        )
        .expect("a stand-in");
        let calls = points.iter().map(arguments).flat_map(|a| {
            let call = move |name: &String| format!("print({name}({a}))\n");
            functions.iter().map(call).collect::<Vec<_>>()
        });
        fs::write(
            path("motor.py"),
            text("python") + &calls.collect::<String>(),
        )
        .expect("a program");
        interpreter.arg(path("motor.py"));
        matches(interpreter.output().expect("it runs").stdout, "python");
    }
}

#[test]
fn a_program_with_the_header_follows_the_model() {
    let Some(mut gcc) = tool("gcc") else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let subject = subject(
        &linear(&bench::Machine::gearmotor(), Known::All),
        Side::Motor,
    );
    let written = write(Format::by_name("c").expect("a format"), &subject).expect("a header");
    let path = |name: &str| folder.path().join(name);
    fs::write(path("motor.h"), &written.text).expect("a header");
    let volts: Vec<String> = (0..STEPS)
        .map(|k| format!("{:?}f", command(k) as f32))
        .collect();
    let program = format!(
        "#include <stdio.h>\n#include \"motor.h\"\nint main(void) {{ float c = 0, w = 0; static const float v[] = {{ {} }};\n\
         for (unsigned k = 0; k < {STEPS}; k++) {{ float dc = SERVOID_STEP_C_BY_C*c + SERVOID_STEP_C_BY_W*w + SERVOID_STEP_C_BY_V*v[k];\n\
         w += SERVOID_STEP_W_BY_C*c + SERVOID_STEP_W_BY_W*w + SERVOID_STEP_W_BY_V*v[k]; c += dc; printf(\"%g\\n\", (double)w); }} return 0; }}\n",
        volts.join(", ")
    );
    fs::write(path("main.c"), program).expect("a program");
    gcc.args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-o"]);
    gcc.arg(path("main")).arg(path("main.c"));
    passes(gcc, "c", &written.text);
    let out = Command::new(path("main")).output().expect("it runs").stdout;
    let out = String::from_utf8(out).expect("text");
    let ran: Vec<f64> = out
        .lines()
        .map(|line| line.parse().expect("a number"))
        .collect();
    let truth = speeds(&subject);
    assert_eq!(ran.len(), truth.len());
    for (k, (ran, truth)) in ran.iter().zip(&truth).enumerate() {
        assert!((ran - truth).abs() < 2e-3, "step {k}: {ran}, not {truth}");
    }
}
