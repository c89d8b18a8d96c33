"""The network: a small YOLOv3-tiny relative with three heads and no anchors.

Each head gives five numbers per cell: the offset of the box's centre from the cell's corner, in cells; the
logarithm of its sides, in cells; and the logit of the score.
"""

import torch
from torch import nn

STRIDES = (8, 16, 32)


def conv(inputs, outputs, kernel=3, stride=1):
    """Convolution, normalisation, leaky rectifier: YOLOv3-tiny's unit."""
    return nn.Sequential(
        nn.Conv2d(inputs, outputs, kernel, stride, kernel // 2, bias=False),
        nn.BatchNorm2d(outputs, eps=1e-3, momentum=0.03),
        nn.LeakyReLU(0.1, inplace=True),
    )


class Residual(nn.Module):
    """Darknet's block: narrow, widen, add."""

    def __init__(self, channels):
        super().__init__()
        self.narrow = conv(channels, channels // 2, 1)
        self.widen = conv(channels // 2, channels, 3)

    def forward(self, x):
        return x + self.widen(self.narrow(x))


class AppleNet(nn.Module):
    """Colour image [N, 3, H, W], RGB in 0..1, to three maps [N, 5, H/s, W/s] for s in STRIDES."""

    def __init__(self):
        super().__init__()
        self.stage2 = conv(3, 12, 3, 2)
        self.stage4 = nn.Sequential(conv(12, 32, 3, 2), Residual(32))
        self.stage8 = nn.Sequential(conv(32, 64, 3, 2), Residual(64), Residual(64))
        self.stage16 = nn.Sequential(conv(64, 128, 3, 2), *(Residual(128) for _ in range(3)))
        self.stage32 = nn.Sequential(conv(128, 144, 3, 2), Residual(144))
        self.lateral32 = conv(144, 64, 1)
        self.merge16 = nn.Sequential(conv(128 + 64, 64, 1), conv(64, 80, 3))
        self.lateral16 = conv(80, 40, 1)
        self.merge8 = nn.Sequential(conv(64 + 40, 40, 1), conv(40, 64, 3))
        self.heads = nn.ModuleList(conv(c, 64, 3) for c in (64, 80, 64))
        self.outputs = nn.ModuleList(nn.Conv2d(64, 5, 1) for _ in STRIDES)
        self.upsample = nn.Upsample(scale_factor=2, mode="nearest")
        for output in self.outputs:
            nn.init.normal_(output.weight, std=0.01)
            nn.init.zeros_(output.bias)
            output.bias.data[:4] = torch.tensor([0.5, 0.5, 1.1, 1.1])
            output.bias.data[4] = -4.0

    def forward(self, image):
        c8 = self.stage8(self.stage4(self.stage2(image)))
        c16 = self.stage16(c8)
        p32 = self.lateral32(self.stage32(c16))
        p16 = self.merge16(torch.cat([c16, self.upsample(p32)], 1))
        p8 = self.merge8(torch.cat([c8, self.upsample(self.lateral16(p16))], 1))
        return [
            output(head(x)) for output, head, x in zip(self.outputs, self.heads, (p8, p16, p32))
        ]


def decode(maps):
    """Maps to boxes [N, A, 4] (corners, pixels), logits [N, A], cell centres [A, 2], strides [A]."""
    boxes, logits, centres, strides = [], [], [], []
    for value, stride in zip(maps, STRIDES):
        n, _, height, width = value.shape
        value = value.float()
        y, x = torch.meshgrid(
            torch.arange(height, device=value.device),
            torch.arange(width, device=value.device),
            indexing="ij",
        )
        corner = torch.stack([x, y], -1).reshape(-1, 2).float()
        flat = value.flatten(2).transpose(1, 2)
        centre = (corner + flat[..., :2]) * stride
        half = torch.exp(flat[..., 2:4].clamp(-4, 4.5)) * (stride / 2)
        boxes.append(torch.cat([centre - half, centre + half], -1))
        logits.append(flat[..., 4])
        centres.append((corner + 0.5) * stride)
        strides.append(torch.full((height * width,), float(stride), device=value.device))
    return torch.cat(boxes, 1), torch.cat(logits, 1), torch.cat(centres), torch.cat(strides)
