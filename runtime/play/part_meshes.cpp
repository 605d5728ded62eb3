#include "runtime/play/part_meshes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "graph/evaluate/evaluate.h"
#include "runtime/mesh/joined.h"

namespace fw {
namespace {

constexpr int kFewestCells = 8, kMostCells = 1024;
constexpr std::size_t kPointsOfAPart = 400;

struct PlacedBox {
    glm::dvec3 least{INFINITY}, greatest{-INFINITY};

    void add(glm::dvec3 p) { least = glm::min(least, p), greatest = glm::max(greatest, p); }
    bool meets(const PlacedBox& other) const {
        return glm::all(glm::lessThanEqual(least, other.greatest)) &&
               glm::all(glm::lessThanEqual(other.least, greatest));
    }
};

/// Some of its points, evenly from the list.
std::vector<glm::dvec3> somePoints(const Mesh& mesh) {
    std::vector<glm::dvec3> points;
    const std::size_t step = std::max<std::size_t>(1, mesh.positions.size() / kPointsOfAPart);
    for (std::size_t i = 0; i < mesh.positions.size(); i += step) points.emplace_back(mesh.positions[i]);
    return points;
}

/// One part's points and field, for questions.
struct AskedPart {
    std::vector<glm::dvec3> points;
    PlacedBox box;
    const Program* program;

    /// Whether some of these points, which are in its space, are deep within it.
    bool holds(std::span<const Point> of, double depth) const {
        std::vector<double> distances(of.size());
        evaluate(program->ir, program->distance(), program->parameters(), of, distances);
        return std::ranges::any_of(distances, [&](double distance) { return distance < -depth; });
    }
};

bool pointsWithin(const AskedPart& points, const glm::dmat4& from, const AskedPart& solid,
                  const glm::dmat4& to, double depth) {
    const glm::dmat4 map = glm::inverse(to) * from;
    std::vector<Point> there;
    for (const glm::dvec3& p : points.points) {
        const glm::dvec3 q(map * glm::dvec4(p, 1.0));
        there.push_back({q.x, q.y, q.z});
    }
    return solid.holds(there, depth);
}

}  // namespace

Result<std::vector<PartMesh>> partMeshes(Player& player, std::span<const PartNode> nodes, double cellSize,
                                         PlayerOptions options, MaterialParts parts) {
    std::vector<PartMesh> meshes(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i].part.nodes.empty()) continue;
        const auto named = [&](Error error) {
            error.message = "part '" + nodes[i].name + "': " + error.message;
            return error;
        };
        options.region.reset();
        options.resolution = kFewestCells;
        if (const Done found = player.reload(nodes[i].part, options); !found) return named(found.error());
        const Box region = player.region();
        options.region = region;
        options.resolution =
            std::clamp(int(std::ceil(longestSide(region) / cellSize)), kFewestCells, kMostCells);
        if (const Done set = player.reload(nodes[i].part, options); !set) return named(set.error());
        Result<Mesh> mesh = player.mesh(parts);
        if (!mesh) return named(mesh.error());
        if (mesh->indices.empty()) return named({.message = "it is empty, or smaller than a cell"});
        meshes[i] = {std::move(*mesh), player.programOnHost()};
    }
    return meshes;
}

glm::dmat4 matrixOf(const Pose& pose) {
    const auto& [x, y, z, w] = pose.turn;
    glm::dmat4 matrix = glm::mat4_cast(glm::dquat(w, x, y, z));
    for (int axis = 0; axis < 3; ++axis) matrix[axis] *= pose.size;
    matrix[3] = glm::dvec4(pose.move[0], pose.move[1], pose.move[2], 1.0);
    return matrix;
}

std::vector<glm::dmat4> placesAt(std::span<const PartNode> nodes, std::size_t moment) {
    std::vector<glm::dmat4> places;
    for (const PartNode& node : nodes) {
        const glm::dmat4 carried = node.parent ? places[*node.parent] : glm::dmat4(1.0);
        places.push_back(node.poses.empty() ? carried : carried * matrixOf(node.poses[moment]));
    }
    return places;
}

Mesh together(std::span<const PartNode> nodes, std::span<const PartMesh> meshes, std::size_t moment) {
    const std::vector<glm::dmat4> places = placesAt(nodes, moment);
    std::vector<Mesh> moved;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        Mesh& mesh = moved.emplace_back(meshes[i].mesh);
        for (glm::vec3& p : mesh.positions) p = glm::vec3(places[i] * glm::dvec4(p, 1.0));
        for (glm::vec3& n : mesh.normals)
            n = glm::vec3(glm::normalize(glm::dmat3(places[i]) * glm::dvec3(n)));
    }
    return joined(moved);
}

bool overlap(std::span<const PartNode> nodes, std::span<const PartMesh> meshes, std::size_t moments,
             double depth) {
    std::vector<AskedPart> parts;
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (!meshes[i].mesh.indices.empty()) {
            parts.push_back({somePoints(meshes[i].mesh), {}, &meshes[i].program});
            numbers.push_back(i);
        }
    for (std::size_t moment = 0; moment < moments; ++moment) {
        const std::vector<glm::dmat4> places = placesAt(nodes, moment);
        for (std::size_t i = 0; i < parts.size(); ++i) {
            parts[i].box = {};
            for (const glm::vec3& p : meshes[numbers[i]].mesh.positions)
                parts[i].box.add(glm::dvec3(places[numbers[i]] * glm::dvec4(p, 1.0)));
        }
        for (std::size_t i = 0; i < parts.size(); ++i)
            for (std::size_t k = 0; k < parts.size(); ++k)
                if (i != k && parts[i].box.meets(parts[k].box) &&
                    pointsWithin(parts[i], places[numbers[i]], parts[k], places[numbers[k]], depth))
                    return true;
    }
    return false;
}

}  // namespace fw
