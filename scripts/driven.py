#!/usr/bin/env python3
"""Draws the film of docs/live.md: three avatars with three lists of names, driven by one recording of a phone.

    scripts/driven.py VIEWER TAKE.csv MAKEHUMAN OUT.webp

MAKEHUMAN is a folder with MakeHuman's base.obj and a folder `targets` of ARKit's shapes for it. On the left is the
built-in face (joints and shapes), in the middle the other head (shapes alone), and on the right a VRM (expressions).
Needs Pillow."""

import sys
import tempfile
from pathlib import Path

import heads

RATE = 15


def main():
    viewer, take, makehuman, out = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        films = []
        for place, avatar in enumerate(heads.three(viewer, makehuman, folder)):
            frames = folder / str(place)
            command = [viewer, "record", *avatar, "--clip", take, "--quality", "low", "--fps", RATE]
            heads.run(*command, "--size", f"{heads.WIDTH}x{heads.HEIGHT}", "--out", f"{frames}/")
            films.append(sorted(frames.glob("*.png")))
        pictures = [heads.beside(frames) for frames in zip(*films)]
        heads.save(pictures, out, round(1000 / RATE), 70)


main()
