// A program: what a runtime needs to evaluate a graph's field, and nothing of how it was drawn. compile()
// makes them.
//
// Lifetime: a plain value.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "graph/base/result.h"
#include "graph/bounds/region.h"
#include "graph/compile/mesh_recipe.h"
#include "graph/ir/families.h"
#include "graph/ir/ir.h"
#include "graph/library/types.h"

namespace fw {

/// One slot of the parameter buffer.
struct LiveParameter {
    std::string name;   ///< of an exposed parameter, else "node.input"; "time" for the seconds
    int component = 0;  ///< which component of a vector input
    double value = 0.0;
};

/// Of the surface that a node gives.
struct NodeExactness {
    Exactness exactness;
    std::string spoiledBy;  ///< as Program::spoiledBy
};

struct Program {
    Ir ir;
    std::array<IrId, kSurfaceComponents> surface{};  ///< roots, in the order of SurfaceComponent
    /// The same of the part through which no light passes; the same roots, where light passes nowhere.
    std::array<IrId, kSurfaceComponents> opaque{};
    std::vector<LiveParameter> live;
    Families families;           ///< of the distance
    uint64_t structureHash = 0;  ///< equal for equal code, whatever the live values

    Exactness exactness;
    std::string spoiledBy;  ///< node by which the field lost its exactness; empty if exact
    /// Of nodes with a surface, of several outputs the first one's; in groups by "instance/node".
    std::map<std::string, NodeExactness, std::less<>> nodeExactness;

    /// Nodes, in groups "instance/node": Ir::origin() of an operation is the place of the one that it came
    /// from. The first stands for none.
    std::vector<std::string> origins = {""};

    /// Names of nodes, their labels where they have some: a surface's painter is the place of the one that
    /// gave it its material, in every instance of a group the same. The first stands for none.
    std::vector<std::string> painters = {""};

    int resolution = 128;  ///< cells along the longest side
    MeshMethod method = MeshMethod::marchingCubes;
    std::optional<Box> region;      ///< given by a polygonize node
    std::vector<MeshStage> stages;  ///< what is done to the mesh, in order; not part of structureHash
    std::vector<Error> notes;       ///< warnings: what its user should know

    IrId distance() const { return surface[distanceComponent]; }
    /// Of surface, then of opaque.
    std::array<IrId, 2 * kSurfaceComponents> roots() const;
    /// Light passes through some part of it.
    bool transmits() const { return opaque != surface; }
    /// Some point's material differs from another's or from the default.
    bool hasMaterial() const;
    /// The live values in their slots.
    std::vector<double> parameters() const;
    /// What the field's buffer holds: the live values in their slots, then the families' tables. Not empty.
    std::vector<float> numbers() const;
};

/// The region of the program's solid with its present live values. `stop`: as of region.h.
Region findRegion(const Program& program, std::stop_token stop = {});

/// Steps of tapes that a search for a Lipschitz constant evaluates at most: of about 50 ms and of 1 ms.
inline constexpr std::size_t kThoroughSteps = 500'000, kQuickSteps = 8'000;

/// A Lipschitz constant of the distance and of the opaque part's distance within a box, for the present live
/// values: the declared one or, if that is infinite, a proven one. Infinity if none is proven, or if the
/// program has particles that are not made. `maxSteps`: as kThoroughSteps.
double lipschitzWithin(const Program& program, const Box& box, std::size_t maxSteps = kThoroughSteps);

}  // namespace fw
