"""Average precision, for a look while training; the figures that count are `pomona evaluate --detection`'s."""

import numpy as np
import torch

from model import decode


def overlap(a, b):
    """IoU of boxes a [n, 4] and b [m, 4]."""
    low, high = np.maximum(a[:, None, :2], b[None, :, :2]), np.minimum(a[:, None, 2:], b[None, :, 2:])
    inside = (high - low).clip(0).prod(2)
    area = lambda x: (x[:, 2:] - x[:, :2]).prod(1)
    return inside / np.maximum(area(a)[:, None] + area(b)[None] - inside, 1e-9)


def suppress(boxes, scores, limit):
    """Greedy non-maximum suppression; indices that stay, best first."""
    order, keep = np.argsort(-scores, kind="stable"), []
    while len(order):
        keep.append(order[0])
        order = order[1:][overlap(boxes[order[:1]], boxes[order[1:]])[0] < limit]
    return np.array(keep, int)


@torch.no_grad()
def detect(net, pictures, threshold=0.01, limit=0.6):
    """Boxes and scores of each picture (all of one size, its sides multiples of 32)."""
    net.eval()
    found = []
    for start in range(0, len(pictures), 8):
        images = np.stack([p.image for p in pictures[start : start + 8]])
        x = torch.from_numpy(images).permute(0, 3, 1, 2).to(next(net.parameters()).device)
        x = (x.float() / 255).to(memory_format=torch.channels_last)
        boxes, logits, _, _ = decode(net(x))
        for b, s in zip(boxes.cpu().numpy(), torch.sigmoid(logits).cpu().numpy()):
            seen = s > threshold
            b, s = b[seen], s[seen]
            keep = suppress(b, s, limit)
            found.append((b[keep], s[keep]))
    return found


def average_precision(found, pictures, limit=0.5):
    """AP over all points of the curve, recall at score 0.25, precision there."""
    rows, total = [], 0
    for (boxes, scores), picture in zip(found, pictures):
        total += len(picture.labels)
        iou = overlap(boxes, picture.labels) if len(picture.labels) else np.zeros((len(boxes), 1))
        taken = np.zeros(iou.shape[1], bool)
        for i, score in enumerate(scores):
            best = int(np.argmax(np.where(taken, -1, iou[i])))
            hit = not taken[best] and iou[i, best] >= limit
            taken[best] |= hit
            rows.append((score, hit))
    rows.sort(key=lambda r: -r[0])
    hits = np.cumsum([r[1] for r in rows])
    precision, recall = hits / np.arange(1, len(rows) + 1), hits / max(total, 1)
    envelope = np.maximum.accumulate(precision[::-1])[::-1]
    ap = float(np.sum(np.diff(recall, prepend=0) * envelope))
    at = sum(r[0] >= 0.25 for r in rows) - 1
    return ap, float(recall[at]), float(precision[at])
