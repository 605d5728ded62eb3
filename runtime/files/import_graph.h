// Files of other programs that become graphs, with the files that these name beside them.
#pragma once

#include <string>
#include <vector>

#include "graph/base/result.h"

namespace fw {

/// Whether a file of that name is imported, and not opened as a graph: "part.3mf".
bool isImported(const std::string& path);

struct ImportedFiles {
    std::string graph;                ///< its path
    std::vector<std::string> beside;  ///< of pictures and meshes that it names
    std::vector<Error> warnings;      ///< what of the file is left away, and what else is to be known
};

/// Writes the graph of the file at `path` to `graphPath`, and what it names into a folder beside, called
/// after the graph ("part_3mf"). Nothing is written of a file that makes no sense. Errors name the file: what
/// is wrong with it, or what cannot be read or written.
Result<ImportedFiles> importGraph(const std::string& path, const std::string& graphPath);

}  // namespace fw
