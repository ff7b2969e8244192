//! Puts the second stage of the boot loader where the chip looks for it: without this script the image links, and does not boot.

fn main() {
    println!("cargo:rerun-if-changed=memory.x");
    println!("cargo:rustc-link-arg=-Tlink-rp.x");
}
