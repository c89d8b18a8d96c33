//! Files of strokes that are any text: `cargo +nightly fuzz run strokes` in `crates/labels`.
#![no_main]

use pomona_labels::parse_strokes;

libfuzzer_sys::fuzz_target!(|text: &str| {
    match parse_strokes(text, "fuzz.txt".as_ref()) {
        Ok(images) => {
            for stroke in images.iter().flat_map(|image| &image.strokes) {
                assert!(stroke.points.len() >= 2 && stroke.length().is_finite());
            }
        }
        Err(error) => assert!(error.to_string().starts_with("fuzz.txt: line ")),
    }
});
