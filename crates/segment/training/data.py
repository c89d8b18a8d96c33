"""Labelled photographs and rendered scenes, and the crops that are made of them."""

import json
from pathlib import Path

import cv2
import numpy as np

from strokes import FRUIT, PEDUNCLE, POST, REST, WOOD, allowed, read_strokes

cv2.setNumThreads(0)


class Picture:
    """A colour image (RGB), the classes that each of its pixels may have (bits), and places worth a look."""

    def __init__(self, name, image, mask, places):
        self.name, self.image, self.mask = name, image, mask
        self.places = np.asarray(places, np.float32).reshape(-1, 2)


def read_image(path):
    image = cv2.imread(str(path))
    if image is None:
        raise SystemExit(f"{path}: no image that can be read")
    return cv2.cvtColor(image, cv2.COLOR_BGR2RGB)


def read_boxes(path, width, height):
    """YOLO labels as corners, pixels; None where there is no file."""
    if not path.exists():
        return None
    rows = np.array([line.split()[:5] for line in path.read_text().splitlines() if line.strip()], float).reshape(-1, 5)
    centre, half = rows[:, 1:3], rows[:, 3:5] / 2
    return np.concatenate([centre - half, centre + half], 1) * [width, height, width, height]


def read_labelled(strokes, folders):
    """Photographs with strokes, found by their name in one of `folders` (beside `../labels`, YOLO, where there are)."""
    pictures = []
    for name, lines in read_strokes(strokes).items():
        path = next((Path(f, name) for f in folders if Path(f, name).exists()), None)
        if path is None:
            raise SystemExit(f"{name} of {strokes} is in none of {', '.join(map(str, folders))}")
        image = read_image(path)
        height, width = image.shape[:2]
        boxes = read_boxes(path.parent.parent / "labels" / (path.stem + ".txt"), width, height)
        mask = allowed((height, width), lines, boxes, unlabelled_fruit=boxes is None)
        places = [p[:2] for _, points in lines for p in points]
        pictures.append(Picture(name, image, mask, places))
    return pictures


# Indices of `classes.png` as `pomona scenes` writes it.
RENDERED = {0: REST, 1: WOOD, 2: REST | PEDUNCLE, 3: FRUIT}


def read_rendered(folder):
    """Frames of `pomona scenes`: colour and exact classes."""
    table = np.zeros(256, np.uint8)
    for index, bits in RENDERED.items():
        table[index] = bits
    pictures = []
    for path in sorted(p for p in Path(folder).iterdir() if (p / "classes.png").exists()):
        image = read_image(path / "color.png")
        classes = cv2.imread(str(path / "classes.png"), cv2.IMREAD_GRAYSCALE)
        wood = np.argwhere(classes == 1)[::97, ::-1]
        pictures.append(Picture(path.name, image, table[classes], wood))
    return pictures


def crop(picture, size, scale, rng):
    """A square of `size` pixels of the picture scaled by `scale`, turned, stretched and maybe mirrored."""
    height, width = picture.image.shape[:2]
    side = size / scale
    if len(picture.places) and rng.random() < 0.7:
        centre = picture.places[rng.integers(len(picture.places))] + rng.uniform(-0.4, 0.4, 2) * side
    else:
        centre = rng.uniform(0, 1, 2) * [width, height]
    low = np.minimum(side / 2, [width / 2, height / 2])
    centre = np.clip(centre, low, [width, height] - low)
    stretch = np.exp(rng.uniform(-0.15, 0.15))
    angle = rng.normal(0, 0.2)
    mirror = -1 if rng.random() < 0.5 else 1
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    linear = np.diag([mirror * scale * stretch, scale / stretch]) @ turn
    # Pixel centres are at (i + 0.5).
    shift = np.array([size / 2, size / 2]) - linear @ centre + linear @ [0.5, 0.5] - 0.5
    matrix = np.concatenate([linear, shift[:, None]], 1).astype(np.float32)
    if scale < 0.75:
        blurred = cv2.GaussianBlur(picture.image, (0, 0), 0.45 * np.sqrt(1 / scale**2 - 1))
    else:
        blurred = picture.image
    border = cv2.BORDER_CONSTANT if rng.random() < 0.5 else cv2.BORDER_REFLECT_101
    image = cv2.warpAffine(blurred, matrix, (size, size), flags=cv2.INTER_LINEAR, borderMode=border,
                           borderValue=(114, 114, 114))
    mask = cv2.warpAffine(picture.mask, matrix, (size, size), flags=cv2.INTER_NEAREST,
                          borderMode=border, borderValue=0)
    return image, mask


def recolour(image, rng):
    """Other light, other cameras: white balance, hue, saturation, exposure, contrast, haze, blur, noise, compression."""
    x = image.astype(np.float32) / 255
    x = x ** np.exp(rng.uniform(-0.45, 0.45))
    x = x * np.exp(rng.normal(0, 0.13, 3)).astype(np.float32) * np.exp(rng.uniform(-0.35, 0.25))
    grey = x.mean(2, keepdims=True)
    x = grey + (x - grey) * rng.uniform(0.35, 1.5)
    middle = x.mean()
    x = middle + (x - middle) * np.exp(rng.uniform(-0.35, 0.3))
    if rng.random() < 0.15:
        x = x * rng.uniform(0.7, 0.95) + rng.uniform(0, 0.25)
    if rng.random() < 0.25:
        # Light that changes over the image.
        size = image.shape[0]
        field = cv2.resize(rng.normal(0, 0.25, (3, 3)).astype(np.float32), (size, size), interpolation=cv2.INTER_CUBIC)
        x = x * np.exp(field)[:, :, None]
    image = (x * 255).clip(0, 255).astype(np.uint8)
    if rng.random() < 0.15:
        hue, saturation, value = cv2.split(cv2.cvtColor(image, cv2.COLOR_RGB2HSV))
        hue = ((hue.astype(int) + int(rng.integers(-8, 9))) % 180).astype(np.uint8)
        image = cv2.cvtColor(cv2.merge([hue, saturation, value]), cv2.COLOR_HSV2RGB)
    if rng.random() < 0.25:
        image = cv2.GaussianBlur(image, (0, 0), rng.uniform(0.4, 1.4))
    if rng.random() < 0.06:
        length = int(rng.integers(3, 8))
        kernel = np.zeros((length, length), np.float32)
        middle, angle = (length - 1) / 2, rng.uniform(0, np.pi)
        for t in np.linspace(-middle, middle, 4 * length):
            kernel[int(round(middle + t * np.sin(angle))), int(round(middle + t * np.cos(angle)))] = 1
        image = cv2.filter2D(image, -1, kernel / kernel.sum())
    if rng.random() < 0.2:
        soft = cv2.GaussianBlur(image, (0, 0), rng.uniform(0.8, 1.6))
        image = cv2.addWeighted(image, 1 + (a := rng.uniform(0.3, 1.2)), soft, -a, 0)
    if rng.random() < 0.25:
        noise = rng.normal(0, rng.uniform(2, 12), image.shape).astype(np.float32)
        if rng.random() < 0.5:
            noise = cv2.GaussianBlur(noise, (0, 0), 0.7) * 1.8
        image = (image + noise).clip(0, 255).astype(np.uint8)
    if rng.random() < 0.2:
        _, code = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, int(rng.integers(25, 85))])
        image = cv2.imdecode(code, cv2.IMREAD_COLOR)
    return image


def distract(image, mask, rng):
    """Posts, wires and pipes drawn over the picture."""
    size = image.shape[0]
    image = np.ascontiguousarray(image)
    for _ in range(rng.integers(1, 4)):
        width = np.exp(rng.uniform(np.log(1.5), np.log(40)))
        middle, angle = rng.uniform(0, size, 2), rng.choice([0, np.pi / 2]) + rng.normal(0, 0.2)
        along = np.array([np.cos(angle), np.sin(angle)])
        across = np.array([-along[1], along[0]]) * width / 2
        color = rng.uniform(10, 250) + rng.normal(0, 25, 3)
        for k in range(6):
            # Shaded across, as a cylinder is.
            side = (k / 6 * 2 - 1, (k + 1) / 6 * 2 - 1)
            light = 1 + rng.uniform(-0.05, 0.05) + 0.4 * np.sin(np.pi * (k + 0.5) / 6) - 0.3
            corners = np.array([middle - along * 2 * size + across * side[0], middle + along * 2 * size + across * side[0],
                                middle + along * 2 * size + across * side[1], middle - along * 2 * size + across * side[1]])
            corners = np.round(corners * 8).astype(np.int32)
            cv2.fillPoly(image, [corners], (color * light).clip(0, 255).tolist(), cv2.LINE_AA, 3)
        hull = np.array([middle - along * 2 * size - across, middle + along * 2 * size - across,
                         middle + along * 2 * size + across, middle - along * 2 * size + across])
        cv2.fillPoly(mask, [np.round(hull * 8).astype(np.int32)], POST, cv2.LINE_8, 3)
    return image, mask


def sample(labelled, rendered, size, rng, rendered_share):
    """One training crop."""
    if rendered and rng.random() < rendered_share:
        picture = rendered[rng.integers(len(rendered))]
        scale = np.exp(rng.uniform(np.log(0.5), np.log(1.4)))
    else:
        picture = labelled[rng.integers(len(labelled))]
        scale = np.exp(rng.uniform(np.log(0.55), np.log(2.2)))
    image, mask = crop(picture, size, scale, rng)
    if rng.random() < 0.06:
        image, mask = distract(image, mask, rng)
    return recolour(image, rng), mask


def batch(labelled, rendered, size, count, seed, rendered_share=0.12):
    """`count` crops: images uint8 [N, H, W, 3], allowed classes uint8 [N, H, W]."""
    rng = np.random.default_rng(seed)
    images, masks = zip(*(sample(labelled, rendered, size, rng, rendered_share) for _ in range(count)))
    return np.stack(images), np.stack(masks)
