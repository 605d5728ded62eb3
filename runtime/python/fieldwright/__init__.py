"""Solids as signed distance fields: graphs, their distances, meshes and pictures, as arrays of numpy.

    import fieldwright as fw
    from fieldwright import nodes

    bead = nodes.sphere(radius=1) - nodes.infinite_cylinder(radius=0.4)
    graph = fw.Graph(bead)
    graph.eval([[0, 0, 0], [1, 0, 0]])         # distances, negative inside
    mesh = graph.mesh(resolution=128)          # mesh.positions, mesh.triangles, …
    graph.export("bead.glb")

Lengths are in the document's unit (metres), +Y is up, angles are in degrees. docs/python.md is the guide.
"""

from __future__ import annotations

import atexit
import json
import os
from dataclasses import dataclass, field
from typing import Any, Iterator, Mapping

import numpy as np

from . import _native

__version__: str = _native.version
__all__ = ["Error", "Graph", "Mesh", "open", "save_png", "nodes"]


class Error(Exception):
    """What a graph, a value or a file is at fault by. What is not known is empty, or 0."""

    message: str = ""
    remedy: str = ""
    file: str = ""
    node: str = ""
    input: str = ""
    line: int = 0
    column: int = 0
    code_line: int = 0
    """In the code of the node."""
    code_column: int = 0
    findings: list[dict[str, Any]]
    """All that was found, errors and warnings, of a graph that cannot be made."""

    def __init__(self, *args: Any):
        super().__init__(*args)
        self.findings = []

    @classmethod
    def _of(cls, text: str) -> "Error":
        data = json.loads(text)
        error = cls(data["where"])
        for name in ("message", "remedy", "file", "node", "input", "line", "column"):
            setattr(error, name, data.get(name, getattr(cls, name)))
        error.code_line, error.code_column = data.get("codeLine", 0), data.get("codeColumn", 0)
        error.findings = data.get("findings", [])
        return error


@dataclass(eq=False)
class Mesh:
    """Triangles of a surface; arrays are read-only, and share the memory that they were made in.

    There are none where the solid is empty, or thinner than a cell.
    """

    positions: np.ndarray
    """n x 3, float32."""
    triangles: np.ndarray
    """m x 3, uint32: counter-clockwise seen from outside."""
    normals: np.ndarray | None = None
    """n x 3, of length 1."""
    colors: np.ndarray | None = None
    """n x 3, linear sRGB, where the colour varies; else `info["baseColor"]` is that of all."""
    info: dict[str, Any] = field(default_factory=dict)
    """What else `mesh` of docs/server.md tells: region, unit, materials, …"""


class Graph:
    """A graph that is open: its parameters and its time can be set, and it is asked for what it is now.

    It may be used from several threads, which wait for each other; graphs work beside each other.
    """

    def __init__(self, surface: "nodes.Node | None" = None, *, text: str | None = None, path: str | os.PathLike[str] = "",
                 device: str | int = ""):
        """Of a surface or mesh that nodes make; of the text of a graph file; or of a file (as open()).

        `path` beside a surface or a text is the file that it would be: files that it names are found from there.
        `device` is the index or a part of the name of the one that meshes and pictures are made on.
        """
        path = _path(path)
        if surface is not None:
            if not isinstance(surface, nodes.Node):
                raise TypeError("Graph() takes what nodes make; open(path) opens a file, Graph(text=…) takes its text")
            if text is not None:
                raise TypeError("Graph() takes a surface or a text, not both")
            text = nodes.text_of(surface)
        if text is None:
            if not path:
                raise TypeError("Graph() takes a surface, a text or a path")
            text = _read(path)
        self._document = _native.Document(str(device))
        self._text, self._path, self._time = text, path, 0.0
        self._opened, _ = self._ask("open", graph=text, path=path)

    def _ask(self, asked: str, /, **params: Any) -> tuple[dict[str, Any], dict[str, Any]]:
        given = ", ".join(f"{json.dumps(name)}: {_json(name, value)}" for name, value in params.items() if value is not None)
        result, blobs = self._document.ask(asked, "{" + given + "}")
        return json.loads(result), blobs

    def __reduce__(self) -> Any:
        raise TypeError("a graph is open, and is not copied: open it again, or take Graph(text=graph.text)")

    @property
    def path(self) -> str:
        """The file that it was opened from, or would be."""
        return self._path

    @property
    def text(self) -> str:
        """The graph file, as it was opened, in the form that the editor writes."""
        return _native.canonical(self._text, self._path)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the graph file; parameters that were set are not in it."""
        _native.save_text(self._text, self._path, _path(path))

    @property
    def parameters(self) -> dict[str, dict[str, Any]]:
        """By name: value, default, min, max, unit, animated, node, input."""
        return {entry.pop("name"): entry for entry in json.loads(self._document.parameters())}

    def set(self, values: Mapping[str, Any] | None = None, **more: Any) -> None:
        """Sets exposed parameters, all or none; names that are no words of Python go into the mapping."""
        wanted = {**(values or {}), **more}
        self._ask("set", values={name: _numbers(name, value).tolist() for name, value in wanted.items()})

    def __getitem__(self, name: str) -> Any:
        """The value of an exposed parameter."""
        return self.parameters[name]["value"]

    def __setitem__(self, name: str, value: Any) -> None:
        """As set()."""
        self.set({name: value})

    def __iter__(self) -> Iterator[str]:
        """The names of the exposed parameters."""
        return iter(self.parameters)

    def __contains__(self, name: object) -> bool:
        return name in self.parameters

    @property
    def time(self) -> float:
        """Seconds at which the graph and its timeline are."""
        return self._time

    @time.setter
    def time(self, seconds: float) -> None:
        self._ask("time", seconds=seconds)
        self._time = seconds

    @property
    def timeline(self) -> dict[str, Any]:
        """length in seconds, framesPerSecond, endless."""
        return self._opened["timeline"]

    def check(self) -> list[dict[str, Any]]:
        """Errors and warnings, each with severity, message and place."""
        return self._ask("check")[0]["findings"]

    def eval(self, points: Any) -> np.ndarray:
        """Distances at points, negative inside: float64 of shape points.shape[:-1], the last index being x, y, z."""
        flat, shape = _triples(points)
        return self._document.eval(flat, False).reshape(shape)

    __call__ = eval

    def gradient(self, points: Any) -> tuple[np.ndarray, np.ndarray]:
        """Distances as eval(), and their gradients, of the shape of the points."""
        flat, shape = _triples(points)
        distances, gradients = self._document.eval(flat, True)
        return distances.reshape(shape), gradients.reshape(*shape, 3)

    def bounds(self, least: Any, greatest: Any) -> np.ndarray:
        """Intervals that contain all distances in boxes between two corners: shape least.shape[:-1] + (2,)."""
        a, shape = _triples(least)
        b, other = _triples(greatest)
        if shape != other or np.any(a > b):
            raise ValueError("bounds: corners of boxes come in pairs, the least before the greatest")
        return self._document.bounds(np.stack([a, b], axis=1)).reshape(*shape, 2)

    def mesh(self, resolution: int | None = None, method: str | None = None, *, normals: bool = True, colors: bool = True,
             materials: bool = False) -> Mesh:
        """Triangles of the surface; `resolution` cells along its longest side, "marching-cubes" or "dual-contouring"."""
        info, arrays = self._ask("mesh", resolution=resolution, method=method, normals=normals, colors=colors,
                                 materials=materials)
        info.pop("blobs", None)
        return Mesh(arrays["positions"], arrays["indices"], arrays.get("normals"), arrays.get("colors"), info)

    def measure(self, resolution: int | None = None, method: str | None = None, *, field: bool = True) -> dict[str, Any]:
        """What `export --report` tells of the mesh: volume, area, widths, …; with `field` how far it is off the field."""
        return self._ask("measure", resolution=resolution, method=method, field=field)[0]

    def render(self, width: int = 640, height: int = 360, samples: int | None = None, **wishes: Any) -> np.ndarray | bytes:
        """A picture: height x width x 4 of uint8, sRGB and alpha, rows from the top.

        Wishes, as `picture` of docs/server.md has them: view, camera, from_ ("front", "three_quarters", …), quality
        ("auto", "live", "draft"), transparent, resolution, method; format "png" gives the bytes of such a file.
        """
        wishes = _unreserved(wishes)
        return self._ask("picture", width=width, height=height, samples=samples, **wishes)[1]["picture"]

    def export(self, path: str | os.PathLike[str], resolution: int | None = None, method: str | None = None,
               **wishes: Any) -> dict[str, Any]:
        """Writes a mesh file, the same bytes as `fieldwright export`; its ending is the format.

        Wishes, as `export` of docs/server.md has them: manifold, compress, parts, splitMaterials, textures, lods, triangles,
        unit, up, for_.
        """
        wishes = _unreserved(wishes)
        return self._ask("export", path=_path(path), resolution=resolution, method=method, **wishes)[0]


def open(path: str | os.PathLike[str], *, device: str | int = "") -> Graph:
    """Opens a graph file."""
    if not _path(path):
        raise ValueError("open: the path is empty")
    return Graph(path=path, device=device)


def save_png(pixels: Any, path: str | os.PathLike[str]) -> None:
    """Writes a picture: uint8, height x width x 4 or 3, or x nothing for grey."""
    array = np.asarray(pixels)
    if array.dtype != np.uint8 or array.ndim not in (2, 3) or (array.ndim == 3 and array.shape[2] not in (3, 4)) or not array.size:
        raise ValueError("save_png: a picture is uint8, height x width, or that x 3 or x 4, and not empty")
    if array.ndim == 2:
        array = np.repeat(array[:, :, None], 3, axis=2)
    if array.shape[2] == 3:
        array = np.concatenate([array, np.full((*array.shape[:2], 1), 255, np.uint8)], axis=2)
    _native.save_png(array, _path(path))


def _path(path: str | bytes | os.PathLike[Any]) -> str:
    text = os.fsdecode(path)
    if "\0" in text:
        raise ValueError(f"a path has a NUL character in it: {text!r}")
    try:
        text.encode()
    except UnicodeEncodeError:
        raise ValueError(f"a path is no text of UTF-8: {text!r}") from None
    return text


def _read(path: str) -> str:
    import io
    try:
        with io.open(path, "rb") as file:
            data = file.read()
        return data.decode()
    except OSError as fault:
        place, message, cause = "", str(fault.strerror), fault
    except UnicodeDecodeError as fault:
        lines = data[:fault.start].split(b"\n")
        place, message, cause = f"{len(lines)}:{len(lines[-1]) + 1}:", "the file is not UTF-8: write it in that encoding", fault
    error = Error(f"{path}:{place} error: {message}")
    error.message, error.file = message, path
    if place:
        error.line, error.column = (int(number) for number in place.split(":")[:2])
    raise error from cause


def _json(name: str, value: Any) -> str:
    try:
        return json.dumps(value, allow_nan=False, default=nodes.plain)
    except (TypeError, ValueError) as fault:
        text = str(fault)
        raise type(fault)(f"{name}: " + ("is not finite" if "JSON compliant" in text else text)) from None


def _numbers(name: str, value: Any) -> np.ndarray:
    array = np.asarray(value)
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        raise ValueError(f"{name}: an array has masked numbers: fill them, or leave them out")
    if array.size and array.dtype.kind not in "biufO":
        raise TypeError(f"{name}: {array.dtype} is no type of real numbers")
    return np.ascontiguousarray(array, dtype=np.float64)


def _unreserved(wishes: dict[str, Any]) -> dict[str, Any]:
    """Names that are words of Python are written with a _ behind."""
    return {{"from_": "from", "for_": "for"}.get(name, name): value for name, value in wishes.items()}


def _triples(points: Any) -> tuple[np.ndarray, tuple[int, ...]]:
    array = _numbers("points", points)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise ValueError("points have three coordinates: the last index of their array goes over x, y and z")
    return array.reshape(-1, 3), array.shape[:-1]


atexit.register(_native.end)

from . import nodes  # noqa: E402  (its functions make what Graph takes)
