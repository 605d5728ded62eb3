"""Debian's copyright files: the licences that apply to the code of a library, and their kinds.

A machine-readable file (https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/) has a
stanza for each group of files in the source package. Many of these files are no part of a library:
packaging, build scripts, tests. `read` returns the stanzas that may cover a library. Other
copyright files are plain text, classified by the phrases in them.
"""

import collections
import dataclasses
import fnmatch
import pathlib
import re

# Kinds of licences as far as linking is concerned, the best first.
FREE = "permissive"  # also licences whose copyleft ends at their own files, such as the MPL
EXCEPTED = "GPL with an exception for linking"
LESSER = "LGPL"  # fine for shared libraries and their headers
GPL = "GPL"
UNKNOWN = "unknown"
KINDS = (FREE, EXCEPTED, LESSER, GPL, UNKNOWN)


@dataclasses.dataclass(frozen=True)
class Reviewed:
    """A licence that a person determined, because a program cannot tell it from the copyright file."""

    packages: str  # a regular expression
    files: str  # a pattern of the stanza that this row replaces; "*" replaces the whole copyright file
    licence: str
    evidence: str  # must occur in the copyright file or, with `in_headers`, in the used headers
    why: str
    in_headers: bool = False


REVIEWED = (
    Reviewed(
        r"libc6(-dev)?", "*", "LGPL-2.1+", "* Most of the GNU C library is under the following copyright",
        "The GPL covers only the programs of glibc; the libraries and headers are under the LGPL."),
    Reviewed(
        r"libstdc\+\+.*|libgcc-.*", "*", "GPL-3+ with GCC runtime library exception", "GCC RUNTIME LIBRARY EXCEPTION",
        "The exception permits any licence for programs that GCC compiled. Other GPL parts are the compilers."),
    Reviewed(
        r"linux-libc-dev", "*", "GPL-2 with Linux-syscall-note", "WITH Linux-syscall-note",
        "The note in the headers says that programs which make system calls are not derived works.", in_headers=True),
    Reviewed(
        r"libpython3\.\d+-dev", "*", "PSF-2.0", "PYTHON SOFTWARE FOUNDATION LICENSE VERSION 2",
        "The GPL is mentioned for Python's readline module and documentation; only Python's headers are used."),
    Reviewed(
        r"libzip4|libzip-dev", "*", "BSD-3-clause",
        "in which case the provisions of the GPL apply INSTEAD OF those given above",
        "The GPL is an alternative for one file, and the licence of Debian's packaging."),
    Reviewed(
        r"libuuid1", "*", "BSD-3-clause and LGPL-2+", "libuuid/*",
        "The GPL covers the programs of util-linux. libuuid consists of libuuid/ and, from lib/, files under the LGPL."),
    Reviewed(
        r"liblzma5", "lib/*", "LGPL-2.1+", "lib/getopt.c lib/getopt1.c lib/getopt.in.h",
        "lib/ has getopt for the programs of XZ Utils; the library is src/liblzma/, which is in the public domain."),
    Reviewed(
        r"liblzma5", "dos/config.h", "public-domain", "dos/config.h was generated with autoheader",
        "The GPL is that of Autoconf, which generated this file for DOS; the file itself is not under it."),
    Reviewed(
        r"glslang-dev", "glslang/MachineIndependent/glslang_tab.cpp", "GPL-3+ with Bison exception", "glslang_tab.cpp.h",
        "Output of Bison: the file has the exception for larger works, which Debian's copyright file omits."),
)

# Stanzas that name only these folders, or no source files, cover no code of a library.
NO_LIBRARY = re.compile(r"(^|/)(debian|tests?|examples?|programs|scripts)/")
SOURCE = re.compile(r"(\.(c|cc|cpp|cxx|h|hh|hpp|hxx|inl|ipp|S|s|asm|y|l)|[*?])$")

NAMES = (  # the first pattern that matches a short name decides
    (EXCEPTED, r"a?gpl.* with .*(autoconf|automake|libtool|bison|gcc|runtime library|classpath|syscall).*"),
    (GPL, r"a?gpl.*"),
    (LESSER, r"lgpl.*"),
    (FREE, r"expat|mit|x11|isc|zlib|libpng|bsd|bsl-1(\.0)?$|apache|mpl|ftl|cc0|public[- ]domain|pd|hpnd|psf|"
           r"fsf(ul|ap)|unicode|bzip2|afl|artistic|none$"),
)
TEXTS = (  # for other short names, and for plain copyright files
    (GPL, "GPL", r"(?<!Lesser )(?<!Library )General Public License|\bA?GPL\b"),
    (LESSER, "LGPL", r"(Lesser|Library) General Public License|\bLGPL"),
    (FREE, "MIT-like", r"Permission is hereby granted, free of charge"),
    (FREE, "BSD-like", r"Redistribution and use in source and binary forms|use, reproduce, modify and redistribute"),
    (FREE, "HPND-like", r"Permission to (use, copy|copy, use), modify,?( and| sell and)? (re)?distribute"),
    (FREE, "zlib-like", r"distribute it freely|use freely|do whatever you want|"
                        r"redistribution and modification (in .*)?is permitted"),
    (FREE, "public domain", r"(in|to|into) the (?i:public domain)"),
)


def classify_text(text):
    """The kind of a licence by its text, and the names of the licences found in it."""
    text = " ".join(text.split())
    found = [(kind, name) for kind, name, pattern in TEXTS if re.search(pattern, text)]
    return (found[0][0], " and ".join(name for _, name in found)) if found else (UNKNOWN, "unknown")


def classify(expression, texts):
    """The kind of `A or B, and C`: the best of alternatives, the worst of licences that apply together.

    `texts` has the texts of short names that are defined in the same file.
    """
    def of_name(name):
        plain = name.replace("_", " ").lower()
        known = (kind for kind, pattern in NAMES if re.match(pattern, plain))
        return next(known, None) or classify_text(texts.get(name, ""))[0]

    def of_all(kinds):
        return max(kinds, key=KINDS.index)

    def of_any(kinds):
        return min(kinds, key=KINDS.index)

    return of_all(of_any(of_all(of_name(name.strip()) for name in re.split(r"\s+and\s+", together))
                         for together in re.split(r"\s+or\s+", group, flags=re.I))
                  for group in re.split(r",\s*(?:and\s+)?", expression))


@dataclasses.dataclass(frozen=True)
class Stanza:
    """Some files of a source package: their licence as written, its kind, their copyright lines."""

    files: tuple
    licence: str
    kind: str
    holders: str = ""
    text: str = ""  # of the licence, if the stanza has it
    why: str = ""  # for reviewed licences


def is_machine_readable(text):
    return re.match(r"\s*Format:.*(copyright-format|dep5)", text, re.I) is not None


def paragraphs(text):
    """The fields of each paragraph, with lower-case names."""
    for paragraph in re.split(r"\n[ \t]*\n(?=\S)", text):
        fields = re.finditer(r"^([A-Za-z][\w-]*):(.*(?:\n[ \t].*|\n$)*)", paragraph, re.M)
        yield {field[1].lower(): field[2].strip() for field in fields}


def split_licence(fields):
    """The short name and the text of a License field."""
    name, _, text = fields.get("license", "").partition("\n")
    return name.strip(), text


def may_cover(pattern, headers, whole):
    """Whether `pattern` may match one of `headers` or, with `whole`, any code of the library.

    `headers` are sets of paths by their last component. Installed paths differ from those in the
    source package, so the comparison starts at an include folder where the pattern has one.
    """
    folder, _, name = pattern.rpartition("/")
    has_wildcard = "*" in name or "?" in name
    installed = "*/" + pattern.split("include/")[-1]
    candidates = set().union(*headers.values()) if has_wildcard else headers.get(name, ())
    if any(fnmatch.fnmatchcase(header, installed) for header in candidates):
        return True
    if NO_LIBRARY.search(pattern) or not SOURCE.search(pattern):
        return False
    if whole or pattern == "*":
        return True
    named = [part for part in folder.split("/") if part not in ("", "src", "lib", "libs", "include")]
    return has_wildcard and (not named or any(f"/{named[-1]}" in header for header in candidates))


def is_proven(row, text, headers):
    if not row.in_headers:
        return row.evidence in text
    contents = [pathlib.Path(header).read_text(encoding="utf-8", errors="replace") for header in headers]
    # Generated headers state no licence: they include another header, or define only numbers.
    stated = [content for content in contents if re.search("SPDX|copyright|licen[cs]e", content, re.I)]
    return bool(stated) and all(row.evidence in content for content in stated)


def read(text, package, headers=(), whole=True):
    """The stanzas of a copyright file that may cover these headers or, with `whole`, the library."""
    rows = [row for row in REVIEWED if re.fullmatch(row.packages, package)]
    for row in rows:
        if row.files == "*":
            if is_proven(row, text, headers):
                return [Stanza(("*",), row.licence, classify(row.licence, {}), why=row.why)]
            return [Stanza(("*",), f"review of {row.licence} lacks its evidence", UNKNOWN)]
    if not is_machine_readable(text):
        kind, name = classify_text(text)
        return [Stanza(("*",), name, kind)]
    by_name, texts, stanzas = collections.defaultdict(set), {}, []
    for header in headers:
        by_name[header.rpartition("/")[2]].add(header)
    for fields in paragraphs(text):
        name, body = split_licence(fields)
        if body:
            texts.setdefault(name, body)
    for fields in paragraphs(text):
        files = tuple(fields.get("files", "").split())
        if not any(may_cover(pattern, by_name, whole) for pattern in files):
            continue
        name, body = split_licence(fields)
        kind = classify(name, {**texts, name: body} if body else texts)
        stanza = Stanza(files, name or "unknown", kind, fields.get("copyright", ""), body)
        for row in rows:
            if row.files in files and row.evidence in text:
                stanza = dataclasses.replace(stanza, licence=row.licence, kind=classify(row.licence, {}), why=row.why)
        stanzas.append(stanza)
    return stanzas or [Stanza(("*",), "unknown", UNKNOWN)]


def licence_texts(text, stanzas):
    """The full texts of the licences of `stanzas`, from the copyright file `text`; a plain file as it is."""
    if not is_machine_readable(text):
        return text.strip()
    names = {stanza.licence for stanza in stanzas}
    names |= {name for licence in names for name in re.split(r",\s*|\s+and\s+|\s+or\s+", licence)}
    found = [(stanza.licence, stanza.text) for stanza in stanzas if stanza.text]
    for fields in paragraphs(text):
        name, body = split_licence(fields)
        if "files" not in fields and body and name in names:
            found.append((name, body))
    plain = {(name, re.sub(r"^[ \t](\.$)?", "", body, flags=re.M)): None for name, body in found}
    return "\n\n".join(f"Licence {name}:\n\n{body}" for name, body in plain)
