"""Write the trained network as ONNX: one input `image` [1, 3, 416, 416], RGB in 0..1, one output `classes`
[1, 5, 416, 416], logits of the classes in the order of `strokes.CLASSES`."""

import argparse
import json
import warnings

import numpy as np
import onnx
import torch
from onnx import numpy_helper

from model import WoodNet
from strokes import CLASSES

# What ONNX lets a writer leave out, and some readers miss.
DEFAULTS = {
    "Conv": {"auto_pad": "NOTSET", "group": 1},
    "Concat": {},
    "Resize": {"coordinate_transformation_mode": "asymmetric", "mode": "nearest", "nearest_mode": "floor"},
    "DepthToSpace": {"mode": "CRD"},
}


def written_out(model):
    """Every attribute of the nodes in DEFAULTS stated."""
    for node in model.graph.node:
        present = {a.name for a in node.attribute}
        for name, value in DEFAULTS.get(node.op_type, {}).items():
            if name not in present:
                node.attribute.append(onnx.helper.make_attribute(name, value))
        if node.op_type == "Conv":
            missing = {"dilations", "kernel_shape", "pads", "strides"} - {a.name for a in node.attribute}
            if missing:
                raise SystemExit(f"{node.name}: the exporter left out {sorted(missing)}")
    return model


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("weights", help="wood.pt of calibrate.py")
    parser.add_argument("out", help="the ONNX file")
    parser.add_argument("--size", type=int, default=416)
    args = parser.parse_args()

    net = WoodNet().eval()
    net.load_state_dict(torch.load(args.weights, map_location="cpu", weights_only=True))
    image = torch.rand(1, 3, args.size, args.size)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        torch.onnx.export(
            net, image, args.out, opset_version=13, dynamo=False, input_names=["image"], output_names=["classes"]
        )
    model = written_out(onnx.load(args.out))
    model.doc_string = ""
    model.producer_name, model.producer_version = "pomona", ""
    metadata = {
        "names": json.dumps({str(i): name for i, name in enumerate(CLASSES)}),
        "license": "CC BY 4.0",
        "data": "strokes drawn by eye in AppleBBCH81, AppleBBCH76 and Pear640 (LatHort)",
    }
    onnx.helper.set_model_props(model, metadata)
    for node in model.graph.node:
        node.doc_string = ""
    onnx.checker.check_model(model, full_check=True)
    onnx.save(model, args.out)

    import onnxruntime

    session = onnxruntime.InferenceSession(args.out, providers=["CPUExecutionProvider"])
    found = session.run(None, {"image": image.numpy()})[0]
    apart = np.abs(found - net(image).detach().numpy()).max()
    weights = sum(numpy_helper.to_array(i).size for i in model.graph.initializer)
    print(f"{args.out}: {weights} numbers, output {found.shape}, differs from PyTorch by {apart:.2e}")
    if apart > 1e-3:
        raise SystemExit("the exported model disagrees with the trained one")


if __name__ == "__main__":
    main()
