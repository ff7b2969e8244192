//! Tells the linker of a microcontroller's image what its chip has and needs, and lets it refuse another chip's memory map.

use std::env;

fn main() {
    println!("cargo:rerun-if-changed=memory");
    println!("cargo:rerun-if-changed=../memory.x");
    if env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("none") {
        return;
    }
    let has = |feature: &str| env::var_os(format!("CARGO_FEATURE_{feature}")).is_some();
    let here = env::var("CARGO_MANIFEST_DIR").expect("cargo sets it");
    // Where the linker finds the map.x that memory.x, at the top of the workspace, includes. An image for no board at all, as for
    // QEMU, has the STM32s' map unless scripts/mcu --memory names another.
    let chip = if has("ESP32C6") {
        "esp32c6"
    } else if has("RP2040_PARTS") {
        "rp2040"
    } else if has("RP2350_PARTS") {
        "rp2350"
    } else {
        "stm32"
    };
    let map = if has("STM32F103") { "stm32f103" } else { chip };
    println!("cargo:rustc-link-search={here}/memory/{map}");
    if has("DEFMT") {
        println!("cargo:rustc-link-arg=-Tdefmt.x");
    }
    if chip == "esp32c6" {
        // Its HAL's scripts have all else.
        println!("cargo:rustc-link-arg=-Tlinkall.x");
    } else if has("STM32") || chip != "stm32" {
        println!("cargo:rustc-link-arg=-T{here}/memory/{chip}/chip.x");
    }
    if chip == "rp2040" {
        // Functions that are equal to the byte, such as readers of message fields of one length, once.
        println!("cargo:rustc-link-arg=--icf=all");
    }
}
