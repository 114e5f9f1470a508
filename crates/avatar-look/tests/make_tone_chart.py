#!/usr/bin/env python3
"""Prints the colour chart that tests/tone.rs holds the tone mappers against, in double precision.

    python3 make_tone_chart.py > tone_chart.csv

Written from the definitions, without a look at the crate: Khronos' specification of PBR Neutral, and AgX as Sobotka
generates its table (a sigmoid through a pivot whose scales follow from its end points), not as a formula.
"""

import math

# The 24 patches of the ColorChecker (sRGB, D65, averages published by BabelColor), and the corners of the
# cube.
PATCHES = [
    (115, 82, 68), (194, 150, 130), (98, 122, 157), (87, 108, 67), (133, 128, 177), (103, 189, 170),
    (214, 126, 44), (80, 91, 166), (193, 90, 99), (94, 60, 108), (157, 188, 64), (224, 163, 46),
    (56, 61, 150), (70, 148, 73), (175, 54, 60), (231, 199, 31), (187, 86, 149), (8, 133, 161),
    (243, 243, 242), (200, 200, 200), (160, 160, 160), (122, 122, 121), (85, 85, 85), (52, 52, 52),
    (0, 0, 0), (255, 255, 255), (255, 0, 0), (0, 255, 0), (0, 0, 255), (0, 255, 255), (255, 0, 255), (255, 255, 0),
]
STOPS = [-8, -4, -2, -1, 0, 1, 2, 4, 8]


def linear(byte):
    v = byte / 255
    return v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4


def neutral(color):
    f90, ks, kd = 0.04, 0.8 - 0.04, 0.15
    x = min(color)
    f = f90 if x > 2 * f90 else x - x**2 / (4 * f90)
    shifted = [c - f for c in color]
    p = max(shifted)
    if p <= ks:
        return shifted
    pn = 1 - (1 - ks) ** 2 / (p + 1 - 2 * ks)
    g = 1 / (kd * (p - pn) + 1)
    return [c * pn / p * g + pn * (1 - g) for c in shifted]


def sigmoid(x):
    """Sobotka's: a line of slope 2 through the pivot, each half scaled so as to touch 0 or 1."""
    pivot_x, pivot_y, slope = 10 / 16.5, 0.5, 2.0
    limit_x, limit_y, power = (1.0, 1.0, 3.25) if x >= pivot_x else (0.0, 0.0, 3.0)
    run, rise = slope * abs(limit_x - pivot_x), abs(limit_y - pivot_y)
    scale = (rise**-power - run**-power) ** (-1 / power)
    t = slope * abs(x - pivot_x) / scale
    bent = scale * t / (1 + t**power) ** (1 / power)
    return pivot_y + math.copysign(bent, x - pivot_x)


# Rows sum to 1: grey stays grey.
INSET = [
    [0.8424010709504686, 0.07843650156180276, 0.0791624274877287],
    [0.04240107095046854, 0.8784365015618028, 0.0791624274877287],
    [0.04240107095046854, 0.07843650156180276, 0.8791624274877287],
]


def times(matrix, v):
    return [sum(m * x for m, x in zip(row, v)) for row in matrix]


def inverse(m):
    (a, b, c), (d, e, f), (g, h, i) = m
    det = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    adjugate = [
        [e * i - f * h, c * h - b * i, b * f - c * e],
        [f * g - d * i, a * i - c * g, c * d - a * f],
        [d * h - e * g, b * g - a * h, a * e - b * d],
    ]
    return [[x / det for x in row] for row in adjugate]


def agx(color):
    grey = math.log2(0.18)
    stops = [math.log2(c) if c > 0 else -math.inf for c in times(INSET, color)]
    shares = [min(max((s - (grey - 10)) / 16.5, 0.0), 1.0) for s in stops]
    encoded = times(inverse(INSET), [sigmoid(s) for s in shares])
    return [min(max(c, 0.0), 1.0) ** 2.2 for c in encoded]


print("r,g,b,neutral_r,neutral_g,neutral_b,agx_r,agx_g,agx_b")
for patch in PATCHES:
    for stop in STOPS:
        color = [linear(c) * 2.0**stop for c in patch]
        print(",".join(f"{v:.9g}" for v in [*color, *neutral(color), *agx(color)]))
