# Walks a Skeleton by the stream of `gaitpad play --stream json`. For Godot 3.2 or later, as in Debian 12.
#
# The skeleton's rest is a T pose that faces +z, and its bones have the names of Unity's humanoid ("Hips",
# "LeftUpperLeg" ...), as VRM avatars and retargeted imports have. Both worlds are right-handed with y up, so nothing
# is converted.
extends Skeleton

export var port := 39540  # of gaitpad's first character
export var address := "127.0.0.1"  # "*": from other machines, too

# The bone that carries each; where a stream lacks it, the one above it does.
const PARENTS := {
	"Spine": "Hips", "Chest": "Spine", "UpperChest": "Chest", "Neck": "UpperChest", "Head": "Neck",
	"LeftUpperLeg": "Hips", "LeftLowerLeg": "LeftUpperLeg", "LeftFoot": "LeftLowerLeg", "LeftToes": "LeftFoot",
	"RightUpperLeg": "Hips", "RightLowerLeg": "RightUpperLeg", "RightFoot": "RightLowerLeg", "RightToes": "RightFoot",
	"LeftShoulder": "UpperChest", "LeftUpperArm": "LeftShoulder", "LeftLowerArm": "LeftUpperArm",
	"LeftHand": "LeftLowerArm", "RightShoulder": "UpperChest", "RightUpperArm": "RightShoulder",
	"RightLowerArm": "RightUpperArm", "RightHand": "RightLowerArm"}

const MOST_AT_ONCE := 64  # datagrams: Godot draws between two looks, and a flood must not keep it from that

var malformed := 0  # datagrams that were skipped
var _socket = PacketPeerUDP.new()


func _ready() -> void:
	if _socket.listen(port, address) != OK:
		push_error("port %d is taken" % port)


func _process(_delta: float) -> void:
	var newest = take()
	if newest != null:
		put(newest)


# The newest object that has come since the last call, or null. At most MOST_AT_ONCE are looked at.
func take():
	var newest = null
	for _i in MOST_AT_ONCE:
		if _socket.get_available_packet_count() == 0:
			break
		var data: PoolByteArray = _socket.get_packet()
		var read = JSON.parse(data.get_string_from_utf8()) if looks_like_json(data) else null
		if read != null and read.error == OK and is_sound(read.result):
			newest = read.result
		else:
			malformed += 1
	return newest


# Begins with { and ends with }.
static func looks_like_json(data: PoolByteArray) -> bool:
	return data.size() > 2 and data[0] == 0x7b and (data[data.size() - 1] == 0x7d or data[data.size() - 2] == 0x7d)


# Whether an object is one of the stream: places are three numbers and a quaternion.
static func is_sound(frame) -> bool:
	if not (frame is Dictionary and frame.get("bones") is Dictionary and frame["bones"].has("Hips")):
		return false
	if not (is_number(frame.get("hips_m")) and frame["hips_m"] > 0 and is_place(frame.get("root"))):
		return false
	for bone in frame["bones"].values():
		if not is_place(bone):
			return false
	return true


static func is_number(value) -> bool:
	return value is float and abs(value) < 1e9


static func is_place(numbers) -> bool:
	if not (numbers is Array and numbers.size() == 7):
		return false
	var square := 0.0
	for i in 7:
		if not is_number(numbers[i]):
			return false
		if i >= 3:
			square += numbers[i] * numbers[i]
	return 0.5 < square and square < 2.0


# Puts one object of the stream on the skeleton.
func put(frame: Dictionary) -> void:
	var root := Transform(turn(frame["root"]), place(frame["root"]))
	var turns := {}  # in the world, counted from the T pose
	for name in frame["bones"]:
		var above = PARENTS.get(name)
		while above != null and not turns.has(above):
			above = PARENTS.get(above)
		turns[name] = (root.basis if above == null else turns[above]) * turn(frame["bones"][name])
	var hips: Vector3 = root.xform(place(frame["bones"]["Hips"])) - Vector3(0, frame["hips_m"], 0)
	var rests := []  # by bone, in the skeleton
	var posed := []
	for bone in get_bone_count():
		var parent := get_bone_parent(bone)
		var rest := get_bone_rest(bone)
		rests.append(rest if parent < 0 else rests[parent] * rest)
		var free: Transform = rest if parent < 0 else posed[parent] * rest
		var name := get_bone_name(bone)
		if not turns.has(name):
			posed.append(free * get_bone_pose(bone))
			continue
		var at := free.origin
		if name == "Hips":  # a larger skeleton makes larger steps
			at = rests[bone].origin + hips * (rests[bone].origin.y / frame["hips_m"])
		posed.append(Transform(turns[name] * rests[bone].basis, at))
		set_bone_pose(bone, free.affine_inverse() * posed[bone])


static func place(numbers: Array) -> Vector3:
	return Vector3(numbers[0], numbers[1], numbers[2])


static func turn(numbers: Array) -> Basis:
	return Basis(Quat(numbers[3], numbers[4], numbers[5], numbers[6]).normalized())
