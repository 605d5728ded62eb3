#include "graph/outlines/boundary.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace fw {

namespace {

// Of the painting's extent. What is nearer than kSame is one; gaps that are wider must be seen, so that a
// place beside an arc is nearer to it than that.
constexpr double kSame = 1e-7;
constexpr double kBeside = 0.2 * kSame;
constexpr double kMostListed = 4e6;  // numbers of arcs in rows
// Looks at an arc, for who meets whom and for what a place is in: a second or so of them. Drawings, and pages
// of letters, take a hundredth.
constexpr std::size_t kMostLooks = 100'000'000;

/// The plain arcs of all fills, those of clips behind the others, with the fill that each is of.
struct AllArcs {
    struct Item {
        Arc arc;
        uint32_t fill;
        uint32_t next;  ///< the arc that follows in the contour
    };
    std::vector<Item> items;
    std::vector<const Fill*> fills;
    std::vector<std::vector<uint32_t>> clips;  ///< numbers of their fills
    glm::dvec2 lo{1e300, 1e300}, hi{-1e300, -1e300};
    double extent = 0;

    explicit AllArcs(const Painting& painting) {
        for (const Fill& fill : painting.fills) add(fill);
        for (const std::vector<Fill>& clip : painting.clips) {
            clips.emplace_back();
            for (const Fill& fill : clip) {
                clips.back().push_back(uint32_t(fills.size()));
                add(fill);
            }
        }
        extent = items.empty() ? 0 : std::max(hi.x - lo.x, hi.y - lo.y);
    }

  private:
    void add(const Fill& fill) {
        const auto number = uint32_t(fills.size());
        fills.push_back(&fill);
        std::vector<Arc> plain;
        for (const Contour& contour : fill.contours) {
            plain.clear();
            for (const Arc& arc : contour.arcs)
                if (arc.a != arc.b) addPlain(arc, plain);
            if (plain.empty()) continue;
            const glm::dvec2 end = plain.back().b, start = plain.front().a;
            if (end != start) plain.push_back(arcBetween(end, start));
            const auto first = uint32_t(items.size());
            for (const Arc& arc : plain) {
                items.push_back({arc, number, uint32_t(items.size() + 1)});
                lo = glm::min(lo, arc.a), hi = glm::max(hi, arc.a);
            }
            items.back().next = first;
        }
    }
};

/// Counts windings along rays to the right, by rows of arcs.
class Windings {
  public:
    Windings(const AllArcs& all_, const Painting& painting)
        : all(all_), fillsPainted(uint32_t(painting.fills.size())) {
        // So that all rows together do not list arcs much more often than there are any.
        double tall = 0;
        for (const AllArcs::Item& item : all.items) tall += std::abs(item.arc.b.y - item.arc.a.y);
        const double height = all.hi.y - all.lo.y, most = tall > 0 ? kMostListed * height / tall : 1;
        count = std::size_t(std::clamp(0.25 * double(all.items.size()), 1.0, std::clamp(most, 1.0, 4096.0)));
        rows.resize(count);
        for (uint32_t i = 0; i < all.items.size(); ++i) {
            const Arc& arc = all.items[i].arc;
            for (std::size_t row = rowOf(std::min(arc.a.y, arc.b.y));
                 row <= rowOf(std::max(arc.a.y, arc.b.y)); ++row)
                rows[row].push_back(i);
        }
        turns.resize(all.fills.size());
    }

    bool isInside(glm::dvec2 p) {
        const std::vector<uint32_t>& row = rows[rowOf(p.y)];
        looked += row.size();
        for (const uint32_t fill : crossed) turns[fill] = 0;
        crossed.clear();
        for (const uint32_t i : row) {
            const Arc& arc = all.items[i].arc;
            const bool rises = arc.b.y > arc.a.y;
            if ((arc.a.y <= p.y) == (arc.b.y <= p.y) || isLeft(arc, p) != rises) continue;
            turns[all.items[i].fill] += rises ? 1 : -1;
            crossed.push_back(all.items[i].fill);
        }
        return std::ranges::any_of(crossed, [&](uint32_t fill) {
            return fill < fillsPainted && has(fill) &&
                   std::ranges::all_of(all.fills[fill]->clips, [&](uint32_t clip) {
                       looked += all.clips[clip].size();
                       return std::ranges::any_of(all.clips[clip], [&](uint32_t of) { return has(of); });
                   });
        });
    }
    std::size_t looks() const { return looked; }

  private:
    std::size_t rowOf(double y) const {
        const double height = all.hi.y - all.lo.y;
        return height > 0
                   ? std::size_t(std::clamp((y - all.lo.y) / height * double(count), 0.0, double(count - 1)))
                   : 0;
    }
    bool has(uint32_t fill) const {
        return all.fills[fill]->evenOdd ? turns[fill] % 2 != 0 : turns[fill] != 0;
    }

    const AllArcs& all;
    uint32_t fillsPainted;
    std::size_t count, looked = 0;
    std::vector<std::vector<uint32_t>> rows;
    std::vector<int> turns;         ///< of each fill
    std::vector<uint32_t> crossed;  ///< fills that have some
};

/// Where the whole circles or lines of two arcs meet: at most two places.
std::vector<glm::dvec2> meetings(const Arc& one, const Arc& other) {
    // Circles are k q.q - 2 q.n + c = 0 about the first arc's end.
    const glm::dvec2 away = other.a - one.a;
    const double k1 = one.bend, k2 = other.bend;
    const glm::dvec2 n2 = other.normal + k2 * away;
    const double c2 = k2 * glm::dot(away, away) + 2 * glm::dot(away, other.normal);
    // Their difference, in which the squares cancel, is a line: 2 q.g = h.
    const glm::dvec2 g = k1 * n2 - k2 * one.normal;
    const double h = k1 * c2;
    // Lines have none: then one of them is the line, and the other is what it is cut with.
    const bool straight = k1 == 0;
    const glm::dvec2 normal = straight ? one.normal : k2 == 0 ? n2 : g;
    const double offset = straight ? 0 : k2 == 0 ? c2 : h;
    const double size2 = glm::dot(normal, normal);
    if (!(size2 > 1e-24 * (k1 * k1 + k2 * k2) + 1e-300)) return {};  // the same centre
    const glm::dvec2 foot = normal * (0.5 * offset / size2), along = rightOf(normal) / std::sqrt(size2);
    const double k = straight ? k2 : k1, c = straight ? c2 : 0;
    const glm::dvec2 n = straight ? n2 : one.normal;
    // k t^2 + 2 half t + rest = 0 along the line.
    const double half = k * glm::dot(foot, along) - glm::dot(n, along);
    const double rest = k * glm::dot(foot, foot) - 2 * glm::dot(n, foot) + c;
    const double root2 = half * half - k * rest;
    std::vector<glm::dvec2> places;
    if (root2 < 0) return places;
    const double sum = -half - std::copysign(std::sqrt(root2), half);
    if (sum != 0) places.push_back(one.a + foot + rest / sum * along);
    if (k != 0) places.push_back(one.a + foot + sum / k * along);
    return places;
}

/// The parts of an arc between places on it.
struct Parting {
    std::vector<std::pair<double, glm::dvec2>> places;  ///< how far along the chord, and where
};

class Parter {
  public:
    explicit Parter(const AllArcs& all_)
        : all(all_), same(kSame * all.extent), partings(all.items.size()), touched(all.items.size(), false) {
        // Cells with about as many arcs as there are cells.
        const glm::dvec2 size = all.hi - all.lo;
        cell = std::max({std::sqrt(size.x * size.y / double(all.items.size())), all.extent / 4096, 1e-300});
        for (uint32_t i = 0; i < all.items.size() && looked <= kMostLooks; ++i) {
            const auto [lo, hi] = cellsOf(all.items[i].arc);
            looked += std::size_t(10 * (hi.first - lo.first + 1) * (hi.second - lo.second + 1));
            for (int64_t y = lo.second; y <= hi.second; ++y)
                for (int64_t x = lo.first; x <= hi.first; ++x) cells[x << 32 | y].push_back(i);
        }
        for (const auto& [where, list] : cells)
            for (std::size_t i = 0; i < list.size() && looked <= kMostLooks; ++i) {
                looked += list.size() - i;
                for (std::size_t j = i + 1; j < list.size(); ++j) meet(list[i], list[j], where);
            }
    }
    std::size_t looks() const { return looked; }

    /// In order from its first end to its last.
    std::vector<Arc> partsOf(uint32_t i) {
        const Arc& arc = all.items[i].arc;
        auto& places = partings[i].places;
        std::ranges::sort(places, {}, [](const auto& place) { return place.first; });
        std::vector<Arc> parts;
        glm::dvec2 from = arc.a;
        for (const auto& [share, place] : places)
            if (glm::distance(place, from) > same && glm::distance(place, arc.b) > same) {
                parts.push_back(arcBetween(from, place, arc.bend));
                from = place;
            }
        parts.push_back(arcBetween(from, arc.b, arc.bend));
        return parts;
    }
    /// Whether another contour comes to the first end of an arc.
    bool isTouched(uint32_t i) const { return touched[i]; }
    bool anyTouched() const { return any; }

  private:
    using Cell = std::pair<int64_t, int64_t>;
    std::pair<Cell, Cell> cellsOf(const Arc& arc) const {
        const glm::dvec2 lo = glm::min(arc.a, arc.b) - all.lo - same,
                         hi = glm::max(arc.a, arc.b) - all.lo + same;
        const auto at = [&](double x) { return int64_t(std::max(0.0, std::floor(x / cell))); };
        return {{at(lo.x), at(lo.y)}, {at(hi.x), at(hi.y)}};
    }

    void meet(uint32_t i, uint32_t j, int64_t where) {
        const Arc &one = all.items[i].arc, &other = all.items[j].arc;
        const glm::dvec2 lo = glm::max(glm::min(one.a, one.b), glm::min(other.a, other.b)),
                         hi = glm::min(glm::max(one.a, one.b), glm::max(other.a, other.b));
        if (lo.x > hi.x + same || lo.y > hi.y + same) return;
        // In the first of the cells that both are in.
        const auto first = [&](double x) { return int64_t(std::max(0.0, std::floor((x - same) / cell))); };
        if ((first(lo.x - all.lo.x) << 32 | first(lo.y - all.lo.y)) != where) return;
        looked += 20;  // so much longer does it take from here on
        const bool follows = all.items[i].next == j, precedes = all.items[j].next == i;
        const auto isEnd = [&](const Arc& arc, glm::dvec2 p) {
            return glm::distance(p, arc.a) <= same || glm::distance(p, arc.b) <= same;
        };
        // An end of one arc that lies on the other; `of` is the arc that begins there.
        const auto touch = [&](uint32_t of, glm::dvec2 p, uint32_t on, bool joined) {
            if (joined || distanceTo(all.items[on].arc, p) > same) return;
            touched[of] = any = true;
            if (!isEnd(all.items[on].arc, p)) part(on, p);
        };
        touch(j, other.a, i, follows), touch(all.items[j].next, other.b, i, precedes);
        touch(i, one.a, j, precedes), touch(all.items[i].next, one.b, j, follows);
        for (const glm::dvec2 p : meetings(one, other)) {
            if (distanceTo(one, p) > same || distanceTo(other, p) > same) continue;
            if (!isEnd(one, p) && !isEnd(other, p)) part(i, p), part(j, p);
        }
    }

    /// At its own place that is the nearest: an arc that were bent to the other's would leave its windings.
    void part(uint32_t i, glm::dvec2 p) {
        const Arc& arc = all.items[i].arc;
        const glm::dvec2 towards = arc.normal - arc.bend * (p - arc.a);
        const glm::dvec2 own = p - sideOf(arc, p) / glm::length(towards) * towards;
        partings[i].places.emplace_back(glm::dot(own - arc.a, arc.b - arc.a), own);
    }

    const AllArcs& all;
    double same, cell;
    std::vector<Parting> partings;
    std::vector<bool> touched;
    bool any = false;
    std::size_t looked = 0;
    std::unordered_map<int64_t, std::vector<uint32_t>> cells;
};

}  // namespace

struct Painted::Inner {
    AllArcs all;
    Windings windings;
    explicit Inner(const Painting& painting) : all(painting), windings(all, painting) {}
};

Painted::Painted(const Painting& painting) : inner(std::make_unique<Inner>(painting)) {}
Painted::Painted(Painted&&) noexcept = default;
Painted::~Painted() = default;

bool Painted::has(glm::dvec2 p) const { return inner->windings.isInside(p); }

std::optional<std::vector<Arc>> Painted::boundary() const {
    const AllArcs& all = inner->all;
    Windings& windings = inner->windings;
    if (all.items.empty() || !(all.extent > 0)) return std::vector<Arc>();
    Parter parter(all);
    if (parter.looks() > kMostLooks) return std::nullopt;
    std::vector<Arc> boundary, chain;
    const double beside = kBeside * all.extent;
    // A chain ends where another contour comes to it.
    const auto end = [&] {
        if (chain.empty()) return;
        const Arc& longest =
            *std::ranges::max_element(chain, {}, [](const Arc& arc) { return glm::distance(arc.a, arc.b); });
        const glm::dvec2 middle = placeOn(longest, 0.5),
                         normal = longest.normal - longest.bend * (middle - longest.a);
        const bool left = windings.isInside(middle + beside * normal),
                   right = windings.isInside(middle - beside * normal);
        if (left != right)
            for (const Arc& arc : chain) boundary.push_back(left ? arc : reversed(arc));
        chain.clear();
    };
    std::vector<bool> done(all.items.size(), false);
    for (uint32_t first = 0; first < all.items.size(); ++first) {
        if (done[first]) continue;
        // From such a place, if the contour has one.
        uint32_t start = first;
        for (uint32_t i = all.items[first].next; i != first && !parter.isTouched(start);
             i = all.items[i].next)
            start = i;
        for (uint32_t i = start; !done[i]; i = all.items[i].next) {
            done[i] = true;
            if (parter.isTouched(i)) end();
            const std::vector<Arc> parts = parter.partsOf(i);
            for (std::size_t k = 0; k < parts.size(); ++k) {
                if (k > 0) end();
                if (parts[k].a != parts[k].b) chain.push_back(parts[k]);
            }
            if (windings.looks() > kMostLooks) return std::nullopt;
        }
        end();
    }
    if (!parter.anyTouched()) return boundary;
    // Of those that lie upon each other one stays.
    const double same = 4 * kSame * all.extent;
    std::ranges::sort(boundary, {}, [](const Arc& arc) { return std::pair(placeOn(arc, 0.5).x, arc.a.x); });
    std::vector<Arc> once;
    for (const Arc& arc : boundary) {
        const glm::dvec2 middle = placeOn(arc, 0.5);
        bool known = false;
        for (std::size_t i = once.size(); i-- > 0 && !known;) {
            if (placeOn(once[i], 0.5).x < middle.x - same) break;
            known = glm::distance(placeOn(once[i], 0.5), middle) <= same &&
                    glm::distance(once[i].a, arc.a) <= same && glm::distance(once[i].b, arc.b) <= same;
        }
        if (!known) once.push_back(arc);
    }
    return once;
}

Result<OutlinePtr> outlineOf(const Painting& painting, const std::string& what, const std::string& remedy) {
    const Painted painted(painting);
    std::optional<std::vector<Arc>> arcs = painted.boundary();
    if (!arcs) return Error{what + " crosses itself or lies upon itself far too often, so " + remedy};
    if (arcs->empty()) return OutlinePtr();
    if (arcs->size() > kMostArcs)
        return Error{what + " has an outline of " + std::to_string(arcs->size()) + " arcs: at most " +
                     std::to_string(kMostArcs) + " can be used, so " + remedy};
    return OutlinePtr(
        std::make_shared<const Outline>(std::move(*arcs), [&](glm::dvec2 p) { return painted.has(p); }));
}

}  // namespace fw
