#include "runtime/textures/pack.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>
#include <numeric>
#include <utility>

namespace fw {
namespace {

constexpr int kTurns = 16;               ///< of a quarter turn
constexpr int kTries = 30;               ///< of a density
constexpr float kFirstFill = 0.75f;      ///< of the square, that is tried first
constexpr int kCellsAlong = 256;         ///< of the square, at most
constexpr std::size_t kMostTurned = 64;  ///< charts, that all four ways to turn them are tried of

glm::vec2 turned(glm::vec2 p, float angle) {
    const float c = std::cos(angle), s = std::sin(angle);
    return {c * p.x - s * p.y, s * p.x + c * p.y};
}

struct Bounds2 {
    glm::vec2 low{1e30f}, high{-1e30f};
    void add(glm::vec2 p) { low = glm::min(low, p), high = glm::max(high, p); }
    glm::vec2 size() const { return high - low; }
};

/// The corners of the convex hull, which has the same bounds however it is turned (Andrew 1979).
std::vector<glm::vec2> hullOf(std::vector<glm::vec2> points) {
    std::ranges::sort(points, [](glm::vec2 a, glm::vec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    std::vector<glm::vec2> hull;
    for (int side = 0; side < 2; ++side) {
        const std::size_t first = hull.size();
        for (const glm::vec2 p : points) {
            const auto bends = [&] {
                const glm::vec2 a = hull[hull.size() - 2], b = hull.back();
                return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) <= 0.0f;
            };
            while (hull.size() >= first + 2 && bends()) hull.pop_back();
            hull.push_back(p);
        }
        hull.pop_back();
        std::ranges::reverse(points);
    }
    return hull.empty() ? points : hull;
}

/// Turned upright within the least bounds, which begin at 0.
FlatChart upright(const FlatChart& chart) {
    const std::vector<glm::vec2> hull = hullOf(chart.corners);
    float best = 0.0f, least = 1e30f;
    for (int i = 0; i < kTurns; ++i) {
        const float angle = float(i) / kTurns * std::numbers::pi_v<float> / 2;
        Bounds2 bounds;
        for (const glm::vec2 p : hull) bounds.add(turned(p, angle));
        const float area = bounds.size().x * bounds.size().y;
        if (area < least * 0.999f) best = angle, least = area;
    }
    Bounds2 bounds;
    for (const glm::vec2 p : hull) bounds.add(turned(p, best));
    if (bounds.size().x > bounds.size().y) {
        best += std::numbers::pi_v<float> / 2;
        bounds = {};
        for (const glm::vec2 p : hull) bounds.add(turned(p, best));
    }
    FlatChart made;
    for (const glm::vec2 p : chart.corners)
        made.corners.push_back(glm::max(turned(p, best) - bounds.low, 0.0f));
    return made;
}

/// Cells that a chart touches, with a margin about it: rows of bits.
struct Mask {
    int width = 0, height = 0, words = 0;
    std::vector<uint64_t> bits = {};
    int first = 0;  ///< cell of the lowest row that is touched

    uint64_t* row(int y) { return &bits[std::size_t(y) * std::size_t(words)]; }
    const uint64_t* row(int y) const { return &bits[std::size_t(y) * std::size_t(words)]; }
};

/// What there is of a triangle at heights from `low` to `high`.
void widen(const glm::vec2* corners, float low, float high, float& left, float& right) {
    for (int i = 0; i < 3; ++i) {
        glm::vec2 from = corners[i], to = corners[(i + 1) % 3];
        if (to.y < from.y) std::swap(from, to);
        if (to.y < low || from.y > high) continue;
        const auto at = [&](float y) {
            const float part = to.y > from.y ? (y - from.y) / (to.y - from.y) : 0.0f;
            return from.x + (to.x - from.x) * std::clamp(part, 0.0f, 1.0f);
        };
        const float a = at(std::max(low, from.y)), b = at(std::min(high, to.y));
        left = std::min({left, a, b});
        right = std::max({right, a, b});
        if (from.y == to.y) left = std::min(left, to.x), right = std::max(right, to.x);
    }
}

/// The chart begins at `margin` texels from the mask's least corner.
Mask maskOf(const FlatChart& chart, float density, int margin, int cell) {
    glm::vec2 most(0.0f);
    for (const glm::vec2 p : chart.corners) most = glm::max(most, p);
    const auto cells = [&](float extent) {
        return (int(std::ceil(extent * density)) + 2 * margin) / cell + 1;
    };
    Mask mask{.width = cells(most.x), .height = cells(most.y)};
    mask.words = (mask.width + 63) / 64;
    mask.bits.assign(std::size_t(mask.words) * std::size_t(mask.height), 0);
    const auto wide = float(margin), side = float(cell);
    for (std::size_t i = 0; i + 2 < chart.corners.size(); i += 3) {
        const glm::vec2 corners[] = {density * chart.corners[i] + wide, density * chart.corners[i + 1] + wide,
                                     density * chart.corners[i + 2] + wide};
        const float low = std::min({corners[0].y, corners[1].y, corners[2].y}) - wide,
                    high = std::max({corners[0].y, corners[1].y, corners[2].y}) + wide;
        for (int y = std::max(0, int(low / side)); y <= std::min(mask.height - 1, int(high / side)); ++y) {
            float left = 1e30f, right = -1e30f;
            widen(corners, float(y) * side - wide, float(y + 1) * side + wide, left, right);
            if (left > right) continue;
            const int from = std::max(0, int((left - wide) / side)),
                      to = std::min(mask.width - 1, int((right + wide) / side));
            for (int x = from; x <= to; ++x) mask.row(y)[x / 64] |= uint64_t(1) << (x % 64);
        }
    }
    while (mask.first < mask.width && !(mask.row(0)[mask.first / 64] >> (mask.first % 64) & 1)) ++mask.first;
    return mask;
}

/// The square, cell by cell.
class Sheet {
  public:
    explicit Sheet(int cells_)
        : cells(cells_), words(cells_ / 64 + 2), bits(std::size_t(words) * std::size_t(cells_), 0) {}

    /// The lowest place where the mask fits, and of those the leftmost.
    std::optional<glm::ivec2> placeFor(const Mask& mask, int below) const {
        for (int y = 0; y + mask.height <= std::min(cells, below); ++y)
            for (int word = 0; word < words; ++word) {
                uint64_t free = ~row(y)[word];
                for (; free != 0; free &= free - 1) {
                    const int x = 64 * word + std::countr_zero(free) - mask.first;
                    if (x + mask.width > cells) break;
                    if (x >= 0 && fits(mask, x, y)) return glm::ivec2(x, y);
                }
            }
        return std::nullopt;
    }

    void put(const Mask& mask, glm::ivec2 at) {
        for (int y = 0; y < mask.height; ++y)
            for (int word = 0; word < mask.words; ++word) {
                uint64_t* to = &row(at.y + y)[at.x / 64 + word];
                to[0] |= mask.row(y)[word] << (at.x % 64);
                if (at.x % 64 > 0) to[1] |= mask.row(y)[word] >> (64 - at.x % 64);
            }
    }

  private:
    uint64_t* row(int y) { return &bits[std::size_t(y) * std::size_t(words)]; }
    const uint64_t* row(int y) const { return &bits[std::size_t(y) * std::size_t(words)]; }

    bool fits(const Mask& mask, int x, int y) const {
        for (int i = 0; i < mask.height; ++i) {
            const int line = (i + mask.height / 2) % mask.height;  // the widest first
            for (int word = 0; word < mask.words; ++word) {
                const uint64_t* there = &row(y + line)[x / 64 + word];
                const uint64_t wanted = mask.row(line)[word];
                if (there[0] & wanted << (x % 64)) return false;
                if (x % 64 > 0 && there[1] & wanted >> (64 - x % 64)) return false;
            }
        }
        return true;
    }

    int cells, words;
    std::vector<uint64_t> bits;
};

/// A quarter turn to the left, beginning at 0 again.
FlatChart quarterTurned(const FlatChart& chart) {
    float most = 0.0f;
    for (const glm::vec2 p : chart.corners) most = std::max(most, p.y);
    FlatChart made;
    for (const glm::vec2 p : chart.corners) made.corners.emplace_back(most - p.y, p.x);
    return made;
}

struct Place {
    int turns = 0;     ///< quarters
    glm::ivec2 at{0};  ///< where the chart's margin begins, in texels
};

/// Of each chart, which comes in `ways`, each a quarter turned from the one before; nothing if they do not
/// fit.
std::optional<std::vector<Place>> placesOf(const std::vector<std::vector<FlatChart>>& ways, float density,
                                           int margin, int size) {
    const int cell = std::max(1, size / kCellsAlong), cells = size / cell;
    std::vector<std::vector<Mask>> masks(ways.size());
    double area = 0;
    for (std::size_t i = 0; i < ways.size(); ++i) {
        for (const FlatChart& way : ways[i]) masks[i].push_back(maskOf(way, density, margin, cell));
        for (const uint64_t word : masks[i][0].bits) area += std::popcount(word);
        if (area > double(cells) * cells) return std::nullopt;
    }
    std::vector<std::size_t> order(ways.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) {
        return std::max(masks[i][0].height, masks[i][0].width) * 4096 + masks[i][0].height +
               masks[i][0].width;
    });
    Sheet sheet(cells);
    std::vector<Place> places(ways.size());
    for (const std::size_t i : order) {
        std::optional<Place> best;
        int top = cells + 1;
        for (std::size_t way = 0; way < masks[i].size(); ++way)
            if (const auto at = sheet.placeFor(masks[i][way], top - 1)) {
                best = {int(way), *at * cell};
                top = at->y + masks[i][way].height;
            }
        if (!best) return std::nullopt;
        sheet.put(masks[i][std::size_t(best->turns)], best->at / cell);
        places[i] = *best;
    }
    return places;
}

double areaOf(const FlatChart& chart) {
    double area = 0;
    for (std::size_t i = 0; i + 2 < chart.corners.size(); i += 3) {
        const glm::dvec2 a = chart.corners[i], b = chart.corners[i + 1], c = chart.corners[i + 2];
        area += 0.5 * std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    }
    return area;
}

}  // namespace

std::optional<Packing> pack(std::span<const FlatChart> given, int size) {
    std::vector<std::vector<FlatChart>> ways;
    double area = 0;
    for (const FlatChart& chart : given) {
        std::vector<FlatChart>& own = ways.emplace_back();
        own.push_back(upright(chart));
        for (int turn = 1; turn < (given.size() > kMostTurned ? 2 : 4); ++turn)
            own.push_back(quarterTurned(own.back()));
        area += areaOf(chart);
    }
    if (ways.empty()) return std::nullopt;
    Packing packing;
    for (int margin = std::max(1, size / 1024); margin >= 1; --margin) {
        // The most that fits lies between what does and what does not.
        float fits = 0.0f, full = 0.0f;
        float density = float(size) * std::sqrt(kFirstFill / float(std::max(area, 1e-30)));
        std::vector<Place> places;
        for (int i = 0; i < kTries && (full == 0.0f || full > 1.02f * fits); ++i) {
            if (const auto found = placesOf(ways, density, margin, size))
                fits = density, places = *found;
            else
                full = density;
            density = full == 0.0f ? 1.06f * fits : fits == 0.0f ? 0.93f * full : 0.5f * (fits + full);
        }
        if (fits == 0.0f) continue;
        packing.density = fits;
        packing.gutter = 2 * margin;
        packing.covered = area * fits * fits / (double(size) * size);
        for (std::size_t i = 0; i < ways.size(); ++i) {
            const glm::vec2 at = glm::vec2(places[i].at) + float(margin);
            std::vector<glm::vec2>& corners = packing.corners.emplace_back();
            for (const glm::vec2 p : ways[i][std::size_t(places[i].turns)].corners)
                corners.push_back(fits * p + at);
        }
        return packing;
    }
    return std::nullopt;
}

}  // namespace fw
