#include "graph/compile/copies.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <random>
#include <utility>

#include "graph/document/timeline.h"

namespace fw {
namespace {

/// Places at which a node is asked for its map; of so many it must be a similarity, for a few may lie where
/// it jumps.
constexpr std::size_t kPlaces = 96, kMostOdd = 8;
/// Of the largest number: what double precision loses in a map that is a similarity is far below.
constexpr double kNoSimilarity = 1e-6;

/// Places in the box, the same on every run.
std::vector<Point> somePlaces(const Box& box) {
    std::mt19937_64 random(1);
    std::vector<Point> places(kPlaces);
    for (Point& place : places)
        for (std::size_t axis = 0; axis < 3; ++axis)
            place[axis] = box.lo[axis] + (box.hi[axis] - box.lo[axis]) * (double(random() >> 11) * 0x1p-53);
    return places;
}

bool isNear(const AffineMap& a, const AffineMap& b, double length) {
    for (std::size_t i = 0; i < 3; ++i) {
        if (!(std::abs(a.move[i] - b.move[i]) <= kNoSimilarity * length)) return false;
        for (std::size_t k = 0; k < 3; ++k)
            if (!(std::abs(a.turn[i][k] - b.turn[i][k]) <= kNoSimilarity)) return false;
    }
    return true;
}

bool haveCopies(const std::vector<Solid>& solids) {
    return std::ranges::any_of(solids, [](const Solid& solid) { return solid.copied.has_value(); });
}

class SolidFinder {
  public:
    SolidFinder(const AskedGraph& graph, double seconds, const Box& box, const CompileOptions& options,
                std::size_t most_)
        : asked(graph),
          time(timelineTime(graph.timeline(), seconds)),
          region(box),
          how(options),
          most(most_) {
        how.time = time;
    }

    std::vector<Solid> find() {
        std::vector<Solid> solids = walk(asked.shown());
        return haveCopies(solids) && solids.size() <= most ? std::move(solids) : std::vector<Solid>{};
    }

  private:
    std::vector<Solid> whole(const Link& link, const Node& node) const {
        std::vector<Solid> solids;
        solids.push_back({AskedGraph::nameOf(node), asked.showing(link, steps), {}});
        return solids;
    }

    std::vector<Solid> walk(const Link& link) {
        const Node* node = asked.onlyOutputOf(link);
        if (!node) {
            const Node* any = asked.graph().node(link.node);
            return any ? whole(link, *any) : std::vector<Solid>{};
        }
        if (++visited > 4 * most) return whole(link, *node);
        const std::vector<std::string> surfaces = asked.surfacesOf(*node);
        const auto behind = [&](std::size_t i) { return *AskedGraph::linkOf(*node, surfaces[i]); };
        if (surfaces.size() == 2 && asked.isUnion(*node, surfaces[0], surfaces[1])) {
            std::vector<Solid> solids = walk(behind(0)), others = walk(behind(1));
            std::ranges::move(others, std::back_inserter(solids));
            return haveCopies(solids) ? std::move(solids) : whole(link, *node);
        }
        if (surfaces.size() != 1) return whole(link, *node);
        const std::vector<Pose> poses = asked.posesOf(*node, surfaces[0]);
        steps.push_back({node->id, surfaces[0]});
        carries.push_back(!poses.empty() && poses[0] != Pose{});
        std::vector<Solid> solids;
        if (!poses.empty()) {
            solids = walk(behind(0));
        } else if (std::optional<CopiedContent> content = contentOf(behind(0))) {
            solids.push_back(
                {AskedGraph::nameOf(*node), asked.showing(behind(0), steps), std::move(content)});
        }
        steps.pop_back();
        carries.pop_back();
        return haveCopies(solids) ? std::move(solids) : whole(link, *node);
    }

    /// What is behind the last of the steps, if that makes copies of it.
    std::optional<CopiedContent> contentOf(const Link& content) const {
        // What paints all goes with the content, and what carries it with the map.
        std::vector<Step> paints, ways;
        for (std::size_t i = 0; i + 1 < steps.size(); ++i) (carries[i] ? ways : paints).push_back(steps[i]);
        ways.push_back(steps.back());
        Graph marked = asked.showing(content, ways);
        const std::string mark = AskedGraph::addField(marked, "s = content;\ns.emission = p;\nreturn s;",
                                                      {{"content", AskedGraph::linkTo(content)}});
        marked.node(ways.back().node)->set(ways.back().input, AskedGraph::linkTo({mark, ""}));
        Result<Program> map = compile(atTime(marked, asked.timeline(), time), how);
        if (!map || !makesCopies(*map)) return std::nullopt;
        return CopiedContent{asked.showing(content, paints), std::move(*map)};
    }

    bool makesCopies(const Program& map) const {
        const std::vector<Point> places = somePlaces(region);
        std::array<std::vector<ValueGradient>, 3> seen;
        for (std::size_t i = 0; i < 3; ++i) {
            seen[i].resize(places.size());
            evaluateGradient(map.ir, map.surface[emissionComponent + i], map.parameters(), places, seen[i]);
        }
        std::vector<AffineMap> maps;
        std::size_t odd = 0;
        for (std::size_t k = 0; k < places.size(); ++k) {
            const AffineMap one = mapAt({seen[0][k].gradient, seen[1][k].gradient, seen[2][k].gradient},
                                        {seen[0][k].value, seen[1][k].value, seen[2][k].value}, places[k]);
            placeOf(one) ? maps.push_back(one) : void(++odd);
            if (odd > kMostOdd) return false;
        }
        return std::ranges::any_of(maps,
                                   [&](const AffineMap& map_) { return !isNear(map_, maps[0], longest()); });
    }

    double longest() const {
        double length = 1.0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            length = std::max({length, std::abs(region.lo[axis]), std::abs(region.hi[axis])});
        return length;
    }

    const AskedGraph& asked;
    double time;  ///< of the timeline
    Box region;
    CompileOptions how;
    std::size_t most, visited = 0;
    std::vector<Step> steps;    ///< on the way
    std::vector<bool> carries;  ///< of each: whether it moves what is behind it
};

}  // namespace

AffineMap mapAt(const std::array<Point, 3>& gradient, const Point& value, const Point& place) {
    AffineMap map{gradient, value};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) map.move[i] -= gradient[i][k] * place[k];
    return map;
}

std::optional<CopyPlace> placeOf(const AffineMap& map) {
    glm::dmat3 turn;  // of columns: the map's transpose, which is its inverse but for the size
    for (int i = 0; i < 3; ++i)
        turn[i] = {map.turn[std::size_t(i)][0], map.turn[std::size_t(i)][1], map.turn[std::size_t(i)][2]};
    const double determinant = glm::determinant(turn), size = 1.0 / std::cbrt(std::abs(determinant));
    if (!(size > 0.0) || !std::isfinite(size)) return std::nullopt;
    turn *= size;
    const glm::dmat3 square = turn * glm::transpose(turn);
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            if (!(std::abs(square[i][k] - (i == k ? 1.0 : 0.0)) <= kNoSimilarity)) return std::nullopt;
    const glm::dvec3 move = -size * (turn * glm::dvec3(map.move[0], map.move[1], map.move[2]));
    if (!std::isfinite(move.x + move.y + move.z)) return std::nullopt;
    const bool mirrored = determinant < 0.0;
    if (mirrored) turn[0] = -turn[0];
    glm::dquat rotation = glm::normalize(glm::quat_cast(turn));
    if (rotation.w < 0.0) rotation = -rotation;
    return CopyPlace{{{move.x, move.y, move.z}, {rotation.x, rotation.y, rotation.z, rotation.w}, size},
                     mirrored};
}

std::vector<Solid> copyingSolids(const Graph& graph, double seconds, const Box& region,
                                 const CompileOptions& options, std::size_t most) {
    const std::optional<AskedGraph> asked = AskedGraph::of(graph, std::span(&seconds, 1), options);
    return asked ? SolidFinder(*asked, seconds, region, options, most).find() : std::vector<Solid>{};
}

}  // namespace fw
