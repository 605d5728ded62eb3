// Reads the triangles of a mesh file as another program would find them, equal positions merged.
//
// This is the report's reader (mesh_report.h), not an importer: it knows the formats that exportMesh writes,
// a little more generally than it writes them (polygons in OBJ and PLY, further vertex properties in PLY,
// several meshes in glTF), and refuses the rest with a reason. Every count and offset is checked against the
// size of the file before anything is allocated or read; a file of any content yields a mesh or an Error.
//
// Two positions are equal if their three floats are (-0 equals 0); OBJ numbers are rounded to float first.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "graph/base/result.h"

namespace fw {

struct WeldedMesh {
    std::vector<glm::vec3> positions;  ///< all different; those of vertices without a triangle included
    std::vector<uint32_t> indices;     ///< three a triangle, all below positions.size()
};

/// Gives equal positions one number, in the order of first appearance.
class Welder {
  public:
    /// `expected` positions fit without growing.
    explicit Welder(std::size_t expected);
    uint32_t add(glm::vec3 position);
    /// So many more may come.
    void expect(std::size_t more);
    std::vector<glm::vec3> take() { return std::move(positions); }

  private:
    void resize(std::size_t slotCount);
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> slots;  ///< open addressing; number + 1, 0 is free
};

/// Merges equal positions; `indices` are below positions.size().
WeldedMesh weld(std::span<const glm::vec3> positions, std::span<const uint32_t> indices);

/// Where a mesh file's bytes are, if not under its name yet.
struct StoredMesh {
    std::string name;  ///< whose extension says the format
    std::string file;
    std::string beside = {};  ///< of glTF: the binary file; empty: as the file names it, beside `name`
};

/// The triangles of the file; its extension names the format.
Result<WeldedMesh> readWelded(const StoredMesh& mesh);

}  // namespace fw
