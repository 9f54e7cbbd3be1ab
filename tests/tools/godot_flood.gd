# Run by Godot: the example's skeleton hears hostile datagrams of the file `datagrams`, then the sound `frame.json`.
extends SceneTree

class Flood:
	var file := File.new()
	var received := 0
	var last := PoolByteArray()

	func get_available_packet_count() -> int:
		return 1 if last.size() > 0 or file.get_position() < file.get_len() else 0

	func get_packet() -> PoolByteArray:
		received += 1
		if last.size() > 0:
			var data := last
			last = PoolByteArray()
			return data
		return file.get_buffer(file.get_32())


var _skeleton: Skeleton


func _init() -> void:
	var figure: Node = load("res://figure.tscn").instance()
	root.add_child(figure)
	for child in figure.get_children():
		if child is Skeleton:
			_skeleton = child
	_skeleton.set_process(false)


func _idle(_delta: float) -> bool:
	var skeleton := _skeleton
	var flood := Flood.new()
	flood.file.open("res://datagrams", File.READ)
	skeleton._socket = flood
	var most := 0
	while flood.get_available_packet_count() > 0:
		var before := flood.received
		skeleton._process(0.0)
		most = int(max(most, flood.received - before))
	var looked_at := flood.received
	var file := File.new()
	file.open("res://frame.json", File.READ)
	flood.last = file.get_buffer(file.get_len())
	var frame = skeleton.take()
	var is_finite := true
	for bone in skeleton.get_bone_count():
		var at: Vector3 = skeleton.get_bone_global_pose(bone).origin
		is_finite = is_finite and abs(at.x) < 1e6 and abs(at.y) < 1e6 and abs(at.z) < 1e6
	print(JSON.print({"looked_at": looked_at, "most_at_once": most, "malformed": skeleton.malformed,
		"still_walks": frame != null, "is_finite": is_finite}))
	quit()
	return true
