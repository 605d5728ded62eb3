"""What Python pays: PYTHONPATH=build/ci/python python3 tests/bench/python_bench.py

The tower's distances at a million points beside the same field written in numpy, and its mesh at 128 cells beside what the
mesher and the download take by themselves, which is a mesh asked for through the same document without its arrays' being
looked at.
"""

import pathlib

import fieldwright as fw
import numpy as np

from figures import measured, row

SAMPLES = pathlib.Path(__file__).parents[2] / "samples"
COUNT = 1_000_000


def box(p, b):
    q = np.abs(p) - b
    return np.linalg.norm(np.maximum(q, 0), axis=-1) + np.minimum(q.max(axis=-1), 0)


def tower(p):
    """README.md: a box, minus crossed tubes, minus rooms."""
    d = box(p, [1, 2, 1])
    c = np.abs(np.mod(p, 0.5) - 0.25) - 0.15
    x, y, z = c[:, 0], c[:, 1], c[:, 2]
    d = np.maximum(d, -np.minimum(np.minimum(np.maximum(x, y), np.maximum(y, z)), np.maximum(x, z)))
    return np.maximum(d, -box(np.mod(p + [0, 0.25, 0], 1) - 0.5, [0.45, 0.2, 0.45]))


TEXT = """d = box(pos, vec3(1, 2, 1)); c = abs(mod(pos, 0.5) - 0.25) - 0.15;
d = max(d, -min(max(c.x, c.y), max(c.y, c.z), max(c.x, c.z)));
d = max(d, -box(mod(pos + vec3(0, 0.25, 0), 1) - 0.5, vec3(0.45, 0.2, 0.45))); return d;"""

points = np.random.default_rng(1).uniform(-2.5, 2.5, (COUNT, 3))
graph = fw.Graph(fw.nodes.expression("vec3 pos = p;\n" + TEXT.replace("d = box(pos, vec3(1", "float d = box(pos, vec3(1").replace("; c =", "; vec3 c =")))
off = np.abs(graph.eval(points) - tower(points)).max()
print(f"the tower at {COUNT} points; numpy's differs by at most {off:.1e}")
theirs, ours, gradients = measured(lambda: tower(points)), measured(lambda: graph.eval(points)), measured(lambda: graph.gradient(points))
row("numpy", theirs)
row("eval, times as fast", ours, theirs[0] / ours[0])
row("gradient, times as fast as numpy's distances", gradients, theirs[0] / gradients[0])

sample = fw.open(SAMPLES / "tower.field.json")
mesh = measured(lambda: sample.mesh(resolution=128))
live = measured(lambda: (sample.set({"tube width": 0.15 + 0.001 * np.random.random()}), sample.mesh(resolution=128)))
row("mesh of the sample at 128 cells", mesh)
row("the same after a parameter was set", live)
