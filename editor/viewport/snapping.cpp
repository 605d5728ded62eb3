#include "editor/viewport/snapping.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>

#include "editor/viewport/grips.h"
#include "graph/assets/triangle_mesh.h"

namespace fw::editor {

namespace {

constexpr float kColumn = 16.0f;    // pixels
constexpr float kSamePlace = 4.0f;  // pixels within which the nearer one counts
constexpr std::size_t kMostVertices = 4'000'000;

bool seesAlike(const Lens& a, const Lens& b) {
    return a.eye == b.eye && a.forward == b.forward && a.right == b.right && a.up == b.up &&
           a.place.lo.x == b.place.lo.x && a.place.lo.y == b.place.lo.y && a.place.hi.x == b.place.hi.x &&
           a.place.hi.y == b.place.hi.y;
}

/// The path of the mesh that this node reads from a file; empty: it reads none.
std::string meshPathOf(const Node& node) {
    const NodeType* type = findNodeType(node.type);
    if (!type || node.muted) return {};
    for (const InputSpec& input : type->inputs) {
        if (!input.file || input.file->noun != kMeshFile.noun) continue;
        const InputValue* value = node.input(input.name);
        if (const auto* path = value ? std::get_if<std::string>(&value->value) : nullptr) return *path;
    }
    return {};
}

}  // namespace

void SnapPlaces::project(const Lens& now) {
    lens = now;
    const std::size_t count = std::size_t(std::max(now.place.width(), 0.0f) / kColumn) + 1;
    const auto columnOf = [&](const Seen& at) {
        return std::min(std::size_t((at.x - now.place.lo.x) / kColumn), count - 1);
    };
    std::vector<Seen> found;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (const auto at = now.project(places[i]); at && now.place.contains(*at))
            found.push_back({at->x, at->y, uint32_t(i)});
    columns.assign(count + 1, 0);
    for (const Seen& at : found) ++columns[columnOf(at) + 1];
    for (std::size_t i = 1; i <= count; ++i) columns[i] += columns[i - 1];
    seen.resize(found.size());
    std::vector<uint32_t> next(columns.begin(), columns.end() - 1);
    for (const Seen& at : found) seen[next[columnOf(at)]++] = at;
}

std::optional<glm::dvec3> SnapPlaces::near(const Lens& now, ImVec2 pixel, float reach) {
    if (!lens || !seesAlike(*lens, now)) project(now);
    const float left = now.place.lo.x;
    const int last = int(columns.size()) - 2;
    const auto column = [&](float x) { return std::clamp(int(std::floor((x - left) / kColumn)), 0, last); };
    const std::span<const Seen> around(seen.data() + columns[std::size_t(column(pixel.x - reach))],
                                       seen.data() + columns[std::size_t(column(pixel.x + reach)) + 1]);
    const auto away = [&](const Seen& at) { return std::hypot(at.x - pixel.x, at.y - pixel.y); };
    float least = reach;
    for (const Seen& at : around) least = std::min(least, away(at));
    std::optional<glm::dvec3> nearest;
    double depth = INFINITY;
    for (const Seen& at : around) {
        const float off = away(at);
        if (off >= reach || off > least + kSamePlace) continue;
        const glm::dvec3& place = places[at.place];
        const double behind = glm::dot(place - now.eye, now.forward);
        if (behind < depth) depth = behind, nearest = place;
    }
    return nearest;
}

std::vector<glm::dvec3> meshVertices(const Graph& graph, const std::string& scope,
                                     const std::set<std::string>& except, const std::string& pinned,
                                     double seconds) {
    const Moment moment(graph, scope, seconds);
    const Graph& now = moment.graph();
    const Placement outside = placementOf(now, scope, pinned);
    std::vector<glm::dvec3> vertices;
    for (const Node& node : nodesOf(now, scope)) {
        const std::string path = meshPathOf(node);
        if (path.empty() || except.contains(node.id)) continue;
        const auto way = wayToShown(now, scope, node.id, pinned);
        if (!way || std::ranges::any_of(*way, [&](const std::string& id) { return except.contains(id); }))
            continue;
        const Placement placement = placementAlong(now, scope, *way).then(outside);
        if (!placement.why.empty()) continue;  // it is not where that says
        const Result<TriangleMeshPtr> mesh = readTriangleMesh(graph.path, path);
        if (!mesh) continue;
        for (const glm::vec3& at : (*mesh)->positions) {
            if (vertices.size() == kMostVertices) return vertices;
            vertices.push_back(placement.of(glm::dvec3(at)));
        }
    }
    return vertices;
}

}  // namespace fw::editor
