"""BVH reader and forward kinematics, vectorised over frames. Part of the independent judge of
`gaitpad replay --out`: shares no code with the program. Units and degrees as in the file."""
import numpy as np


class Bvh:
    """A BVH file: names, parents, offsets (J, 3). End Sites are joints named PARENT_End without channels. channels[j]
    is a list of names, first[j] the column where they begin, data is (F, C)."""

    def __init__(self):
        self.names, self.parents, self.offsets = [], [], []
        self.channels, self.first, self.end_site = [], [], []
        self.data, self.frame_time, self.path = None, 0.0, ""

    def index(self, name):
        return self.names.index(name)

    def children(self, joint):
        return [i for i, p in enumerate(self.parents) if p == joint]

    def ancestors(self, joint):
        """The joints from this one up to the root."""
        chain = []
        while joint >= 0:
            chain.append(joint)
            joint = self.parents[joint]
        return chain


def _add_joint(bvh, name, parent, end_site):
    bvh.names.append(name)
    bvh.parents.append(parent)
    bvh.offsets.append([0.0, 0.0, 0.0])
    bvh.channels.append([])
    bvh.first.append(0)
    bvh.end_site.append(end_site)
    return len(bvh.names) - 1


def _read_hierarchy(bvh, tokens):
    """Consumes tokens up to MOTION; returns the number of channels."""
    stack, current, columns, i = [], -1, 0, 1
    while tokens[i] != "MOTION":
        word = tokens[i]
        if word in ("ROOT", "JOINT"):
            current = _add_joint(bvh, tokens[i + 1], stack[-1] if stack else -1, False)
            i += 2
        elif word == "End":
            current = _add_joint(bvh, bvh.names[stack[-1]] + "_End", stack[-1], True)
            i += 2
        elif word == "OFFSET":
            bvh.offsets[current] = [float(t) for t in tokens[i + 1:i + 4]]
            i += 4
        elif word == "CHANNELS":
            count = int(tokens[i + 1])
            bvh.channels[current] = tokens[i + 2:i + 2 + count]
            bvh.first[current] = columns
            columns += count
            i += 2 + count
        elif word == "{":
            stack.append(current)
            i += 1
        elif word == "}":
            stack.pop()
            i += 1
        else:
            raise ValueError(f"{bvh.path}: unexpected word {word!r} in the hierarchy")
    return columns


def read_bvh(path):
    bvh = Bvh()
    bvh.path = str(path)
    with open(path, encoding="utf-8", errors="replace") as file:
        text = file.read()
    head, _, motion = text.partition("MOTION")
    columns = _read_hierarchy(bvh, head.split() + ["MOTION"])
    bvh.offsets = np.array(bvh.offsets)
    lines = motion.strip().split("\n", 2)
    frames = int(lines[0].split()[1])
    bvh.frame_time = float(lines[1].split()[2])
    values = np.fromstring(lines[2] if len(lines) > 2 else "", sep=" ")
    if values.size != frames * columns:
        raise ValueError(f"{path}: {values.size} values, expected {frames} x {columns}")
    bvh.data = values.reshape(frames, columns)
    return bvh


def write_bvh(bvh, path, digits=6):
    """Writes what read_bvh returned (for tests and planted faults)."""
    out = ["HIERARCHY"]

    def node(j, depth):
        pad = "  " * depth
        if bvh.end_site[j]:
            out.append(pad + "End Site")
        else:
            out.append(pad + ("ROOT " if bvh.parents[j] < 0 else "JOINT ") + bvh.names[j])
        out.append(pad + "{")
        out.append(pad + "  OFFSET " + " ".join(f"{v:.9g}" for v in bvh.offsets[j]))
        if bvh.channels[j]:
            out.append(f"{pad}  CHANNELS {len(bvh.channels[j])} " + " ".join(bvh.channels[j]))
        for child in bvh.children(j):
            node(child, depth + 1)
        out.append(pad + "}")

    node(0, 0)
    out += ["MOTION", f"Frames: {len(bvh.data)}", f"Frame Time: {bvh.frame_time:.9g}"]
    row = " ".join([f"%.{digits}f"] * bvh.data.shape[1])
    out += [row % tuple(values) for values in bvh.data]
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(out) + "\n")


def axis_matrices(axis, degrees):
    """The matrices (F, 3, 3) of rotations about X, Y or Z."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    matrices = np.zeros((len(c), 3, 3))
    i, j, k = {"X": (0, 1, 2), "Y": (1, 2, 0), "Z": (2, 0, 1)}[axis]
    matrices[:, i, i] = 1.0
    matrices[:, j, j] = matrices[:, k, k] = c
    matrices[:, k, j], matrices[:, j, k] = s, -s
    return matrices


def local_rotations(bvh):
    """The product of the rotation channels in file order, (F, J, 3, 3)."""
    frames = len(bvh.data)
    local = np.tile(np.eye(3), (frames, len(bvh.names), 1, 1))
    for j, channels in enumerate(bvh.channels):
        for c, name in enumerate(channels):
            if name.lower().endswith("rotation"):
                local[:, j] = local[:, j] @ axis_matrices(name[0].upper(), bvh.data[:, bvh.first[j] + c])
    return local


def translations(bvh):
    """The places of joints relative to their parents (F, J, 3): OFFSET, or the position channels of a joint that has
    them."""
    offsets = np.tile(bvh.offsets, (len(bvh.data), 1, 1))
    for j, channels in enumerate(bvh.channels):
        for c, name in enumerate(channels):
            if name.lower().endswith("position"):
                offsets[:, j, "XYZ".index(name[0].upper())] = bvh.data[:, bvh.first[j] + c]
    return offsets


def forward_kinematics(parents, offsets, local, order=None):
    """World positions (F, J, 3) and rotations (F, J, 3, 3). order: parents before children, if the joints are in
    another order."""
    position, rotation = offsets.copy(), local.copy()
    for j in order or range(len(parents)):
        p = parents[j]
        if p >= 0:
            position[:, j] = position[:, p] + np.einsum("fij,fj->fi", rotation[:, p], offsets[:, j])
            rotation[:, j] = rotation[:, p] @ local[:, j]
    return position, rotation


def rotation_vectors(matrices):
    """The logarithm of matrices (..., 3, 3) in degrees; accurate up to about 179 degrees."""
    vee = 0.5 * np.stack([matrices[..., 2, 1] - matrices[..., 1, 2],
                          matrices[..., 0, 2] - matrices[..., 2, 0],
                          matrices[..., 1, 0] - matrices[..., 0, 1]], axis=-1)
    sine = np.linalg.norm(vee, axis=-1)
    cosine = 0.5 * (np.trace(matrices, axis1=-2, axis2=-1) - 1.0)
    angle = np.arctan2(sine, cosine)
    scale = np.where(sine > 1e-12, angle / np.maximum(sine, 1e-300), 1.0)
    return np.degrees(vee * scale[..., None])


def angle_between(a, b):
    """Degrees between two rotations (..., 3, 3)."""
    return np.linalg.norm(rotation_vectors(np.swapaxes(a, -1, -2) @ b), axis=-1)


def quaternions(matrices):
    """Quaternions w, x, y, z (F, ..., 4); neighbours along axis 0 are in one hemisphere."""
    m = matrices
    diagonal = np.stack([m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]], axis=-1)
    trace = diagonal.sum(-1)
    size = np.sqrt(np.maximum(0.0, np.stack(
        [1 + trace, 1 + 2 * diagonal[..., 0] - trace, 1 + 2 * diagonal[..., 1] - trace,
         1 + 2 * diagonal[..., 2] - trace], axis=-1))) / 2
    d = [m[..., 2, 1] - m[..., 1, 2], m[..., 0, 2] - m[..., 2, 0], m[..., 1, 0] - m[..., 0, 1]]
    s = [m[..., 1, 0] + m[..., 0, 1], m[..., 0, 2] + m[..., 2, 0], m[..., 2, 1] + m[..., 1, 2]]
    big = np.maximum(4 * size, 1e-9)
    options = np.stack([
        np.stack([size[..., 0], d[0] / big[..., 0], d[1] / big[..., 0], d[2] / big[..., 0]], -1),
        np.stack([d[0] / big[..., 1], size[..., 1], s[0] / big[..., 1], s[1] / big[..., 1]], -1),
        np.stack([d[1] / big[..., 2], s[0] / big[..., 2], size[..., 2], s[2] / big[..., 2]], -1),
        np.stack([d[2] / big[..., 3], s[1] / big[..., 3], s[2] / big[..., 3], size[..., 3]], -1)], -2)
    best = np.argmax(size, axis=-1)
    q = np.take_along_axis(options, best[..., None, None], axis=-2)[..., 0, :]
    dots = np.sum(q[1:] * q[:-1], axis=-1)
    signs = np.concatenate([np.ones((1,) + dots.shape[1:]), np.where(dots < 0, -1.0, 1.0)])
    return q * np.cumprod(signs, axis=0)[..., None]


def matrices_of(q):
    """The inverse of quaternions(); normalises."""
    q = q / np.linalg.norm(q, axis=-1, keepdims=True)
    w, x, y, z = np.moveaxis(q, -1, 0)
    rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
    return np.stack([np.stack(r, -1) for r in rows], -2)


def second_differences(local):
    """Changes of the one-tick rotation vector, (F, J) degrees per tick^2; the ends are 0."""
    steps = rotation_vectors(np.swapaxes(local[:-1], -1, -2) @ local[1:])
    result = np.zeros(local.shape[:2])
    result[1:-1] = np.linalg.norm(steps[1:] - steps[:-1], axis=-1)
    return result
