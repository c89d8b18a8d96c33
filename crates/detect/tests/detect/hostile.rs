//! Networks and descriptions that are anything at all: errors, or boxes in the image; never a panic.

use crate::any_network;
use pomona_detect::ModelDescription;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

/// Pieces of descriptions, right and wrong, and what text may hold besides.
fn pieces() -> impl Strategy<Value = String> {
    let piece = prop_oneof![
        Just("family = 'yolov8'\n"),
        Just("family = "),
        Just("classes = ['a', 'b'"),
        Just("]\n"),
        Just("class = 3\n"),
        Just("anchors = [[1, 2], [3"),
        Just("input_size = [416, -1]\n"),
        Just("mean = [nan, inf, 1e400]\n"),
        Just("threshold = 0.5\n"),
        Just("[tiling]\n"),
        Just("é = \"\\u{0}\"\n"),
        Just("\n"),
        Just("= 'x'\n"),
        Just("#"),
        Just("\"\"\""),
    ];
    let text = prop::collection::vec(
        prop_oneof![4 => piece.prop_map(str::to_owned), 1 => any::<String>()],
        0..8,
    );
    text.prop_map(|pieces| pieces.concat())
}

#[test]
fn any_network_is_survived() {
    // The same networks each time, so that the counts below hold.
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]);
    let mut runner = TestRunner::new_with_rng(Config::with_cases(0), rng);
    let (mut answered, mut seen) = (0, 0);
    for _ in 0..4000 {
        let bytes = prop::collection::vec(any::<u8>(), 0..400);
        let bytes = bytes.new_tree(&mut runner).unwrap().current();
        if let Some(found) = any_network::detect_with(&bytes) {
            answered += 1;
            seen += usize::from(!found.is_empty());
        }
    }
    println!("{answered} of 4000 networks answered, {seen} of them with boxes");
    // Bytes that never get past the checks would test nothing.
    assert!(answered >= 100, "{answered}");
    assert!(seen >= 30, "{seen}");
}

proptest! {
    #[test]
    fn any_description_is_survived(text in pieces()) {
        if let Err(error) = ModelDescription::parse(&text, "any.toml") {
            let message = error.to_string();
            prop_assert!(message.starts_with("any.toml: "), "{}", message);
            prop_assert!(!message.contains('\n'), "{}", message);
        }
    }
}
