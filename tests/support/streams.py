"""Receivers for `gaitpad play --stream`, and the expected bones, computed from an exported pose.glb."""
import json
import re
import select
import socket
import subprocess
import tempfile
import threading

import numpy as np

from support.bvh import matrices_of
from support.glb import Glb, world

# Unity's names of a humanoid's bones and their parents. If a skeleton lacks the parent, its own parent takes its place.
PARENTS = {"Hips": None, "Spine": "Hips", "Chest": "Spine", "UpperChest": "Chest", "Neck": "UpperChest", "Head": "Neck"}
for _side in ("Left", "Right"):
    for _chain in (("Hips", "UpperLeg", "LowerLeg", "Foot", "Toes"), ("UpperChest", "Shoulder", "UpperArm", "LowerArm", "Hand")):
        for _above, _part in zip(_chain, _chain[1:]):
            PARENTS[_side + _part] = _above if _above in PARENTS else _side + _above
LEG_JOINTS = {"UpperLeg": "UpLeg", "LowerLeg": "Leg", "Foot": "Foot", "Toes": "ToeBase"}
ARM_JOINTS = {"Shoulder": "Shoulder", "UpperArm": "Arm", "LowerArm": "ForeArm", "Hand": "Hand"}


def joint_of(bone):
    """The built-in walk's joint of a bone."""
    for side in ("Left", "Right"):
        part = bone.removeprefix(side)
        if part != bone:
            return side + {**LEG_JOINTS, **ARM_JOINTS}[part]
    return bone


class Receiver:
    """Receives the datagrams of one port in the background until it is closed. Port 0: any free one."""

    def __init__(self, port=0, address="127.0.0.1"):
        self._socket = socket.socket(socket.AF_INET6 if ":" in address else socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind((address, port))
        self.port = self._socket.getsockname()[1]
        self.datagrams = []
        self._is_ending = False
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self):
        while not self._is_ending:
            if select.select([self._socket], [], [], 0.05)[0]:
                self.datagrams.append(self._socket.recv(65536))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._is_ending = True
        self._thread.join()
        self._socket.close()

    def frames(self):
        return [json.loads(datagram) for datagram in self.datagrams]


def free_ports(count):
    """The first of `count` neighbouring ports that are free now."""
    for first in range(39600, 60000, count):
        sockets = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(count)]
        try:
            for i, one in enumerate(sockets):
                one.bind(("127.0.0.1", first + i))
            return first
        except OSError:
            continue
        finally:
            for one in sockets:
                one.close()
    raise AssertionError("no free ports")


class OscDump:
    """liblo's own receiver, `oscdump`, for one port."""

    def __init__(self, port):
        self._output = tempfile.TemporaryFile("w+")  # a file, because a full pipe would block it
        self._process = subprocess.Popen(["oscdump", "-L", str(port)], stdout=self._output)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.kill()
        self._process.wait()
        self._output.close()

    def messages(self):
        """Ends the receiver and returns (path, types, values) of each message."""
        self._process.terminate()
        self._process.wait(10)
        self._output.seek(0)
        found = []
        for line in self._output:
            words = re.search(r"(/\S+) (\S+) (.*)", line)
            values = re.findall(r'"([^"]*)"|(\S+)', words[3])
            found.append((words[1], words[2], [text or float(number) for text, number in values]))
        return found


def rotation_of(place):
    """The rotation matrix of seven numbers; the last four are a quaternion x y z w."""
    return matrices_of(np.roll(np.array(place[3:], float), 1))


def world_rotations(places, root):
    """From bones in their parents' frames to 3x3 matrices in the world."""
    rotations = {}
    for bone, place in places.items():
        above = PARENTS[bone]
        while above and above not in rotations:
            above = PARENTS[above]
        rotations[bone] = (rotations[above] if above else rotation_of(root)) @ rotation_of(place)
    return rotations


# --- the same from the export --------------------------------------------------------------------------------------
def turn_between(a, b):
    """The smallest rotation from direction a to direction b (Rodrigues)."""
    a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
    v, c = np.cross(a, b), a @ b
    cross = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.eye(3) + cross + cross @ cross / (1 + c)


def level(v):
    return np.array([v[0], 0.0, v[2]])


class ExportedBones:
    """The humanoid of a pose.glb: bones are relative to a T pose that is computed from the bind pose."""

    def __init__(self, path):
        file = Glb(path)
        times, translations, rotations = file.tracks()
        self.place_m, self.world = world(file, len(times), translations, rotations)
        self.index = {bone: file.names.index(joint_of(bone)) for bone in PARENTS if joint_of(bone) in file.names}
        at, turn = world(file, 1, {}, {})
        at, turn = at[0], turn[0]
        place = {bone: at[i] for bone, i in self.index.items()}
        facing = turn_between(level(place["LeftUpperLeg"] - place["RightUpperLeg"]), np.array([1.0, 0, 0]))
        self.t_pose = {}
        for bone in self.index:
            side = "Left" if bone.startswith("Left") else "Right"
            part = bone.removeprefix(side)
            line, aim = None, None
            if part in ("UpperLeg", "LowerLeg"):
                end = {"UpperLeg": "LowerLeg", "LowerLeg": "Foot"}[part]
                line, aim = place[side + end] - place[bone], [0, -1, 0]
            elif part in ("UpperArm", "LowerArm", "Hand"):
                ends = ("LowerArm", "Hand") if part != "UpperArm" else ("UpperArm", "LowerArm")
                line, aim = place[side + ends[1]] - place[side + ends[0]], [1 if side == "Left" else -1, 0, 0]
            elif part in ("Foot", "Toes"):
                line, aim = level(place[side + "Toes"] - place[side + "Foot"]), [0, 0, 1]
            to_aim = np.eye(3) if line is None else turn_between(facing @ line, np.array(aim, float))
            self.t_pose[bone] = to_aim @ facing @ turn[self.index[bone]]

    def rotations(self, tick):
        """World rotation of each bone."""
        return {bone: self.world[tick, i] @ self.t_pose[bone].T for bone, i in self.index.items()}


def hostile(frame, rng):
    """A datagram: noise, a damaged object, one with a value of another kind, or a valid one with its tick unchanged."""
    text = json.dumps(frame)
    kind = rng.integers(6)
    if kind == 0:
        return rng.bytes(int(rng.integers(0, 1500)))
    if kind == 1:
        data = bytearray(text.encode())
        for _ in range(int(rng.integers(1, 20))):
            data[rng.integers(len(data))] = rng.integers(256)
        return bytes(data)
    if kind == 2:
        return text[:rng.integers(len(text))].encode()
    if kind == 3:
        return [b"[]", b"null", b"7", b'"Hips"', b'{"bones": "Hips"}', b'{"bones": ["Hips"]}', b"[" * 20000, b"",
                b'{"bones": {"Hips": []}}', b'{"bones": {"Hips": null}, "root": 1}'][rng.integers(10)]
    frame = json.loads(text)
    odd = [None, True, "x", [], {}, -1, 0, 1e308, float("nan"), float("inf"), 10**400, [1e300] * 7, [0] * 7, [0] * 6]
    value = odd[rng.integers(len(odd))]
    where = rng.integers(4)
    if where == 0:
        frame[list(frame)[rng.integers(len(frame))]] = value
    elif where == 1:
        frame["bones"][list(frame["bones"])[rng.integers(len(frame["bones"]))]] = value
    elif where == 2:
        frame["bones"]["Hips"][rng.integers(7)] = value
    else:
        del frame[list(frame)[rng.integers(len(frame))]]
    return json.dumps(frame).encode()
