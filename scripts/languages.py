#!/usr/bin/env python3
"""Draws the film of docs/speech.md in which three avatars say a German sentence and an
English one.

    scripts/languages.py VIEWER MAKEHUMAN TARGETS OUT.mp4 OUT.webp

MAKEHUMAN is MakeHuman's folder with base.obj and the folders rigs and eyes, TARGETS one with ARKit's shapes and visemes
for it, a .target each. On the left is the built-in face, in the middle MakeHuman's head, which has shapes alone, and on
the right its body as a VRM, which has nothing but expressions. Needs espeak-ng, ffmpeg and Pillow."""

import sys
import tempfile
from pathlib import Path

import heads

RATE = 25
SENTENCES = [
    ("de", "Guten Tag! Wir bewegen alle die Lippen, jeder nach seiner Art, und meinen dieselben Laute."),
    ("en", "And now the same in English: all of us move our lips, each in our own way."),
]


def main():
    viewer, makehuman, targets, film, moving = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        avatars = heads.three(Path(makehuman), Path(targets), folder)
        pictures = []
        parts = []
        for voice, text in SENTENCES:
            films = []
            for place, avatar in enumerate(avatars):
                frames = folder / f"{voice}{place}"
                command = [viewer, "speak", *avatar, "--say", text, "--voice", voice, "--life", "lively", "--seed", "3"]
                command += ["--quality", "low", "--fps", RATE, "--size", f"{heads.WIDTH}x{heads.HEIGHT}", "--out", f"{frames}/"]
                heads.run(*command)
                films.append(sorted(frames.glob("*.png")))
            beside = folder / voice
            beside.mkdir()
            for number, frames in enumerate(zip(*films)):
                picture = heads.beside(frames)
                picture.save(beside / f"{number:04}.png")
                pictures.append(picture)
            part = folder / f"{voice}.mp4"
            sound = next((folder / f"{voice}0").glob("*.wav"))
            encode = ["ffmpeg", "-y", "-loglevel", "error", "-framerate", RATE, "-i", beside / "%04d.png", "-i", sound]
            encode += ["-af", "apad", "-shortest", "-c:v", "libx264", "-crf", 26, "-pix_fmt", "yuv420p"]
            heads.run(*encode, "-c:a", "aac", "-b:a", "64k", part)
            parts.append(f"file '{part}'\n")
        listed = folder / "parts.txt"
        listed.write_text("".join(parts))
        join = ["ffmpeg", "-y", "-loglevel", "error", "-f", "concat", "-safe", 0, "-i", listed, "-c", "copy"]
        heads.run(*join, "-movflags", "+faststart", film)
        # Without sound, in a third of the pictures: what shows itself in a document.
        heads.save(pictures[::3], moving, round(3000 / RATE), 55)


main()
