"""The third-party code that the binaries of a build contain or load, and the notices about it.

    python3 runtime/package/third_party.py BUILD NOTICES BINARY...

writes the file NOTICES for a package that holds these BINARYs of the folder BUILD. Its sources are
the link commands and headers that Ninja recorded, `ldd`, Debian's lists of files, and Debian's
copyright files (copyright_files.py). tests/package/licences checks the same data.
"""

import collections
import dataclasses
import functools
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
import copyright_files

DOCS = pathlib.Path("/usr/share/doc")
COMMON_LICENCES = pathlib.Path("/usr/share/common-licenses")

# Code that a library contains although its Debian copyright file does not mention it.
ALSO_CONTAINED = {
    "libimgui-dev": "The built-in font ProggyClean\nCopyright: 2004, 2005 Tristan Grimmer\nLicence: Expat, as above",
}


@dataclasses.dataclass(frozen=True)
class Use:
    """A third-party file, and how a binary uses it: "header", "static", "linked" or "needed by LIBRARY"."""

    file: str
    how: str

    def is_contained(self):
        return self.how in ("header", "static")


def run(*command, check=True):
    """The output of a command."""
    environment = {"PATH": "/usr/local/bin:/usr/bin:/bin", "LC_ALL": "C"}
    result = subprocess.run(command, check=check, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment)
    return result.stdout.decode(errors="replace")


def read(path):
    return pathlib.Path(path).read_text(encoding="utf-8", errors="replace")


@functools.cache
def real_path(folder, name):
    return os.path.realpath(os.path.join(folder, name))


class Build:
    """A folder that Ninja has built. Errors are `SystemExit`s with a message."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder).resolve()
        if not (self.folder / "build.ninja").is_file():
            raise SystemExit(f"{folder}: no build.ninja; configure it with CMake's generator Ninja first")
        cache = self.folder / "CMakeCache.txt"
        self.cache = dict(re.findall(r"^(\w+):\w+=(.*)$", read(cache), re.M)) if cache.exists() else {}
        self.own_folders = [self.folder, pathlib.Path(self.cache.get("CMAKE_HOME_DIRECTORY", self.folder))]
        self.inputs, self.variables = {}, {}  # of each output
        output = None
        for line in read(self.folder / "build.ninja").splitlines():
            if line.startswith("build "):
                outputs, _, rule = line.removeprefix("build ").partition(": ")
                output = outputs.split(" ")[0]
                self.inputs[output] = [word for word in rule.split(" || ")[0].split(" ")[1:] if word != "|"]
                self.variables[output] = {}
            elif line.startswith("  ") and output:
                name, _, value = line.strip().partition(" = ")
                self.variables[output][name] = value

    @functools.cached_property
    def recorded_headers(self):
        """The headers of each object file, as `ninja -t deps` prints them.

        Ninja reads a copy, because it may shorten the record of a build that is still running.
        """
        if not (self.folder / ".ninja_deps").exists():
            raise SystemExit(f"{self.folder}: nothing is built there")
        with tempfile.TemporaryDirectory() as copy:
            shutil.copy(self.folder / "build.ninja", copy)
            shutil.copy(self.folder / ".ninja_deps", copy)
            pathlib.Path(copy, "CMakeFiles").symlink_to(self.folder / "CMakeFiles")
            lines = run(self.cache.get("CMAKE_MAKE_PROGRAM", "ninja"), "-C", copy, "-t", "deps").splitlines()
        found, headers = {}, []
        for line in lines:
            if ": #deps" in line:
                headers = found.setdefault(line.split(": #deps")[0], [])
            elif line.startswith("    "):
                headers.append(line.strip())
        return found

    def is_own(self, path):
        return any(path.is_relative_to(folder) for folder in self.own_folders)

    def uses(self, binary):
        """All third-party files that `binary`, a path in the build folder, contains or loads."""
        binary = pathlib.Path(binary).resolve()
        if not binary.is_file():
            raise SystemExit(f"{binary}: no such file; build it first")
        target = str(binary.relative_to(self.folder)) if binary.is_relative_to(self.folder) else None
        if target not in self.inputs:
            raise SystemExit(f"{binary}: not built by {self.folder}/build.ninja")
        parts, pending = set(), [target]
        while pending:
            part = pending.pop()
            if part in self.inputs and part not in parts:
                parts.add(part)
                pending += self.inputs[part]
        compiled = [part for part in parts if part.endswith((".o", ".gch"))]
        for part in compiled or [target]:
            if part not in self.recorded_headers:
                raise SystemExit(f"{binary}: Ninja has no record of the headers of {part}; build it first")
        headers = {real_path(self.folder, header) for part in compiled for header in self.recorded_headers[part]}
        uses = {Use(header, "header") for header in headers if not self.is_own(pathlib.Path(header))}
        uses |= {Use(library, "static") for library in self.static_libraries(target)}
        if binary.suffix != ".a":
            uses |= {use for use in loaded_libraries(binary) if not self.is_own(pathlib.Path(use.file))}
        return uses

    def static_libraries(self, target):
        """The third-party archives on the link command of `target`."""
        variables = self.variables[target]
        folders = [word[2:] for word in variables.get("LINK_PATH", "").split() if word.startswith("-L")]
        folders += self.linker_folders
        for word in variables.get("LINK_LIBRARIES", "").split():
            path = self.folder / word
            if word.startswith("-l"):  # the linker, too, prefers a shared library to an archive
                names = (f"{folder}/lib{word[2:]}{ending}" for folder in folders for ending in (".so", ".a"))
                path = pathlib.Path(next(filter(os.path.exists, names), path))
            if path.suffix == ".a" and not self.is_own(path):
                yield str(path.resolve())

    @functools.cached_property
    def linker_folders(self):
        folders = run(self.cache.get("CMAKE_CXX_COMPILER", "c++"), "-print-search-dirs")
        return re.search(r"^libraries: =(.*)$", folders, re.M)[1].split(":")


def loaded_libraries(binary):
    """The shared libraries that the dynamic linker loads with `binary`."""
    paths = {}  # by soname
    for line in run("ldd", str(binary), check=False).splitlines():
        if match := re.match(r"\s*(\S+) => (.*?)(?: \(0x.*)?$", line):
            found = match[2] != "not found"
            paths[match[1]] = os.path.realpath(match[2]) if found else f"{match[1]} (not found)"
    files = [str(binary), *(path for path in paths.values() if path.startswith("/"))]
    needed = {}
    for part in re.split(r"^File: ", "\n" + run("readelf", "-d", *files, "/dev/null", check=False), flags=re.M)[1:]:
        needed[part.splitlines()[0]] = re.findall(r"\(NEEDED\).*\[(.*)\]", part)
    for soname, path in paths.items():
        parents = [parent for parent, file in paths.items() if soname in needed.get(file, ())]
        is_direct = soname in needed[str(binary)] or not parents
        yield Use(path, "linked" if is_direct else f"needed by {parents[0]}")


def owners(files):
    """The Debian package of each file; files of no package are missing in the result."""
    spellings = {}
    for file in files:
        for path in (file, file.removeprefix("/usr"), "/usr" + file):  # /lib is a link to /usr/lib
            spellings[path] = file
    found = {}
    for line in run("dpkg-query", "-S", *spellings, check=False).splitlines():
        names, _, path = line.rpartition(": ")
        if path in spellings and not line.startswith("diversion "):
            found.setdefault(spellings[path], re.split("[:,]", names)[0])
    return found


def group_by_package(uses):
    """The uses of each package; those of files that no package has are under None."""
    owned = owners({use.file for use in uses})
    groups = collections.defaultdict(list)
    for use in sorted(uses, key=lambda use: (owned.get(use.file, ""), use.file)):
        groups[owned.get(use.file)].append(use)
    return groups


@functools.cache
def versions():
    """Upstream version, source package and its version, by the name of the installed package."""
    fields = ("Package", "source:Upstream-Version", "source:Package", "source:Version")
    lines = run("dpkg-query", "-W", "-f", "\t".join(f"${{{field}}}" for field in fields) + "\n").splitlines()
    return {name: rest for name, *rest in (line.split("\t") for line in lines)}


@functools.cache
def copyright_text(package):
    """The copyright file of a package; None if it has none."""
    path = DOCS / package / "copyright"
    return read(path) if path.is_file() else None


@functools.cache
def stanzas_of(package, uses):
    """The stanzas of the package's copyright file that may cover the files in the tuple `uses`."""
    headers = tuple(use.file for use in uses if use.how == "header")
    return copyright_files.read(copyright_text(package) or "", package, headers, whole=len(headers) < len(uses))


def licence_of(stanzas):
    return "; ".join(dict.fromkeys(stanza.licence for stanza in stanzas))


def project_of(package):
    """The upstream name of a package's project."""
    named = re.search(r"^Upstream-Name: *(.+)$", copyright_text(package) or "", re.M)
    return {"imgui": "Dear ImGui"}.get(named[1], named[1]) if named else package


RULE = "-" * 78


def source_code(package):
    _, source, version = versions()[package]
    return f"Source code: https://snapshot.debian.org/package/{source}/{version}/"


def contained_notice(package, users, stanzas):
    """The notice about code of a package that the binaries `users` contain."""
    version = versions()[package][0]
    lines = [f"{project_of(package)} {version} (Debian package {package}), in {', '.join(users)}"]
    lines += [f"Licence: {licence_of(stanzas)}"]
    lines += [f"Note: {why}" for why in dict.fromkeys(stanza.why for stanza in stanzas) if why]
    lines += [source_code(package)]
    if all(stanza.kind in (copyright_files.EXCEPTED, copyright_files.LESSER) for stanza in stanzas):
        return "\n".join(lines)  # the exceptions ask for no notice, nor does the LGPL for its headers
    holders = dict.fromkeys(line.strip() for stanza in stanzas for line in stanza.holders.splitlines())
    lines += ["Copyright:", *(f"    {holder}" for holder in holders if holder)] if any(holders) else []
    lines += ["", copyright_files.licence_texts(copyright_text(package) or "", stanzas)]
    return "\n".join(lines + (["", ALSO_CONTAINED[package]] if package in ALSO_CONTAINED else []))


def loaded_notice(package, uses, stanzas):
    """The notice about a package with libraries that the binaries load."""
    ways = ", ".join(dict.fromkeys(use.how for use in uses))
    head = f"{package} {versions()[package][0]}, {ways}"
    return f"{head}\n    Licence: {licence_of(stanzas)}\n    {source_code(package)}"


def notices(uses_of):
    """The text of a NOTICES file; `uses_of` has the uses of each binary by its name."""
    contained, loaded = [], []
    for package, uses in group_by_package(set().union(*uses_of.values())).items():
        inside = [use for use in uses if use.is_contained()]
        if package is None:
            contained += [f"{use.file}\nLicence: unknown, as no Debian package has this file" for use in uses]
        elif inside:
            users = [binary for binary, used in uses_of.items() if not used.isdisjoint(inside)]
            contained.append(contained_notice(package, users, stanzas_of(package, tuple(inside))))
        else:
            loaded.append(loaded_notice(package, uses, stanzas_of(package, tuple(uses))))
    referred = set(re.findall(r"/usr/share/common-licenses/([\w.-]*\w)", "".join(contained)))
    referred |= set(re.findall(r"\bLGPL-[\d.]*\d", "".join(loaded)))
    parts = [f"""\
Third-party notices of Fieldwright

Fieldwright is under the MIT licence. These notices are about the code of other
projects in {', '.join(uses_of)},
and about the shared libraries that these files load.
"""]
    parts.append(f"\nCode in the binaries\n{RULE}\n" + f"\n\n{RULE}\n".join(contained) + "\n\n")
    if loaded:
        parts.append(f"""
Shared libraries
{RULE}
On Debian the copyright file of a PACKAGE is /usr/share/doc/PACKAGE/copyright. The
archive of Fieldwright brings most of these libraries, and their copyright files in
share/doc/fieldwright/libraries.

""" + "\n\n".join(loaded) + "\n\n")
    for name in sorted(referred):
        path = COMMON_LICENCES / name
        if path.is_file() and not name.startswith("GPL"):  # which covers no code in the binaries
            parts.append(f"\n{name}, referred to above\n{RULE}\n{read(path)}\n")
    return "".join(parts)


def main(arguments):
    if len(arguments) < 3:
        raise SystemExit(__doc__)
    build = Build(arguments[0])
    text = notices({pathlib.Path(binary).name: frozenset(build.uses(binary)) for binary in arguments[2:]})
    pathlib.Path(arguments[1]).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
