#!/usr/bin/env bash
# From strokes and photographs to a model that pomona reads: renders scenes, trains, calibrates, exports, evaluates.
#
#   bash crates/segment/training/run.sh OUT PHOTOGRAPHS... [-- option of train.py...]
#
# PHOTOGRAPHS are the folders that hold the images which ../labels/*.txt name. Needs the packages of requirements.txt in
# the python3 that is found first. Started again with the same OUT, training goes on where it was interrupted.
set -euo pipefail
if [ $# -lt 2 ]; then
    echo "usage: bash $0 OUT PHOTOGRAPHS... [-- option of train.py...]" >&2
    exit 2
fi
here=$(cd "$(dirname "$0")" && pwd)
labels="$here/../labels"
mkdir -p "$1"
out=$(cd "$1" && pwd)
shift
photographs=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
    photographs+=("$(cd "$1" && pwd)")
    shift
done
[ $# -eq 0 ] || shift

pomona() { cargo run --quiet --release --manifest-path "$here/../../cli/Cargo.toml" -- "$@"; }

if [ ! -d "$out/rendered" ]; then
    pomona scenes harsh --count 40 --seed 800000 --out "$out/rendered.new"
    pomona scenes orchard --count 30 --seed 810000 --out "$out/rendered.new"
    pomona scenes row --count 10 --seed 820000 --out "$out/rendered.new"
    mv "$out/rendered.new" "$out/rendered"
fi
python3 "$here/train.py" --strokes "$labels/train.txt" --held-out "$labels/calibration.txt" \
    --images "${photographs[@]}" --rendered "$out/rendered" --out "$out" "$@"
python3 "$here/calibrate.py" "$out/wood.pt" "$out/calibrated.pt" \
    --strokes "$labels/calibration.txt" --images "${photographs[@]}"
python3 "$here/export.py" "$out/calibrated.pt" "$out/wood.onnx"
cp "$here/../model/wood.toml" "$out/wood.toml"
# Every photograph in one folder, as the evaluation wants it.
mkdir -p "$out/photographs"
for folder in "${photographs[@]}"; do
    find "$folder" -maxdepth 1 -type f -exec ln -sf {} "$out/photographs/" \;
done
pomona evaluate --segmentation "$out/photographs" --strokes "$labels/val.txt" \
    --second-strokes "$labels/second.txt" --segmenter "$out/wood.onnx" --out "$out/evaluation"
