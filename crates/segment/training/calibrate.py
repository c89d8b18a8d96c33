"""Make the network's probabilities true: a temperature and a bias for each class, fitted on photographs kept apart.

Guo et al., On Calibration of Modern Neural Networks, ICML 2017, arXiv 1706.04599; with a bias, since training weighs
rare classes more. Both go into the last layer.
"""

import argparse

import cv2
import numpy as np
import torch

from data import read_labelled
from model import WoodNet
from strokes import CLASSES


@torch.no_grad()
def logits_and_masks(net, pictures, most=60000, seed=0):
    """Logits [n, classes] and allowed classes [n] of pixels drawn from the pictures."""
    rng = np.random.default_rng(seed)
    found = []
    for picture in pictures:
        height, width = picture.image.shape[:2]
        image = cv2.copyMakeBorder(picture.image, 0, -height % 32, 0, -width % 32, cv2.BORDER_CONSTANT, value=(114, 114, 114))
        x = torch.from_numpy(image).permute(2, 0, 1)[None].float() / 255
        logits = net(x)[0, :, :height, :width].reshape(len(CLASSES), -1).T
        mask = picture.mask.reshape(-1)
        bits = (mask[:, None] >> np.arange(len(CLASSES))) & 1
        chosen = np.flatnonzero((bits.sum(1) > 0) & (bits.sum(1) < len(CLASSES)))
        chosen = rng.choice(chosen, min(most, len(chosen)), replace=False)
        found.append((logits[chosen], torch.from_numpy(bits[chosen].astype(bool))))
    return torch.cat([f[0] for f in found]), torch.cat([f[1] for f in found])


def fit(logits, bits):
    """The temperature and the biases of least cost."""
    scale = torch.zeros(1, requires_grad=True)
    bias = torch.zeros(len(CLASSES), requires_grad=True)

    def cost():
        log_p = torch.log_softmax(logits * torch.exp(scale) + bias, 1)
        return -torch.logsumexp(log_p.masked_fill(~bits, -30.0), 1).mean()

    before = float(cost().detach())
    optimizer = torch.optim.LBFGS([scale, bias], max_iter=100, line_search_fn="strong_wolfe")

    def closure():
        optimizer.zero_grad()
        value = cost() + 1e-4 * (bias**2).sum()
        value.backward()
        return value

    optimizer.step(closure)
    return float(torch.exp(scale).detach()), bias.detach() - bias.detach().mean(), before, float(cost().detach())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("weights", help="wood.pt of train.py")
    parser.add_argument("out", help="the calibrated weights")
    parser.add_argument("--strokes", required=True, help="strokes of photographs kept apart from training")
    parser.add_argument("--images", nargs="+", required=True)
    args = parser.parse_args()
    net = WoodNet().eval()
    net.load_state_dict(torch.load(args.weights, map_location="cpu", weights_only=True))
    logits, bits = logits_and_masks(net, read_labelled(args.strokes, args.images))
    scale, bias, before, after = fit(logits, bits)
    with torch.no_grad():
        net.output.weight *= scale
        # The shuffle takes four channels for each class.
        net.output.bias.copy_(net.output.bias * scale + bias.repeat_interleave(4))
    torch.save(net.state_dict(), args.out)
    print(f"scale {scale:.3f}, bias {dict(zip(CLASSES, (round(float(b), 3) for b in bias)))}, cost {before:.4f} to {after:.4f}")


if __name__ == "__main__":
    main()
