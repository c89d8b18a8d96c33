#!/usr/bin/env bash
# From tiles to a model that pomona reads: renders scenes, trains, exports, evaluates.
#
#   bash crates/detect/training/run.sh TILES OUT [option of train.py]...
#
# TILES holds train/ and val/, each with images/ and labels/ (YOLO). Needs the packages of requirements.txt in the
# python3 that is found first. Started again with the same OUT, training goes on where it was interrupted.
set -euo pipefail
if [ $# -lt 2 ]; then
    echo "usage: bash $0 TILES OUT [option of train.py]..." >&2
    exit 2
fi
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$2"
tiles=$(cd "$1" && pwd) out=$(cd "$2" && pwd)
shift 2

pomona() { cargo run --quiet --release --manifest-path "$here/../../cli/Cargo.toml" -- "$@"; }

if [ ! -d "$out/rendered" ]; then
    pomona scenes harsh --count 110 --seed 700000 --out "$out/rendered.new"
    pomona scenes orchard --count 60 --seed 710000 --out "$out/rendered.new"
    pomona scenes row --count 10 --seed 720000 --out "$out/rendered.new"
    mv "$out/rendered.new" "$out/rendered"
fi
python3 "$here/train.py" --tiles "$tiles" --rendered "$out/rendered" --out "$out" "$@"
python3 "$here/export.py" "$out/apple.pt" "$out/apple.onnx"
cp "$here/../model/apple.toml" "$out/apple.toml"
pomona evaluate --detection "$tiles/val" --model "$out/apple.onnx" --out "$out/evaluation"
