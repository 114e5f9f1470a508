"""Pictures a second of the window in motion: a virtual display, real keys, and its picture read from outside.

Xvfb keeps the screen in a file, so that looking at it costs the window next to nothing. A picture counts when
pixels spread over the middle of the screen have changed since the last look.
"""

import mmap
import os
import pathlib
import shutil
import subprocess
import time

SIZE = (1280, 720)
PATIENCE_SECS = 60
# Keys of poses, so that the face is always on its way from one to the next.
KEYS = "134567"
KEY_SECS = 0.2
LOOK_SECS = 0.004


class Missing(Exception):
    """What a measurement needs is not there; the text says what."""


def pictures_a_second(command, seconds, scratch):
    """Opens the window and presses keys of poses for so long. Raises Missing where that cannot be."""
    for name in ["Xvfb", "xdotool"]:
        if shutil.which(name) is None:
            raise Missing(f"{name} is not installed")
    folder = pathlib.Path(scratch, "screen")
    folder.mkdir(exist_ok=True)
    read, write = os.pipe()
    screen = f"{SIZE[0]}x{SIZE[1]}x24"
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), "-screen", "0", screen, "-fbdir", folder, "-nolisten", "tcp", "-noreset"],
        pass_fds=[write],
        stderr=subprocess.DEVNULL,
    )
    os.close(write)
    window = None
    try:
        with os.fdopen(read) as number:
            display = f":{number.readline().strip()}"
        if display == ":":
            raise Missing("Xvfb does not start")
        environment = {**os.environ, "DISPLAY": display}
        for name in ["WAYLAND_DISPLAY", "WAYLAND_SOCKET"]:
            environment.pop(name, None)
        window = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        with open(folder / "Xvfb_screen0", "rb") as file, mmap.mmap(file.fileno(), 0, prot=mmap.PROT_READ) as pixels:
            _wait_for_face(pixels, window)
            # There is no window manager that would do it.
            focus = ["xdotool", "search", "--onlyvisible", "--name", "Mimik", "windowfocus"]
            if subprocess.run(focus, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode:
                raise Missing("xdotool finds no window of the name Mimik")
            return _count(pixels, window, environment, seconds)
    finally:
        for process in [window, server]:
            if process is not None:
                process.terminate()
                process.wait()


def looked_at(length):
    """Places in a screen's file: rows over the middle half of the picture, a few pixels of each."""
    width, height = SIZE
    header = length - 4 * width * height
    return [
        slice(header + 4 * (row * width + width // 4), header + 4 * (row * width + 3 * width // 4))
        for row in range(height // 4, 3 * height // 4, 24)
    ]


def _look(pixels, places):
    return hash(b"".join(pixels[place] for place in places))


def _wait_for_face(pixels, window):
    """Until the middle of the screen is not one colour, and has stayed as it is for a second."""
    places = looked_at(len(pixels))
    end, seen, since = time.monotonic() + PATIENCE_SECS, None, 0.0
    while time.monotonic() < end:
        if window.poll() is not None:
            raise Missing(f"the window ended with {window.returncode}")
        now = b"".join(pixels[place] for place in places)
        if now != seen:
            seen, since = now, time.monotonic()
        elif time.monotonic() > since + 1 and len(set(now)) > 8:
            return
        time.sleep(0.05)
    raise Missing(f"no face within {PATIENCE_SECS} s")


def _count(pixels, window, environment, seconds):
    places, changes, pressed = looked_at(len(pixels)), 0, 0
    last = _look(pixels, places)
    start = next_key = time.monotonic()
    while (now := time.monotonic()) < start + seconds:
        if now >= next_key:
            subprocess.Popen(["xdotool", "key", KEYS[pressed % len(KEYS)]], env=environment).wait()
            pressed += 1
            next_key += KEY_SECS
        seen = _look(pixels, places)
        changes += seen != last
        last = seen
        time.sleep(LOOK_SECS)
    if window.poll() is not None:
        raise Missing(f"the window ended with {window.returncode}")
    if changes == 0:
        raise Missing(f"nothing moved in {seconds} s of keys")
    return changes / seconds
