"""Functions that make nodes, one for each type of the node library, with its inputs by name.

    part = nodes.box(half_extents=[1, 2, 1]) - nodes.infinite_cylinder(radius=0.4).rotate(angles=[90, 0, 0])

Surfaces join by `|`, have in common by `&`, and are cut by `-`. Each function that takes a surface, or another value of
a node, is a method of those too: `a.translate(offset=[0, 1, 0])`. A value that a node has by another name is
`node["name"]`. `expression` takes code beside inputs of names of your own:

    nodes.expression("return length(p) - r;", r=1)

`parameter` exposes a number by a name, which Graph.set() takes. What the functions are called and take is the table
that docs/nodes.md shows.
"""

from __future__ import annotations

import difflib
import inspect
import json
import os
from typing import Any, Callable

import numpy as np

from . import _native

_table: dict[str, dict[str, Any]] = {entry["id"]: entry for entry in json.loads(_native.nodes())["nodes"]}
_annotations = {"float": "float | Node", "int": "int", "bool": "bool", "string": "str"}


class Node:
    """A node, or one of its values. It belongs to no graph yet: Graph() takes all that it is made of."""

    def __init__(self, type: str, inputs: dict[str, Any], code: str | None = None, output: str | None = None):
        self.type, self.inputs, self.code, self.output = type, inputs, code, output
        self._whole: Node | None = None  # of one of its values: the node itself

    @property
    def _made(self) -> "Node":
        return self._whole or self

    def __getitem__(self, output: str) -> "Node":
        names = [entry["name"] for entry in _table[self.type]["outputs"]]
        if output not in names:
            raise KeyError(f"{self.type} has no value {output!r}: it has {', '.join(names) or 'none'}")
        value = Node(self.type, self.inputs, self.code, output)
        value._whole = self._made
        return value

    __iter__ = None  # its values have names, not numbers

    def __or__(self, other: "Node") -> "Node":
        return make("union", a=self, b=other) if isinstance(other, Node) else NotImplemented

    def __and__(self, other: "Node") -> "Node":
        return make("intersect", a=self, b=other) if isinstance(other, Node) else NotImplemented

    def __sub__(self, other: "Node") -> "Node":
        return make("subtract", a=self, b=other) if isinstance(other, Node) else NotImplemented

    def __getattr__(self, name: str) -> Callable[..., "Node"]:
        taking = _socket(_table[name]) if name in _table and not name.startswith("_") else None
        if taking is None:
            raise AttributeError(f"no node type {name!r} takes another node's value first")

        def method(**inputs: Any) -> Node:
            if taking in inputs:
                raise TypeError(f"{name}() has its {taking!r} already: the node that it is called of")
            return make(name, **{taking: self, **inputs})

        function = globals()[name]
        signature = inspect.signature(function)
        method.__name__ = method.__qualname__ = name
        method.__doc__ = function.__doc__
        method.__signature__ = signature.replace(
            parameters=[one for one in signature.parameters.values() if one.name != taking])
        return method

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *(name for name, entry in _table.items() if _socket(entry) and name != "output")]

    def __repr__(self) -> str:
        return f"<{self.type}{'.' + self.output if self.output else ''}>"


def make(type: str, code: str | None = None, /, **inputs: Any) -> Node:
    """A node of a type; what is None is left as it is by default."""
    if type not in _table:
        near = difflib.get_close_matches(type, _table, 1)
        raise ValueError(f"there is no node type {type!r}" + (f": did you mean {near[0]!r}?" if near else ""))
    entry = _table[type]
    given = {name: value for name, value in inputs.items() if value is not None}
    known = [one["name"] for one in entry["inputs"]]
    if not entry.get("open"):
        for name in given:
            if name not in known:
                raise TypeError(f"{type}() has no input {name!r}: it has {', '.join(known)}")
    return Node(type, given, code)


def plain(value: Any) -> Any:
    """What JSON has for a number or an array of numpy, or for a path."""
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"{value!r} is no number, no text, and no list of those")


def _socket(entry: dict[str, Any]) -> str | None:
    """The input that a method's own node goes to: the first that is no number."""
    for one in entry["inputs"]:
        if one["type"] in ("surface", "mesh", "spline", "particles"):
            return one["name"]
    return None


def text_of(result: Node) -> str:
    """The graph file that shows this surface, or this mesh."""
    ids: dict[int, str] = {}
    written: list[dict[str, Any]] = []
    used: dict[str, int] = {}

    def value(node: Node, name: str, given: Any) -> Any:
        if isinstance(given, Node):
            link = {"from": ids[id(given._made)]}
            return {**link, "output": given.output} if given.output else link
        if isinstance(given, (list, tuple)) and any(isinstance(one, Node) for one in given):
            raise TypeError(f"{node.type}: {name!r} is a list with a node in it: give numbers, or one node for all of them")
        try:
            return json.loads(json.dumps(given, default=plain, allow_nan=False))
        except (TypeError, ValueError):
            raise TypeError(f"{node.type}: {name!r} is {given!r}: no finite number, text or list of those") from None

    pending, begun = [result._made], set()
    while pending:  # not by recursion: chains may be long
        node = pending[-1]
        behind = [one._made for one in node.inputs.values() if isinstance(one, Node) and id(one._made) not in ids]
        if behind and id(node) not in ids:
            if any(id(one) in begun for one in behind):
                raise ValueError("the nodes go round in a circle")
            begun.add(id(node))
            pending += behind
            continue
        pending.pop()
        if id(node) in ids:
            continue
        used[node.type] = used.get(node.type, 0) + 1
        ids[id(node)] = node.type if used[node.type] == 1 else f"{node.type}_{used[node.type]}"
        entry = {"id": ids[id(node)], "type": node.type, "inputs": {name: value(node, name, one) for name, one in node.inputs.items()}}
        if node.code is not None:
            entry["code"] = node.code
        written.append(entry)
    if result.type != "output":
        outputs = _table[result.type]["outputs"]
        shown = next((one["type"] for one in outputs if one["name"] == result.output), outputs[0]["type"])
        written.append({"id": "out", "type": "output", "inputs": {"mesh" if shown == "mesh" else "surface": value(result, "", result)}})
    return json.dumps({"fieldwright": 1, "nodes": written})


def _function(entry: dict[str, Any]) -> Callable[..., Node]:
    lines = [entry["doc"], ""]
    parameters = []
    for one in entry["inputs"]:
        default = one.get("default")
        annotation = _annotations.get(one["type"], "Node" if default is None else "Any")
        parameters.append(inspect.Parameter(one["name"], inspect.Parameter.KEYWORD_ONLY, default=None, annotation=annotation))
        about = [one["type"]] + ([one["unit"]] if one.get("unit") else [])
        if one.get("options"):
            about.append("one of " + ", ".join(one["options"]))
        if default is not None:
            about.append(f"default {default}")
        lines.append(f"{one['name']} ({', '.join(about)}): {one['doc']}")
    if entry.get("open"):
        def node(code: str, **inputs: Any) -> Node:
            return make(entry["id"], code, **inputs)
    else:
        def node(**inputs: Any) -> Node:
            return make(entry["id"], **inputs)
        node.__signature__ = inspect.Signature(parameters, return_annotation="Node")
    node.__name__ = node.__qualname__ = entry["id"]
    node.__doc__ = "\n".join(lines)
    return node


for _entry in _table.values():
    if _entry["outputs"] or _entry["id"] == "output":
        globals()[_entry["id"]] = _function(_entry)

__all__ = ["Node", "make", "text_of", *(name for name in _table if name in globals())]


def _stubs() -> str:
    """nodes.pyi: what type checkers and editors read of this module."""
    methods, functions = [], []
    for name, entry in _table.items():
        if name not in globals():
            continue
        doc = json.dumps(entry["doc"], ensure_ascii=False)
        if entry.get("open"):
            functions.append(f"def {name}(code: str, **inputs: Any) -> Node:\n    {doc}\n")
            continue
        arguments = {one["name"]: _annotations.get(one["type"], "Any") for one in entry["inputs"]}
        def written(but: str | None) -> str:
            return "".join(f", {one}: {kind} | None = None" for one, kind in arguments.items() if one != but)
        functions.append(f"def {name}({('*' + written(None)) if arguments else ''}) -> Node:\n    {doc}\n")
        if (taking := _socket(entry)) and name != "output":
            rest = written(taking)
            methods.append(f"    def {name}(self{', *' + rest if rest else ''}) -> Node:\n        {doc}\n")
    return ("# Made of the node table.\nfrom __future__ import annotations\nfrom typing import Any\n\nclass Node:\n    type: str\n"
            "    inputs: dict[str, Any]\n    code: str | None\n    output: str | None\n"
            "    def __getitem__(self, output: str) -> Node: ...\n    def __or__(self, other: Node) -> Node: ...\n"
            "    def __and__(self, other: Node) -> Node: ...\n    def __sub__(self, other: Node) -> Node: ...\n"
            + "".join(methods) + "\ndef make(type: str, code: str | None = None, /, **inputs: Any) -> Node: ...\n"
            "def text_of(result: Node) -> str: ...\n" + "".join(functions))
