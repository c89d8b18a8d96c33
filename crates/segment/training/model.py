"""The network: a small U-Net whose finest features have half the image's resolution."""

import torch
from torch import nn

from strokes import CLASSES


def conv(inputs, outputs, kernel=3, stride=1):
    """Convolution, normalisation, leaky rectifier."""
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


class Merge(nn.Module):
    """Coarse features, upsampled, beside finer ones."""

    def __init__(self, coarse, fine, outputs):
        super().__init__()
        self.upsample = nn.Upsample(scale_factor=2, mode="nearest")
        self.join = conv(coarse + fine, outputs, 1)
        self.smooth = conv(outputs, outputs, 3)

    def forward(self, coarse, fine):
        return self.smooth(self.join(torch.cat([self.upsample(coarse), fine], 1)))


class WoodNet(nn.Module):
    """Colour image [N, 3, H, W], RGB in 0..1, sides multiples of 32, to logits [N, classes, H, W]."""

    def __init__(self):
        super().__init__()
        self.stage2 = conv(3, 16, 3, 2)
        self.stage4 = nn.Sequential(conv(16, 32, 3, 2), Residual(32))
        self.stage8 = nn.Sequential(conv(32, 64, 3, 2), Residual(64), Residual(64))
        self.stage16 = nn.Sequential(conv(64, 112, 3, 2), *(Residual(112) for _ in range(3)))
        self.stage32 = nn.Sequential(conv(112, 128, 3, 2), Residual(128), Residual(128))
        self.merge16 = Merge(128, 112, 80)
        self.merge8 = Merge(80, 64, 56)
        self.merge4 = Merge(56, 32, 32)
        self.merge2 = Merge(32, 16, 20)
        self.output = nn.Conv2d(20, 4 * len(CLASSES), 1)
        self.shuffle = nn.PixelShuffle(2)

    def forward(self, image):
        c2 = self.stage2(image)
        c4 = self.stage4(c2)
        c8 = self.stage8(c4)
        c16 = self.stage16(c8)
        x = self.merge16(self.stage32(c16), c16)
        x = self.merge4(self.merge8(x, c8), c4)
        return self.shuffle(self.output(self.merge2(x, c2)))
