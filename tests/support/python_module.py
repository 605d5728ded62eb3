"""The Python module against the command: python_module.py COMMAND SAMPLES BAD. Prints what does not hold; its status says whether all does."""

import copy
import gc
import json
import os
import pathlib
import pickle
import resource
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import fieldwright as fw
import numpy as np
from fieldwright import nodes

COMMAND, SAMPLES, BAD = sys.argv[1:4]
LONG = bool(os.environ.get("FIELDWRIGHT_LONG"))
TOWER = f"{SAMPLES}/tower.field.json"


def run(*words, **more):
    return subprocess.run([COMMAND, *words], check=True, capture_output=True, text=True, **more).stdout


class Numbers(unittest.TestCase):
    def points(self, count=500):
        return np.random.default_rng(3).uniform(-2.5, 2.5, (count, 3))

    def test_distances_are_those_of_the_command_to_the_last_bit(self):
        points = self.points()
        lines = "\n".join(" ".join(map(repr, map(float, p))) for p in points)
        for sample in ("tower", "csg_part", "gear_pair"):
            path = f"{SAMPLES}/{sample}.field.json"
            graph = fw.open(path)
            said = np.array([float(line) for line in run("eval", path, "--points", "-", input=lines).split()])
            self.assertTrue((graph.eval(points) == said).all(), sample)
            values, gradients = graph.gradient(points)
            self.assertTrue((values == said).all())
            self.assertEqual(gradients.shape, points.shape)
            bounds = graph.bounds(points - 0.1, points + 0.1)
            self.assertTrue(((bounds[:, 0] <= said) & (said <= bounds[:, 1])).all())

    def test_what_a_field_samples_stays_as_long_as_it(self):
        splash = nodes.emitter(burst=5).particles_to_field(resolution=16, region_min=[-1, -1, -1], region_max=[1, 1, 1])
        solids = [nodes.spline().tube(radius=0.1), nodes.circle(radius=0.1).sweep(spline=nodes.spline()),
                  nodes.text(string="ab").extrude(), splash]
        points = np.random.default_rng(5).uniform(-1, 1, (300, 3))
        lines = "\n".join(" ".join(map(repr, map(float, p))) for p in points)
        with tempfile.TemporaryDirectory() as folder:
            for solid in solids:
                graph = fw.Graph(solid)
                graph.save(f"{folder}/a.field.json")
                said = np.array([float(line) for line in run("eval", f"{folder}/a.field.json", "--points", "-", input=lines).split()])
                for _ in range(3):
                    self.assertTrue((graph.eval(points) == said).all(), solid)
                    rubbish = [np.full(1000 * k, 1e30) for k in range(1, 50)]
                bounds = graph.bounds(points, points + 0.1)
                self.assertTrue(((bounds[:, 0] <= said) & (said <= bounds[:, 1])).all(), solid)
                del rubbish

    def test_files_are_those_of_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("ours", "theirs"):
                os.mkdir(f"{folder}/{name}")
            for name in ("a.stl", "b.glb"):  # which has the file's name in it
                ours, theirs = f"{folder}/ours/{name}", f"{folder}/theirs/{name}"
                fw.open(TOWER).export(ours, resolution=48)
                run("export", TOWER, "-o", theirs, "--resolution", "48")
                self.assertEqual(pathlib.Path(ours).read_bytes(), pathlib.Path(theirs).read_bytes(), name)

    def test_a_mesh_is_closed_and_as_large_as_it_is_measured(self):
        graph = fw.Graph(nodes.sphere(radius=1))
        mesh = graph.mesh(resolution=64)
        self.assertEqual((mesh.positions.dtype, mesh.triangles.dtype), (np.float32, np.uint32))
        a, b, c = (mesh.positions[mesh.triangles[:, k]].astype(float) for k in range(3))
        volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
        self.assertAlmostEqual(volume, 4 / 3 * np.pi, delta=0.01)
        self.assertAlmostEqual(volume, graph.measure(resolution=64)["volume"], delta=1e-5)
        edges = np.sort(np.concatenate([mesh.triangles[:, [0, 1]], mesh.triangles[:, [1, 2]], mesh.triangles[:, [2, 0]]]), axis=1)
        self.assertTrue((np.unique(edges, axis=0, return_counts=True)[1] == 2).all())
        self.assertTrue(np.allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-4))

    def test_memory_is_shared_and_stays(self):
        graph = fw.Graph(nodes.sphere(radius=1))
        mesh = graph.mesh(resolution=32)
        before = mesh.positions.copy()
        self.assertFalse(mesh.positions.flags.owndata)
        with self.assertRaises(ValueError):
            mesh.positions[0, 0] = 7
        for resolution in (24, 48):
            graph.mesh(resolution=resolution)
        del graph
        gc.collect()
        self.assertTrue((mesh.positions == before).all())

    def test_pictures_have_the_solid_in_the_middle(self):
        picture = fw.Graph(nodes.sphere(radius=1)).render(96, 64, transparent=True)
        self.assertEqual((picture.shape, picture.dtype), ((64, 96, 4), np.uint8))
        self.assertEqual((picture[32, 48, 3], picture[0, 0, 3]), (255, 0))

    def test_parameters_and_time_move_it(self):
        part = fw.open(f"{SAMPLES}/csg_part.field.json")
        name = "drill radius"
        self.assertEqual((part[name], part.parameters[name]["max"]), (0.5, 0.7))
        inside = part.eval([0, 0.6, 0.55])
        part[name] = 0.2
        self.assertLess(part.eval([0, 0.6, 0.55]), inside)
        with self.assertRaises(fw.Error) as refused:
            part[name] = 3
        self.assertIn("0.7", str(refused.exception))
        self.assertEqual(part[name], 0.2)
        wheel = fw.open(f"{SAMPLES}/gear_pair.field.json")
        points = self.points(100)
        first = wheel.eval(points)
        wheel.time = 0.37
        self.assertFalse((wheel.eval(points) == first).all())


class Nodes(unittest.TestCase):
    def test_a_graph_of_nodes_is_what_it_says(self):
        drill = nodes.infinite_cylinder(radius=0.4)
        graph = fw.Graph(nodes.sphere(radius=1) - drill.rotate(angles=(90, 0, 0)))
        self.assertAlmostEqual(graph.eval([0.7, 0, 0]), -0.3)
        self.assertAlmostEqual(graph.eval([0, 0, 0]), 0.4)
        self.assertEqual(graph.eval(np.zeros((2, 3, 3))).shape, (2, 3))
        again = fw.Graph(text=graph.text)
        self.assertEqual(again.text, graph.text)
        written = json.loads(graph.text)["nodes"]
        self.assertEqual([entry["type"] for entry in written].count("infinite_cylinder"), 1)

    def test_every_type_has_a_function_and_every_default_fits(self):
        table = json.loads(run("nodes", "--json"))["nodes"]
        for entry in table:
            if not entry["outputs"]:
                continue
            made = getattr(nodes, entry["id"])
            self.assertIn(entry["doc"], made.__doc__)
            given = {one["name"]: one["default"] for one in entry["inputs"] if isinstance(one.get("default"), (int, float, list))}
            node = made(**given) if not entry.get("open") else made("return 1.0;")
            self.assertEqual(node.type, entry["id"])
        with self.assertRaises(TypeError):
            nodes.sphere(radios=1)
        with self.assertRaises(AttributeError):
            nodes.sphere().nothing
        with self.assertRaises(KeyError):
            nodes.sphere()["nothing"]

    def test_code_meshes_and_chains_that_are_long(self):
        self.assertAlmostEqual(fw.Graph(nodes.expression("return length(p) - r;", r=2)).eval([3, 0, 0]), 1)
        smooth = nodes.sphere(radius=1).polygonize(resolution=24).smooth()
        self.assertGreater(len(fw.Graph(smooth).mesh().triangles), 500)
        chain = nodes.sphere(radius=1)
        for _ in range(1500):
            chain = chain.translate(offset=[0.001, 0, 0])
        self.assertAlmostEqual(fw.Graph(chain).eval([1.5, 0, 0]), -1, places=6)


class Faults(unittest.TestCase):
    def test_every_bad_graph_is_an_error_with_its_place(self):
        for path in sorted(pathlib.Path(BAD).iterdir()):
            with self.assertRaises(fw.Error, msg=path.name) as refused:
                fw.open(path)
            self.assertEqual(refused.exception.file, str(path))
            said = subprocess.run([COMMAND, "check", str(path)], capture_output=True, text=True)
            self.assertIn(refused.exception.message, said.stdout + said.stderr)
        with self.assertRaises(fw.Error) as refused:
            fw.open("nowhere.field.json")
        self.assertIn("nowhere.field.json", str(refused.exception))
        with self.assertRaises(fw.Error) as refused:
            fw.Graph(nodes.expression("return 1 +;"))
        error = refused.exception
        self.assertEqual((error.node, error.code_line), ("expression", 1))

    def test_odd_arguments_are_refused(self):
        graph = fw.Graph(nodes.sphere())
        for points in ([1, 2], 3, [[1, 2]], np.zeros((4, 2))):
            with self.assertRaises(ValueError):
                graph.eval(points)
        with self.assertRaises(ValueError):
            graph.bounds([1, 1, 1], [0, 0, 0])
        for wishes in ({"resolution": 0}, {"resolution": 10**6}, {"method": "none"}):
            with self.assertRaises(fw.Error):
                graph.mesh(**wishes)
        with self.assertRaises(ValueError):
            graph.set(radius=float("nan"))
        with self.assertRaises(fw.Error):
            graph.set(radius=[1, 2, 3, 4])
        with self.assertRaises(fw.Error):
            graph.render(1, 1)
        with self.assertRaises(fw.Error):
            graph.export("part.nothing")
        with self.assertRaises(fw.Error):
            graph.export("/nowhere/at/all/part.stl")
        with self.assertRaises(ValueError):
            fw.save_png(np.zeros((2, 2)), "no.png")
        self.assertTrue(np.isnan(graph.eval([np.nan, 0, 0])))
        self.assertEqual(graph.eval(np.zeros((0, 3))).shape, (0,))


    def test_what_is_of_another_kind_is_refused(self):
        solid = nodes.sphere(radius=1)
        graph = fw.Graph(solid)
        for other in (None, 1, [solid], "a"):
            for combine in (lambda: solid | other, lambda: solid & other, lambda: solid - other):
                with self.assertRaises(TypeError):
                    combine()
        for make in (lambda: fw.Graph(), lambda: fw.Graph("a.field.json"), lambda: fw.Graph(nodes.sphere), lambda: fw.Graph(solid, text="{}"),
                     lambda: list(solid), lambda: pickle.dumps(graph), lambda: copy.copy(graph), lambda: solid.translate(surface=solid),
                     lambda: fw.Graph(nodes.box(half_extents=[nodes.sphere(), 1, 1])), lambda: fw.Graph(nodes.sphere(radius=float("nan"))),
                     lambda: graph.eval([["1", "2", "3"]]), lambda: graph.eval([[1j, 0, 0]]), lambda: graph.mesh(resolution=object())):
            with self.assertRaises(TypeError):
                make()
        masked = np.ma.masked_array(np.zeros((2, 3)), mask=[[1, 0, 0], [0, 0, 0]])
        for make in (lambda: graph.eval(masked), lambda: graph.mesh(resolution=10**400), lambda: graph.mesh(resolution=float("inf")),
                     lambda: fw.open("a\0b"), lambda: fw.open(b"n\xff.field.json"), lambda: fw.open(""), lambda: nodes.make("spehre"),
                     lambda: fw.save_png(np.zeros((5, 0, 4), np.uint8), "no.png"), lambda: fw.save_png(np.zeros((4, 4), np.uint8), "a\0.png")):
            with self.assertRaises(ValueError):
                make()
        with self.assertRaises(fw.Error):
            graph.export("a.stl", for_="nobody")
        self.assertEqual(fw.Error("x").findings, [])

    def test_what_is_of_numpy_and_of_paths_is_taken(self):
        graph = fw.Graph(nodes.box(half_extents=[np.float32(1), 1, np.int64(1)]))
        mesh = graph.mesh(resolution=np.int64(16), normals=np.bool_(False))
        self.assertFalse(mesh == graph.mesh(resolution=16))
        graph.time = np.float32(0.5)
        other = copy.copy(nodes.sphere(radius=1))
        other.inputs = {"radius": 3}
        self.assertEqual(fw.Graph(other).eval([0, 0, 0]), -3)
        part = fw.open(f"{SAMPLES}/csg_part.field.json")
        self.assertEqual(("drill radius" in part, "nothing" in part, list(part)), (True, False, list(part.parameters)))
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "b.field.json")
            path.write_text("before")
            graph.save(os.fsencode(path))
            self.assertEqual(fw.open(path).text, graph.text)
            path.write_bytes(b'{"fieldwright": 1,\n "nodes": [{"id": "\x80"}]}')
            with self.assertRaises(fw.Error) as refused:
                fw.open(path)
            self.assertEqual((refused.exception.file, refused.exception.line, refused.exception.column), (str(path), 2, 20))


class Threads(unittest.TestCase):
    def test_two_threads_have_the_same_as_one(self):
        paths = [TOWER, f"{SAMPLES}/csg_part.field.json"]
        alone = [fw.open(path).mesh(resolution=32) for path in paths]
        found = {}

        def work(i):
            graph = fw.open(paths[i])
            found[i] = [graph.mesh(resolution=32) for _ in range(3)]

        workers = [threading.Thread(target=work, args=(i,)) for i in range(2)]
        [worker.start() for worker in workers]
        [worker.join() for worker in workers]
        for i in range(2):
            for mesh in found[i]:
                self.assertTrue((mesh.positions == alone[i].positions).all())
                self.assertTrue((mesh.triangles == alone[i].triangles).all())

    def test_one_graph_serves_several_threads(self):
        graph = fw.Graph(nodes.sphere(radius=1))
        faults = []

        def work(seed):
            points = np.random.default_rng(seed).uniform(-1, 1, (1000, 3))
            for _ in range(20):
                if not np.allclose(graph.eval(points), np.linalg.norm(points, axis=1) - 1):
                    faults.append(seed)

        workers = [threading.Thread(target=work, args=(i,)) for i in range(4)]
        [worker.start() for worker in workers]
        [worker.join() for worker in workers]
        self.assertEqual(faults, [])

    def expect_interrupted(self, code):
        """By SIGINT, once the code has said that it runs."""
        begin = "import signal, threading, fieldwright as fw\nsignal.signal(signal.SIGINT, signal.default_int_handler)  # whoever starts the tests\n"
        child = subprocess.Popen([sys.executable, "-c", begin + code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        child.stdout.readline()
        child.send_signal(2)
        _, said = child.communicate()
        self.assertIn("KeyboardInterrupt", said)
        self.assertEqual(child.returncode, -2)

    def test_control_c_ends_what_runs(self):
        # A picture of paths of light that would take minutes.
        self.expect_interrupted(f"graph = fw.open({TOWER!r})\ngraph.mesh()\nprint('runs', flush=True)\ngraph.render(1920, 1080, samples=4096)\n")

    def test_control_c_ends_who_waits_for_another_thread(self):
        self.expect_interrupted(f"graph = fw.open({TOWER!r})\ngraph.mesh()\n"
                                "threading.Thread(target=lambda: graph.render(1920, 1080, samples=4096), daemon=True).start()\n"
                                "print('runs', flush=True)\ngraph.eval([0, 0, 0])\n")

    def test_an_interpreter_that_ends_leaves_no_thread_within(self):
        code = (f"import threading, numpy as np, fieldwright as fw\ngraph = fw.open({TOWER!r})\npoints = np.zeros((10**6, 3))\n"
                "begun = threading.Event()\ndef work():\n    while True:\n        begun.set()\n        graph.gradient(points)\n"
                "threading.Thread(target=work, daemon=True).start()\nbegun.wait()\n")
        for _ in range(3):
            ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
            self.assertEqual((ended.returncode, ended.stderr), (0, ""))


class Memory(unittest.TestCase):
    @unittest.skipUnless(LONG, "set FIELDWRIGHT_LONG")
    def test_a_thousand_meshes_leak_nothing(self):
        graph = fw.open(TOWER)

        def used():
            gc.collect()
            pages = pathlib.Path("/proc/self/statm").read_text().split()[1]
            return int(pages) * resource.getpagesize()

        for i in range(100):
            graph.mesh(resolution=48)
        before = used()
        for i in range(1000):
            graph["tube width"] = 0.1 + 0.0001 * i
            graph.mesh(resolution=48)
        self.assertLess(used() - before, 16 << 20)


unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=0)
