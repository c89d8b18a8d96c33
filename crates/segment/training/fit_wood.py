"""The probability that a branch seen in colour is wood, fitted to strokes drawn by eye.

Reads the candidates in the `picks.json` of frames that `photographs_as_frames.py` made, and fits a logistic function of
their contrast (`crates/pomona/src/robust/wood/evidence.rs`). A candidate is wood where
its foot lies within three pixels, or an eighth of the apple's radius, of a stroke. Prints the log loss over photographs
left out, what further figures would add, and how often the answer of largest probability is right. With --second, how
often two people agree: the direction to the wood that each drew nearest to an apple.
"""

import argparse
import json
import re
from pathlib import Path

import numpy as np

from strokes import read_strokes

FOLDS = 8
# Keeps weights finite where a figure separates the two kinds.
RIDGE = 0.1
IN_FRONT_RADII = 0.85
REACH_RADII = 3.0
SAME_DIRECTION_RAD = np.radians(25)
ON_WOOD_PX, ON_WOOD_RADII = 3.0, 0.12
FIGURES = {
    "contrast": lambda c: c["contrast"],
    "in front": lambda c: float(c["distance"] < IN_FRONT_RADII),
    "contrast squared": lambda c: c["contrast"] ** 2,
    "distance": lambda c: c["distance"],
    "length": lambda c: min(c["length"], 2.5),
    "width": lambda c: min(c["width"], 12.0) / 10,
}


def dense(strokes):
    """Points [n, 3] along strokes of wood, a pixel apart."""
    points = [np.zeros((0, 3))]
    for kind, line in strokes:
        if kind != "wood":
            continue
        for a, b in zip(line[:-1], line[1:]):
            steps = max(1, int(np.hypot(*(b - a)[:2])))
            points.append(a + (b - a) * np.linspace(0, 1, steps, endpoint=False)[:, None])
        points.append(line[-1:])
    return np.vstack(points)


def nearest(wood, x, y, radius):
    """Distance in radii and angle of the nearest wood; infinite where there is none."""
    if not len(wood):
        return np.inf, 0.0
    off = wood[:, :2] - (x, y)
    distance = np.hypot(*off.T) / radius
    k = distance.argmin()
    return distance[k], np.arctan2(off[k, 1], off[k, 0])


def between(a, b):
    return abs((a - b + np.pi) % (2 * np.pi) - np.pi)


def photograph(name):
    """The photograph that a tile was cut from."""
    return re.sub(r"_\d+$", "", name)


def candidates(folder):
    """The candidates about each apple, by frame: figures, whether it is wood, and whether it points at the nearest."""
    strokes = read_strokes(folder / "strokes.txt")
    for picks in sorted((folder / "picks").glob("*/picks.json")):
        name = picks.parent.name
        camera = json.loads((folder / "frames" / name / "camera.json").read_text())
        wood = dense(strokes[name])
        for pick in json.loads(picks.read_text())["picks"]:
            if "apple" not in pick:
                continue
            box, apple = pick["box"], pick["apple"]
            x, y = (box["x_min"] + box["x_max"]) / 2, (box["y_min"] + box["y_max"]) / 2
            scale = camera["fx"] / apple["center"][2]
            radius = apple["radius"] * scale
            project = lambda p: np.array([p[0] / p[2] * camera["fx"], p[1] / p[2] * camera["fy"]])
            distance, angle = nearest(wood, x, y, radius)
            found = []
            for c in pick.get("candidates", ()):
                if "contrast" not in c:
                    continue
                off = project(c["foot"]) - project(apple["center"])
                edge = (np.hypot(*(wood[:, :2] - (x, y) - off).T) - wood[:, 2]).min() if len(wood) else np.inf
                found.append({
                    "contrast": c["contrast"],
                    "distance": np.hypot(*off) / radius,
                    "length": c["shown"] / apple["radius"],
                    "width": 2 * c["radius"] * scale,
                    "angle": np.arctan2(off[1], off[0]),
                    "wood": edge < max(ON_WOOD_PX, ON_WOOD_RADII * radius),
                })
            seen = distance < REACH_RADII
            yield photograph(name), seen, angle, found


def fit(x, y):
    """Weights of least log loss, by Newton's method."""
    weights = np.zeros(x.shape[1])
    ridge = np.full(x.shape[1], RIDGE)
    ridge[0] = 0
    for _ in range(50):
        p = 1 / (1 + np.exp(-x @ weights))
        hessian = (x * (p * (1 - p))[:, None]).T @ x + np.diag(ridge)
        step = np.linalg.solve(hessian, x.T @ (y - p) - ridge * weights)
        weights += step
        if abs(step).max() < 1e-9:
            break
    return weights


def answer(found, wood):
    """The candidate that is most probably the nearest wood, and that probability."""
    none_nearer, best = 1.0, (0.0, None)
    for k in np.argsort([c["distance"] for c in found], kind="stable"):
        probability = none_nearer * wood[k]
        none_nearer *= 1 - wood[k]
        if probability > best[0]:
            best = (probability, found[k])
    return best


def report(apples):
    names = sorted({name for name, *_ in apples})
    fold = {name: k % FOLDS for k, name in enumerate(names)}
    of = np.array([fold[name] for name, *_, found in apples for _ in found])
    y = np.array([c["wood"] for *_, found in apples for c in found], float)
    print(f"{len(y)} candidates, {y.mean():.0%} wood, about {len(apples)} apples in {len(names)} photographs")
    kinds = list(FIGURES)
    for count in range(1, len(kinds) + 1):
        x = np.array([[1] + [FIGURES[k](c) for k in kinds[:count]] for *_, found in apples for c in found])
        p = np.zeros(len(y))
        for k in range(FOLDS):
            p[of == k] = 1 / (1 + np.exp(-x[of == k] @ fit(x[of != k], y[of != k])))
        loss = -np.mean(np.log(np.where(y > 0, p, 1 - p)))
        weights = ", ".join(f"{w:.2f}" for w in fit(x, y))
        print(f"{' + '.join(kinds[:count])}: log loss {loss:.4f}; weights {weights}")
        if count == 1:
            chosen = p
    start, rows = 0, []
    for _, seen, angle, found in apples:
        probability, best = answer(found, chosen[start:start + len(found)])
        start += len(found)
        if best is not None:
            rows.append((probability, seen and between(best["angle"], angle) < SAME_DIRECTION_RAD, seen))
    rows = np.array(rows, float)
    print(f"right, of apples with visible wood: {rows[rows[:, 2] > 0, 1].mean():.1%}")
    for low, high in ((0, 0.4), (0.4, 0.6), (0.6, 0.8), (0.8, 1.01)):
        part = rows[(rows[:, 0] >= low) & (rows[:, 0] < high)]
        if len(part):
            print(f"  probability {low:.1f} to {min(high, 1):.1f}: {len(part)} answers, {part[:, 1].mean():.0%} right")


def agreement(first, second, images):
    """How often two people's nearest wood lies in the same direction from an apple."""
    import cv2
    from photographs_as_frames import whole_apples

    one = {name: s for path in first for name, s in read_strokes(path).items()}
    both, same, far = 0, 0, 0
    for name, strokes in read_strokes(second).items():
        if not (images / name).is_file() or name not in one:
            continue
        image = cv2.imread(str(images / name))
        if image is None:
            raise SystemExit(f"{images / name}: not an image")
        height, width = image.shape[:2]
        a, b = dense(one[name]), dense(strokes)
        for x0, y0, x1, y1 in whole_apples(images.parent / "labels" / f"{Path(name).stem}.txt", width, height):
            x, y, radius = (x0 + x1) / 2, (y0 + y1) / 2, (x1 - x0 + y1 - y0) / 4
            (da, angle_a), (db, angle_b) = nearest(a, x, y, radius), nearest(b, x, y, radius)
            if da < REACH_RADII and db < REACH_RADII:
                off = between(angle_a, angle_b)
                both, same, far = both + 1, same + (off < SAME_DIRECTION_RAD), far + (off > np.radians(50))
    print(f"{images}: two people, {both} apples: within 25 degrees {same / max(both, 1):.0%}, beyond 50 {far / max(both, 1):.0%}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", type=Path, nargs="*", help="each with frames/, strokes.txt and picks/")
    parser.add_argument("--second", type=Path, help="strokes by a second person, of some of the images")
    parser.add_argument("--first", type=Path, nargs="+", default=[], help="strokes of the same images by the first")
    parser.add_argument("--images", type=Path, nargs="+", default=[], help="those images, labels/ beside each folder")
    options = parser.parse_args()
    apples = [apple for folder in options.folders for apple in candidates(folder)]
    if options.folders and not apples:
        raise SystemExit("no candidates: run `pomona pick FOLDER/frames/* --segmenter built-in --out FOLDER/picks` first")
    if apples:
        report(apples)
    for images in options.images if options.second else ():
        agreement(options.first, options.second, images)


if __name__ == "__main__":
    main()
