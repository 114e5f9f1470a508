"""What scripts/check-live has python-osc and pylivelinkface write and read; WITNESS is the example of
avatar-live. Numbers are random with a fixed seed."""

import random
import struct
import subprocess
import sys

from pylivelinkface import FaceBlendShape, PyLiveLinkFace
from pythonosc.osc_bundle_builder import IMMEDIATELY, OscBundleBuilder
from pythonosc.osc_message_builder import OscMessageBuilder
from pythonosc.osc_packet import OscPacket

ROUNDS = 200
random.seed(5)


def f32(number):
    return struct.unpack("f", struct.pack("f", number))[0]


def ask(lines):
    text = "\n".join(lines) + "\n"
    answer = subprocess.run([sys.argv[1]], input=text, capture_output=True, text=True, check=True)
    return answer.stdout.split("\n")[: len(lines)]


def message(address, *arguments):
    builder = OscMessageBuilder(address)
    for argument in arguments:
        builder.add_arg(argument)
    return builder.build()


def values_of(line):
    words = line.split(" ")
    return {name: float(value) for name, value in zip(words[::2], words[1::2])}


shapes = [shape.name[0].lower() + shape.name[1:] for shape in FaceBlendShape][:52]
faces = [{name: f32(random.random()) for name in shapes} for _ in range(ROUNDS)]

# python-osc writes, in a bundle that is in a bundle.
packets = []
for number, face in enumerate(faces):
    inner = OscBundleBuilder(IMMEDIATELY)
    for name, value in face.items():
        inner.add_content(message("/VMC/Ext/Blend/Val", name, value))
    outer = OscBundleBuilder(IMMEDIATELY)
    outer.add_content(message("/VMC/Ext/OK", 1, 3, 0, 1))
    outer.add_content(message("/VMC/Ext/T", float(number)))
    outer.add_content(inner.build())
    outer.add_content(message("/VMC/Ext/Blend/Apply"))
    packets.append(outer.build().dgram)
for face, line in zip(faces, ask(["vmc " + packet.hex() for packet in packets])):
    read = values_of(line)
    assert set(read) == set(face), line
    assert all(f32(read[name]) == face[name] for name in face), line
print(f"python-osc -> avatar-live: {ROUNDS} frames are the same")

# python-osc reads what we write.
lines = ["write vmc head.turn 20 " + " ".join(f"{name} {value!r}" for name, value in face.items()) for face in faces]
for face, line in zip(faces, ask(lines)):
    read, addresses, head = {}, [], None
    for packet in line.split(" "):
        for timed in OscPacket(bytes.fromhex(packet)).messages:
            addresses.append(timed.message.address)
            if timed.message.address == "/VMC/Ext/Blend/Val":
                read[timed.message.params[0]] = timed.message.params[1]
            if timed.message.address == "/VMC/Ext/Bone/Pos" and timed.message.params[0] == "Head":
                head = timed.message.params[4:]
    assert read == face, line
    assert addresses[:2] == ["/VMC/Ext/OK", "/VMC/Ext/T"] and addresses[-1] == "/VMC/Ext/Blend/Apply"
    # Half of 20 degrees, about -Y in Unity's frame.
    assert abs(head[1] + 0.17364818) < 1e-6 and abs(head[3] - 0.98480775) < 1e-6, head
print(f"avatar-live -> python-osc: {ROUNDS} frames are the same")

# pylivelinkface writes, and reads.
packets = []
for face in faces:
    live = PyLiveLinkFace(name="Ann", uuid="DEADC0DE-1337-1337-1337-CAFEBABE0001")
    for shape, value in zip(FaceBlendShape, face.values()):
        live.set_blendshape(shape, value, True)
    packets.append(live.encode())
for face, line in zip(faces, ask(["livelink " + packet.hex() for packet in packets])):
    read = values_of(line)
    assert all(f32(read[name]) == face[name] for name in face), line
print(f"pylivelinkface -> avatar-live: {ROUNDS} frames are the same")
lines = ["write livelink " + " ".join(f"{name} {value!r}" for name, value in face.items()) for face in faces]
for face, line in zip(faces, ask(lines)):
    has_face, live = PyLiveLinkFace.decode(bytes.fromhex(line))
    assert has_face and live.name == "Ann"
    for shape, value in zip(FaceBlendShape, face.values()):
        assert live.get_blendshape(shape) == value, (shape, line)
print(f"avatar-live -> pylivelinkface: {ROUNDS} frames are the same")
