"""gaitpad live: an add-on for Blender 3.4 by which `gaitpad play --stream json://...` walks any armature.

Install it by Edit > Preferences > Add-ons > Install, choose an armature, and open the tab gaitpad of the 3D view's
side bar (N). *Guess bones* fills in the map from gaitpad's bones to the armature's by their names; each line can be
changed and is stored with the armature. *Start* listens, *Record* writes a key frame for each pose that comes.

The stream has a character's bones as a humanoid's: identity rotations mean a T pose. So the armature is turned into
a T pose here by the same rule as gaitpad's (src/session/humanoid.h), and each bone turns from there in the world as
gaitpad's does. The armature may be of any size, rest in any pose and face any way.
"""
import json
import re
import socket

import bpy
from mathutils import Matrix, Quaternion, Vector

bl_info = {"name": "gaitpad live", "author": "gaitpad", "version": (0, 1, 0), "blender": (3, 4, 0),
           "location": "3D View > Sidebar > gaitpad", "category": "Animation",
           "description": "Walks an armature by the poses that gaitpad streams"}

PORT = 39540
MOST_AT_ONCE = 256  # datagrams taken at once, because a flood must not keep Blender from drawing
MOST_M = 1e4  # farther places are refused: no walk goes there
# gaitpad's bones: a bone stands behind the one that carries it; where that is not mapped, the one above it does.
PARENTS = {"Hips": None, "Spine": "Hips", "Chest": "Spine", "UpperChest": "Chest", "Neck": "UpperChest", "Head": "Neck"}
for _side in ("Left", "Right"):
    for _chain in (("Hips", "UpperLeg", "LowerLeg", "Foot", "Toes"), ("UpperChest", "Shoulder", "UpperArm", "LowerArm", "Hand")):
        for _above, _part in zip(_chain, _chain[1:]):
            PARENTS[_side + _part] = _above if _above in PARENTS else _side + _above

# --- which bone is which, by its name: the words are those of src/motion/anatomy.cpp --------------------------------
PART_WORDS = {
    "toe": "toe", "toes": "toe", "ball": "toe", "bale": "toe", "toebase": "toe", "forefoot": "toe", "ankle": "ankle",
    "foot": "ankle", "knee": "knee", "shin": "knee", "calf": "knee", "tibia": "knee", "leg": "knee", "lowleg": "knee",
    "lowerleg": "knee", "loleg": "knee", "shank": "knee", "thigh": "hip", "femur": "hip", "hip": "hip", "upleg": "hip",
    "upperleg": "hip", "collar": "collar", "clavicle": "collar", "clav": "collar", "collarbone": "collar",
    "scapula": "collar", "shoulder": "shoulder", "shoulderjoint": "shoulder", "humerus": "upper_arm",
    "shldr": "upper_arm", "uparm": "upper_arm", "upperarm": "upper_arm", "upprarm": "upper_arm", "bicep": "upper_arm",
    "biceps": "upper_arm", "elbow": "elbow", "forearm": "elbow", "radius": "elbow", "ulna": "elbow",
    "lowerarm": "elbow", "lowarm": "elbow", "loarm": "elbow", "wrist": "wrist", "hand": "wrist"}
NECK_WORDS = {"neck", "lowerneck", "upperneck"}
HEAD_WORDS = {"head", "skull"}
HELPER_WORDS = {"twist", "share", "roll", "rigmesh", "pole", "ik", "metatarsals", "end", "nub"}
BESIDE_ARM_WORDS = {"dum", "thumb", "index", "middle", "mid", "ring", "pinky", "little", "finger", "fingers", "palm",
                    "carpal", "metacarpal", "carpals", "pectoral", "eye", "top", "weapon", "prop", "leg", "foot", "hip"}
BESIDE_LEG_WORDS = {"buttock", "buttocks"}
LEG_PARTS = {"hip", "knee", "ankle", "toe"}
SIDES = {"l": "Left", "left": "Left", "lft": "Left", "r": "Right", "right": "Right", "rgt": "Right"}


def name_words(name):
    """The words of a name in lower case: "CC_Base_L_ToeBase" gives cc base l toe base, "LHipJoint" l hip joint."""
    return [word.lower() for word in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+", name.rpartition(":")[2])]


def joined(word):
    """Splits one word that has a side and a part: "lfoot", "rightelbow"."""
    for n in (5, 4, 1):
        if SIDES.get(word[:n]) and PART_WORDS.get(word[n:]):
            return SIDES[word[:n]], PART_WORDS[word[n:]]
    return None


def named_joint(name):
    """The side and part that a bone's name says; (None, None) if it says nothing."""
    words = name_words(name)
    for word in words:
        if word in NECK_WORDS:
            return None, "neck"
        if word in HEAD_WORDS:
            return None, None if {*words} & (HELPER_WORDS | BESIDE_ARM_WORDS) else "head"
    if {*words} & HELPER_WORDS:
        return None, None
    side = part = None
    for word in words:
        side = side or SIDES.get(word)
        said = PART_WORDS.get(word)
        if part is None or said == "toe":  # of several words the outer one counts: "FootToes"
            part = said or part
    if "arm" in words and part not in LEG_PARTS:
        part = "elbow" if {*words} & {"fore", "low", "lower", "lo"} else "upper_arm"
    if side is None or part is None:
        side, part = next(filter(None, map(joined, words)), (side, part))
    if part == "knee" and {*words} & {"up", "upper"}:
        part = "hip"
    if {*words} & (BESIDE_LEG_WORDS if part in LEG_PARTS else BESIDE_ARM_WORDS):
        part = None
    return (side, part) if side else (None, None)


def guessed_bones(bones):
    """Maps gaitpad's bones to names of these (bpy.types.Bone, parents before children); bones that are not found are
    left out."""
    named = {bone.name: named_joint(bone.name) for bone in bones}
    found = {}

    def above(bone, side, *parts):
        """The nearest bone above this one that is one of these parts; the first part that exists is taken."""
        for part in parts:
            for other in bone.parent_recursive:
                if named[other.name] == (side, part):
                    return other
        return None

    def is_below(bone, other):
        return other in bone.parent_recursive

    for side in ("Left", "Right"):
        for foot in (bone for bone in bones if named[bone.name] == (side, "ankle")):
            lower = above(foot, side, "knee")
            upper = lower and above(lower, side, "hip")
            if upper is None:
                continue
            toes = next((b for b in bones if named[b.name][1] == "toe" and is_below(b, foot)), None)
            found.update({side + "UpperLeg": upper, side + "LowerLeg": lower, side + "Foot": foot, side + "Toes": toes})
            break
        for lower in (bone for bone in bones if named[bone.name] == (side, "elbow")):
            upper = above(lower, side, "upper_arm", "shoulder")
            if upper is None:
                continue
            hand = None  # the lowest bone of that name: a bone of that name above it turns the forearm
            for bone in bones:
                if named[bone.name] == (side, "wrist") and is_below(bone, hand or lower):
                    hand = bone
            found.update({side + "Shoulder": above(upper, side, "collar", "shoulder"), side + "UpperArm": upper,
                          side + "LowerArm": lower, side + "Hand": hand})
            break

    def common(a, b):
        """The lowest bone that carries both bones."""
        path = [a, *a.parent_recursive]
        return next((bone for bone in [b, *b.parent_recursive] if bone in path), None)

    if found.get("LeftUpperLeg") and found.get("RightUpperLeg"):
        found["Hips"] = common(found["LeftUpperLeg"], found["RightUpperLeg"])
    head = next((bone for bone in bones if named[bone.name][1] == "head"), None)
    found["Head"] = head
    arms = [found[side + "UpperArm"] for side in ("Left", "Right") if found.get(side + "UpperArm")]
    chest = common(*arms) if len(arms) == 2 else common(arms[0], head) if arms and head else None
    if chest and found.get("Hips"):
        spine = path_below(common(found["Hips"], chest), chest)
        for name, bone in zip(("Spine", "Chest", "UpperChest"), spine_bones(spine)):
            found[name] = bone
        neck = path_below(chest, head)[:-1] if head and is_below(head, chest) else []
        found["Neck"] = neck[0] if neck else None
    return {name: found[name].name for name in PARENTS if found.get(name)}


def path_below(top, bone):
    """The bones from below `top` down to `bone`."""
    path = []
    while bone is not None and bone != top:
        path.insert(0, bone)
        bone = bone.parent
    return path


def spine_bones(spine):
    """The bones of a spine that are gaitpad's Spine, Chest and UpperChest."""
    n = len(spine)
    return spine if n < 3 else [spine[0], spine[n // 2], spine[-1]]


# --- from the stream to the armature -------------------------------------------------------------------------------
def rotation_between(a, b):
    """The smallest rotation from direction a to direction b. (rotation_difference() is not exact for small ones.)"""
    a, b = a.normalized(), b.normalized()
    if a.dot(b) < -0.999999:
        return Quaternion(a.orthogonal(), 3.14159265358979)
    return Quaternion((1.0 + a.dot(b), *a.cross(b))).normalized()


class Puppet:
    """An armature that poses of the stream can be put on. `bones`: gaitpad's bones -> names of its own.

    Only names and copies are kept: Blender's own objects move in memory when somebody edits or undoes."""

    def __init__(self, armature, bones):
        rest = armature.data.bones
        self.name = armature.name
        self.bones = {name: bone for name, bone in bones.items() if name in PARENTS and bone in rest}
        missing = [name for name in ("Hips", "LeftUpperLeg", "RightUpperLeg") if name not in self.bones]
        if missing:
            raise ValueError(f"no bone is chosen for {' and '.join(missing)}")
        self.order = [bone.name for bone in sorted(rest, key=lambda bone: len(bone.parent_recursive))]
        self.name_of = {bone: name for name, bone in self.bones.items()}
        self.head = {name: rest[bone].head_local.copy() for name, bone in self.bones.items()}
        self.tail = {name: rest[bone].tail_local.copy() for name, bone in self.bones.items()}
        self.axes = self._axes()
        self.t_pose = {name: self._turn(name) @ self.axes.transposed() @ rest[bone].matrix_local.to_3x3().normalized()
                       for name, bone in self.bones.items()}
        self.hips_m = self.axes.col[1].dot(self.head["Hips"])
        self.last = {}  # the last rotations, so that neighbouring key frames turn along the shorter arc

    @property
    def armature(self):
        return bpy.data.objects[self.name]

    def _axes(self):
        """Columns: the armature's left, up and forward, which are gaitpad's x, y and z."""
        left = self.head["LeftUpperLeg"] - self.head["RightUpperLeg"]
        hips = (self.head["LeftUpperLeg"] + self.head["RightUpperLeg"]) / 2
        low = sum((self._end(side + "LowerLeg") for side in ("Left", "Right")), Vector()) / 2
        rise = hips - low
        axis = max(range(3), key=lambda i: abs(rise[i]))
        up = Vector([0.0] * 3)
        up[axis] = 1.0 if rise[axis] > 0 else -1.0
        left = (left - up * left.dot(up)).normalized()
        return Matrix((left, up, left.cross(up))).transposed()

    def _end(self, name):
        """The place where the bone ends: at the next bone of its limb, else at its own tail."""
        if name not in self.bones:
            return self.head["Hips"]
        following = {"UpperLeg": "LowerLeg", "LowerLeg": "Foot", "Foot": "Toes", "UpperArm": "LowerArm", "LowerArm": "Hand"}
        side = next(side for side in ("Left", "Right") if name.startswith(side))
        return self.head.get(side + following[name.removeprefix(side)], self.tail[name])

    def _turn(self, name):
        """The rotation from the resting bone to its place in a T pose, in gaitpad's axes."""
        def line(of):
            return self.axes.transposed() @ (self._end(of) - self.head[of])

        side = "Left" if name.startswith("Left") else "Right"
        part = name.removeprefix(side)
        if part in ("UpperLeg", "LowerLeg"):
            return rotation_between(line(name), Vector((0, -1, 0))).to_matrix()
        if part in ("UpperArm", "LowerArm") or part == "Hand" and side + "LowerArm" in self.bones:
            aside = Vector((1 if side == "Left" else -1, 0, 0))
            return rotation_between(line(name if part != "Hand" else side + "LowerArm"), aside).to_matrix()
        if part in ("Foot", "Toes") and side + "Foot" in self.bones and side + "Toes" in self.bones:
            ahead = line(side + "Foot")
            return rotation_between(Vector((ahead.x, 0, ahead.z)), Vector((0, 0, 1))).to_matrix()
        return Matrix.Identity(3)

    def put(self, frame):
        """Applies one object of the stream to the armature."""
        world = {}  # rotations of gaitpad's bones, relative to the T pose
        root = frame["root"]
        root_turn = to_quaternion(root)
        for name, bone in frame["bones"].items():
            above = PARENTS.get(name)
            while above is not None and above not in world:
                above = PARENTS[above]
            world[name] = (world[above] if above else root_turn) @ to_quaternion(bone)
        hips = Vector(root[:3]) + root_turn @ Vector(frame["bones"]["Hips"][:3])
        moved = hips - Vector((0, frame["hips_m"], 0))
        scale = self.hips_m / frame["hips_m"] if self.hips_m > 0 else 1.0
        placed = {}  # the matrices of the posed bones in the armature
        posed = self.armature.pose.bones
        for bone in (posed[name] for name in self.order if name in posed):
            rest = bone.bone.matrix_local
            free = rest if bone.parent is None else \
                placed[bone.parent.name] @ bone.parent.bone.matrix_local.inverted() @ rest
            name = self.name_of.get(bone.name)
            if name not in world:
                placed[bone.name] = free @ bone.matrix_basis
                continue
            turn = self.axes @ world[name].to_matrix() @ self.t_pose[name]
            place = free.translation
            if name == "Hips":
                place = rest.translation + self.axes @ (moved * scale)
            placed[bone.name] = Matrix.Translation(place) @ turn.to_4x4()
            self._pose(bone, free.inverted() @ placed[bone.name], name == "Hips")

    def _pose(self, bone, basis, is_moved):
        rotation = basis.to_quaternion()
        if bone.name in self.last and rotation.dot(self.last[bone.name]) < 0:
            rotation.negate()
        self.last[bone.name] = rotation
        bone.rotation_mode = "QUATERNION"
        bone.rotation_quaternion = rotation
        if is_moved:
            bone.location = basis.translation

    def keep(self, frame):
        """Writes a key frame of the present pose."""
        for name, bone_name in self.bones.items():
            bone = self.armature.pose.bones[bone_name]
            bone.keyframe_insert("rotation_quaternion", frame=frame)
            if name == "Hips":
                bone.keyframe_insert("location", frame=frame)


def sound_frame(data):
    """The object in a datagram of the stream; None if it is another program's, or damaged."""
    try:
        frame = json.loads(data)
        is_known = all(isinstance(name, str) for name in frame["bones"])
        places = [frame["root"], *frame["bones"].values()]
        is_sound = is_known and "Hips" in frame["bones"] and all(is_place(place) for place in places) and \
            is_number(frame["time_s"]) and is_number(frame["hips_m"]) and frame["hips_m"] > 0
        return frame if is_sound else None
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return None


def is_number(value):
    """True for a number; not for True, nor for a whole number too large for a float; NaN fails both comparisons."""
    return type(value) in (int, float) and -1e9 < value < 1e9


def is_place(place):
    """True for a place and a quaternion."""
    return isinstance(place, list) and len(place) == 7 and all(map(is_number, place)) and \
        all(abs(m) < MOST_M for m in place[:3]) and 0.5 < sum(part * part for part in place[3:]) < 2.0


def to_quaternion(place):
    x, y, z, w = place[3:]
    return Quaternion((w, x, y, z))


class Listener:
    """Receives the stream for one armature. Port 0: any free one; `port` tells which one."""

    def __init__(self, armature, bones, port, host="127.0.0.1"):
        self.puppet = Puppet(armature, bones)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)  # poses that wait while Blender draws
        self.socket.setblocking(False)
        try:
            self.socket.bind((host, port))
        except OSError:
            self.socket.close()
            raise
        self.port = self.socket.getsockname()[1]
        self.malformed = 0  # number of datagrams that were skipped
        self.record(None)

    def close(self):
        self.socket.close()

    def record(self, first_frame):
        """From now on each pose is kept as a key frame, the next one at this frame. None: poses are no longer kept."""
        self.first_frame = first_frame
        self.first_s = None  # time of the stream at that frame

    def waiting(self):
        """The objects that have arrived since the last call, at most MOST_AT_ONCE."""
        frames = []
        for _ in range(MOST_AT_ONCE):
            try:
                data = self.socket.recv(65536)
            except BlockingIOError:
                break
            except OSError:
                continue  # an error that an earlier datagram of ours has caused
            frame = sound_frame(data)
            if frame is None:
                self.malformed += 1
            else:
                frames.append(frame)
        return frames

    def take(self, scene):
        """Applies the poses that have arrived: while it records every pose, else the newest. Returns their number."""
        frames = self.waiting()
        is_recording = self.first_frame is not None
        for frame in frames if is_recording else frames[-1:]:
            self.puppet.put(frame)
            if is_recording:
                if self.first_s is None:
                    self.first_s = frame["time_s"]
                fps = scene.render.fps / scene.render.fps_base
                self.puppet.keep(self.first_frame + (frame["time_s"] - self.first_s) * fps)
        return len(frames)


LISTENERS = {}  # the listeners, by their armature's name


def take_all():
    """Called by Blender's timer while anything listens."""
    for name, listener in list(LISTENERS.items()):
        if bpy.data.objects.get(name) is None:
            stop(name)
            continue
        try:
            listener.take(bpy.context.scene)
        except KeyError as bone:
            print(f"gaitpad live: {name}: the bone {bone} is gone, so it listens no longer")
            stop(name)
    return 1 / 60 if LISTENERS else None


def stop(name):
    LISTENERS.pop(name).close()


# --- Blender's user interface ---------------------------------------------------------------------------------------
class GAITPAD_PG_bone(bpy.types.PropertyGroup):
    name: bpy.props.StringProperty(description="gaitpad's bone")
    bone: bpy.props.StringProperty(description="The armature's bone; empty: none")


class GAITPAD_PG_live(bpy.types.PropertyGroup):
    port: bpy.props.IntProperty(name="Port", default=PORT, min=1, max=65535,
                                description="The n-th character of gaitpad comes to the n-th port of its stream")
    host: bpy.props.StringProperty(name="Address", default="127.0.0.1",
                                   description="Where to listen; 0.0.0.0: for other machines, too")
    bones: bpy.props.CollectionProperty(type=GAITPAD_PG_bone)


def bone_map(armature):
    return {entry.name: entry.bone for entry in armature.gaitpad.bones if entry.bone}


class ArmatureOperator(bpy.types.Operator):
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.type == "ARMATURE"


class GAITPAD_OT_guess(ArmatureOperator):
    """Fill in the map by the names of the armature's bones"""
    bl_idname = "gaitpad.guess_bones"
    bl_label = "Guess bones"

    def execute(self, context):
        armature = context.object
        guessed = guessed_bones(list(armature.data.bones))
        armature.gaitpad.bones.clear()
        for name in PARENTS:
            entry = armature.gaitpad.bones.add()
            entry.name, entry.bone = name, guessed.get(name, "")
        if not guessed:
            self.report({"WARNING"}, "no name of a bone tells what it is; choose the bones by hand")
        return {"FINISHED"}


class GAITPAD_OT_start(ArmatureOperator):
    """Listen to gaitpad's stream, or stop listening"""
    bl_idname = "gaitpad.start"
    bl_label = "Start"

    def execute(self, context):
        armature = context.object
        if armature.name in LISTENERS:
            stop(armature.name)
            return {"FINISHED"}
        if not armature.gaitpad.bones:
            bpy.ops.gaitpad.guess_bones()
        live = armature.gaitpad
        try:
            listener = Listener(armature, bone_map(armature), live.port, live.host)
        except (OSError, ValueError) as error:
            self.report({"ERROR"}, f"{armature.name}: {error}")
            return {"CANCELLED"}
        LISTENERS[armature.name] = listener
        if not bpy.app.timers.is_registered(take_all):
            bpy.app.timers.register(take_all)
        return {"FINISHED"}


class GAITPAD_OT_record(ArmatureOperator):
    """Write a key frame for each pose from the present frame on, or stop doing so"""
    bl_idname = "gaitpad.record"
    bl_label = "Record"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.object.name in LISTENERS

    def execute(self, context):
        listener = LISTENERS[context.object.name]
        is_recording = listener.first_frame is not None
        listener.record(None if is_recording else float(context.scene.frame_current))
        return {"FINISHED"}


class GAITPAD_PT_live(bpy.types.Panel):
    bl_label = "gaitpad live"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "gaitpad"

    def draw(self, context):
        layout, armature = self.layout, context.object
        if armature is None or armature.type != "ARMATURE":
            layout.label(text="Choose an armature")
            return
        listener = LISTENERS.get(armature.name)
        is_recording = listener is not None and listener.first_frame is not None
        column = layout.column()
        column.enabled = listener is None
        column.prop(armature.gaitpad, "host")
        column.prop(armature.gaitpad, "port")
        column.operator("gaitpad.guess_bones")
        layout.operator("gaitpad.start", text="Stop" if listener else "Start", depress=listener is not None)
        layout.operator("gaitpad.record", text="Stop recording" if is_recording else "Record", depress=is_recording)
        column = layout.column(align=True)
        column.enabled = listener is None
        if listener is not None and listener.malformed > 0:
            layout.label(text=f"{listener.malformed} datagrams were not gaitpad's", icon="ERROR")
        for entry in armature.gaitpad.bones:
            column.prop_search(entry, "bone", armature.data, "bones", text=entry.name)


CLASSES = (GAITPAD_PG_bone, GAITPAD_PG_live, GAITPAD_OT_guess, GAITPAD_OT_start, GAITPAD_OT_record, GAITPAD_PT_live)


def register():
    for item in CLASSES:
        bpy.utils.register_class(item)
    bpy.types.Object.gaitpad = bpy.props.PointerProperty(type=GAITPAD_PG_live)


def unregister():
    for name in list(LISTENERS):
        stop(name)
    del bpy.types.Object.gaitpad
    for item in reversed(CLASSES):
        bpy.utils.unregister_class(item)


if __name__ == "__main__":
    register()
