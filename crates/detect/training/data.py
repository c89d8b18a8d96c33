"""Tiles, rendered scenes, and the crops that are made of them."""

import json
from pathlib import Path

import cv2
import numpy as np

cv2.setNumThreads(0)


class Picture:
    """A colour image (RGB) with labels [n, 4] (corners, pixels), and what training makes of them.

    `truth` is a pair: boxes, and the weight of each; weight 0 says: look away. It is replaced as a whole, so that
    a thread that cuts crops meanwhile never sees one without the other.
    """

    def __init__(self, name, image, labels, weights=None):
        self.name, self.image = name, image
        self.labels = np.asarray(labels, np.float32).reshape(-1, 4)
        self.truth = (self.labels, np.ones(len(self.labels), np.float32) if weights is None else weights)


def read_tiles(folder):
    """Tiles with YOLO labels: `folder/images/*.jpg`, `folder/labels/*.txt`."""
    tiles = []
    for path in sorted(Path(folder, "images").iterdir()):
        image = cv2.cvtColor(cv2.imread(str(path)), cv2.COLOR_BGR2RGB)
        height, width = image.shape[:2]
        lines = Path(folder, "labels", path.stem + ".txt").read_text().splitlines()
        rows = np.array([line.split() for line in lines if line.strip()], float).reshape(-1, 5)
        centre, half = rows[:, 1:3], rows[:, 3:5] / 2
        scale = np.array([width, height, width, height])
        boxes = np.concatenate([centre - half, centre + half], 1) * scale
        boxes = boxes.clip(0, scale)
        sides = boxes[:, 2:] - boxes[:, :2]
        tiles.append(Picture(path.stem, image, boxes[sides.min(1, initial=9e9) >= 4]))
    if not tiles:
        raise SystemExit(f"{folder}: no tile found; give the folder that holds images/ and labels/")
    return tiles


def read_rendered(folder):
    """Frames of `pomona scenes`: colour and truth; apples hidden by more than 60 % are looked away from."""
    pictures = []
    for path in sorted(Path(folder).iterdir()):
        image = cv2.cvtColor(cv2.imread(str(path / "color.png")), cv2.COLOR_BGR2RGB)
        apples = json.loads((path / "truth.json").read_text())["apples"]
        apples = [a for a in apples if a.get("visible_share", 1) > 0.05]
        boxes = [[a["box"][k] for k in ("x_min", "y_min", "x_max", "y_max")] for a in apples]
        weights = np.array([a.get("visible_share", 1) >= 0.4 for a in apples], np.float32)
        pictures.append(Picture(path.name, image, boxes, weights))
    return pictures


def mosaic(pictures, rng):
    """Four tiles of one size, two by two."""
    a, b, c, d = (pictures[i] for i in rng.integers(len(pictures), size=4))
    height, width = a.image.shape[:2]
    image = np.concatenate(
        [np.concatenate([a.image, b.image], 1), np.concatenate([c.image, d.image], 1)]
    )
    shifts = [(0, 0), (width, 0), (0, height), (width, height)]
    truths = [p.truth for p in (a, b, c, d)]
    boxes = [t[0] + np.array(s * 2, np.float32) for t, s in zip(truths, shifts)]
    return Picture("mosaic", image, np.concatenate(boxes), np.concatenate([t[1] for t in truths]))


def crop(picture, size, scale, rng):
    """A square of `size` pixels cut at random from the picture scaled by `scale`; maybe mirrored."""
    height, width = picture.image.shape[:2]
    side = size / scale
    x = rng.uniform(0, width - side) if width > side else (width - side) * rng.uniform(0, 1)
    y = rng.uniform(0, height - side) if height > side else (height - side) * rng.uniform(0, 1)
    stretch = np.exp(rng.uniform(-0.12, 0.12))
    sx, sy = scale * stretch, scale / stretch
    mirror = rng.random() < 0.5
    matrix = np.array([[sx, 0, -x * sx], [0, sy, -y * sy]], np.float32)
    if mirror:
        matrix[0] = [-sx, 0, size - 1 + x * sx]
    smooth = cv2.INTER_AREA if scale < 0.6 else cv2.INTER_LINEAR
    image = cv2.warpAffine(
        picture.image, matrix, (size, size), flags=smooth, borderValue=(114, 114, 114)
    )
    truth, importance = picture.truth
    boxes = (truth - np.array([x, y, x, y], np.float32)) * np.array([sx, sy, sx, sy], np.float32)
    if mirror:
        boxes = np.stack([size - boxes[:, 2], boxes[:, 1], size - boxes[:, 0], boxes[:, 3]], 1)
    whole = (boxes[:, 2] - boxes[:, 0]) * (boxes[:, 3] - boxes[:, 1])
    boxes = boxes.clip(0, size)
    left = (boxes[:, 2] - boxes[:, 0]) * (boxes[:, 3] - boxes[:, 1])
    weights = np.where(left >= 0.3 * whole, importance, 0)
    keep = (left > 0) & ((boxes[:, 2:] - boxes[:, :2]).min(1, initial=9e9) >= 3)
    return image, boxes[keep], weights[keep]


def recolour(image, rng):
    """Other light, other cameras: hue, saturation, brightness, contrast, blur, noise, compression."""
    gains = rng.uniform(-1, 1, 3) * [0.02, 0.6, 0.5] + 1
    hue, saturation, value = cv2.split(cv2.cvtColor(image, cv2.COLOR_RGB2HSV))
    ramp = np.arange(256, dtype=np.float32)
    gamma = np.exp(rng.uniform(-0.35, 0.35))
    hue = cv2.LUT(hue, ((ramp + (gains[0] - 1) * 180) % 180).astype(np.uint8))
    saturation = cv2.LUT(saturation, (ramp * gains[1]).clip(0, 255).astype(np.uint8))
    value = cv2.LUT(
        value, (255 * (ramp / 255) ** gamma * gains[2]).clip(0, 255).astype(np.uint8)
    )
    image = cv2.cvtColor(cv2.merge([hue, saturation, value]), cv2.COLOR_HSV2RGB)
    if rng.random() < 0.12:
        image = cv2.GaussianBlur(image, (0, 0), rng.uniform(0.5, 1.6))
    if rng.random() < 0.12:
        noise = rng.normal(0, rng.uniform(2, 12), image.shape).astype(np.float32)
        image = (image + noise).clip(0, 255).astype(np.uint8)
    if rng.random() < 0.1:
        _, code = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, int(rng.integers(30, 80))])
        image = cv2.imdecode(code, cv2.IMREAD_COLOR)
    return image


def distract(image, boxes, weights, rng):
    """Red things that are no apples: striped poles, ribbons, crates. Boxes that they cover are looked away from."""
    size = image.shape[0]
    image = np.ascontiguousarray(image)
    mask = np.zeros(image.shape[:2], np.uint8)
    for _ in range(rng.integers(1, 4)):
        red = np.array([rng.uniform(120, 255), rng.uniform(10, 90), rng.uniform(20, 100)])
        pale = rng.uniform(150, 255, 3) if rng.random() < 0.7 else red * rng.uniform(0.5, 0.9)
        width = np.exp(rng.uniform(np.log(5), np.log(45)))
        band = width * rng.uniform(0.8, 4)
        length = rng.uniform(1, 12) * width if rng.random() < 0.5 else 2 * size
        middle = rng.uniform(0, size, 2)
        angle = rng.choice([0, np.pi / 2]) + rng.normal(0, 0.15)
        along = np.array([np.cos(angle), np.sin(angle)])
        across = np.array([-along[1], along[0]]) * width / 2
        for i, start in enumerate(np.arange(-length / 2, length / 2, band)):
            a, b = middle + along * start, middle + along * min(start + band, length / 2)
            corners = np.round(np.array([a - across, a + across, b + across, b - across])).astype(np.int32)
            color = (pale if i % 2 else red) * rng.uniform(0.9, 1.1)
            cv2.fillPoly(image, [corners], color.clip(0, 255).tolist(), cv2.LINE_AA)
            cv2.fillPoly(mask, [corners], 1)
    weights = weights.copy()
    for i, (x0, y0, x1, y1) in enumerate(boxes.astype(int)):
        if mask[y0 : y1 + 1, x0 : x1 + 1].mean() > 0.35:
            weights[i] = 0
    return image, boxes, weights


def sample(tiles, rendered, size, rng, rendered_share=0.12):
    """One training crop."""
    if rendered and rng.random() < rendered_share:
        picture = rendered[rng.integers(len(rendered))]
        scale = np.exp(rng.uniform(np.log(0.3), np.log(1.1)))
    else:
        draw = rng.random()
        if draw < 0.45:
            picture, scale = mosaic(tiles, rng), np.exp(rng.uniform(np.log(0.45), np.log(1.2)))
        elif draw < 0.92:
            picture, scale = tiles[rng.integers(len(tiles))], np.exp(rng.uniform(np.log(0.77), np.log(1.6)))
        else:
            picture, scale = tiles[rng.integers(len(tiles))], np.exp(rng.uniform(np.log(1.6), np.log(4.0)))
    image, boxes, weights = crop(picture, size, scale, rng)
    if rng.random() < 0.2:
        image, boxes, weights = distract(image, boxes, weights, rng)
    return recolour(image, rng), boxes, weights


def batch(tiles, rendered, size, count, seed):
    """`count` crops: images uint8 [N, H, W, 3], boxes [N, M, 4], weights [N, M] (−1: no box)."""
    rng = np.random.default_rng(seed)
    samples = [sample(tiles, rendered, size, rng) for _ in range(count)]
    most = max(1, max(len(s[1]) for s in samples))
    boxes = np.zeros((count, most, 4), np.float32)
    weights = np.full((count, most), -1, np.float32)
    for i, (_, b, w) in enumerate(samples):
        boxes[i, : len(b)], weights[i, : len(b)] = b, w
    return np.stack([s[0] for s in samples]), boxes, weights
