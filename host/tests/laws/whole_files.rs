//! Output files are written whole or not at all.

use std::fs;
use std::io;

use servoid_io::output::write_whole;

fn names(folder: &std::path::Path) -> Vec<String> {
    fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect()
}

#[test]
fn a_failure_leaves_the_old_file_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.json");
    for old in [None, Some("old")] {
        if let Some(old) = old {
            fs::write(&path, old).unwrap();
        }
        let error = write_whole(&path, |out| {
            out.write_all(b"half")?;
            Err(io::Error::other("the disk is full"))
        });
        let message = error.unwrap_err().to_string();
        assert!(
            message.contains("out.json: cannot be written: the disk is full; nothing was changed"),
            "{message}"
        );
        assert_eq!(fs::read_to_string(&path).ok().as_deref(), old);
        assert_eq!(names(folder.path()).len(), usize::from(old.is_some()));
    }
}

#[test]
fn a_panic_leaves_nothing_either() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.json");
    let panicked = std::panic::catch_unwind(|| {
        let _ = write_whole(&path, |_| panic!("on purpose"));
    });
    assert!(panicked.is_err());
    assert!(names(folder.path()).is_empty());
}

#[test]
fn a_success_replaces_the_old_file_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.json");
    fs::write(&path, "a much longer old file").unwrap();
    write_whole(&path, |out| out.write_all(b"new")).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "new");
    assert_eq!(names(folder.path()), ["out.json"]);
}

#[test]
fn a_folder_and_a_missing_folder_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let message = write_whole(folder.path(), |_| Ok(()))
        .unwrap_err()
        .to_string();
    assert!(
        message.ends_with("is a folder; name a file inside it"),
        "{message}"
    );
    let message = write_whole(&folder.path().join("none/out.json"), |_| Ok(()))
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("does not exist; make it first"),
        "{message}"
    );
}

#[cfg(unix)]
#[test]
fn links_are_followed_devices_survive_and_modes_are_kept() {
    use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
    let folder = tempfile::tempdir().unwrap();
    let (file, link) = (folder.path().join("file"), folder.path().join("link"));
    fs::write(&file, "old").unwrap();
    fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
    symlink(&file, &link).unwrap();
    write_whole(&link, |out| out.write_all(b"new")).unwrap();
    assert_eq!(fs::read_to_string(&file).unwrap(), "new");
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(
        fs::metadata(&file).unwrap().permissions().mode() & 0o777,
        0o640
    );

    let device = folder.path().join("null");
    symlink("/dev/null", &device).unwrap();
    write_whole(&device, |out| out.write_all(b"gone")).unwrap();
    assert!(
        fs::metadata("/dev/null")
            .unwrap()
            .file_type()
            .is_char_device()
    );
}
