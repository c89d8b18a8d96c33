"""Photographs with labelled apples as RGB-D frames whose depth is that of the apples alone.

A labelled apple stands for a sphere of 38 mm whose outline fills its box; nothing else has a reading, as thin wood has
none in the frames of time-of-flight cameras. `pomona pick` and `pomona evaluate --real` then show what colour is worth on
far more apples than there are real frames with labels. Apples that the image's edge cuts, that are longer than broad by
over two fifths or smaller than 24 pixels are left out.
"""

import argparse
import json
from pathlib import Path

import cv2
import numpy as np

from strokes import read_strokes

RADIUS_M = 0.038
FOCAL_PX = 600.0
DEPTH_SCALE = 0.0002
LEAST_SIDE_PX = 24.0
MOST_ASPECT = 1.4


def whole_apples(labels, width, height):
    """Boxes [x0, y0, x1, y1], pixels, of apples that are seen whole, from YOLO's labels."""
    boxes = []
    for line in labels.read_text().splitlines() if labels.is_file() else ():
        x, y, w, h = (float(v) for v in line.split()[1:5])
        x, y, w, h = x * width, y * height, w * width, h * height
        box = (x - w / 2, y - h / 2, x + w / 2, y + h / 2)
        inside = box[0] >= 1 and box[1] >= 1 and box[2] <= width - 1 and box[3] <= height - 1
        if inside and min(w, h) >= LEAST_SIDE_PX and max(w, h) <= MOST_ASPECT * min(w, h):
            boxes.append(box)
    return boxes


def depth_of(boxes, width, height):
    """The depth image of spheres that fill the boxes, in units of DEPTH_SCALE; 0 where there is none."""
    nearest = np.full((height, width), np.inf)
    v, u = np.mgrid[0:height, 0:width] + 0.5
    for x0, y0, x1, y1 in boxes:
        radius = (x1 - x0 + y1 - y0) / 4
        off = ((u - (x0 + x1) / 2) ** 2 + (v - (y0 + y1) / 2) ** 2) / radius**2
        front = FOCAL_PX * RADIUS_M / radius - RADIUS_M * np.sqrt(np.clip(1 - off, 0, 1))
        nearest = np.where(off < 1, np.minimum(nearest, front), nearest)
    return np.where(np.isfinite(nearest), nearest / DEPTH_SCALE, 0).round().astype(np.uint16)


def write_frame(folder, image, boxes):
    height, width = image.shape[:2]
    folder.mkdir(parents=True, exist_ok=True)
    cv2.imwrite(str(folder / "color.png"), image)
    cv2.imwrite(str(folder / "depth.png"), depth_of(boxes, width, height))
    camera = {
        "width": width, "height": height, "fx": FOCAL_PX, "fy": FOCAL_PX,
        "cx": width / 2 - 0.5, "cy": height / 2 - 0.5,
        "depth_scale": DEPTH_SCALE, "frame_id": "camera_color_optical_frame",
    }
    (folder / "camera.json").write_text(json.dumps(camera))
    objects = "".join(
        f"<object><name>{i}</name><bndbox><xmin>{x0:.1f}</xmin><ymin>{y0:.1f}</ymin>"
        f"<xmax>{x1:.1f}</xmax><ymax>{y1:.1f}</ymax></bndbox></object>"
        for i, (x0, y0, x1, y1) in enumerate(boxes)
    )
    (folder / "boxes.xml").write_text(f"<annotation>{objects}</annotation>")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=Path, help="receives frames/ and strokes.txt")
    parser.add_argument("images", type=Path, help="the photographs; labels of fruit lie in labels/ beside it")
    parser.add_argument("strokes", type=Path, nargs="+", help="strokes of wood (docs/strokes.md)")
    options = parser.parse_args()
    lines, apples, frames = [], 0, 0
    for path in options.strokes:
        for name, strokes in read_strokes(path).items():
            if not (options.images / name).is_file():
                continue
            image = cv2.imread(str(options.images / name))
            if image is None:
                raise SystemExit(f"{options.images / name}: not an image")
            stem = Path(name).stem
            height, width = image.shape[:2]
            boxes = whole_apples(options.images.parent / "labels" / f"{stem}.txt", width, height)
            if not boxes:
                continue
            write_frame(options.out / "frames" / stem, image, boxes)
            lines.append(f"image {stem}")
            for kind, points in strokes:
                lines.append(" ".join([kind] + [",".join(f"{v:.1f}" for v in point) for point in points]))
            apples, frames = apples + len(boxes), frames + 1
    if not frames:
        raise SystemExit(f"{options.images}: holds none of the labelled images with a whole apple")
    (options.out / "strokes.txt").write_text("\n".join(lines) + "\n")
    print(f"{apples} apples in {frames} frames: {options.out}")


if __name__ == "__main__":
    main()
