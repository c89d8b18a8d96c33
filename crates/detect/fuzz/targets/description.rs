//! Descriptions that are any text: `cargo +nightly fuzz run description` in `crates/detect`.
#![no_main]

use pomona_detect::ModelDescription;

libfuzzer_sys::fuzz_target!(|text: &str| {
    if let Err(error) = ModelDescription::parse(text, "fuzz.toml") {
        assert!(error.to_string().starts_with("fuzz.toml: "));
    }
});
