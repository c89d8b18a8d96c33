"""Strokes of wood drawn by eye (docs/strokes.md), and what they say about each pixel."""

from pathlib import Path

import cv2
import numpy as np

CLASSES = ("rest", "wood", "peduncle", "fruit", "post")
REST, WOOD, PEDUNCLE, FRUIT, POST = (1 << i for i in range(len(CLASSES)))
BITS = {"wood": WOOD, "far": WOOD, "peduncle": PEDUNCLE, "post": POST}
# Drawn in this order, so that wood lies over posts and peduncles over wood.
ORDER = ("post", "far", "wood", "peduncle")
# The width, pixels, of the band beside a stroke that may be either.
EDGE = 1.0
FINE = 8  # subpixels per pixel while drawing ellipses


def read_strokes(path):
    """{image: [(class, points [n, 3] of x, y and half width)]}, pixels; the image's corner is (0, 0)."""
    images, current = {}, None
    for number, line in enumerate(Path(path).read_text().splitlines(), 1):
        words = line.split("#")[0].split()
        if not words:
            continue
        if words[0] == "image":
            current = images.setdefault(words[1], [])
            continue
        if current is None or words[0] not in BITS:
            raise SystemExit(f"{path}:{number}: {words[0]}: expected `image NAME`, or a stroke of {', '.join(BITS)}")
        points = np.array([[float(v) for v in word.split(",")] for word in words[1:]], np.float32)
        current.append((words[0], points.reshape(-1, 3)))
    return images


def nearness(size, points):
    """For each pixel the distance to a stroke's edge, pixels, negative inside; a large number far away."""
    height, width = size
    found = np.full(size, 1e9, np.float32)
    for a, b in zip(points, points[1:] if len(points) > 1 else points):
        reach = max(a[2], b[2]) + 8
        x0, y0 = np.floor(np.minimum(a, b)[:2] - reach).clip(0).astype(int)
        x1, y1 = np.ceil(np.maximum(a, b)[:2] + reach).astype(int).clip(0, [width, height])
        if x0 >= x1 or y0 >= y1:
            continue
        x, y = np.meshgrid(np.arange(x0, x1) + 0.5 - a[0], np.arange(y0, y1) + 0.5 - a[1])
        dx, dy = b[0] - a[0], b[1] - a[1]
        t = ((x * dx + y * dy) / max(dx * dx + dy * dy, 1e-9)).clip(0, 1)
        edge = np.hypot(x - t * dx, y - t * dy) - (a[2] + t * (b[2] - a[2]))
        part = found[y0:y1, x0:x1]
        np.minimum(part, edge, out=part)
    return found


def allowed(size, strokes, boxes=None, unlabelled_fruit=False):
    """For each pixel of an image (height, width) the set of classes that it may have, as bits."""
    ground = REST | FRUIT if unlabelled_fruit else REST
    mask = np.full(size, ground, np.uint8)
    for x0, y0, x1, y1 in boxes if boxes is not None else ():
        centre = (int((x0 + x1) / 2 * FINE), int((y0 + y1) / 2 * FINE))
        for share, value in ((1.15, REST | FRUIT), (0.65, FRUIT)):
            axes = (int((x1 - x0) / 2 * share * FINE), int((y1 - y0) / 2 * share * FINE))
            cv2.ellipse(mask, centre, axes, 0, 0, 360, value, -1, cv2.LINE_8, 3)
    for kind in ORDER:
        of_kind = [points for name, points in strokes if name == kind]
        if of_kind:
            edge = np.min([nearness(size, points) for points in of_kind], 0)
            mask[edge <= EDGE] = REST | FRUIT | BITS[kind]
            mask[edge <= 0] = BITS[kind]
    return mask
