// `fieldwright serve`: graphs, meshes and pictures for other programs, by messages (message.h) on standard
// input and output, or on a local socket.
//
// A client that goes takes with it all that it had open. Nothing outside the roots is read or written
// (graph/base/fence.h), and no network is used: a local socket is a file, which its owner alone may open.
#pragma once

#include <string>
#include <vector>

#include "graph/base/result.h"

namespace fw::serve {

struct ServeOptions {
    std::vector<std::string> roots = {"."};  ///< folders; paths of requests are from the first
    std::string socket = {};                 ///< path of a local socket; empty: standard input and output
    std::string device = {};                 ///< as DeviceOptions::pick
    bool assistant = false;                  ///< the Model Context Protocol (assistant.h)
};

/// What bounds the memory that clients can claim, for --help.
std::string limitsInWords();

/// Serves until its client is gone, or one asks for its end. Errors: a root that is no folder, a socket that
/// cannot be made.
Done serve(const ServeOptions& options);

}  // namespace fw::serve
