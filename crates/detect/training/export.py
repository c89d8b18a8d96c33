"""Write the trained network as ONNX: one input `image` [1, 3, 416, 416], RGB in 0..1, one output `boxes` [1, 5, 3549].

The output is laid out as YOLOv8's: centre x, centre y, width, height in pixels of the input, and the score, already
between 0 and 1; cells of stride 8, then 16, then 32, row by row. Nothing is suppressed inside.
"""

import argparse
import json
import warnings

import numpy as np
import onnx
import torch
from onnx import numpy_helper
from torch import nn

from model import STRIDES, AppleNet


class Exported(nn.Module):
    """The network with its maps turned into boxes."""

    def __init__(self, net, size):
        super().__init__()
        self.net = net
        for i, stride in enumerate(STRIDES):
            cells = size // stride
            y, x = torch.meshgrid(torch.arange(cells), torch.arange(cells), indexing="ij")
            self.register_buffer(f"corner{i}", torch.stack([x, y]).reshape(1, 2, -1).float())

    def forward(self, image):
        parts = []
        for i, (stride, value) in enumerate(zip(STRIDES, self.net(image))):
            flat = value.reshape(1, 5, -1)
            centre = (flat[:, :2] + getattr(self, f"corner{i}")) * stride
            sides = torch.exp(flat[:, 2:4].clamp(-4.0, 4.5)) * stride
            parts.append(torch.cat([centre, sides, torch.sigmoid(flat[:, 4:])], 1))
        return torch.cat(parts, 2)


# What ONNX lets a writer leave out, and some readers miss.
DEFAULTS = {
    "Conv": {"auto_pad": "NOTSET", "group": 1},
    "Concat": {},
    "Resize": {"coordinate_transformation_mode": "asymmetric", "mode": "nearest", "nearest_mode": "floor"},
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
    parser.add_argument("weights", help="apple.pt of train.py")
    parser.add_argument("out", help="the ONNX file")
    parser.add_argument("--size", type=int, default=416)
    args = parser.parse_args()

    net = AppleNet().eval()
    net.load_state_dict(torch.load(args.weights, map_location="cpu", weights_only=True))
    image = torch.rand(1, 3, args.size, args.size)
    exported = Exported(net, args.size).eval()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        torch.onnx.export(
            exported, image, args.out, opset_version=13, dynamo=False,
            input_names=["image"], output_names=["boxes"],
        )
    model = written_out(onnx.load(args.out))
    model.doc_string = ""
    model.producer_name, model.producer_version = "pomona", ""
    metadata = {"names": json.dumps({"0": "apple"}), "license": "CC BY 4.0", "data": "AppleBBCH81 (LatHort), rendered scenes"}
    onnx.helper.set_model_props(model, metadata)
    for node in model.graph.node:
        node.doc_string = ""
    onnx.checker.check_model(model, full_check=True)
    onnx.save(model, args.out)

    import onnxruntime

    session = onnxruntime.InferenceSession(args.out, providers=["CPUExecutionProvider"])
    found = session.run(None, {"image": image.numpy()})[0]
    apart = np.abs(found - exported(image).detach().numpy()).max()
    weights = sum(numpy_helper.to_array(i).size for i in model.graph.initializer)
    print(f"{args.out}: {weights} numbers, output {found.shape}, differs from PyTorch by {apart:.2e}")
    if apart > 1e-3:
        raise SystemExit("the exported model disagrees with the trained one")


if __name__ == "__main__":
    main()
