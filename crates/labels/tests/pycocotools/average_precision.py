"""Average precision by COCO's own program: labels and results in, AP50 and AP50-95 out.

    python average_precision.py LABELS.json RESULTS.json
"""

import contextlib
import io
import sys

from pycocotools.coco import COCO
from pycocotools.cocoeval import COCOeval

with contextlib.redirect_stdout(io.StringIO()):
    labels = COCO(sys.argv[1])
    evaluation = COCOeval(labels, labels.loadRes(sys.argv[2]), "bbox")
    evaluation.params.maxDets = [1, 10, 100_000]
    evaluation.evaluate()
    evaluation.accumulate()
# Overlap, recall, class, size, detections for each image: all sizes, all detections.
precision = evaluation.eval["precision"][:, :, 0, 0, -1]
print(precision[0].mean(), precision.mean())
