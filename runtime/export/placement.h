// How lengths and axes of a mesh stand in its file.
//
// A graph reckons in its document's unit, +Y up. glTF has metres and +Y up by its specification, 3MF is
// written in millimetres; STL, OBJ, PLY and OpenVDB say neither, and hold the document's numbers unless
// others are asked for. A slicer takes those of an STL for millimetres, and its plate for the plane of x and
// y.
#pragma once

#include <optional>
#include <string>

#include "graph/base/result.h"
#include "graph/document/unit.h"
#include "runtime/mesh/mesh.h"

namespace fw {

/// What is asked of a file.
struct PlacementWish {
    std::string unit = {};     ///< of its lengths: "mm"; empty: the format's own, or the document's
    std::string up = {};       ///< the axis that points up: "y" or "z"; empty: y
    std::string purpose = {};  ///< "print": in millimetres, +Z up; empty: none

    bool forPrinting() const { return purpose == "print"; }
    bool isNone() const { return unit.empty() && up.empty() && purpose.empty(); }
    bool operator==(const PlacementWish&) const = default;
};

struct Placement {
    double scale = 1.0;  ///< a length of 1 becomes so much, of what the file's writer takes: of 3MF metres
    bool zUp = false;    ///< +Y becomes +Z, and +Z becomes -Y
    LengthUnit unit = {"m", "metres", 1.0}, document = unit;  ///< of the file, and of the graph

    bool isNone() const { return scale == 1.0 && !zUp; }
    glm::vec3 place(glm::vec3 p) const { return turned(p) * float(scale); }
    /// Where the graph has what a program reads at `p`, which has brought 3MF to metres.
    glm::vec3 placeBack(glm::vec3 p) const;
    glm::vec3 turned(glm::vec3 v) const { return zUp ? glm::vec3(v.x, -v.z, v.y) : v; }
    /// "millimetres, +Z up"
    std::string words() const;
};

/// Errors: no such unit or axis; a format that has another by its specification; printing in a format that is
/// not printed.
Result<Placement> placementOf(const std::string& path, const LengthUnit& document, const PlacementWish& wish);

/// The mesh with its points and normals where they stand in the file.
Mesh placed(Mesh mesh, const Placement& placement);

/// What to say of a solid so many units long on its longest side, as a part that is made; none if that is
/// likely.
std::optional<std::string> unlikelySize(double longest, const LengthUnit& unit);

}  // namespace fw
