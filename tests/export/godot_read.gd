# SPDX-License-Identifier: Apache-2.0
# Run by Godot 3: the scene that its importer made of vessels.glb, as one line of JSON.
extends SceneTree

var said = {"vertices": [], "triangles": 0, "collider_triangles": 0, "places": {}}

# JSON.print() keeps six digits
func exact(p):
    return ["%.10f" % p.x, "%.10f" % p.y, "%.10f" % p.z]

func look(node):
    if node is MeshInstance:
        for s in range(node.mesh.get_surface_count()):
            var arrays = node.mesh.surface_get_arrays(s)
            for v in arrays[Mesh.ARRAY_VERTEX]:
                var p = node.global_transform.xform(v) if node.is_inside_tree() else v
                said.vertices.append(exact(p))
            said.triangles += arrays[Mesh.ARRAY_INDEX].size() / 3
    elif node is CollisionShape:
        said.collider_triangles += node.shape.get_faces().size() / 3
    elif node.get_class() == "Spatial" and node.name != "vessels":
        said.places[node.name] = exact(node.translation)
    for child in node.get_children():
        look(child)

func _init():
    var scene = load("res://vessels.glb").instance()
    get_root().add_child(scene)
    look(scene)
    print(JSON.print(said))
    quit()
