"""`fieldwright serve` as a child process, one for each folder of graphs. Knows nothing of Blender.

Messages are those of docs/server.md. A child that has died is started again at the next request, with the documents that
were open; what fails twice is a ServerError, which a person can read.
"""
import json
import os
import shutil
import subprocess
import tempfile


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
    """A child that serves one folder."""

    def __init__(self, program, root):
        self.program, self.root = program, root
        self.child = self.errors = None
        self.last = 0

    def start(self):
        self.stop()
        self.errors = tempfile.TemporaryFile()
        try:
            self.child = subprocess.Popen([self.program, "serve", "--root", self.root], stdin=subprocess.PIPE,
                                          stdout=subprocess.PIPE, stderr=self.errors, cwd=self.root)
        except OSError as error:
            raise ServerError(f"'{self.program}' cannot be started: {error.strerror}") from None

    def stop(self):
        if self.child:
            self.child.stdin.close()
            self.child.stdout.close()
            self.child.kill()
            self.child.wait()
        if self.errors:
            self.errors.close()
        self.child = self.errors = None

    def alive(self):
        return self.child is not None and self.child.poll() is None

    def ask(self, method, **params):
        """The result of a request, and its blobs by name."""
        self.last += 1
        message = {"jsonrpc": "2.0", "id": self.last, "method": method, "params": params}
        try:
            self.child.stdin.write(json.dumps(message).encode() + b"\n")
            self.child.stdin.flush()
            while True:
                line = self.child.stdout.readline()
                if not line:
                    raise BrokenPipeError
                answer = json.loads(line)
                if answer.get("id") == self.last:
                    break
            blobs = {blob["name"]: self.child.stdout.read(blob["bytes"])
                     for blob in answer.get("result", {}).get("blobs", ())}
        except (OSError, ValueError):
            raise ServerError(self.why_gone()) from None
        if "error" in answer:
            raise ServerError(answer["error"]["message"], answer["error"].get("data"))
        return answer["result"], blobs

    def why_gone(self):
        said = ""
        if self.errors:
            self.child.wait(5)
            self.errors.seek(0)
            said = self.errors.read()[-300:].decode(errors="replace").strip()
        self.stop()
        return "fieldwright ended" + (f": {said}" if said else ": it is started again at the next change")


class Graph:
    """A graph file that is open on a server, with its values and its time; open again after the server has died."""

    servers = {}

    def __init__(self, path, program):
        self.path, self.program = os.path.abspath(path), program
        self.document = self.child = None
        self.values, self.seconds = {}, 0.0
        self.about = {}

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

    def open(self):
        server = self.server
        if not server.alive():
            server.start()
        self.close()
        self.about, _ = server.ask("open", path=os.path.basename(self.path))
        self.document, self.child = self.about["document"], server.child
        if self.values:
            known = {each["name"] for each in self.about["parameters"] if not each["animated"]}
            values = {name: value for name, value in self.values.items() if name in known}
            if values:
                server.ask("set", document=self.document, values=values)
        if self.seconds:
            server.ask("time", document=self.document, seconds=self.seconds)

    def close(self):
        if self.document and self.server.alive() and self.child is self.server.child:
            self.server.ask("close", document=self.document)
        self.document = None

    def ask(self, method, **params):
        if not self.document or not self.server.alive() or self.child is not self.server.child:
            self.open()
        try:
            return self.server.ask(method, document=self.document, **params)
        except ServerError:
            if self.server.alive():
                raise
        self.open()
        return self.server.ask(method, document=self.document, **params)

    def set(self, values):
        self.values.update(values)
        return self.ask("set", values=values)[0]

    def time(self, seconds):
        self.seconds = seconds
        self.ask("time", seconds=seconds)

    def mesh(self, resolution=0):
        params = {"resolution": resolution} if resolution else {}
        return self.ask("mesh", materials=True, **params)
