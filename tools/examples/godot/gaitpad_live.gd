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

var _socket := PacketPeerUDP.new()


func _ready() -> void:
	if _socket.listen(port, address) != OK:
		push_error("port %d is taken" % port)


func _process(_delta: float) -> void:
	var newest = take()
	if newest != null:
		put(newest)


# The newest object that has come since the last call, or null.
func take():
	var newest = null
	while _socket.get_available_packet_count() > 0:
		var read := JSON.parse(_socket.get_packet().get_string_from_utf8())
		if read.error == OK and read.result is Dictionary and read.result.has("bones"):
			newest = read.result
	return newest


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
