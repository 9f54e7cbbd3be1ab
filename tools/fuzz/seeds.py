#!/usr/bin/python3
"""Writes the fuzzers' first inputs from the repository's own files: seeds.py OUT_FOLDER"""
import math
import pathlib
import struct
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]


def lines_of(text, letter):
    return [line for line in text.splitlines() if line.startswith(letter + ":")]


def bytes_behind(line, words):
    return bytes(int(x, 16) for x in line.split()[words:])


def write_pads(out):
    """The traces unchanged, and fuzz_descriptor's inputs: two bytes of choices and the length before their bytes."""
    for path in sorted((ROOT / "tests/data/pads").glob("*.hid")):
        text = path.read_text()
        (out / "fuzz_trace" / path.name).write_text(text)
        descriptor = bytes_behind(lines_of(text, "R")[0], 2)
        reports = b"".join(bytes_behind(line, 3) for line in lines_of(text, "E")[:3])
        for override in (0, 1):
            head = bytes([3, override, len(descriptor) & 255, len(descriptor) >> 8])
            (out / "fuzz_descriptor" / f"{path.stem}.{override}").write_bytes(head + descriptor + reports)


def write_session(out):
    """Writes a recording with embedded files: a text, bytes, and one that was saved while it ran."""
    pad = next(iter(sorted((ROOT / "tests/data/pads").glob("*.hid")))).read_text()
    lines = [line for line in pad.splitlines() if line[:2] in ("R:", "N:", "I:", "E:")]
    head = ("V: 2 rate_hz=240\nO: pace own\nO: style styles/even.toml\nO: terrain g.toml\nO: crowd 2\n"
            "F: styles/even.toml\nG: hip_sway = 1\nG:\nF: g.png\nX: 3 89 50 00\n")
    (out / "fuzz_trace" / "session.hid").write_text(
        head + "\n".join(line for line in lines if line[:2] != "E:") + "\nT: 0\n" + lines[-1] +
        "\nT: 2\nF: styles/mine.toml\nG: hip_sway = 2\n")


def leg(side, x):
    """A leg 0.8 m long: hip, knee, ankle and toe, in centimetres."""
    places = (("UpLeg", f"{x} -2 0"), ("Leg", "0 -40 0"), ("Foot", "0 -40 0"), ("ToeBase", "0 -8 12"))
    opened = "".join(f"JOINT {side}{name}\n{{\nOFFSET {place}\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
                     for name, place in places)
    return opened + "End Site\n{\nOFFSET 0 0 6\n}\n" + "}\n" * len(places)


def write_walk(out):
    """Writes a walk: legs that swing against each other while the root travels."""
    frames = []
    for k in range(40):
        swing = [30 * math.sin(0.35 * k + phase) for phase in (0, math.pi)]
        legs = [f"0 {s:.2f} 0 0 {max(0.0, -s):.2f} 0 0 0 0 0 0 0" for s in swing]
        frames.append(f"0 90 {4 * k} 0 0 0 " + " ".join(legs))
    text = ("HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\n"
            "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n" +
            leg("Left", 10) + leg("Right", -10) + f"}}\nMOTION\nFrames: {len(frames)}\nFrame Time: 0.0333\n")
    (out / "fuzz_bvh" / "walk.bvh").write_text(text + "\n".join(frames) + "\n")
    (out / "fuzz_bvh" / "still.bvh").write_text(text.replace(f"Frames: {len(frames)}", "Frames: 1") + frames[0] + "\n")


def bone(name, direction, dof):
    return f"begin\nid 1\nname {name}\ndirection {direction}\nlength 7\naxis 0 0 20 XYZ\n{dof}end\n"


def write_acclaim(out):
    """Writes a body of two legs, at rest and in two frames."""
    bones, tree, frame = "", "root lhip rhip\n", ["root 0 17 0 0 0 0"]
    for side, x in (("l", 1), ("r", -1)):
        bones += bone(side + "hip", f"{x} 0 0", "") + bone(side + "femur", "0 -1 0", "dof rx ry rz\nlimits (-1 2)\n(-inf inf)\n")
        bones += bone(side + "tibia", "0 -1 0", "dof rx\n") + bone(side + "foot", "0 -1 2", "dof tx rz\n")
        tree += f"{side}hip {side}femur\n{side}femur {side}tibia\n{side}tibia {side}foot\n"
        frame += [f"{side}femur 3 -2 1e-3", f"{side}tibia 20", f"{side}foot 0 5"]
    asf = (":version 1.10\n:name x\n:units\nmass 1\nlength 0.45\nangle deg\n:root\norder TX TY TZ RX RY RZ\naxis XYZ\n"
           f"position 0 0 0\norientation 0 0 0\n:bonedata\n{bones}:hierarchy\nbegin\n{tree}end\n")
    lines = "\n".join(frame)
    (out / "fuzz_acclaim" / "rest.asf").write_text(asf)
    (out / "fuzz_acclaim" / "two_frames").write_text(f"{asf}\n----\n:FULLY-SPECIFIED\n:DEGREES\n1\n{lines}\n2\n{lines}\n")


EVERY_KEY = """name = "mine"
unique_id = "a1:b2"
port = "usb-1/input0"
devices = ["054c:0ce6", "057e:*"]
drivers = ["hidraw", "usb"]
measured_on = "2026-11-21"
mapping = "030000004c050000e60c000011810000,Pad,a:b0,leftx:a0~,-lefty:+a1,dpup:h0.1,"
[left]
right = "-y"
forward = "x"
x = { min = -0.98, centre = 0.012, max = 0.97 }
shape = "axial"
inner = 0.05
outer = 0.9
sideways = 0.1
curve = 0.3
[left.measured]
sigma = 0.002
hysteresis = 0.01
drift_per_s = 0
circularity_error = 8.1
[left_trigger]
released = 0.02
pressed = 0.98
"""


def write_calibrations(out):
    for path in (ROOT / "config/calibration").glob("*.toml"):
        (out / "fuzz_calibration" / path.name).write_text(path.read_text())
    (out / "fuzz_calibration" / "every_key.toml").write_text(EVERY_KEY)


def write_imports(out):
    """Writes one file of each kind that is imported."""
    texts = {
        "evemu": "# EVEMU 1.3\nI: 0003 1209 0001 0111\nA: 00 15 240 0 15 0\nA: 01 10 235 0 10 0\n",
        "libinput": "# libinput record\ndevices:\n- node: /dev/input/event5\n  evdev:\n    id: [3, 4617, 1, 273]\n"
                    "    absinfo:\n      0: [15, 240, 0, 15, 0]\n      1: [10, 235, 0, 10, 0]\n",
        "umockdev": "@DEV /dev/input/event5\nEVIOCGID 0 0300091201001101\n"
                    "EVIOCGABS 0 800000000F000000F0000000000000000F00000000000000\n"
                    "EVIOCGABS(1) 0 800000000A000000EB000000000000000A00000000000000\n",
        "sdl": "03000000091200000100000011010000,Node,a:b1,b:b0,leftx:a0,lefty:a1~,platform:Linux,\n",
    }
    for name, text in texts.items():
        (out / "fuzz_import" / name).write_text(text)


def write_expectations(out):
    for path in ROOT.rglob("config/**/*.expect.toml"):
        (out / "fuzz_expectation" / path.name).write_bytes(path.read_bytes())
    (out / "fuzz_expectation" / "every_table.toml").write_text(
        '# mine\npose_hash = "0123456789abcdef"\nkeep_poses = false\nticks = 240\nbad_commands = 0\n'
        '[replay]\nmotion = "walk.toml"\npace = "adult"\ncharacter = ["build.toml", "adult"]\nstyle = ["./mine.toml"]\n'
        'crowd = 2\nterrain = "g.toml"\nscript = "s.toml"\nik = "paper"\nstick = "points"\ncalibration = "c.toml"\n'
        'map = "m.toml"\nrate = 240\nlenient = true\n[files]\n"config/styles/even.toml" = "0123456789abcdef"\n'
        '[[character]]\nsteps_left = 3\nspeed_m_s = { value = 1.25, within = 0.05 }\n')


def write_pad_files(out):
    for path in sorted((ROOT / "config/pads").glob("*.toml")):
        (out / "fuzz_pad_file" / path.name).write_bytes(path.read_bytes())


def write_mappings(out):
    base = "030000000912000001000000{version},Pad,a:b0,b:b1,x:b2,y:b3,back:b8,start:b9,leftx:a0,lefty:a1~,rightx:a2,righty:a3,"
    for name, line in {
            "plain": base.format(version="11010000") + "dpup:h0.1,dpdown:h0.4,platform:Linux,",
            "halves": base.format(version="00000000") + "lefttrigger:+a2,righttrigger:-a2~,-leftx:b4,+leftx:b5,crc:12ab,",
            "two": base.format(version="11010000") + "\n" + base.format(version="00000000") + "hint:SDL_GAMECONTROLLER_USE_BUTTON_LABELS:=1,"}.items():
        (out / "fuzz_mapping" / name).write_text(line + "\n")


def write_commands(out):
    (out / "fuzz_command" / "all").write_text(
        "style limp\nstyle 2 even\nset hip_sway 2\nset 1 arm_swing 0.5\ngait step_length_m 0.5\ngait 2 speed stick\ngait stick\n"
        "stick steers\nstick points 90\nreset\nreset 2\nik paper\nik robust\nmark\n")
    (out / "fuzz_command" / "script.toml").write_text(
        '[[event]]\nat_s = 1.5\ncommand = "style 1 limp"\n[[event]]\nat_s = 0\ncommand = "mark"\n')
    (out / "fuzz_session" / "walk").write_bytes(
        b"@\x80\x20\nmark\nset 1 legs.weight.knee 0\nset left_leg.weight.knee 1\nset hip_sway 2\ngait 2 stride_left_m 0.3\n"
        b"gait hip_bounce 1.5\ngait 1 speed_m_s 0.8\n@\x20\x20\nstyle limp\nik paper\nstick points 90\nreset 2\n"
        b"ik robust\nset arm_swing 0\nset look_at 0.5\ngait stick\nstick steers\n@\x80\x80\n")


def write_streams(out):
    numbers = struct.pack("<29d", *(0.1 * i for i in range(29)))
    for name, address in {"osc": "osc://127.0.0.1:39539", "six": "json://[::1]:39540", "plain": "json"}.items():
        (out / "fuzz_stream" / name).write_bytes(f"{address}\nA \"walker\" \\ ü\n".encode() + numbers)


def write_forwards(out):
    """Writes fuzz_forward's inputs from recordings, and two nodes of evdev."""
    for path in sorted((ROOT / "tests/data/pads").glob("*.hid"))[::3]:
        text = path.read_text()
        descriptor = bytes_behind(lines_of(text, "R")[0], 2)
        reports = b"".join(bytes([min(len(r), 65)]) + r[:65] for r in
                           (bytes_behind(line, 3) for line in lines_of(text, "E")[:4]))
        head = bytes([0, len(descriptor) & 255, len(descriptor) >> 8])
        (out / "fuzz_forward" / path.stem).write_bytes(head + descriptor + reports)
    for name, shift in (("node", 0), ("wide_node", 16)):
        axes = b"".join(struct.pack("<BBhh", code, shift, -32768, 32767) for code in (0, 1, 3, 4, 0x10, 0x11))
        keys = b"\xff" + b"".join(struct.pack("<H", code) for code in (0x130, 0x131, 0x133, 0x220))
        reports = bytes([16]) + b"\xff\x7f\x00\x80" * 4 + bytes([0xff, 1, 0xfe, 2, 3, 4])
        (out / "fuzz_forward" / name).write_bytes(struct.pack("<BH", 3, len(axes + keys)) + axes + keys + reports)


def main():
    out = pathlib.Path(sys.argv[1])
    for target in pathlib.Path(__file__).parent.glob("fuzz_*.cpp"):
        (out / target.stem).mkdir(parents=True, exist_ok=True)
    write_pads(out)
    write_session(out)
    write_walk(out)
    write_acclaim(out)
    write_calibrations(out)
    write_imports(out)
    write_expectations(out)
    write_pad_files(out)
    write_mappings(out)
    write_commands(out)
    write_streams(out)
    write_forwards(out)
    for path in (ROOT / "config/terrain").iterdir():
        (out / "fuzz_terrain" / path.name).write_bytes(path.read_bytes())


if __name__ == "__main__":
    main()
