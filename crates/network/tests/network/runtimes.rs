//! Both runtimes on the same models, and one network on many threads.

use crate::onnx::{self, Attribute, Axis, F16, F32, I64, Model};
use crate::support::{has_onnx_runtime, largest_difference, noise, open_bytes, runtimes, shared};
use pomona_network::{Element, ModelSource, Network, RuntimeChoice, Tensor, open_network};

/// Opens a model in both runtimes and gives the largest difference between their outputs for noise over
/// 0 to `most`; nothing where ONNX Runtime cannot be used.
fn difference(bytes: &[u8], open: usize, most: f32) -> Option<f32> {
    if runtimes().len() < 2 {
        return None;
    }
    let folder = tempfile::tempdir().unwrap();
    let embedded = open_bytes(folder.path(), bytes, &RuntimeChoice::Embedded).unwrap();
    let onnx = open_bytes(folder.path(), bytes, &RuntimeChoice::OnnxRuntime).unwrap();
    assert_eq!(embedded.inputs(), onnx.inputs());
    assert_eq!(embedded.outputs(), onnx.outputs());
    assert_eq!(embedded.metadata(), onnx.metadata());
    let inputs = noise(embedded.as_ref(), open, most);
    let outputs = [embedded.run(&inputs).unwrap(), onnx.run(&inputs).unwrap()];
    Some(largest_difference(&outputs[0], &outputs[1]))
}

#[test]
fn a_small_network_gives_the_same_numbers() {
    let difference = difference(&onnx::small().to_bytes(), 0, 1.0);
    assert!(
        difference.is_none_or(|difference| difference < 1e-5),
        "{difference:?}"
    );
}

#[test]
fn open_axes_take_the_size_of_the_image() {
    let axes = [
        Axis::Open("batch"),
        Axis::Fixed(3),
        Axis::Open("height"),
        Axis::Open("width"),
    ];
    let bytes = onnx::small_of(F32, &axes).to_bytes();
    for side in [16, 40] {
        let difference = difference(&bytes, side, 1.0);
        assert!(
            difference.is_none_or(|difference| difference < 1e-5),
            "{difference:?}"
        );
    }
    let folder = tempfile::tempdir().unwrap();
    for choice in runtimes() {
        let network = open_bytes(folder.path(), &bytes, &choice).unwrap();
        assert_eq!(network.inputs()[0].shape, [None, Some(3), None, None]);
        let outputs = network.run(&noise(network.as_ref(), 40, 1.0)).unwrap();
        assert_eq!(outputs[0].shape, [1, 6, 10, 10]);
    }
}

#[test]
fn half_precision_goes_in_and_out_as_f32() {
    let axes = [1, 3, 32, 32].map(Axis::Fixed);
    let bytes = onnx::small_of(F16, &axes).to_bytes();
    // Half precision keeps eleven bits; the embedded runtime computes with more of them.
    let difference = difference(&bytes, 0, 1.0);
    assert!(
        difference.is_none_or(|difference| difference < 1e-2),
        "{difference:?}"
    );
    let folder = tempfile::tempdir().unwrap();
    let network = open_bytes(folder.path(), &bytes, &RuntimeChoice::Automatic).unwrap();
    assert_eq!(network.inputs()[0].element, Element::F16);
}

#[test]
fn whole_numbers_come_out_as_f32() {
    let mut model = onnx::small();
    model.node(
        "ArgMax",
        &["output"],
        &["best"],
        &[("axis", Attribute::Int(1)), ("keepdims", Attribute::Int(0))],
    );
    model.port(12, "best", I64, &[1, 8, 8].map(Axis::Fixed));
    let folder = tempfile::tempdir().unwrap();
    for choice in runtimes() {
        let network = open_bytes(folder.path(), &model.to_bytes(), &choice).unwrap();
        assert_eq!(network.outputs()[1].element, Element::I64);
        let outputs = network.run(&noise(network.as_ref(), 0, 1.0)).unwrap();
        let (scores, best) = (&outputs[0].data, &outputs[1].data);
        for (cell, &best) in best.iter().enumerate() {
            let score = |channel: usize| scores[channel * 64 + cell];
            assert!((0..6).all(|channel| score(channel) <= score(best as usize)));
        }
    }
}

/// A convolution with a kernel of 3 and pooling by 2 that have these attributes and no others.
fn sparse(convolution: &[(&str, Attribute)], pooling: &[(&str, Attribute)]) -> Vec<u8> {
    let mut model = Model::new(4);
    model.input("images", &[1, 3, 16, 16].map(Axis::Fixed));
    model.weights("kernel", &[6, 3, 3, 3], 0.2);
    model.node("Conv", &["images", "kernel"], &["convolved"], convolution);
    model.node("MaxPool", &["convolved"], &["output"], pooling);
    model.output("output", &["n", "c", "h", "w"].map(Axis::Open));
    model.to_bytes()
}

#[test]
fn attributes_that_are_left_out_are_what_onnx_says() {
    let kernel = ("kernel_shape", Attribute::Ints(&[2, 2]));
    let same = ("auto_pad", Attribute::Text("SAME_UPPER"));
    let step = ("strides", Attribute::Ints(&[2, 2]));
    let bare = sparse(&[], &[kernel]);
    let padded = sparse(&[same, step], &[kernel, same]);
    let half = sparse(&[("pads", Attribute::Ints(&[1; 4]))], &[kernel, step]);
    for bytes in [bare, padded, half] {
        let difference = difference(&bytes, 0, 1.0);
        assert!(
            difference.is_none_or(|difference| difference < 1e-5),
            "{difference:?}"
        );
    }
}

#[test]
fn padding_that_the_embedded_runtime_would_misread_is_refused() {
    let kernel = ("kernel_shape", Attribute::Ints(&[2, 2]));
    let lower = ("auto_pad", Attribute::Text("SAME_LOWER"));
    // As much before as behind: lower and upper are the same.
    let even = difference(&sparse(&[lower], &[kernel]), 0, 1.0);
    assert!(even.is_none_or(|difference| difference < 1e-5), "{even:?}");
    let folder = tempfile::tempdir().unwrap();
    for bytes in [
        sparse(&[], &[kernel, lower]),
        sparse(&[lower, ("strides", Attribute::Ints(&[2, 2]))], &[kernel]),
    ] {
        let error = open_bytes(folder.path(), &bytes, &RuntimeChoice::Embedded)
            .err()
            .unwrap();
        assert!(error.to_string().contains("SAME_LOWER"), "{error}");
    }
}

#[test]
fn yolov3_tiny_gives_the_same_numbers() {
    let difference = difference(&onnx::yolov3_tiny(96, 1).to_bytes(), 0, 1.0);
    assert!(
        difference.is_none_or(|difference| difference < 1e-3),
        "{difference:?}"
    );
}

#[test]
fn yolox_nano_gives_the_same_numbers() {
    let Some(path) = shared("models/yolox_nano_coco.onnx") else {
        return;
    };
    let difference = difference(&std::fs::read(path).unwrap(), 0, 255.0);
    assert!(
        difference.is_none_or(|difference| difference < 1e-3),
        "{difference:?}"
    );
}

#[test]
fn many_threads_run_one_network() {
    let folder = tempfile::tempdir().unwrap();
    for choice in runtimes() {
        let network = open_bytes(folder.path(), &onnx::small().to_bytes(), &choice).unwrap();
        let network: &dyn Network = network.as_ref();
        let inputs = noise(network, 0, 1.0);
        let expected = network.run(&inputs).unwrap();
        let run = || (0..20).all(|_| network.run(&inputs).unwrap() == expected);
        let all_same = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..4).map(|_| scope.spawn(run)).collect();
            threads.into_iter().all(|thread| thread.join().unwrap())
        });
        assert!(all_same);
    }
}

#[test]
fn tiles_of_a_thread_pool_do_not_begin_one_within_the_other() {
    use std::sync::atomic::{AtomicUsize, Ordering};
    let folder = tempfile::tempdir().unwrap();
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(2)
        .build()
        .unwrap();
    for choice in runtimes() {
        let network = open_bytes(folder.path(), &onnx::small().to_bytes(), &choice).unwrap();
        let network: &dyn Network = network.as_ref();
        let inputs = noise(network, 0, 1.0);
        let (running, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
        pool.install(|| {
            use rayon::prelude::*;
            (0..32).into_par_iter().with_max_len(1).for_each(|_| {
                most.fetch_max(1 + running.fetch_add(1, Ordering::SeqCst), Ordering::SeqCst);
                network.run(&inputs).unwrap();
                running.fetch_sub(1, Ordering::SeqCst);
            });
        });
        assert!(most.into_inner() <= 2);
    }
}

#[test]
fn a_built_in_model_has_its_name_in_the_report_of_errors() {
    let bytes: &'static [u8] = onnx::small().to_bytes().leak();
    let source = ModelSource::BuiltIn {
        name: "apple",
        bytes,
    };
    let network = open_network(&source, &RuntimeChoice::Automatic, 2).unwrap();
    let wrong = Tensor {
        name: "images".into(),
        shape: vec![1, 3, 8, 8],
        data: vec![0.0; 192],
    };
    let error = network.run(&[wrong]).unwrap_err().to_string();
    assert!(
        error.starts_with("apple: input `images`: is [1, 3, 32, 32], given was [1, 3, 8, 8]"),
        "{error}"
    );
}

#[test]
fn the_exporters_notes_and_weights_that_are_also_inputs() {
    let mut model: Model = onnx::small();
    model.metadata("names", "{0: 'apple'}");
    // Old files list weights among the inputs.
    model.input("first.bias", &[Axis::Fixed(8)]);
    let folder = tempfile::tempdir().unwrap();
    for choice in runtimes() {
        let network = open_bytes(folder.path(), &model.to_bytes(), &choice).unwrap();
        assert_eq!(
            network.metadata(),
            [("names".to_owned(), "{0: 'apple'}".to_owned())]
        );
        assert_eq!(network.inputs().len(), 1);
        network.run(&noise(network.as_ref(), 0, 1.0)).unwrap();
    }
}

#[test]
fn the_report_says_what_runs() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = onnx::small().to_bytes();
    let report = |choice| open_bytes(folder.path(), &bytes, &choice).unwrap().report();
    let embedded = report(RuntimeChoice::Embedded);
    assert_eq!(
        (
            embedded.name.as_str(),
            embedded.library,
            embedded.fallback_reason
        ),
        ("embedded", None, None)
    );
    let automatic = report(RuntimeChoice::Automatic);
    if has_onnx_runtime() {
        assert_eq!(automatic.name, "onnxruntime");
        assert!(automatic.library.unwrap().contains("onnxruntime"));
        assert!(automatic.version.starts_with("1."));
        assert_eq!(automatic.fallback_reason, None);
    } else {
        assert_eq!(automatic.name, "embedded");
        assert!(automatic.fallback_reason.unwrap().contains("ONNX Runtime"));
    }
}
