"""Packs the Python module as a wheel: make_wheel.py PACKAGE NATIVE WHEEL

A wheel is an archive of the files with a list of them (packaging.python.org, "Binary distribution format"). PACKAGE is the
folder of Python files, NATIVE the compiled module. WHEEL's name says which version it is, and for what Python and system.
"""

import base64
import hashlib
import pathlib
import subprocess
import sys
import zipfile

package, native, wheel = map(pathlib.Path, sys.argv[1:])
version, tag = wheel.stem.split("-", 2)[1:]
files = {f"fieldwright/{path.name}": path.read_bytes() for path in sorted(package.iterdir()) if path.suffix in (".py", ".typed")}
files[f"fieldwright/{native.name}"] = native.read_bytes()
make_stubs = f"import sys; sys.path.insert(0, {str(native.parent.parent)!r}); from fieldwright import nodes; print(nodes._stubs())"
files["fieldwright/nodes.pyi"] = subprocess.run([sys.executable, "-c", make_stubs], check=True, capture_output=True).stdout
about = f"fieldwright-{version}.dist-info"
files[f"{about}/METADATA"] = f"""Metadata-Version: 2.1
Name: fieldwright
Version: {version}
Summary: Procedural solids from graphs of signed distance fields
License: MIT
Requires-Python: >=3.11
Requires-Dist: numpy
""".encode()
files[f"{about}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: fieldwright\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
lines = []
for name, data in files.items():
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    lines.append(f"{name},sha256={digest},{len(data)}\n")
files[f"{about}/RECORD"] = "".join([*lines, f"{about}/RECORD,,\n"]).encode()

with zipfile.ZipFile(wheel, "w") as archive:
    for name, data in files.items():
        entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
        entry.external_attr = 0o644 << 16
        archive.writestr(entry, data, zipfile.ZIP_DEFLATED)
