// DXF files: the flat outlines that CAD programs draw. (Autodesk, DXF Reference, AutoCAD 2012: group codes)
#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <glm/vec3.hpp>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "graph/base/words.h"
#include "graph/outlines/drawing.h"

namespace fw {

namespace {

constexpr double kDxfTolerance = 2e-6;         // of the drawing's extent
constexpr double kJoins = 1e-5;                // of the same: ends that are nearer meet
constexpr std::size_t kMostDxfArcs = 400'000;  // arcs
constexpr std::size_t kMostLines = 100'000;    // that are joined
constexpr int kMostBlocksDeep = 16;            // blocks within blocks
constexpr int kMostInserts = 20'000;
constexpr std::size_t kMostGroups = 2'000'000;  // a code with its value each

/// A line with a code, and a line with its value.
struct Group {
    int code;
    std::string_view value;
};

/// An entity's name and what follows it.
struct Entity {
    std::string_view name;
    std::vector<Group> groups;
    std::string_view text(int code, std::string_view otherwise = {}) const {
        for (const Group& group : groups)
            if (group.code == code) return group.value;
        return otherwise;
    }
    double number(int code, double otherwise) const { return numberOf(text(code), otherwise); }
    static double numberOf(std::string_view text, double otherwise) {
        if (text.starts_with('+')) text.remove_prefix(1);
        double value = 0;
        const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
        return problem == std::errc() && std::abs(value) < 1e12 ? value : otherwise;
    }
    std::vector<double> numbers(int code) const {
        std::vector<double> all;
        for (const Group& group : groups)
            if (group.code == code) all.push_back(numberOf(group.value, 0));
        return all;
    }
    glm::dvec2 place(int x) const { return {number(x, 0), number(x + 10, 0)}; }
    /// Whether it lies in a plane that is seen from below, which mirrors it.
    bool isMirrored() const { return number(230, 1) < 0; }
};

std::string_view trimmedLine(std::string_view line) {
    const std::size_t from = std::min(line.find_first_not_of(" \t"), line.size());
    return line.substr(from, line.find_last_not_of(" \t\r") + 1 - from);
}

/// De Boor's algorithm on points and weights: a rational B-spline as a function of its knots.
struct Spline {
    int degree = 3;
    std::vector<double> knots, weights;
    std::vector<glm::dvec2> controls;

    bool isSound() const {
        return degree >= 1 && degree <= 10 && controls.size() > std::size_t(degree) &&
               knots.size() == controls.size() + std::size_t(degree) + 1 && std::ranges::is_sorted(knots) &&
               (weights.empty() || weights.size() == controls.size()) &&
               std::ranges::all_of(weights, [](double weight) { return weight > 0; });
    }
    double from() const { return knots[std::size_t(degree)]; }
    double to() const { return knots[controls.size()]; }
    glm::dvec2 operator()(double t) const {
        const auto p = std::size_t(degree);
        const auto first = knots.begin() + degree + 1, last = knots.begin() + std::ptrdiff_t(controls.size());
        const auto span = std::size_t(std::upper_bound(first, last, t) - knots.begin()) - 1;
        std::vector<glm::dvec3> d(p + 1);
        for (std::size_t i = 0; i <= p; ++i) {
            const std::size_t at = span - p + i;
            const double w = weights.empty() ? 1 : weights[at];
            d[i] = {w * controls[at].x, w * controls[at].y, w};
        }
        for (std::size_t level = 1; level <= p; ++level)
            for (std::size_t i = p; i >= level; --i) {
                const double lo = knots[span - p + i], hi = knots[span + 1 + i - level];
                const double share = hi > lo ? (t - lo) / (hi - lo) : 0;
                d[i] = (1 - share) * d[i - 1] + share * d[i];
            }
        return glm::dvec2(d[p].x, d[p].y) / d[p].z;
    }
};

/// An angle as one from just above 0 to a whole turn.
double forwardTurn(double angle) {
    const double turn = std::fmod(angle, 2 * std::numbers::pi);
    return turn > 0 ? turn : turn + 2 * std::numbers::pi;
}

class DxfReader {
  public:
    DxfReader(const std::string& layer_, bool open_) : layer(layer_), open(open_) {}

    Result<Drawing> run(std::string_view bytes) {
        if (bytes.starts_with("AutoCAD Binary DXF"))
            return Error{"is a binary DXF file: save it as an ASCII one"};
        if (const std::optional<Error> damaged = sections(bytes)) return *damaged;
        // How far it reaches says how near curves must be followed.
        for (const Entity& entity : entities)
            for (const Group& group : entity.groups)
                if ((group.code >= 10 && group.code <= 13) || (group.code >= 20 && group.code <= 23))
                    extent = std::max(extent, std::abs(Entity::numberOf(group.value, 0)));
        tolerance = kDxfTolerance * std::max(extent, 1e-9);
        draw(entities, PlaneTransform{}, 0, true);
        if (problem) return *problem;
        if (lines.empty() && closed.empty()) {
            if (!layer.empty() && !layers.contains(layer))
                return Error{"has no layer " + inQuotes(layer) + ": it has " +
                             listed({layers.begin(), layers.end()})};
            return Error{"has no closed outline that could be filled" +
                         (remarked.empty() ? "" : ", only " + *remarked.begin())};
        }
        return finished();
    }

  private:
    /// The header's unit, the blocks and the entities. An Error if it is no DXF file, or is cut off.
    std::optional<Error> sections(std::string_view bytes) {
        std::vector<Group> groups;
        std::size_t at = 0;
        int number = 0;
        const auto line = [&]() -> std::optional<std::string_view> {
            if (at >= bytes.size()) return std::nullopt;
            const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
            const std::string_view found = trimmedLine(bytes.substr(at, end - at));
            at = end + 1;
            ++number;
            return found;
        };
        bool ended = false;
        while (const auto first = line()) {
            int code = 0;
            const auto [end, wrong] = std::from_chars(first->data(), first->data() + first->size(), code);
            if (wrong != std::errc() || end != first->data() + first->size()) {
                if (first->empty() && at >= bytes.size()) break;
                return Error{"is damaged in line " + std::to_string(number) +
                             ": a number of a group is expected there"};
            }
            const auto value = line();
            if (!value) return Error{"is cut off: save or copy it again"};
            if (code == 0 && *value == "EOF") {
                ended = true;
                break;
            }
            if (code != 999) groups.push_back({code, *value});
            if (groups.size() > kMostGroups)
                return Error{"has more than " + std::to_string(kMostGroups) +
                             " values: leave away what is no outline"};
        }
        if (groups.empty() || groups.front().code != 0 || groups.front().value != "SECTION")
            return Error{"is no DXF file: it does not begin with a section"};
        if (!ended) return Error{"is cut off: save or copy it again"};
        std::string_view section, variable;
        std::vector<Entity>* into = nullptr;
        for (std::size_t i = 0; i < groups.size(); ++i) {
            const Group& group = groups[i];
            if (group.code == 0) {
                variable = {};
                if (group.value == "SECTION") {
                    section = i + 1 < groups.size() ? groups[i + 1].value : std::string_view();
                    into = section == "ENTITIES" ? &entities : nullptr;
                    continue;
                }
                if (group.value == "ENDSEC") into = nullptr;
                if (section == "BLOCKS" && group.value == "BLOCK") {
                    Entity block{group.value, {}};
                    for (std::size_t k = i + 1; k < groups.size() && groups[k].code != 0; ++k)
                        block.groups.push_back(groups[k]);
                    Block& made = blocks[block.text(2)];
                    made.base = block.place(10);
                    into = &made.entities;
                    continue;
                }
                if (group.value == "ENDBLK") into = nullptr;
                if (into) into->push_back({group.value, {}});
            } else if (into && !into->empty()) {
                into->back().groups.push_back(group);
            } else if (section == "HEADER") {
                if (group.code == 9) variable = group.value;
                if (variable == "$INSUNITS" && group.code == 70) unit = int(Entity::numberOf(group.value, 0));
            }
        }
        return std::nullopt;
    }

    void draw(const std::vector<Entity>& all, const PlaneTransform& to, int depth, bool chosen) {
        for (std::size_t i = 0; i < all.size() && !problem; ++i) {
            const Entity& entity = all[i];
            const std::string own(entity.text(8, "0"));
            layers.insert(own);
            // What lies on layer 0 of a block is on the layer of its insert.
            const bool seen = layer.empty() || own == layer || (depth > 0 && own == "0" && chosen);
            if (entity.name == "INSERT") {
                insert(entity, to, depth, seen);
            } else if (entity.name == "POLYLINE") {
                std::vector<Entity> corners;
                while (i + 1 < all.size() && all[i + 1].name == "VERTEX") corners.push_back(all[++i]);
                if (seen) polyline(entity, corners, to);
            } else if (seen && entity.number(60, 0) == 0 && entity.number(67, 0) == 0) {
                one(entity, to);
            }
        }
    }

    void insert(const Entity& entity, const PlaneTransform& to, int depth, bool seen) {
        const auto block = blocks.find(entity.text(2));
        if (block == blocks.end()) return;
        if (depth >= kMostBlocksDeep)
            return fail("has blocks within blocks more than " + std::to_string(kMostBlocksDeep) +
                        " deep, or in a ring");
        const double angle = entity.number(50, 0) * std::numbers::pi / 180, sx = entity.number(41, 1),
                     sy = entity.number(42, 1);
        const glm::dvec2 along{std::cos(angle), std::sin(angle)};
        const int columns = std::max(1, int(std::min(entity.number(70, 1), 1e4))),
                  rows = std::max(1, int(std::min(entity.number(71, 1), 1e4)));
        for (int row = 0; row < rows && !problem; ++row)
            for (int column = 0; column < columns && !problem; ++column) {
                if (++inserts > kMostInserts)
                    return fail("inserts more than " + std::to_string(kMostInserts) + " blocks: simplify it");
                PlaneTransform own{sx * along, sy * leftOf(along), {0, 0}};
                own.origin = entity.place(10) + column * entity.number(44, 0) * along +
                             row * entity.number(45, 0) * leftOf(along) - own.direction(block->second.base);
                draw(block->second.entities, to * (mirrorOf(entity) * own), depth + 1, seen);
            }
    }

    static PlaneTransform mirrorOf(const Entity& entity) {
        return entity.isMirrored() ? PlaneTransform{{-1, 0}, {0, 1}, {0, 0}} : PlaneTransform{};
    }

    void one(const Entity& entity, const PlaneTransform& outer) {
        constexpr double degree = std::numbers::pi / 180;
        const PlaneTransform to = entity.name == "LINE" || entity.name == "ELLIPSE" || entity.name == "SPLINE"
                                      ? outer
                                      : outer * mirrorOf(entity);
        const double scale = std::max(greatestScale(to), 1e-12);
        Pen pen(tolerance / scale);
        if (entity.name == "LINE") {
            pen.moveTo(entity.place(10));
            pen.lineTo(entity.place(11));
        } else if (entity.name == "CIRCLE" || entity.name == "ARC") {
            const double r = entity.number(40, 0),
                         from = entity.name == "ARC" ? entity.number(50, 0) * degree : 0;
            double until = entity.name == "ARC" ? entity.number(51, 360) * degree : 2 * std::numbers::pi;
            until = from + forwardTurn(until - from);
            if (!(r > 0)) return;
            const glm::dvec2 centre = entity.place(10);
            pen.moveTo(centre + r * glm::dvec2(std::cos(from), std::sin(from)));
            pen.ellipse(centre, {r, 0}, {0, r}, from, until);
            if (entity.name == "CIRCLE") pen.close();
        } else if (entity.name == "ELLIPSE") {
            const glm::dvec2 u = entity.place(11),
                             v = entity.number(40, 1) * leftOf(u) * (entity.isMirrored() ? -1.0 : 1.0);
            const double from = entity.number(41, 0);
            double until = entity.number(42, 2 * std::numbers::pi);
            until = from + forwardTurn(until - from);
            if (!(glm::length(u) > 0)) return;
            const glm::dvec2 centre = entity.place(10);
            pen.moveTo(centre + std::cos(from) * u + std::sin(from) * v);
            pen.ellipse(centre, u, v, from, until);
            if (until - from > 2 * std::numbers::pi - 1e-6) pen.close();
        } else if (entity.name == "LWPOLYLINE") {
            std::vector<Entity> corners;
            for (const Group& group : entity.groups) {
                if (group.code == 10) corners.push_back({"VERTEX", {}});
                if (!corners.empty() && (group.code == 10 || group.code == 20 || group.code == 42))
                    corners.back().groups.push_back(group);
            }
            return polyline(entity, corners, outer);
        } else if (entity.name == "SPLINE") {
            spline(entity, pen);
        } else if (entity.name == "SOLID" || entity.name == "TRACE") {
            pen.moveTo(entity.place(10));
            for (const int corner : {11, 13, 12}) pen.lineTo(entity.place(corner));
            pen.close();
        } else {
            static const std::set<std::string_view> silent = {"POINT",  "SEQEND", "VIEWPORT",
                                                              "VERTEX", "ATTDEF", "ATTRIB",
                                                              "XLINE",  "RAY",    "ACAD_PROXY_ENTITY"};
            if (!silent.contains(entity.name)) remarked.insert(std::string(entity.name.substr(0, 32)));
            return;
        }
        add(moved(pen.taken(), to, tolerance));
    }

    /// Corners, each with the bulge of what leads to the next: the tangent of a quarter of its turn.
    void polyline(const Entity& entity, const std::vector<Entity>& corners, const PlaneTransform& outer) {
        const int flags = int(entity.number(70, 0));
        if ((flags & (16 | 64)) != 0) return void(remarked.insert("POLYLINE of a mesh"));
        const PlaneTransform to = outer * mirrorOf(entity);
        Contour contour{{}, (flags & 1) != 0};
        const std::size_t count = corners.size();
        for (std::size_t i = 0; i + (contour.closed ? 0 : 1) < count; ++i) {
            const glm::dvec2 a = corners[i].place(10), b = corners[(i + 1) % count].place(10);
            const double turn = 4 * std::atan(corners[i].number(42, 0)), chord = glm::distance(a, b);
            if (!(chord > 0)) continue;
            if (std::abs(turn) <= std::numbers::pi) {
                contour.arcs.push_back(arcBetween(a, b, 2 * std::sin(0.5 * turn) / chord));
                continue;
            }
            // More than half a circle: in two halves, by the place farthest from the chord.
            const glm::dvec2 along = (b - a) / chord,
                             top = 0.5 * (a + b) + 0.5 * chord * std::tan(0.25 * turn) * rightOf(along);
            const double half = glm::distance(a, top), bend = 2 * std::sin(0.25 * turn) / half;
            contour.arcs.push_back(arcBetween(a, top, bend));
            contour.arcs.push_back(arcBetween(top, b, bend));
        }
        if (!contour.arcs.empty()) add(moved({contour}, to, tolerance));
    }

    void spline(const Entity& entity, Pen& pen) {
        Spline curve;
        curve.degree = int(entity.number(71, 3));
        curve.knots = entity.numbers(40);
        curve.weights = entity.numbers(41);
        const std::vector<double> x = entity.numbers(10), y = entity.numbers(20);
        for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) curve.controls.push_back({x[i], y[i]});
        if (!curve.isSound())
            return void(remarked.insert("SPLINE without knots and control points that fit"));
        pen.moveTo(curve(curve.from()));
        // Between two knots it is smooth.
        for (std::size_t k = std::size_t(curve.degree); k < curve.controls.size(); ++k)
            if (curve.knots[k + 1] > curve.knots[k]) {
                // Its end belongs to the next span: just before it is this one's.
                pen.along(std::cref(curve), curve.knots[k],
                          std::nextafter(curve.knots[k + 1], curve.knots[k]));
                if (pen.arcs() >= kMostDxfArcs) return;
            }
        if ((int(entity.number(70, 0)) & 1) != 0) pen.close();
    }

    void add(std::vector<Contour> contours) {
        for (Contour& contour : contours) {
            drawn += contour.arcs.size();
            if (drawn >= kMostDxfArcs)
                return fail("draws more than " + std::to_string(kMostDxfArcs) + " arcs: simplify it");
            if (contour.closed)
                closed.push_back(std::move(contour));
            else if (!contour.arcs.empty())
                lines.push_back(std::move(contour));
            if (lines.size() > kMostLines)
                return fail("has more than " + std::to_string(kMostLines) +
                            " lines to be joined: simplify it");
        }
    }

    /// Lines joined end to end into closed contours, and all brought to a unit.
    Result<Drawing> finished() {
        join();
        if (closed.empty() && !(open && !lines.empty()))
            return Error{"has lines but none of them close an outline: join their ends"};
        const std::vector<Contour>& all = closed.empty() ? lines : closed;
        glm::dvec2 lo{1e300, 1e300}, hi{-1e300, -1e300};
        for (const Contour& contour : all)
            for (const Arc& arc : contour.arcs)
                for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
                    const glm::dvec2 p = placeOn(arc, share);
                    lo = glm::min(lo, p), hi = glm::max(hi, p);
                }
        const double longer = std::max(hi.x - lo.x, hi.y - lo.y);
        if (!(longer > 0)) return Error{"has no line with a length"};
        Drawing drawing;
        const glm::dvec2 centre = 0.5 * (lo + hi);
        const PlaneTransform toUnit{{1 / longer, 0}, {0, 1 / longer}, -centre / longer};
        drawing.paths = moved(closed, toUnit, kDxfTolerance);
        if (!closed.empty()) drawing.painting.fills.push_back({drawing.paths, true});
        for (Contour& line : moved(lines, toUnit, kDxfTolerance)) drawing.paths.push_back(std::move(line));
        // $INSUNITS; a drawing that says none is taken to be in millimetres.
        const std::map<int, double> units = {{1, 0.0254},  {2, 0.3048},  {3, 1609.344}, {4, 1e-3},
                                             {5, 1e-2},    {6, 1},       {7, 1e3},      {8, 2.54e-8},
                                             {9, 2.54e-5}, {10, 0.9144}, {13, 1e-6},    {14, 0.1}};
        const auto found = units.find(unit);
        drawing.scale = longer * (found == units.end() ? 1e-3 : found->second);
        for (const std::string& what : remarked)
            drawing.remarks.push_back("what it has of " + what + " is left away");
        if (!lines.empty())
            drawing.remarks.push_back(std::to_string(lines.size()) +
                                      (lines.size() == 1 ? " line that closes" : " lines that close") +
                                      " no outline " + (lines.size() == 1 ? "is" : "are") + " left away");
        return drawing;
    }

    /// `lines` are those that are left, each as long as it can be.
    void join() {
        // Ends by cells as large as what is taken for one place.
        const double cell = kJoins * std::max(extent, 1e-9);
        std::multimap<std::pair<int64_t, int64_t>, std::pair<std::size_t, bool>>
            ends;  // the line, and whether its end
        const auto cellOf = [&](glm::dvec2 p) {
            return std::pair(int64_t(std::floor(p.x / cell)), int64_t(std::floor(p.y / cell)));
        };
        for (std::size_t i = 0; i < lines.size(); ++i) {
            ends.emplace(cellOf(lines[i].arcs.front().a), std::pair(i, false));
            ends.emplace(cellOf(lines[i].arcs.back().b), std::pair(i, true));
        }
        std::vector<bool> used(lines.size(), false);
        const auto next = [&](glm::dvec2 p) -> std::optional<std::pair<std::size_t, bool>> {
            const auto [x, y] = cellOf(p);
            for (int64_t dy = -1; dy <= 1; ++dy)
                for (int64_t dx = -1; dx <= 1; ++dx)
                    for (auto [at, last] = ends.equal_range({x + dx, y + dy}); at != last;) {
                        const auto [line, isEnd] = at->second;
                        const Contour& contour = lines[line];
                        if (used[line])
                            at = ends.erase(at);  // so that none is passed over twice
                        else if (glm::distance(isEnd ? contour.arcs.back().b : contour.arcs.front().a, p) <=
                                 cell)
                            return at->second;
                        else
                            ++at;
                    }
            return std::nullopt;
        };
        std::vector<Contour> left;
        for (std::size_t first = 0; first < lines.size(); ++first) {
            if (used[first]) continue;
            used[first] = true;
            Contour whole = lines[first];
            bool turned = false;
            while (glm::distance(whole.arcs.back().b, whole.arcs.front().a) > cell ||
                   whole.arcs.size() == 1) {
                const auto follower = next(whole.arcs.back().b);
                if (!follower && turned) break;
                if (!follower) {
                    turned = true;
                    reverse(whole.arcs);
                    continue;
                }
                const auto [line, isEnd] = *follower;
                used[line] = true;
                std::vector<Arc> arcs = lines[line].arcs;
                if (isEnd) reverse(arcs);
                // Its first end is brought to where the last one ended.
                arcs.front() = arcBetween(whole.arcs.back().b, arcs.front().b, arcs.front().bend);
                whole.arcs.insert(whole.arcs.end(), arcs.begin(), arcs.end());
            }
            if (turned) reverse(whole.arcs);
            whole.closed =
                glm::distance(whole.arcs.back().b, whole.arcs.front().a) <= cell && whole.arcs.size() > 1;
            if (whole.closed)
                closed.push_back(std::move(whole));
            else
                left.push_back(std::move(whole));
        }
        lines = std::move(left);
    }

    void fail(std::string message) {
        if (!problem) problem = Error{std::move(message)};
    }

    struct Block {
        glm::dvec2 base{0, 0};
        std::vector<Entity> entities;
    };
    const std::string& layer;
    const bool open;  ///< lines that close no outline will do
    std::vector<Entity> entities;
    std::map<std::string_view, Block> blocks;
    std::set<std::string> layers, remarked;
    std::vector<Contour> lines, closed;
    std::optional<Error> problem;
    double extent = 0, tolerance = kDxfTolerance;
    std::size_t drawn = 0;
    int unit = 0, inserts = 0;
};

}  // namespace

Result<Drawing> readDxf(const std::string& bytes, const std::string& part, bool open) {
    return DxfReader(part, open).run(bytes);
}

}  // namespace fw
