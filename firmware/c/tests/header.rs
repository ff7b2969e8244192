//! The header is what cbindgen makes of the sources: `UPDATE_REFERENCE=1 cargo test -p servoid-c --test header` writes it anew.

use std::path::Path;

#[test]
fn the_header_declares_what_the_library_has() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(root.join("cbindgen.toml")).unwrap();
    let mut made = Vec::new();
    cbindgen::Builder::new()
        .with_config(config)
        .with_src(root.join("src/recording.rs"))
        .with_src(root.join("src/status.rs"))
        .with_src(root.join("src/fit.rs"))
        .with_src(root.join("src/predict.rs"))
        .with_src(root.join("src/servo.rs"))
        .generate()
        .unwrap()
        .write(&mut made);
    let made = String::from_utf8(made).unwrap();
    let path = root.join("include/servoid.h");
    if std::env::var_os("UPDATE_REFERENCE").is_some() {
        std::fs::write(&path, &made).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        kept == made,
        "include/servoid.h is not what the sources say: run this test with UPDATE_REFERENCE=1"
    );
}
