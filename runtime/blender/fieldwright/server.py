"""`fieldwright serve` as a child process, one for each folder of graphs. Knows nothing of Blender.

Messages are those of docs/server.md. A child that has died is started again at the next request, with the documents that
were open; what fails twice is a ServerError, which a person can read.
"""
import ctypes
import json
import os
import shutil
import socket
import subprocess
import tempfile
from collections import OrderedDict


class ServerError(Exception):
    """What is wrong, in words; `data` has file, node, line and column, as far as they are known."""

    def __init__(self, message, data=None):
        super().__init__(message)
        self.data = data or {}

    def __str__(self):
        place = self.data.get("file", "")
        if place and self.data.get("line"):
            place += f":{self.data['line']}:{self.data.get('column', 1)}"
        node = f"node '{self.data['node']}'" if self.data.get("node") else ""
        return ": ".join(part for part in (place, node, self.args[0]) if part)


def find_program(wished=""):
    """The command: the one wished for, else the one on the path; a ServerError if it is not there."""
    program = shutil.which(os.path.expanduser(wished) if wished else "fieldwright")
    if not program:
        raise ServerError(f"there is no program '{wished or 'fieldwright'}': install Fieldwright, or give its path in "
                          "the add-on's preferences")
    return program


class Server:
    """A child that serves one folder. It has only so many documents open: the one that was not asked for longest makes room."""

    def __init__(self, program, root):
        self.program, self.root = program, root
        self.child = self.requests = self.errors = None
        self.last = 0
        self.buffer = bytearray()  # of blobs, used again and again: fresh memory would cost more than what is read into it
        self.most = 1
        self.opened = OrderedDict()  # Graphs that have a document here, the one asked last at the end

    def start(self):
        self.stop()
        self.errors = tempfile.TemporaryFile()
        # No pipe: one whose reader is gone would end Blender, which does not always ignore SIGPIPE.
        self.requests, theirs = socket.socketpair()
        try:
            with theirs:
                self.child = subprocess.Popen([self.program, "serve", "--root", self.root], stdin=theirs,
                                              stdout=subprocess.PIPE, stderr=self.errors, cwd=self.root)
        except OSError as error:
            self.stop()
            raise ServerError(f"'{self.program}' cannot be started in '{self.root}': {error.strerror}") from None
        try:
            self.most = self.ask("version")[0]["limits"]["documents"]
        except (KeyError, TypeError):
            self.stop()
            raise ServerError(f"'{self.program}' is not the command fieldwright: give its path in the add-on's "
                              "preferences") from None

    def stop(self):
        self.opened.clear()
        if self.child:
            self.child.kill()
            self.child.wait()
            self.child.stdout.close()
        for each in filter(None, (self.requests, self.errors)):
            each.close()
        self.child = self.requests = self.errors = None

    def alive(self):
        return self.child is not None and self.child.poll() is None

    def ask(self, method, **params):
        """The result of a request, and its blobs by name, until the next request."""
        self.last += 1
        message = {"jsonrpc": "2.0", "id": self.last, "method": method, "params": params}
        try:
            self.requests.sendall(json.dumps(message).encode() + b"\n", socket.MSG_NOSIGNAL)
            while True:
                line = self.child.stdout.readline()
                if not line:
                    raise BrokenPipeError
                answer = json.loads(line)
                if answer.get("id") == self.last:
                    break
            blobs = self.read(answer.get("result", {}).get("blobs", ()))
        except (OSError, ValueError, AttributeError):  # gone, or it does not speak as it should
            raise ServerError(self.why_gone()) from None
        if "error" in answer:
            raise ServerError(answer["error"]["message"], answer["error"].get("data"))
        return answer.get("result"), blobs

    def read(self, announced):
        size = sum(blob["bytes"] for blob in announced)
        if size > len(self.buffer):
            self.buffer = bytearray(size + size // 2)
        whole, blobs, start = memoryview(self.buffer)[:size], {}, 0
        if self.child.stdout.readinto(whole) < size:
            raise BrokenPipeError
        for blob in announced:
            blobs[blob["name"]] = whole[start:start + blob["bytes"]]
            start += blob["bytes"]
        return blobs

    def why_gone(self):
        """Ends what is left of the child; its last words, if it had some."""
        self.child.kill()
        self.child.wait()
        self.errors.seek(0)
        said = self.errors.read()[-300:].decode(errors="replace").strip()
        self.stop()
        return f"'{self.program}' ended" + (f": {said}" if said else ": it is started again at the next change")


def single(value):
    """A number, or several, as single precision has it: properties of Blender do."""
    return [single(each) for each in value] if isinstance(value, list) else ctypes.c_float(value).value


def fitting(values, parameters):
    """Of these values those that the parameters can have, within their limits."""
    fits = {}
    for about in parameters:
        value, now = values.get(about["name"]), about["value"]
        if about["animated"] or value is None or isinstance(value, list) != isinstance(now, list):
            continue
        least, most = about.get("min", float("-inf")), about.get("max", float("inf"))
        if not isinstance(value, list):
            fits[about["name"]] = min(max(value, least), most)
        elif len(value) == len(now):
            fits[about["name"]] = [min(max(each, least), most) for each in value]
    return fits


class Graph:
    """A graph file that is open on a server; opened again after the server has died, or when others needed its place there."""

    servers = {}

    def __init__(self, path, program):
        self.path, self.program = path, program
        self.about = {}  # the answer to `open`; document, values and time are as that left them, or as they were set since
        self.values, self.seconds, self.resolution = {}, 0.0, 0

    @property
    def server(self):
        root = os.path.dirname(self.path)
        key = (self.program, root)
        if key not in Graph.servers:
            Graph.servers[key] = Server(self.program, root)
        return Graph.servers[key]

    @staticmethod
    def stop_all():
        for server in Graph.servers.values():
            server.stop()
        Graph.servers.clear()

    def is_open(self):
        return self.server.alive() and self in self.server.opened

    def open(self):
        server = self.server
        if not server.alive():
            server.start()
        self.close()
        while len(server.opened) >= server.most:
            next(iter(server.opened)).close()
        self.about, _ = server.ask("open", path=os.path.basename(self.path))
        server.opened[self] = None
        self.values = {each["name"]: single(each["value"]) for each in self.about["parameters"]}
        self.seconds, self.resolution = 0.0, 0

    def close(self):
        if self.is_open():
            del self.server.opened[self]
            self.server.ask("close", document=self.about["document"])

    def mesh(self, values, seconds, resolution):
        """The mesh of these values (those that no parameter can have are left out) at this time, in seconds; `resolution`
        0: as the graph says. A server that ends over it is started once more."""
        for again in (False, True):
            try:
                if not self.is_open() or (self.resolution and not resolution):  # a server goes on with the last one
                    self.open()
                self.server.opened.move_to_end(self)
                return self.mesh_now(values, seconds, resolution)
            except ServerError:
                if again or self.server.alive():
                    raise

    def mesh_now(self, values, seconds, resolution):
        server, document = self.server, self.about["document"]
        new = {name: value for name, value in fitting(values, self.about["parameters"]).items() if self.values[name] != value}
        if new:
            server.ask("set", document=document, values=new)
            self.values.update(new)
        if seconds != self.seconds:
            server.ask("time", document=document, seconds=seconds)
            self.seconds = seconds
        self.resolution = resolution
        cells = {"resolution": resolution} if resolution else {}
        return server.ask("mesh", document=document, materials=True, edges=True, normals=False, **cells)
