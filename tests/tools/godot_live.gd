# Run by Godot: puts each object of the stream that comes on the example's skeleton and prints, as a line of JSON, its
# tick and how each bone stands in the skeleton (x y z and a quaternion). Ends after one with tick -1.
extends SceneTree

var _skeleton: Skeleton


func _initialize() -> void:
	var figure: Node = load("res://figure.tscn").instance()
	root.add_child(figure)
	for child in figure.get_children():
		if child is Skeleton:
			_skeleton = child
	_skeleton.set_process(false)
	print("ready")


func _idle(_delta: float) -> bool:
	var frame = _skeleton.take()
	if frame == null:
		return false
	if frame["tick"] < 0:
		quit()
		return false
	_skeleton.put(frame)
	var bones := {}
	for bone in _skeleton.get_bone_count():
		var at := _skeleton.get_bone_global_pose(bone)
		var turn := at.basis.get_rotation_quat()
		bones[_skeleton.get_bone_name(bone)] = [at.origin.x, at.origin.y, at.origin.z, turn.x, turn.y, turn.z, turn.w]
	print(JSON.print({"tick": frame["tick"], "bones": bones}))
	return false
