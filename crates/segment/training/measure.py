"""Recall along centre lines and precision of what is marked, for a look while training.

The figures that count are those of `pomona evaluate --segmentation`.
"""

import cv2
import numpy as np
import torch

from strokes import BITS, nearness, read_strokes

TOLERANCE = 3.0


def along(points):
    """Places a pixel apart on a stroke's centre line, and the half width there."""
    rows = [points[:1]]
    for a, b in zip(points, points[1:]):
        steps = max(1, int(np.ceil(np.hypot(*(b - a)[:2]))))
        rows.append(a + (b - a) * (np.arange(1, steps + 1) / steps)[:, None])
    return np.concatenate(rows)


class Truth:
    """What the strokes of one picture say."""

    def __init__(self, picture, strokes):
        self.picture = picture
        height, width = picture.image.shape[:2]
        wood = [p for kind, p in strokes if kind in ("wood", "far")]
        edges = [nearness((height, width), p) for p in wood]
        edge = np.min(edges, 0) if edges else np.full((height, width), 1e9, np.float32)
        self.near = edge <= TOLERANCE
        places = np.concatenate([along(p) for p in wood]) if wood else np.zeros((0, 3))
        inside = (places[:, 0] > 0) & (places[:, 0] < width) & (places[:, 1] > 0) & (places[:, 1] < height)
        self.places = places[inside]
        posts = [along(p) for kind, p in strokes if kind == "post"]
        posts = np.concatenate(posts) if posts else np.zeros((0, 3))
        inside = (posts[:, 0] > 0) & (posts[:, 0] < width) & (posts[:, 1] > 0) & (posts[:, 1] < height)
        self.posts = posts[inside]


def truths(pictures, strokes):
    lines = read_strokes(strokes)
    return [Truth(p, lines[p.name]) for p in pictures]


@torch.no_grad()
def wood(net, image):
    """Probability of wood for each pixel; the image is padded to multiples of 32."""
    net.eval()
    height, width = image.shape[:2]
    padded = cv2.copyMakeBorder(image, 0, -height % 32, 0, -width % 32, cv2.BORDER_CONSTANT, value=(114, 114, 114))
    x = torch.from_numpy(padded).permute(2, 0, 1)[None].float() / 255
    p = torch.softmax(net(x.to(next(net.parameters()).device)).float(), 1)
    return p[0, 1, :height, :width].cpu().numpy()


def figures(maps, truths, threshold):
    """Recall of wood of at least 4 pixels and of 3 to 4, precision, and the share of posts called wood."""
    counts = np.zeros(8)
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (7, 7))
    for p, truth in zip(maps, truths):
        marked = p >= threshold
        reach = cv2.dilate(marked.astype(np.uint8), kernel)
        x, y = truth.places[:, :2].astype(int).T
        hit, wide = reach[y, x] > 0, 2 * truth.places[:, 2]
        for i, chosen in enumerate((wide >= 4, (wide >= 3) & (wide < 4))):
            counts[2 * i] += hit[chosen].sum()
            counts[2 * i + 1] += chosen.sum()
        counts[4] += (marked & truth.near).sum()
        counts[5] += marked.sum()
        x, y = truth.posts[:, :2].astype(int).T
        counts[6] += marked[y, x].sum()
        counts[7] += len(x)
    return counts[::2] / np.maximum(counts[1::2], 1)
