"""Train the segmenter of wood: one command, seeded, on a CPU or on a GPU where there is one."""

import argparse
import copy
import math
import multiprocessing
import time
from pathlib import Path

import numpy as np
import torch

from data import batch, read_labelled, read_rendered
from measure import figures, truths, wood
from model import WoodNet
from strokes import CLASSES

# Rare classes count for more; measured, the probabilities are put right afterwards (`calibrate`).
WEIGHTS = {"wood": 2.0, "peduncle": 3.0, "post": 2.0}


def loss_of(logits, masks, weights):
    """Minus the logarithm of the probability of the classes that a pixel may have, and the overlap of wood."""
    log_p = torch.log_softmax(logits.float(), 1)
    bits = torch.stack([(masks >> i) & 1 for i in range(len(CLASSES))], 1).bool()
    known = bits.any(1) & ~bits.all(1)
    allowed = torch.logsumexp(log_p.masked_fill(~bits, -30.0), 1)
    single = bits.sum(1) == 1
    weight = torch.where(single, (bits * weights[:, None, None]).amax(1), torch.ones_like(allowed)) * known
    cross = -(allowed * weight).sum() / weight.sum().clamp(min=1)
    p = log_p[:, 1].exp() * known
    sure, never = (bits[:, 1] & single).float(), (known & ~bits[:, 1]).float()
    hit = (p * sure).sum()
    overlap = 1 - (hit + 50) / (hit + 0.5 * (p * never).sum() + 0.5 * ((1 - p) * sure).sum() + 50)
    return cross, overlap


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--strokes", required=True, help="strokes of the photographs to learn from")
    parser.add_argument("--held-out", help="strokes of photographs to look at while training")
    parser.add_argument("--images", nargs="+", required=True, help="folders of the photographs")
    parser.add_argument("--rendered", help="folder of frames by `pomona scenes`")
    parser.add_argument("--out", default="run")
    parser.add_argument("--steps", type=int, default=4000)
    parser.add_argument("--batch", type=int, default=12)
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--rate", type=float, default=2e-3)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--every", type=int, default=250, help="steps between two looks")
    parser.add_argument("--start", help="weights to start from")
    args = parser.parse_args()

    if args.threads:
        torch.set_num_threads(args.threads)
    torch.manual_seed(args.seed)
    device = "cuda" if torch.cuda.is_available() else "cpu"
    out = Path(args.out)
    out.mkdir(parents=True, exist_ok=True)
    labelled = read_labelled(args.strokes, args.images)
    rendered = read_rendered(args.rendered) if args.rendered else []
    held_out = read_labelled(args.held_out, args.images) if args.held_out else []
    judged = truths(held_out, args.held_out) if args.held_out else []

    net = WoodNet()
    if args.start:
        net.load_state_dict(torch.load(args.start, map_location="cpu", weights_only=True))
    net = net.to(device, memory_format=torch.channels_last)
    slow = copy.deepcopy(net).eval()
    decayed = [p for p in net.parameters() if p.ndim > 1]
    plain = [p for p in net.parameters() if p.ndim <= 1]
    optimizer = torch.optim.AdamW(
        [{"params": decayed, "weight_decay": 0.02}, {"params": plain, "weight_decay": 0.0}], lr=args.rate
    )
    first = 0
    resume = out / "last.pt"
    if resume.exists():
        state = torch.load(resume, map_location=device, weights_only=True)
        net.load_state_dict(state["net"])
        slow.load_state_dict(state["slow"])
        optimizer.load_state_dict(state["optimizer"])
        first = state["step"]
    weights = torch.tensor([WEIGHTS.get(name, 1.0) for name in CLASSES], device=device)

    ready = multiprocessing.get_context("fork").Queue(6)

    def fill():
        for step in range(first, args.steps):
            ready.put(batch(labelled, rendered, args.size, args.batch, (args.seed, step)))

    filler = multiprocessing.get_context("fork").Process(target=fill, daemon=True)
    filler.start()
    begun, sums = time.time(), np.zeros(2)
    log = open(out / "log.txt", "a", buffering=1)
    for step in range(first, args.steps):
        images, masks = (torch.from_numpy(a).to(device) for a in ready.get())
        x = (images.permute(0, 3, 1, 2).float() / 255).to(memory_format=torch.channels_last)
        done = step / args.steps
        rate = min(1, (step + 1) / 200) * (0.01 + 0.99 * (1 + math.cos(math.pi * done)) / 2)
        for group in optimizer.param_groups:
            group["lr"] = args.rate * rate
        net.train()
        with torch.autocast(device, dtype=torch.bfloat16):
            logits = net(x)
        cross, overlap = loss_of(logits, masks, weights)
        optimizer.zero_grad(set_to_none=True)
        (cross + 0.5 * overlap).backward()
        torch.nn.utils.clip_grad_norm_(net.parameters(), 5.0)
        optimizer.step()
        sums += [float(cross.detach()), float(overlap.detach())]
        keep = min(0.999, (1 + step) / (10 + step))
        with torch.no_grad():
            for a, b in zip(slow.state_dict().values(), net.state_dict().values()):
                a.copy_(a * keep + b * (1 - keep) if a.dtype.is_floating_point else b)
        if (step + 1) % args.every == 0 or step + 1 == args.steps:
            text = f"step {step + 1} loss {sums[0] / args.every:.4f} {sums[1] / args.every:.3f}"
            if judged:
                maps = [wood(slow, t.picture.image) for t in judged]
                for threshold in (0.3, 0.5, 0.7):
                    wide, thin, precision, posts = figures(maps, judged, threshold)
                    text += f" | {threshold}: wide {wide:.3f} thin {thin:.3f} precision {precision:.3f} posts {posts:.3f}"
            log.write(f"{text} {time.time() - begun:.0f} s\n")
            sums[:] = 0
            state = {"net": net.state_dict(), "slow": slow.state_dict(), "step": step + 1}
            torch.save(state | {"optimizer": optimizer.state_dict()}, out / "last.pt")
    torch.save(slow.state_dict(), out / "wood.pt")


if __name__ == "__main__":
    main()
