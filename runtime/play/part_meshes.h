// The meshes of parts that move as wholes (graph/compile/moving_parts.h): each made once, where it rests.
#pragma once

#include <glm/mat4x4.hpp>
#include <vector>

#include "graph/compile/moving_parts.h"
#include "runtime/play/player.h"

namespace fw {

struct PartMesh {
    Mesh mesh;
    Program program;  ///< of its field, for the host
};

/// A mesh for every node that is a part, in cells of `cellSize` metres, made by a player, which is left with
/// the last of them; of what carries others an empty one. `parts` as of Player::mesh(). Errors: as of
/// Player::reload() and mesh(), with the part's name; a part that is empty.
Result<std::vector<PartMesh>> partMeshes(Player& player, std::span<const PartNode> nodes, double cellSize,
                                         PlayerOptions options, MaterialParts parts);

/// From the space of what is carried into that of what carries it.
glm::dmat4 matrixOf(const Pose& pose);

/// From each node's own space into the document's, at the moment of that number.
std::vector<glm::dmat4> placesAt(std::span<const PartNode> nodes, std::size_t moment);

/// All meshes as one, where they are at the moment of that number.
Mesh together(std::span<const PartNode> nodes, std::span<const PartMesh> meshes, std::size_t moment);

/// Whether two parts are in each other at some moment, by more than `depth` metres: then together they are
/// no union. Some hundred points of each are looked at.
bool overlap(std::span<const PartNode> nodes, std::span<const PartMesh> meshes, std::size_t moments,
             double depth);

}  // namespace fw
