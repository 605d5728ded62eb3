"""Adds files to the licences of a wheel: add_licences.py WHEEL FILE...

They go to NAME-VERSION.dist-info/licenses, as https://peps.python.org/pep-0639 specifies, and into
RECORD, the list of all files.
"""

import base64
import hashlib
import pathlib
import sys
import zipfile

wheel = pathlib.Path(sys.argv[1])
with zipfile.ZipFile(wheel) as archive:
    files = {name: archive.read(name) for name in archive.namelist()}
about = "-".join(wheel.name.split("-")[:2]) + ".dist-info"
files.pop(f"{about}/RECORD")
for path in map(pathlib.Path, sys.argv[2:]):
    files[f"{about}/licenses/{path.name}"] = path.read_bytes()
record = ""
for name, data in files.items():
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    record += f"{name},sha256={digest},{len(data)}\n"
files[f"{about}/RECORD"] = f"{record}{about}/RECORD,,\n".encode()

complete = wheel.with_suffix(".part")
with zipfile.ZipFile(complete, "w") as archive:
    for name, data in files.items():
        entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
        entry.external_attr = 0o644 << 16
        archive.writestr(entry, data, zipfile.ZIP_DEFLATED)
complete.replace(wheel)
