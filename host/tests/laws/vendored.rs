//! What pages have of others: each file is the one that came, has its licence beside it, and ends no script of the page around it.

use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

#[test]
fn what_is_vendored_is_what_came_with_its_licence() {
    let host = Path::new(env!("CARGO_MANIFEST_DIR"));
    for folder in [
        "src/workbench/assets/vendor",
        "results/src/page/assets/vendor",
    ] {
        let folder = host.join(folder);
        let sums = fs::read_to_string(folder.join("SHA256SUMS")).expect("sums");
        let mut named = BTreeSet::from(["SHA256SUMS".to_owned()]);
        for line in sums.lines() {
            let (sum, name) = line.split_once("  ").expect("a sum and a name");
            let bytes = fs::read(folder.join(name)).expect(name);
            let own: String = Sha256::digest(&bytes)
                .iter()
                .map(|byte| format!("{byte:02x}"))
                .collect();
            assert_eq!(own, sum, "{name}");
            assert!(
                !String::from_utf8_lossy(&bytes).contains("</script"),
                "{name}"
            );
            named.insert(name.to_owned());
        }
        let there: BTreeSet<String> = fs::read_dir(&folder)
            .expect("a folder")
            .map(|file| {
                file.expect("a file")
                    .file_name()
                    .to_string_lossy()
                    .into_owned()
            })
            .collect();
        assert_eq!(there, named);
        for name in &named {
            let of = name.split(['-', '.']).next().unwrap_or_default();
            let licence = format!("{of}-LICENSE");
            assert!(
                name == "SHA256SUMS" || there.contains(&licence),
                "{licence}"
            );
        }
    }
}
