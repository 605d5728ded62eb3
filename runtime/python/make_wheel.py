"""Packs the Python module as a wheel: make_wheel.py PACKAGE NATIVE VERSION FOLDER

A wheel is an archive of the files with a list of them (packaging.python.org, "Binary distribution format"). PACKAGE is the
folder of Python files, NATIVE the compiled module, FOLDER where the wheel goes. Prints its path.
"""

import base64
import hashlib
import pathlib
import subprocess
import sys
import sysconfig
import zipfile

package, native, version, folder = (pathlib.Path(word) if i != 2 else word for i, word in enumerate(sys.argv[1:]))
interpreter = f"cp{sys.version_info.major}{sys.version_info.minor}"
tag = f"{interpreter}-{interpreter}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"
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

folder.mkdir(parents=True, exist_ok=True)
wheel = folder / f"fieldwright-{version}-{tag}.whl"
with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
    for name, data in files.items():
        archive.writestr(zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0)), data, zipfile.ZIP_DEFLATED)
print(wheel)
