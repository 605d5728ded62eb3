#include "editor/splines/edits.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "graph/document/named_parameters.h"
#include "graph/library/node_type.h"

namespace fw::editor::splines {

namespace {

constexpr std::size_t kSize = 5;

std::vector<double> knotAt(const glm::dvec3& place, double radius, double twist) {
    return {place.x, place.y, place.z, radius, twist};
}
void insertAt(Knots& knots, std::size_t before, const std::vector<double>& numbers) {
    knots.numbers.insert(knots.numbers.begin() + std::ptrdiff_t(kSize * before), numbers.begin(),
                         numbers.end());
}
void place(Knots& knots, std::size_t knot, const glm::dvec3& at) {
    for (int k = 0; k < 3; ++k) knots.numbers[kSize * knot + std::size_t(k)] = at[k];
}
bool isFull(const Knots& knots) { return knots.count() + 3 > kMostKnots; }

}  // namespace

std::string knotsInput(const Node& node) {
    const NodeType* type = findNodeType(node.type);
    if (!type) return "";
    const auto found = std::ranges::find(type->inputs, Type::knots, &InputSpec::type);
    return found == type->inputs.end() ? "" : found->name;
}

std::optional<Knots> knotsOf(const Node& node) {
    const std::string input = knotsInput(node);
    if (input.empty()) return std::nullopt;
    Knots knots;
    knots.numbers = inputNumbers(node, input);
    const NodeType& type = *findNodeType(node.type);
    const InputValue* kind = node.input("kind");
    const std::string* word = kind ? std::get_if<std::string>(&kind->value) : nullptr;
    if (word) knots.kind = splineKindNamed(*word);
    const auto number = [&](const char* name) {
        const std::vector<double> given =
            inputIndex(type, name) < 0 ? std::vector<double>() : inputNumbers(node, name);
        return given.empty() ? 0.0 : given[0];
    };
    knots.closed = number("closed") != 0;
    knots.bend = number("bend");
    if (knots.numbers.size() % kSize != 0) return std::nullopt;
    return knots;
}

SplinePtr splineOf(const Knots& knots) {
    const Result<SplinePtr> spline =
        splineThrough(knotsFrom(knots.numbers), knots.kind, knots.closed, knots.bend);
    return spline ? *spline : nullptr;
}

Knots moved(Knots knots, std::size_t knot, const glm::dvec3& to) {
    const glm::dvec3 by = to - knots.at(knot);
    place(knots, knot, to);
    if (knots.kind != SplineKind::bezier || knot % 3 != 0) return knots;
    const std::size_t count = knots.count();
    if (knot + 1 < count) place(knots, knot + 1, knots.at(knot + 1) + by);
    if (knot > 0)
        place(knots, knot - 1, knots.at(knot - 1) + by);
    else if (knots.closed && count > 2)
        place(knots, count - 1, knots.at(count - 1) + by);
    return knots;
}

std::optional<Inserted> inserted(const Knots& knots, double along) {
    const SplinePtr spline = splineOf(knots);
    if (!spline || spline->knots.size() < 2 || isFull(knots)) return std::nullopt;
    const bool bezier = knots.kind == SplineKind::bezier;
    const std::size_t parts = bezier ? (knots.closed ? knots.count() / 3 : (knots.count() - 1) / 3)
                                     : (knots.closed ? knots.count() : knots.count() - 1);
    if (spline->knots.size() != parts + 1) return std::nullopt;  // some are upon each other
    const auto above = std::ranges::upper_bound(spline->knots, along) - spline->knots.begin();
    const auto part = std::size_t(std::clamp<std::ptrdiff_t>(above - 1, 0, std::ptrdiff_t(parts) - 1));
    const auto arc = std::ranges::find_if(
        spline->arcs, [&](const SpaceArc& each) { return along <= each.begin + 2 * each.half; });
    const SpaceArc& on = arc == spline->arcs.end() ? spline->arcs.back() : *arc;
    const double s = std::clamp(along - on.begin - on.half, -on.half, on.half);
    const glm::dvec3 at = placeOn(on, s);
    const double t = (along - spline->knots[part]) / (spline->knots[part + 1] - spline->knots[part]);
    const std::size_t first = bezier ? 3 * part : part,
                      next = (bezier ? first + 3 : first + 1) % knots.count();
    const double twist = knots.numbers[kSize * first + 4] +
                         t * (knots.numbers[kSize * next + 4] - knots.numbers[kSize * first + 4]);
    const double radius = on.radius + on.radiusSlope * s;
    Inserted result{knots, first + 1};
    if (!bezier) {
        insertAt(result.knots, first + 1, knotAt(at, radius, twist));
        return result;
    }
    // De Casteljau's halves at the parameter whose place is the nearest.
    const glm::dvec3 a = knots.at(first), b = knots.at(first + 1), c = knots.at(first + 2),
                     d = knots.at(next);
    double best = 0.5, nearest = 1e300;
    for (int i = 1; i < 400; ++i) {
        const double w = i / 400.0, u = 1 - w;
        const double far =
            glm::distance(u * u * u * a + 3 * u * u * w * b + 3 * u * w * w * c + w * w * w * d, at);
        if (far < nearest) nearest = far, best = w;
    }
    const auto between = [&](const glm::dvec3& p, const glm::dvec3& q) { return p + best * (q - p); };
    const glm::dvec3 ab = between(a, b), bc = between(b, c), cd = between(c, d), left = between(ab, bc),
                     right = between(bc, cd);
    place(result.knots, first + 1, ab);
    place(result.knots, first + 2, cd);
    for (const glm::dvec3& each : {right, between(left, right), left})
        insertAt(result.knots, first + 2, knotAt(each, radius, twist));
    result.knot = first + 3;
    return result;
}

std::optional<Inserted> extended(const Knots& knots, bool atEnd) {
    if (knots.closed || knots.count() < 2 || isFull(knots)) return std::nullopt;
    const std::size_t last = knots.count() - 1, end = atEnd ? last : 0, before = atEnd ? last - 1 : 1;
    glm::dvec3 by = knots.at(end) - knots.at(before);
    if (!(glm::length(by) > 0)) by = {0.1, 0, 0};
    const double radius = knots.numbers[kSize * end + 3], twist = knots.numbers[kSize * end + 4];
    Inserted result{knots, 0};
    const int many = knots.kind == SplineKind::bezier ? 3 : 1;
    for (int i = 1; i <= many; ++i)
        insertAt(result.knots, atEnd ? result.knots.count() : 0,
                 knotAt(knots.at(end) + double(i) * by, radius, twist));
    result.knot = atEnd ? result.knots.count() - 1 : 0;
    return result;
}

Knots removed(const Knots& knots, std::size_t knot) {
    const std::size_t count = knots.count();
    Knots result = knots;
    const auto erase = [&](std::size_t from, std::size_t many) {
        const auto begin = result.numbers.begin() + std::ptrdiff_t(kSize * from);
        result.numbers.erase(begin, begin + std::ptrdiff_t(kSize * many));
    };
    if (knots.kind != SplineKind::bezier) {
        if (count > 2) erase(knot, 1);
        return result;
    }
    if (knot % 3 != 0 || count < (knots.closed ? 9 : 7)) return knots;
    if (knot == 0 && !knots.closed)
        erase(0, 3);
    else if (knot + 1 == count)
        erase(knot - 2, 3);
    else if (knot == 0) {  // the handle before it is the last
        erase(count - 1, 1);
        erase(0, 2);
        // The other handle of its first curve stands before its second point, which is the first now.
        std::rotate(result.numbers.begin(), result.numbers.begin() + std::ptrdiff_t(kSize),
                    result.numbers.end());
    } else {
        erase(knot - 1, 3);
    }
    return result;
}

}  // namespace fw::editor::splines
