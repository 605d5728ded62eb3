// The folders that a process which serves others may read and write in.
//
// Without a fence all files are open, as to any command of its user. With one, whoever opens a file that a
// graph or a request names asks here: openAsset(), readGraphText(), saveGraph(), states of particles and
// OutputFile. Of an open file the kernel is asked where it lies (/proc/self/fd), so that it does not matter
// what a path looked like, or whether a link was put in its place meanwhile.
//
// What it does not cover: a file within that is a hard link to, or a folder that is a mount of, something
// elsewhere; whoever moves folders about while a file is being renamed into one of them; fonts that are asked
// for by the name of their family, which the system lists; and what the program itself brings along or keeps
// in its caches.
#pragma once

#include <string>
#include <vector>

#include "graph/base/result.h"

namespace fw {

/// From now on files lie below `roots`, or, to be written alone, below `own`: the program's caches. Once,
/// while there is one thread. Errors: a root that is no folder.
Done fenceFiles(const std::vector<std::string>& roots, const std::string& own = {});

/// Whether that path leads to a place within, be there a file or not; so nobody learns what lies elsewhere.
Done checkMayRead(const std::string& path);
/// Whether an open file lies within; `path` names it in the Error.
Done checkFenced(int descriptor, const std::string& path);

/// Whether a file of that path may be written: its folder is there, and within. Errors: it is not.
Done checkMayWrite(const std::string& path);

}  // namespace fw
