"""Train the apple detector: one command, seeded, on a CPU or on a GPU where there is one."""

import argparse
import copy
import math
import queue
import threading
import time
from pathlib import Path

import numpy as np
import torch
import torch.nn.functional as F

from data import batch, read_rendered, read_tiles
from measure import average_precision, detect, overlap
from model import AppleNet, decode


def pair_iou(a, b):
    """IoU and generalised IoU of paired boxes [..., 4]."""
    low, high = torch.maximum(a[..., :2], b[..., :2]), torch.minimum(a[..., 2:], b[..., 2:])
    inside = (high - low).clamp(min=0).prod(-1)
    area_a, area_b = (a[..., 2:] - a[..., :2]).prod(-1), (b[..., 2:] - b[..., :2]).prod(-1)
    union = (area_a + area_b - inside).clamp(min=1e-6)
    hull = (torch.maximum(a[..., 2:], b[..., 2:]) - torch.minimum(a[..., :2], b[..., :2])).prod(-1)
    iou = inside / union
    return iou, iou - (hull - union) / hull.clamp(min=1e-6)


@torch.no_grad()
def assign(boxes, logits, centres, strides, truth, weights, most=10):
    """Task-aligned assignment (Feng et al., ICCV 2021): the cells whose score and box agree best with a label.

    Returns for each cell the index of its label (−1: none), the target of its score, and its weight.
    """
    low, high = truth[:, :, None, :2], truth[:, :, None, 2:]
    inside = ((centres > low) & (centres < high)).all(-1)
    near = ((centres - (low + high) / 2).abs() < 0.6 * strides[:, None]).all(-1)
    real = (weights > 0)[:, :, None]
    allowed = (inside | near) & real
    iou, _ = pair_iou(boxes[:, None], truth[:, :, None])
    align = torch.sigmoid(logits)[:, None].sqrt() * iou.pow(4) * allowed
    top, _ = align.topk(most, dim=-1)
    chosen = allowed & (align >= top[..., -1:].clamp(min=1e-9))
    owner_iou, owner = (iou * chosen).max(1)
    positive = owner_iou > 0
    mine = F.one_hot(owner, truth.shape[1]).permute(0, 2, 1).bool() & chosen
    align = align * mine
    best_align = align.amax(-1, keepdim=True).clamp(min=1e-9)
    best_iou = (iou * mine).amax(-1, keepdim=True)
    target = (align / best_align * best_iou).amax(1)
    away = (((centres > low) & (centres < high)).all(-1) & (weights == 0)[:, :, None]).any(1)
    weight = torch.where(away & ~positive, 0.0, 1.0)
    weight = torch.where(positive, torch.gather(weights, 1, owner), weight)
    return torch.where(positive, owner, -1), target * positive, weight


def loss_of(maps, truth, weights):
    """Score loss, box loss."""
    boxes, logits, centres, strides = decode(maps)
    owner, target, weight = assign(boxes, logits, centres, strides, truth, weights)
    total = (target * weight).sum().clamp(min=1)
    score = F.binary_cross_entropy_with_logits(logits, target, weight=weight, reduction="sum") / total
    positive = owner >= 0
    image = positive.nonzero()[:, 0]
    _, giou = pair_iou(boxes[positive], truth[image, owner[positive]])
    box = ((1 - giou) * (target * weight)[positive]).sum() / total
    return score, box


def clean(net, tiles):
    """Look again at the labels: confident finds without a label are looked away from, labels on which nothing
    is found count less. Never changes a label's place. Returns how many of each."""
    missing = doubtful = 0
    for tile, (boxes, scores) in zip(tiles, detect(net, tiles, 0.02)):
        iou = overlap(tile.labels, boxes)
        best = np.where(iou > 0.3, scores, 0).max(1, initial=0)
        unseen = boxes[(scores > 0.45) & (iou.max(0, initial=0) < 0.3)]
        weights = np.r_[np.where(best < 0.05, 0.4, 1), np.zeros(len(unseen))]
        tile.truth = (np.concatenate([tile.labels, unseen]).astype(np.float32), weights.astype(np.float32))
        missing, doubtful = missing + len(unseen), doubtful + int((best < 0.05).sum())
    return missing, doubtful


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tiles", required=True, help="folder with train/ and val/")
    parser.add_argument("--rendered", help="folder of frames by `pomona scenes`")
    parser.add_argument("--out", default="run")
    parser.add_argument("--steps", type=int, default=6000)
    parser.add_argument("--batch", type=int, default=32)
    parser.add_argument("--size", type=int, default=320)
    parser.add_argument("--rate", type=float, default=2e-3)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--threads", type=int, default=0)
    args = parser.parse_args()

    if args.threads:
        torch.set_num_threads(args.threads)
    torch.manual_seed(args.seed)
    device = "cuda" if torch.cuda.is_available() else "cpu"
    out = Path(args.out)
    out.mkdir(parents=True, exist_ok=True)
    tiles = read_tiles(Path(args.tiles, "train"))
    held_out = read_tiles(Path(args.tiles, "val"))
    rendered = read_rendered(args.rendered) if args.rendered else []

    net = AppleNet().to(device, memory_format=torch.channels_last)
    slow = copy.deepcopy(net).eval()
    decayed = [p for p in net.parameters() if p.ndim > 1]
    plain = [p for p in net.parameters() if p.ndim <= 1]
    optimizer = torch.optim.AdamW(
        [{"params": decayed, "weight_decay": 0.02}, {"params": plain, "weight_decay": 0.0}],
        lr=args.rate,
    )
    first = 0
    resume = out / "last.pt"
    if resume.exists():
        state = torch.load(resume, map_location=device, weights_only=True)
        net.load_state_dict(state["net"])
        slow.load_state_dict(state["slow"])
        optimizer.load_state_dict(state["optimizer"])
        first = state["step"]

    cleanings = {int(args.steps * share) for share in (0.35, 0.6, 0.8)}
    if first and min(cleanings) <= first:
        clean(slow, tiles)

    ready = queue.Queue(4)

    def fill():
        for step in range(first, args.steps):
            ready.put(batch(tiles, rendered, args.size, args.batch, (args.seed, step)))

    threading.Thread(target=fill, daemon=True).start()
    begun, sums = time.time(), np.zeros(2)
    log = open(out / "log.txt", "a", buffering=1)
    for step in range(first, args.steps):
        images, truth, weights = (torch.from_numpy(a).to(device) for a in ready.get())
        x = (images.permute(0, 3, 1, 2).float() / 255).to(memory_format=torch.channels_last)
        done = step / args.steps
        rate = min(1, (step + 1) / 200) * (0.01 + 0.99 * (1 + math.cos(math.pi * done)) / 2)
        for group in optimizer.param_groups:
            group["lr"] = args.rate * rate
        net.train()
        with torch.autocast(device, dtype=torch.bfloat16):
            maps = net(x)
        score, box = loss_of(maps, truth, weights)
        optimizer.zero_grad(set_to_none=True)
        (score + 2.5 * box).backward()
        torch.nn.utils.clip_grad_norm_(net.parameters(), 10.0)
        optimizer.step()
        sums += [float(score.detach()), float(box.detach())]
        keep = min(0.9995, (1 + step) / (10 + step))
        with torch.no_grad():
            for a, b in zip(slow.state_dict().values(), net.state_dict().values()):
                a.copy_(a * keep + b * (1 - keep) if a.dtype.is_floating_point else b)
        if step + 1 in cleanings:
            log.write("labels: %d missing, %d doubtful\n" % clean(slow, tiles))
        if (step + 1) % 250 == 0 or step + 1 == args.steps:
            ap, recall, precision = average_precision(detect(slow, held_out), held_out)
            log.write(
                f"step {step + 1} loss {sums[0] / 250:.3f} {sums[1] / 250:.3f} "
                f"AP50 {ap:.4f} recall {recall:.3f} precision {precision:.3f} {time.time() - begun:.0f} s\n"
            )
            sums[:] = 0
            state = {"net": net.state_dict(), "slow": slow.state_dict(), "step": step + 1}
            torch.save(state | {"optimizer": optimizer.state_dict()}, out / "last.pt")
    torch.save(slow.state_dict(), out / "apple.pt")


if __name__ == "__main__":
    main()
