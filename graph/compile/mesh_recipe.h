// Where a mesh comes from: a file, or a field by what polygonize says and the stages behind it. Plain values;
// none of them is part of a program's code.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "graph/base/box.h"

namespace fw {

enum class MeshMethod : unsigned char { marchingCubes, dualContouring };
inline constexpr const char* kMeshMethodNames[] = {"marching-cubes", "dual-contouring"};
/// That of this name, which is one of them.
MeshMethod meshMethod(std::string_view name);

/// What is done to a mesh.
struct MeshStage {
    enum class Kind : unsigned char { smooth, subdivide, decimate, dropCrumbs } kind = Kind::smooth;
    int times = 1;        ///< iterations of smooth, levels of subdivide, at least 0
    bool project = true;  ///< of subdivide: new vertices are led onto the field
    double error = 0.0;   ///< of decimate: metres that the result may be away from the field; 0: any
    int triangles = 0;    ///< of decimate: at which it ends; 0: as few as the error allows
    bool byShape =
        false;  ///< of decimate: borders between colours and materials may move, for textures tell them
    /// Of smooth, metres: the radius of balls that stay as they are, and how far a vertex may get; 0: none,
    /// any.
    double spare = 0.0, within = 0.0;
    double least = 0.0;  ///< of dropCrumbs: parts stay of so large a share of the largest one's volume
    bool operator==(const MeshStage&) const = default;
};
/// Whether the stage needs the field.
inline bool projectsVertices(const MeshStage& stage) {
    return stage.kind == MeshStage::Kind::subdivide && stage.project && stage.times > 0;
}

struct TriangleMesh;

struct MeshRecipe {
    /// The mesh itself, where a file has it: the rest then says nothing.
    std::shared_ptr<const TriangleMesh> read = {};
    int resolution = 0;  ///< cells along the longest side; 0: the output's, and so with method and region
    MeshMethod method = MeshMethod::marchingCubes;
    std::optional<Box> region = {};
    std::vector<MeshStage> stages = {};  ///< in order
};

}  // namespace fw
