//! Models that cannot be used: each gives a message with the file, the place and the remedy.

use crate::onnx::{self, Axis, F32, Model};
use crate::support::{noise, open_bytes, runtimes};
use pomona_network::{ModelSource, RuntimeChoice, open_network};

/// What every runtime says about a file.
fn messages(bytes: &[u8]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let say = |choice| match open_bytes(folder.path(), bytes, &choice) {
        Ok(network) => match network.run(&noise(network.as_ref(), 32, 1.0)) {
            Ok(_) => String::new(),
            Err(error) => error.to_string(),
        },
        Err(error) => error.to_string(),
    };
    runtimes().into_iter().map(say).collect()
}

/// Every runtime names the file and says all of this.
fn assert_refused(bytes: &[u8], parts: &[&str]) {
    for message in messages(bytes) {
        for part in ["model.onnx: "].iter().chain(parts) {
            assert!(message.contains(part), "`{part}` is not in: {message}");
        }
    }
}

#[test]
fn files_of_other_kinds() {
    assert_refused(
        b"",
        &[
            "is not an ONNX model but empty",
            "export or download it again",
        ],
    );
    assert_refused(
        b"\x89PNG\r\n\x1a\n",
        &["but a PNG image", "give the model's .onnx file"],
    );
    assert_refused(b"PK\x03\x04\x14\0\0\0", &["but a zip archive", "unpack it"]);
    let torch = b"PK\x03\x04\0\0\x08\x08\0\0\0\0\0\0yolov3/data.pkl";
    assert_refused(
        torch,
        &["but a PyTorch checkpoint", "export the model to ONNX"],
    );
    assert_refused(b"family = \"yolox\"\n", &["a text file, such as TOML"]);
    assert_refused(
        b"\x01\x02\x03\x04",
        &["is not an ONNX model; give a model exported as ONNX"],
    );
    assert_refused(&[0xff; 64], &["byte 0 of 64: is not an ONNX model"]);
}

#[test]
fn a_file_that_is_not_there() {
    for choice in runtimes() {
        let source = ModelSource::File("no/such/model.onnx".into());
        let error = open_network(&source, &choice, 1).err().unwrap().to_string();
        assert!(
            error.starts_with("no/such/model.onnx: cannot be read"),
            "{error}"
        );
    }
}

#[test]
fn a_file_cut_short_anywhere() {
    let whole = onnx::small().to_bytes();
    // Cuts that fall between two fields leave a file that is whole but lacks its end.
    for length in (2..whole.len()).step_by(7) {
        let folder = tempfile::tempdir().unwrap();
        let outcome = open_bytes(folder.path(), &whole[..length], &RuntimeChoice::Embedded);
        if let Err(error) = outcome {
            let error = error.to_string();
            assert!(
                error.contains("truncated") || error.contains("is not an ONNX model"),
                "{length}: {error}"
            );
        }
    }
    assert_refused(
        &whole[..whole.len() / 2],
        &["it is truncated", "export or download it again", "byte "],
    );
}

#[test]
fn operators_that_nobody_knows() {
    let mut model = onnx::small();
    model.node("Frobnicate", &["output"], &["frobnicated"], &[]);
    model.output("frobnicated", &[Axis::Open("any")]);
    assert_refused(
        &model.to_bytes(),
        &["Frobnicate", "opset 13", "try the other runtime"],
    );
    let mut model = onnx::small();
    model.opset = 9999;
    for message in messages(&model.to_bytes()) {
        // The embedded runtime takes any version of the operators that it knows.
        assert!(message.is_empty() || message.contains("9999"), "{message}");
    }
}

#[test]
fn weights_in_another_file() {
    let model = |file: &str| {
        let mut model = Model::new(1);
        model.input("images", &[1, 3, 4, 4].map(Axis::Fixed));
        model.weights_elsewhere("shift", &[4], file);
        model.node("Add", &["images", "shift"], &["output"], &[]);
        model.output("output", &[1, 3, 4, 4].map(Axis::Fixed));
        model.to_bytes()
    };
    assert_refused(
        &model("model.onnx.data"),
        &[
            "weights in `model.onnx.data`",
            "cannot be read",
            "copy the file",
        ],
    );
    assert_refused(&model("../model.data"), &["outside the model's folder"]);
    assert_refused(&model("/etc/model.data"), &["outside the model's folder"]);

    let folder = tempfile::tempdir().unwrap();
    let weights: Vec<u8> = (0..4)
        .flat_map(|number| (number as f32).to_le_bytes())
        .collect();
    std::fs::write(folder.path().join("model.onnx.data"), &weights).unwrap();
    for choice in runtimes() {
        let network = open_bytes(folder.path(), &model("model.onnx.data"), &choice).unwrap();
        let inputs = noise(network.as_ref(), 0, 1.0);
        let outputs = network.run(&inputs).unwrap();
        for (index, (taken, given)) in inputs[0].data.iter().zip(&outputs[0].data).enumerate() {
            assert!((given - taken - (index % 4) as f32).abs() < 1e-6);
        }
    }
    std::fs::write(folder.path().join("model.onnx.data"), &weights[..9]).unwrap();
    for choice in runtimes() {
        let error = open_bytes(folder.path(), &model("model.onnx.data"), &choice)
            .err()
            .unwrap();
        assert!(error.to_string().contains("refuses the network"), "{error}");
    }
}

#[test]
fn inputs_that_no_image_fits() {
    let of = |axes: &[i64]| {
        let mut model = Model::new(1);
        let axes: Vec<Axis> = axes.iter().map(|&axis| Axis::Fixed(axis)).collect();
        model.input("tokens", &axes);
        model.node("Relu", &["tokens"], &["output"], &[]);
        model.output("output", &axes);
        model.to_bytes()
    };
    assert_refused(
        &of(&[1, 512]),
        &[
            "inputs: none takes a colour image: `tokens` [1, 512]",
            "[1, 3, height, width]",
        ],
    );
    assert_refused(&of(&[1, 1, 28, 28]), &["none takes a colour image"]);
    assert_refused(
        &of(&[1, 3, 1_000_000, 1_000_000]),
        &["input `tokens`", "larger than any image"],
    );
    assert_refused(&of(&[1, 3, i64::MAX, i64::MAX]), &["larger than any image"]);
    assert_refused(&Model::new(1).to_bytes(), &["inputs: there are none"]);
    let mut model = Model::new(1);
    model.port(11, "images", 11, &[1, 3, 4, 4].map(Axis::Fixed));
    model.output("images", &[]);
    assert_refused(
        &model.to_bytes(),
        &["input `images`", "32-bit floating point"],
    );
    let mut model = Model::new(1);
    model.input("images", &[1, 3, 4, 4].map(Axis::Fixed));
    assert_refused(&model.to_bytes(), &["outputs: there are none"]);
}

#[test]
fn weights_that_do_not_fit() {
    let of = |shape: &[i64], bytes: &[u8]| {
        let mut model = Model::new(1);
        model.input("images", &[1, 3, 4, 4].map(Axis::Fixed));
        model.raw_weights("shift", F32, shape, bytes);
        model.node("Add", &["images", "shift"], &["output"], &[]);
        model.output("output", &[1, 3, 4, 4].map(Axis::Fixed));
        model.to_bytes()
    };
    assert_refused(
        &of(&[5], &[0; 16]),
        &["weights `shift`: are [5] of 4 bytes each, but 16 bytes are there"],
    );
    assert_refused(
        &of(&[i64::MAX, 4], &[0; 16]),
        &["weights `shift`", "16 bytes are there"],
    );
    assert_refused(&of(&[-4], &[0; 16]), &["weights `shift`"]);
    // Right in itself, but nothing to add to an image of this size.
    assert_refused(&of(&[5], &[0; 20]), &["refuses the network"]);
}

#[test]
fn a_folder_is_no_model() {
    let folder = tempfile::tempdir().unwrap();
    for choice in runtimes() {
        let source = ModelSource::File(folder.path().to_owned());
        let error = open_network(&source, &choice, 1).err().unwrap().to_string();
        assert!(error.contains("cannot be read"), "{error}");
    }
}

#[test]
fn damaged_bytes_never_panic() {
    let whole = onnx::small().to_bytes();
    let mut noise = onnx::Noise(5);
    for _ in 0..300 {
        let mut damaged = whole.clone();
        for _ in 0..3 {
            let at = (noise.even() * damaged.len() as f32) as usize;
            damaged[at] = (noise.even() * 256.0) as u8;
        }
        let folder = tempfile::tempdir().unwrap();
        if let Ok(network) = open_bytes(folder.path(), &damaged, &RuntimeChoice::Embedded) {
            let _ = network.run(&crate::support::noise(network.as_ref(), 8, 1.0));
        }
    }
}
