"""Faces and corners of Blender 3.4 and 3.5, written where they lie in memory.

There a face is a record of 12 bytes (first corner, number of corners, flags) and a corner one of 8 (vertex, edge). Properties write
them one number at a time, which for a smooth mesh takes four times as long as to copy the records. Nobody promises what they look
like: so two faces are made by properties once, and only if every byte is as it is written here are records written. Newer versions
have arrays instead, which properties copy as a whole.
"""
import ctypes

import bpy
import numpy

FACE = numpy.dtype([("start", "<u4"), ("total", "<u4"), ("rest", "V2"), ("smooth", "u1"), ("end", "V1")])
faces_so_far = numpy.zeros(0, FACE)
tried = None


def by_properties(mesh, corners, sides):
    faces = len(corners) // 3
    mesh.polygons.foreach_set("loop_start", numpy.arange(0, 3 * faces, 3, dtype=numpy.uint32))
    mesh.polygons.foreach_set("loop_total", numpy.full(faces, 3, numpy.uint32))
    mesh.polygons.foreach_set("use_smooth", numpy.ones(faces, bool))
    mesh.loops.foreach_set("vertex_index", corners)
    mesh.loops.foreach_set("edge_index", sides)


def by_records(mesh, corners, sides):
    global faces_so_far
    faces = len(corners) // 3
    if faces > len(faces_so_far):
        faces_so_far = numpy.zeros(faces + faces // 4, FACE)
        faces_so_far["start"] = numpy.arange(0, 3 * len(faces_so_far), 3)
        faces_so_far["total"], faces_so_far["smooth"] = 3, 1
    both = numpy.empty((len(corners), 2), numpy.uint32)
    both[:, 0], both[:, 1] = corners, sides
    ctypes.memmove(mesh.polygons[0].as_pointer(), faces_so_far.ctypes.data, FACE.itemsize * faces)
    ctypes.memmove(mesh.loops[0].as_pointer(), both.ctypes.data, both.nbytes)


def lies_as_thought():
    """Whether records are what is written here: two faces by properties against the same as records, byte by byte."""
    seen = []
    corners, sides = numpy.array([0, 1, 2, 2, 1, 3], numpy.uint32), numpy.array([0, 1, 2, 1, 4, 3], numpy.uint32)
    for write in by_properties, by_records:
        mesh = bpy.data.meshes.new("fieldwright probe")
        mesh.vertices.add(4)
        mesh.edges.add(5)
        mesh.loops.add(6)
        mesh.polygons.add(2)
        steps = [each[1].as_pointer() - each[0].as_pointer() for each in (mesh.polygons, mesh.loops)]
        if steps != [FACE.itemsize, 8]:
            bpy.data.meshes.remove(mesh)
            return False
        write(mesh, corners, sides)
        seen.append(ctypes.string_at(mesh.polygons[0].as_pointer(), 24) + ctypes.string_at(mesh.loops[0].as_pointer(), 48))
        bpy.data.meshes.remove(mesh)
    return seen[0] == seen[1]


def write(mesh, corners, sides):
    """Gives a mesh that has room for them its triangles, smooth: their corners, and the edge behind each."""
    global tried
    if tried is None:
        tried = lies_as_thought()
    if len(corners):
        (by_records if tried else by_properties)(mesh, corners, sides)
