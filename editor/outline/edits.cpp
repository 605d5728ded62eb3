#include "editor/outline/edits.h"

#include <algorithm>
#include <cmath>

namespace fw::editor::outline {

namespace {

double squared(Position a, Position b) {
    const double x = a[0] - b[0], y = a[1] - b[1];
    return x * x + y * y;
}

/// Where on the segment it is nearest to the place.
Position nearest(Position a, Position b, Position place) {
    const double x = b[0] - a[0], y = b[1] - a[1], length = x * x + y * y;
    const double t =
        length > 0.0 ? std::clamp(((place[0] - a[0]) * x + (place[1] - a[1]) * y) / length, 0.0, 1.0) : 0.0;
    return {a[0] + t * x, a[1] + t * y};
}

void put(Points& points, std::size_t index, Position place) {
    points.numbers.insert(points.numbers.begin() + std::ptrdiff_t(2 * index), {place[0], place[1]});
    Selection shifted;
    for (const std::size_t each : points.selected) shifted.insert(each >= index ? each + 1 : each);
    points.selected = std::move(shifted);
}

/// The other way around; the first point stays the first.
Points reversed(const Points& points) {
    Points result;
    const std::size_t count = points.count();
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t from = (count - i) % count;
        const Position place = points.at(from);
        result.numbers.insert(result.numbers.end(), {place[0], place[1]});
        if (points.selected.contains(from)) result.selected.insert(i);
    }
    return result;
}

double turn(Position a, Position b, Position c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Whether c, which lies on the line through a and b, lies between them.
bool between(Position a, Position b, Position c) {
    return std::min(a[0], b[0]) <= c[0] && c[0] <= std::max(a[0], b[0]) && std::min(a[1], b[1]) <= c[1] &&
           c[1] <= std::max(a[1], b[1]);
}

bool meet(Position a, Position b, Position c, Position d) {
    const double p = turn(a, b, c), q = turn(a, b, d), r = turn(c, d, a), s = turn(c, d, b);
    if (((p > 0 && q < 0) || (p < 0 && q > 0)) && ((r > 0 && s < 0) || (r < 0 && s > 0))) return true;
    return (p == 0 && between(a, b, c)) || (q == 0 && between(a, b, d)) || (r == 0 && between(c, d, a)) ||
           (s == 0 && between(c, d, b));
}

}  // namespace

std::optional<std::size_t> pointAt(const Points& points, Position place, double reach) {
    std::optional<std::size_t> found;
    double least = reach * reach;
    for (std::size_t i = 0; i < points.count(); ++i)
        if (const double away = squared(points.at(i), place); away <= least) found = i, least = away;
    return found;
}

std::optional<Spot> sideAt(const Points& points, Position place, double reach) {
    std::optional<Spot> found;
    double least = reach * reach;
    for (std::size_t i = 0; i < points.count(); ++i) {
        const Position spot = nearest(points.at(i), points.at((i + 1) % points.count()), place);
        if (const double away = squared(spot, place); away <= least) found = Spot{i, spot}, least = away;
    }
    return found;
}

Points moved(Points points, Position by, double step) {
    for (const std::size_t point : points.selected)
        for (std::size_t axis = 0; axis < 2; ++axis) {
            double& number = points.numbers[2 * point + axis];
            number += by[axis];
            if (step > 0.0) number = std::round(number / step) * step;
            // What is near to a short number is that number.
            number = std::round(number * 1e9) / 1e9;
            if (number == 0.0) number = 0.0;  // no -0
        }
    return points;
}

Points inserted(Points points, std::size_t after, Position place) {
    put(points, after + 1, place);
    points.selected = {after + 1};
    return points;
}

Points divided(Points points) {
    for (std::size_t i = points.count(); i-- > 0;) {
        const std::size_t next = (i + 1) % points.count();
        if (!points.selected.contains(i) || !points.selected.contains(next)) continue;
        const Position a = points.at(i), b = points.at(next);
        put(points, i + 1, {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])});
        points.selected.insert(i + 1);
    }
    return points;
}

Points removed(const Points& points) {
    if (points.count() < kLeastPoints + points.selected.size()) return points;
    Points result;
    for (std::size_t i = 0; i < points.count(); ++i)
        if (!points.selected.contains(i))
            result.numbers.insert(result.numbers.end(), {points.at(i)[0], points.at(i)[1]});
    return result;
}

Points flipped(const Points& points, int axis) {
    Points result = points;
    for (std::size_t i = 0; i < points.count(); ++i) {
        double& number = result.numbers[2 * i + std::size_t(axis)];
        number = number == 0.0 ? 0.0 : -number;
    }
    return reversed(result);
}

Points mirrored(const Points& points, int axis) {
    const std::size_t along = std::size_t(axis), count = points.count();
    // The part goes once through the outline, from where it comes in to where it leaves.
    std::size_t first = count;
    for (std::size_t i = 0; i < count; ++i)
        if (points.at(i)[along] >= 0.0 && points.at((i + count - 1) % count)[along] < 0.0) first = i;
    if (count == 0) return points;
    if (first == count) {  // all on one side
        if (points.at(0)[along] < 0.0) return points;
        first = 0;
        // Begin at the axis, so that the two halves meet there.
        for (std::size_t i = 1; i < count; ++i)
            if (points.at(i)[along] < points.at(first)[along]) first = i;
        for (std::size_t i = 0; i < count; ++i)
            if (points.at(i)[along] == points.at(first)[along] &&
                points.at((i + count - 1) % count)[along] == points.at(first)[along])
                first = i;
    }
    Points result;
    const auto cut = [&](std::size_t from, std::size_t to) {  // where the side crosses the axis
        const Position a = points.at(from), b = points.at(to);
        const double t = a[along] / (a[along] - b[along]);
        Position place = {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
        place[along] = 0.0;
        result.numbers.insert(result.numbers.end(), {place[0], place[1]});
    };
    const std::size_t before = (first + count - 1) % count;
    if (points.at(before)[along] < 0.0 && points.at(first)[along] > 0.0) cut(before, first);
    std::size_t i = first;
    for (std::size_t gone = 0; gone < count && points.at(i)[along] >= 0.0; ++gone, i = (i + 1) % count)
        result.numbers.insert(result.numbers.end(), {points.at(i)[0], points.at(i)[1]});
    const std::size_t last = (i + count - 1) % count;
    if (points.at(i)[along] < 0.0 && points.at(last)[along] > 0.0) cut(last, i);
    for (std::size_t back = result.count(); back-- > 0;) {
        Position place = result.at(back);
        if (place[along] == 0.0) continue;  // on the axis it is its own image
        place[along] = -place[along];
        result.numbers.insert(result.numbers.end(), {place[0], place[1]});
    }
    return result.count() < kLeastPoints ? points : result;
}

Selection within(const Points& points, Position lo, Position hi) {
    Selection found;
    for (std::size_t i = 0; i < points.count(); ++i) {
        const Position at = points.at(i);
        if (at[0] >= std::min(lo[0], hi[0]) && at[0] <= std::max(lo[0], hi[0]) &&
            at[1] >= std::min(lo[1], hi[1]) && at[1] <= std::max(lo[1], hi[1]))
            found.insert(i);
    }
    return found;
}

double twiceArea(const Points& points) {
    double sum = 0.0;
    for (std::size_t i = 0; i < points.count(); ++i) {
        const Position a = points.at(i), b = points.at((i + 1) % points.count());
        sum += a[0] * b[1] - b[0] * a[1];
    }
    return sum;
}

bool crossesItself(const Points& points) {
    const std::size_t count = points.count();
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = i + 2; j < count; ++j) {
            if (i == 0 && j + 1 == count) continue;  // neighbours
            if (meet(points.at(i), points.at(i + 1), points.at(j), points.at((j + 1) % count))) return true;
        }
    return false;
}

}  // namespace fw::editor::outline
