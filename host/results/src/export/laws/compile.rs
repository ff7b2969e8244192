//! What is for compilers goes through them, and does what the model does.

use super::super::samples::{Known, linear, subject};
use super::super::{Format, Side};
use super::numbers::{STEPS, command, speeds};
use super::{texts, write};
use servoid_plant as bench;
use std::fs;
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
    let (mut c, mut rust) = (String::new(), String::new());
    for (k, (format, _, _, written)) in texts().into_iter().enumerate() {
        // All in one, since a compiler takes longer to start than to read them.
        match format {
            "c" => {
                fs::write(path(&format!("m{k}.h")), &written.text).expect("a file");
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
            _ => {}
        }
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
            "-o",
        ]);
        rustc.arg(path("all.rmeta")).arg(path("all.rs"));
        passes(rustc, "rust", "");
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
