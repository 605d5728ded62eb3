// A 3MF file of the volumetric and implicit extensions as a graph.
//
// What is built becomes the output: each item a level set within its bounds, or a mesh, in its colour and
// place, all of them together. A function becomes a group (functions.h), those that nothing uses too. The
// model's unit is the document's; its z axis points up, as the plate of a printer has it, so that one node
// turns it to our y.
//
// What there is no room for is told, in words that name it: a warning where the solid is the same without it,
// an error where it would be another.
//
// A level set is where its function is below 0, which need not be a distance. Functions are wired as numbers,
// and a number in place of a surface is of unknown exactness: whoever meshes it goes by intervals.
#pragma once

#include <string>
#include <vector>

#include "graph/document/graph.h"

namespace fw {

inline constexpr std::string_view k3mfEnding = ".3mf";

/// A file that the graph names, by its path from the graph's folder.
struct FileBeside {
    std::string path, bytes;
};

struct Imported {
    Graph graph;  ///< without a path
    std::vector<FileBeside> files = {};
    std::vector<Error> warnings = {};
};

/// The graph of a file's bytes. `path` is the file's in messages; the files beside the graph go into the
/// folder `folder` ("part_3mf").
Result<Imported> import3mf(const std::string& bytes, const std::string& path, const std::string& folder);

}  // namespace fw
