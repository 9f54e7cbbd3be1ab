# A figure of 1.7 m in a T pose, made of nothing but bones, which gaitpad walks.
#   build/gaitpad play --stream json        beside: godot3 --path tools/examples/godot
extends Spatial

const AT := {  # where each bone begins, in metres; +x is the figure's left
	"Hips": Vector3(0, 0.92, 0), "Spine": Vector3(0, 1.0, 0), "Chest": Vector3(0, 1.17, 0),
	"Neck": Vector3(0, 1.42, 0), "Head": Vector3(0, 1.5, 0),
	"LeftUpperLeg": Vector3(0.09, 0.88, 0), "LeftLowerLeg": Vector3(0.09, 0.47, 0),
	"LeftFoot": Vector3(0.09, 0.08, 0), "LeftToes": Vector3(0.09, 0.02, 0.14),
	"RightUpperLeg": Vector3(-0.09, 0.88, 0), "RightLowerLeg": Vector3(-0.09, 0.47, 0),
	"RightFoot": Vector3(-0.09, 0.08, 0), "RightToes": Vector3(-0.09, 0.02, 0.14),
	"LeftUpperArm": Vector3(0.18, 1.38, 0), "LeftLowerArm": Vector3(0.46, 1.38, 0), "LeftHand": Vector3(0.71, 1.38, 0),
	"RightUpperArm": Vector3(-0.18, 1.38, 0), "RightLowerArm": Vector3(-0.46, 1.38, 0),
	"RightHand": Vector3(-0.71, 1.38, 0)}

var _skeleton: Skeleton = preload("res://gaitpad_live.gd").new()
var _lines := ImmediateGeometry.new()


func _ready() -> void:
	for name in AT:
		var parent = _skeleton.PARENTS.get(name)
		while parent != null and _skeleton.find_bone(parent) < 0:
			parent = _skeleton.PARENTS.get(parent)
		_skeleton.add_bone(name)
		var bone := _skeleton.find_bone(name)
		if parent != null:
			_skeleton.set_bone_parent(bone, _skeleton.find_bone(parent))
		_skeleton.set_bone_rest(bone, Transform(Basis(), AT[name] - AT.get(parent, Vector3())))
	add_child(_skeleton)
	add_child(_lines)
	var material := SpatialMaterial.new()
	material.flags_unshaded = true
	_lines.material_override = material
	var camera := Camera.new()
	camera.name = "Camera"
	add_child(camera)


func _process(_delta: float) -> void:
	_lines.clear()
	_lines.begin(Mesh.PRIMITIVE_LINES)
	for bone in _skeleton.get_bone_count():
		var parent := _skeleton.get_bone_parent(bone)
		if parent >= 0:
			_lines.add_vertex(_skeleton.get_bone_global_pose(parent).origin)
			_lines.add_vertex(_skeleton.get_bone_global_pose(bone).origin)
	_lines.end()
	var hips := _skeleton.get_bone_global_pose(_skeleton.find_bone("Hips")).origin
	$Camera.look_at_from_position(hips + Vector3(3, 0.5, 2), hips, Vector3.UP)
