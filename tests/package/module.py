#!/usr/bin/python3
"""The module of Python, as it was installed: module.py VERSION"""

import importlib.metadata
import pydoc
import sys

import fieldwright as fw

assert fw.__version__ == importlib.metadata.version("fieldwright") == sys.argv[1], fw.__version__
mesh = fw.Graph(fw.nodes.box(half_extents=[1, 2, 3])).mesh(resolution=32)
assert mesh.positions.max(axis=0).tolist() == [1, 2, 3], mesh.info
assert "half_extents" in pydoc.render_doc(fw.nodes.box)
print("Python has a box of", len(mesh.triangles), "triangles")
