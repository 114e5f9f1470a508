#!/usr/bin/env python3
"""Draws the film of docs/live.md: three avatars with three lists of names, driven by one recording of a phone.

    scripts/driven.py VIEWER TAKE.csv MAKEHUMAN TARGETS OUT.webp

MAKEHUMAN is MakeHuman's folder with base.obj and the folders rigs and eyes, TARGETS one with ARKit's shapes and visemes
for it, a .target each. On the left is the built-in face, in the middle MakeHuman's head, which has shapes alone, and on
the right its body as a VRM, which has nothing but expressions. Needs Pillow."""

import sys
import tempfile
from pathlib import Path

import heads

RATE = 15


def main():
    viewer, take, makehuman, targets, out = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        films = []
        for place, avatar in enumerate(heads.three(Path(makehuman), Path(targets), folder)):
            frames = folder / str(place)
            command = [viewer, "record", *avatar, "--clip", take, "--quality", "low", "--fps", RATE]
            heads.run(*command, "--size", f"{heads.WIDTH}x{heads.HEIGHT}", "--out", f"{frames}/")
            films.append(sorted(frames.glob("*.png")))
        pictures = [heads.beside(frames) for frames in zip(*films)]
        heads.save(pictures, out, round(1000 / RATE), 70)


main()
