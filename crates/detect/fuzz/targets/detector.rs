//! A network that declares and answers anything: `cargo +nightly fuzz run detector` in `crates/detect`.
#![no_main]

#[path = "../any_network.rs"]
mod any_network;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    any_network::detect_with(data);
});
