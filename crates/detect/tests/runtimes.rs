//! Both runtimes on the same models.

use pomona_detect::{ModelSource, Network, RuntimeChoice, Tensor, open_network};
use std::path::{Path, PathBuf};

fn shared_model() -> Option<PathBuf> {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models/yolox_nano_coco.onnx");
    if path.exists() {
        return Some(path);
    }
    println!("skipped: {} is not here", path.display());
    None
}

fn noise(network: &dyn Network) -> Vec<Tensor> {
    network
        .inputs()
        .iter()
        .map(|port| {
            let shape: Vec<usize> = port.shape.iter().map(|axis| axis.unwrap_or(1)).collect();
            let count = shape.iter().product();
            let mut state = 1_u32;
            let data = (0..count)
                .map(|_| {
                    state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    (state >> 24) as f32
                })
                .collect();
            Tensor {
                name: port.name.clone(),
                shape,
                data,
            }
        })
        .collect()
}

#[test]
fn yolox_nano_gives_the_same_numbers_on_both() {
    let Some(path) = shared_model() else { return };
    let source = ModelSource::File(path);
    let embedded = open_network(&source, &RuntimeChoice::Embedded, 1).unwrap();
    let onnx = match open_network(&source, &RuntimeChoice::OnnxRuntime, 1) {
        Ok(network) => network,
        Err(error) => {
            println!("skipped: {error}");
            return;
        }
    };
    println!("{:?} {:?}", onnx.report(), embedded.report());
    println!(
        "{:?} {:?} {:?}",
        onnx.inputs(),
        onnx.outputs(),
        onnx.metadata()
    );
    let inputs = noise(onnx.as_ref());
    let start = std::time::Instant::now();
    let ours = embedded.run(&inputs).unwrap();
    println!("embedded {:?}", start.elapsed());
    let start = std::time::Instant::now();
    let theirs = onnx.run(&inputs).unwrap();
    println!("onnx {:?}", start.elapsed());
    assert_eq!(ours[0].shape, theirs[0].shape);
    let worst = ours[0]
        .data
        .iter()
        .zip(&theirs[0].data)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f32::max);
    println!("worst {worst}");
    assert!(worst < 1e-3);
}
