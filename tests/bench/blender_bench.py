# What Blender pays: FIELDWRIGHT=build/ci/fieldwright blender --background --factory-startup --python tests/bench/blender_bench.py
#
# Of the tower at 128 cells: from a parameter that is set to the object as Blender shows it, evaluated and with its normals; where
# the time goes; and the same arrays given to Blender the plain way, as signed integers and with the edges left to it.
import pathlib
import sys

import bpy
import numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "runtime" / "blender"), str(ROOT / "tests" / "bench")]
import fieldwright
from fieldwright import driven, solid
from figures import measured, row

CELLS = 128
fieldwright.register()
thing = driven.add(bpy.context, str(ROOT / "samples" / "tower.field.json"))
own = thing.fieldwright
own.resolution = CELLS
assert not own.error, own.error
calls = 0


def width():
    global calls
    calls += 1
    return 0.12 + 0.0005 * (calls % 100)


def show():
    bpy.context.view_layer.update()
    return thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.vertex_normals[0].vector


def whole():
    own.parameters["tube width"].number = width()
    assert not own.error, own.error
    show()


def plainly():
    mesh, faces = thing.data, len(made["indices"]) // 3
    mesh.clear_geometry()
    mesh.vertices.add(len(made["places"]))
    mesh.loops.add(3 * faces)
    mesh.polygons.add(faces)
    mesh.vertices.foreach_set("co", made["places"].ravel())
    mesh.loops.foreach_set("vertex_index", made["indices"].view(numpy.int32))
    mesh.polygons.foreach_set("loop_start", numpy.arange(0, 3 * faces, 3, dtype=numpy.int32))
    if bpy.app.version < (3, 6):
        mesh.polygons.foreach_set("loop_total", numpy.full(faces, 3, numpy.int32))
    mesh.polygons.foreach_set("use_smooth", numpy.ones(faces, bool))
    mesh.update(calc_edges=True)


graph = driven.graphs[thing.name_full]
ask, document = graph.server.ask, graph.about["document"]
result, blobs = ask("mesh", document=document, materials=True, edges=True, normals=False)
answer = result, {name: bytes(blob) for name, blob in blobs.items()}
made = solid.arrays(*answer)
total = measured(whole)
served = measured(lambda: ask("mesh", document=document, materials=True, edges=True, normals=False),
                  lambda: ask("set", document=document, values={"tube width": width()}))
bare = measured(lambda: ask("mesh", document=document, normals=False),
                lambda: ask("set", document=document, values={"tube width": width()}))
filled = measured(lambda: solid.fill(thing.data, made))
shown = measured(show, thing.data.update)
plain = measured(plainly)
size = sum(len(blob) for blob in answer[1].values())
print(f"Blender {bpy.app.version_string}: {len(made['places'])} vertices, {len(made['indices']) // 3} triangles, {size / 1e6:.1f} MB")
row("a parameter to the object as it is shown", total)
row("  the server's mesh with its edges, and the pipe", served)
row("  of that, without edges", bare)
row("  arrays in Blender's axes", measured(lambda: solid.arrays(*answer)))
row("  given to Blender's mesh", filled)
row("  materials", measured(lambda: solid.dress(thing.data, made)))
row("  evaluated, and its normals", shown)
row("given plainly; times as long", plain, plain[0] / filled[0])
fieldwright.unregister()
