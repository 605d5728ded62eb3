#include "tests/support/graph/everyday_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "graph/library/units.h"

namespace fw::test {

namespace {

/// Twelve significant digits.
std::string digits(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.12g", value);
    return text;
}

std::string quoted(const std::string& text) { return "\"" + text + "\""; }

/// Writes scenes. Parameters in metres; a part's reach is in document units, as in SceneWriter.
class EverydayWriter {
  public:
    EverydayWriter(uint32_t seed, double unitsPerMetre)
        : perMetre(unitsPerMetre), writer(seed, unitsPerMetre) {}

    ScenePart solid() {
        ScenePart part = random.chance(0.2) ? grouped() : writer.shape();
        if (random.chance(0.25)) part = blended(part);
        for (int operations = random.below(4); operations > 0; --operations) part = operation(part);
        return part;
    }
    /// A solid whose field mostly stays a bound of the distance.
    ScenePart plainSolid() {
        ScenePart part = writer.plainShape();
        const int operation = random.below(4);
        if (operation == 0) part.id = turned(part.id);
        if (operation == 1) part = repeated(part);
        if (operation == 2 && part.distanceLike) part = walled(part);
        return part;
    }

    std::string combined(const std::string& a, const std::string& b) {
        // No morph: halfway between solids that are apart is nothing.
        const double kind = random.between(0, 1);
        return combined(kind < 0.75 ? "union" : kind < 0.9 ? "subtract" : "xor", a, b);
    }
    /// Without a blend. Only unions keep distances exact.
    std::string plainlyCombined(const std::string& a, const std::string& b, bool canSubtract) {
        const char* type = canSubtract && random.chance(0.3) ? "subtract" : "union";
        return writer.add(type, {{"a", link(a)}, {"b", link(b)}});
    }

    std::string moved(const std::string& id, const Point& place) {
        return writer.add("translate", {{"surface", link(id)}, {"offset", vector(place)}});
    }
    std::string turned(const std::string& id) {
        return writer.add("rotate", {{"surface", link(id)}, {"angles", angles()}});
    }

    std::string text(const std::string& shown, const std::string& unit) const {
        return "{\"fieldwright\": 1,\n \"nodes\": [\n" + writer.nodes +
               "  {\"id\": \"out\", \"type\": \"output\", \"inputs\": {\"surface\": " + link(shown) + "}}]" +
               (groups.empty() ? "" : ",\n \"groups\": [\n" + groups + "]") +
               (unit == "m" ? "" : ",\n \"unit\": " + quoted(unit)) + "}\n";
    }

  private:
    static std::string link(const std::string& id) { return SceneWriter::link(id); }
    std::string vector(const Point& units) const {
        return "[" + digits(units[0]) + ", " + digits(units[1]) + ", " + digits(units[2]) + "]";
    }
    std::string angles() {
        const auto angle = [&] { return random.between(-180, 180); };
        const double x = angle(), y = angle(), z = angle();
        return vector({x, y, z});
    }
    std::string direction() { return vector(random.direction()); }
    /// A random length of so many metres.
    std::string length(double low, double high) { return digits(perMetre * random.between(low, high)); }
    /// A random number for each metre.
    std::string rate(double low, double high) {
        const double value = random.between(low, high) / perMetre;
        return digits(random.chance(0.5) ? value : -value);
    }

    std::string combined(const char* type, const std::string& a, const std::string& b) {
        SceneWriter::Inputs inputs = {{"a", link(a)}, {"b", link(b)}};
        if (std::string(type) == "morph") {
            inputs.push_back({"t", digits(random.between(0, 1))});
        } else if (random.chance(0.5)) {
            static constexpr std::array kProfiles = {"round", "chamfer", "stairs", "exact", "groove"};
            inputs.push_back({"radius", length(0.03, 0.3)});
            inputs.push_back({"profile", quoted(kProfiles[std::size_t(random.below(5))])});
            inputs.push_back({"steps", std::to_string(2 + random.below(4))});
        }
        return writer.add(type, inputs);
    }

    ScenePart blended(const ScenePart& part) {
        const ScenePart other = writer.shape();
        Point place = random.direction();
        const double distance = 0.5 * std::min(part.reach, other.reach);
        for (double& x : place) x *= distance;
        const std::string second = moved(other.id, place);
        static constexpr std::array kTypes = {"union", "union", "subtract", "intersect", "morph"};
        const char* type = kTypes[std::size_t(random.below(5))];
        return {combined(type, part.id, second),
                std::max(part.reach, other.reach + distance) + 0.1 * perMetre,
                part.distanceLike && other.distanceLike};
    }

    ScenePart operation(const ScenePart& part) {
        ScenePart result = part;
        switch (random.below(6)) {
            case 0: result = placed(part); break;
            case 1:
            case 2: result = deformed(part); break;
            case 3: result = repeated(part); break;
            case 4: result = part.distanceLike ? resized(part) : placed(part); break;
            default: result = coded(part);
        }
        const double limit = 2.2 * perMetre;
        if (result.reach <= limit) return result;
        const double factor = 0.6 * limit / result.reach;
        result.id = writer.add("scale", {{"surface", link(result.id)}, {"factor", digits(factor)}});
        result.reach *= factor;
        return result;
    }

    ScenePart placed(const ScenePart& part) {
        const std::string surface = link(part.id);
        ScenePart result = part;
        switch (random.below(4)) {
            case 0: result.id = turned(part.id); break;
            case 1: {
                const Point factors{random.between(0.5, 1.6), random.between(0.5, 1.6),
                                    random.between(0.5, 1.6)};
                result.id = writer.add("stretch", {{"surface", surface}, {"factors", vector(factors)}});
                result.reach *= std::max({factors[0], factors[1], factors[2]});
                break;
            }
            case 2: {
                const double scale = random.between(0.5, 1.5), distance = 0.3 * part.reach;
                Point place = random.direction();
                for (double& x : place) x *= distance;
                const std::string rotation = angles();
                result.id = writer.add("transform", {{"surface", surface},
                                                     {"translation", vector(place)},
                                                     {"rotation", rotation},
                                                     {"scale", digits(scale)}});
                result.reach = scale * part.reach + distance;
                break;
            }
            default: {
                const double offset = part.reach * random.between(-0.3, 0.2);
                const std::string normal = direction();
                result.id = writer.add(
                    "mirror", {{"surface", surface}, {"normal", normal}, {"offset", digits(offset)}});
                result.reach += 2.0 * std::abs(offset);
            }
        }
        return result;
    }

    ScenePart deformed(const ScenePart& part) {
        const std::string surface = link(part.id);
        ScenePart result = part;
        switch (random.below(7)) {
            case 0: result.id = writer.add("twist", {{"surface", surface}, {"rate", rate(10, 90)}}); break;
            case 1: result.id = writer.add("bend", {{"surface", surface}, {"rate", rate(5, 50)}}); break;
            case 2: {
                result.id = writer.add("taper", {{"surface", surface}, {"rate", rate(0.02, 0.25)}});
                result.reach *= 1.4;
                result.distanceLike = false;
                break;
            }
            case 3: {
                const double x = random.between(0, 0.4) * perMetre, z = random.between(0, 0.4) * perMetre;
                result.id =
                    writer.add("elongate", {{"surface", surface}, {"half_extents", vector({x, 0, z})}});
                result.reach += std::hypot(x, z);
                break;
            }
            case 4: {
                const std::string wave = length(0.05, 0.2), frequency = rate(1, 5);
                const std::string position =
                    writer.add("expression", {},
                               "return vec3(p.x + " + wave + " * sin(" + frequency + " * p.y), p.yz);");
                result.id = writer.add("warp", {{"surface", surface}, {"p", link(position)}});
                result.reach += 0.2 * perMetre;
                break;
            }
            default: {
                static constexpr std::array kKinds = {"perlin", "simplex", "worley"};
                const std::string kind = kKinds[std::size_t(random.below(3))];
                const std::string scale = digits(random.between(1, 4) / perMetre);
                const std::string noise =
                    writer.add("noise", {{"kind", quoted(kind)},
                                         {"scale", scale},
                                         {"octaves", std::to_string(1 + random.below(3))},
                                         {"seed", std::to_string(random.below(1000))}});
                const double amplitude = std::min(0.3 * part.reach, perMetre * random.between(0.02, 0.12));
                const std::string amount = writer.add(
                    "math", {{"op", quoted("multiply")}, {"a", link(noise)}, {"b", digits(amplitude)}});
                result.id = writer.add("displace", {{"surface", surface}, {"amount", link(amount)}});
                result.reach += 3.0 * amplitude;
            }
        }
        return result;
    }

    ScenePart repeated(const ScenePart& part) {
        ScenePart result = part;
        const std::string neighbours = random.chance(0.8) ? "true" : "false";
        if (random.chance(0.5)) {
            Point period{}, copies{1, 1, 1};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                period[axis] = part.reach * random.between(1.2, 2.5);
                copies[axis] = random.chance(0.4) ? 1 : 2 + random.below(3);
            }
            result.id = writer.add("repeat", {{"surface", link(part.id)},
                                              {"period", vector(period)},
                                              {"count", vector(copies)},
                                              {"neighbours", neighbours}});
            for (std::size_t axis = 0; axis < 3; ++axis) period[axis] *= 0.5 * (copies[axis] - 1.0);
            result.reach += norm(period);
            return result;
        }
        const double offset = part.reach * random.between(0.7, 1.8);
        const std::string source = moved(part.id, {offset, 0, 0});
        const std::string count = std::to_string(2 + random.below(7));
        result.id = writer.add("polar_repeat",
                               {{"surface", link(source)}, {"count", count}, {"neighbours", neighbours}});
        result.reach += offset;
        return result;
    }

    /// Larger, smaller, or a wall.
    ScenePart walled(const ScenePart& part) {
        const double size = std::min(part.reach, perMetre);
        ScenePart result = part;
        if (random.chance(0.5)) {
            const double distance = size * random.between(-0.03, 0.15);
            result.id = writer.add("offset", {{"surface", link(part.id)}, {"distance", digits(distance)}});
            result.reach += 2.0 * std::abs(distance);
        } else {
            const double thickness = size * random.between(0.03, 0.1);
            result.id = writer.add("shell", {{"surface", link(part.id)}, {"thickness", digits(thickness)}});
            result.reach += 2.0 * thickness;
        }
        return result;
    }

    ScenePart resized(const ScenePart& part) {
        if (random.chance(0.8)) return walled(part);
        const std::string surface = link(part.id);
        const double size = std::min(part.reach, perMetre);
        ScenePart result = part;
        const std::string resolution = std::to_string(16 + random.below(9));
        if (random.chance(0.5))
            result.id = writer.add("true_distance", {{"surface", surface}, {"resolution", resolution}});
        else
            result.id = writer.add("round_edges", {{"surface", surface},
                                                   {"radius", digits(0.08 * size)},
                                                   {"edges", quoted("inner")},
                                                   {"resolution", resolution}});
        result.reach *= 1.1;
        return result;
    }

    ScenePart coded(const ScenePart& part) {
        ScenePart result = part;
        const std::string height = digits(part.reach * random.between(0.1, 0.6));
        std::string code;
        switch (random.below(5)) {
            case 0: {  // cut by a plane
                const Point normal = random.direction();
                code = "return max(s, dot(p, vec3(" + digits(normal[0]) + ", " + digits(normal[1]) + ", " +
                       digits(normal[2]) + ")) - " + height + ");";
                break;
            }
            case 1: {  // slices
                const std::string frequency = rate(2, 6), depth = length(0.1, 0.3);
                code = "return max(s, sin(" + frequency + " * p.y) * " + depth + ");";
                break;
            }
            case 2:  // a ball cut out by a choice
                code = "d = length(p - vec3(" + height + ", 0, 0)) - " + height +
                       "; if (d < s) return max(s, -d); return s;";
                break;
            case 3:  // ribs
                code = "return s - abs(sin(" + rate(2, 8) + " * p.x)) * " + digits(0.05 * part.reach) + ";";
                result.reach *= 1.15;
                break;
            default:  // holes along x and z
                code = "q = p.xz - " + height + " * round(p.xz / " + height + "); return max(s, " +
                       digits(0.05 * part.reach) + " - length(q));";
        }
        result.id = writer.add("expression", {{"s", link(part.id)}}, code);
        result.distanceLike = false;
        return result;
    }

    /// An instance of one of three groups, which is added to the document at its first use.
    ScenePart grouped() {
        const double size = perMetre * random.between(0.3, 0.7), wall = 0.1 * size;
        const std::string sizeText = digits(size), wallText = digits(wall);
        switch (random.below(3)) {
            case 0: {
                addGroup(0, hollowGroup());
                return {instance("hollow", {{"size", sizeText}, {"wall", wallText}}), 2.0 * size};
            }
            case 1: {
                addGroup(1, flangeGroup());
                const ScenePart part = writer.shape();
                const std::string id = instance("flange", {{"body", link(part.id)}, {"bore", wallText}});
                return {id, std::max(part.reach, 0.5 * perMetre) + wall};
            }
            default: {
                addGroup(0, hollowGroup());
                addGroup(2, pairGroup());
                return {instance("pair", {{"distance", sizeText}}), size + perMetre};
            }
        }
    }

    std::string instance(const std::string& group, const SceneWriter::Inputs& inputs) {
        const std::string id = writer.add("group", inputs);
        // The writer knows no groups: the key goes between the id and the type.
        const std::string start = "{\"id\": \"" + id + "\", ";
        writer.nodes.insert(writer.nodes.find(start) + start.size(), "\"group\": " + quoted(group) + ", ");
        return id;
    }

    void addGroup(std::size_t number, const std::string& text) {
        if (hasGroup[number]) return;
        hasGroup[number] = true;
        groups += (groups.empty() ? "" : ",\n") + text;
    }

    /// A hollow box with an open top.
    std::string hollowGroup() const {
        return R"(  {"id": "hollow",
   "inputs": [{"name": "size", "type": "float", "value": )" +
               digits(0.5 * perMetre) + R"(}, {"name": "wall", "type": "float", "value": )" +
               digits(0.05 * perMetre) + R"(}],
   "outputs": [{"name": "surface", "type": "surface"}],
   "nodes": [
    {"id": "given", "type": "group_input"},
    {"id": "half", "type": "combine_xyz", "inputs": {"x": {"from": "given", "output": "size"},
     "y": {"from": "given", "output": "size"}, "z": {"from": "given", "output": "size"}}},
    {"id": "block", "type": "box", "inputs": {"half_extents": {"from": "half"}}},
    {"id": "walls", "type": "shell", "inputs": {"surface": {"from": "block"}, "thickness": {"from": "given", "output": "wall"}}},
    {"id": "top", "type": "plane", "inputs": {"normal": [0, 1, 0]}},
    {"id": "open", "type": "intersect", "inputs": {"a": {"from": "walls"}, "b": {"from": "top"}}},
    {"id": "made", "type": "group_output", "inputs": {"surface": {"from": "open"}}}]})";
    }

    /// A solid with a plate around it and a hole through both.
    std::string flangeGroup() const {
        return R"(  {"id": "flange",
   "inputs": [{"name": "body", "type": "surface"}, {"name": "bore", "type": "float", "value": )" +
               digits(0.05 * perMetre) + R"(}],
   "outputs": [{"name": "surface", "type": "surface"}],
   "nodes": [
    {"id": "given", "type": "group_input"},
    {"id": "plate", "type": "cylinder", "inputs": {"radius": )" +
               digits(0.45 * perMetre) + R"(, "half_height": )" + digits(0.08 * perMetre) + R"(}},
    {"id": "both", "type": "union", "inputs": {"a": {"from": "given", "output": "body"}, "b": {"from": "plate"},
     "radius": {"from": "given", "output": "bore"}}},
    {"id": "drill", "type": "infinite_cylinder", "inputs": {"radius": {"from": "given", "output": "bore"}}},
    {"id": "drilled", "type": "subtract", "inputs": {"a": {"from": "both"}, "b": {"from": "drill"}}},
    {"id": "made", "type": "group_output", "inputs": {"surface": {"from": "drilled"}}}]})";
    }

    /// Two instances of the hollow box: a group in a group.
    std::string pairGroup() const {
        return R"(  {"id": "pair",
   "inputs": [{"name": "distance", "type": "float", "value": )" +
               digits(perMetre) + R"(}],
   "outputs": [{"name": "surface", "type": "surface"}],
   "nodes": [
    {"id": "given", "type": "group_input"},
    {"id": "one", "type": "group", "group": "hollow", "inputs": {"size": )" +
               digits(0.3 * perMetre) + R"(}},
    {"id": "two", "type": "group", "group": "hollow", "inputs": {"wall": )" +
               digits(0.02 * perMetre) + R"(}},
    {"id": "place", "type": "combine_xyz", "inputs": {"x": {"from": "given", "output": "distance"}}},
    {"id": "away", "type": "translate", "inputs": {"surface": {"from": "two"}, "offset": {"from": "place"}}},
    {"id": "all", "type": "union", "inputs": {"a": {"from": "one"}, "b": {"from": "away"}}},
    {"id": "made", "type": "group_output", "inputs": {"surface": {"from": "all"}}}]})";
    }

    const double perMetre;
    SceneWriter writer;
    std::string groups;
    std::array<bool, 3> hasGroup{};

  public:
    SceneRandom& random = writer.random;
};

}  // namespace

EverydayScene everydayScene(uint32_t seed, const std::string& unit) {
    EverydayScene scene;
    scene.seed = seed;
    scene.unit = unit;
    // The inverse of the unit in metres, without the rounding error of a division by 0.001.
    scene.perMetre = unit == "m"    ? 1.0
                     : unit == "cm" ? 100.0
                     : unit == "mm" ? 1000.0
                                    : 1.0 / lengthUnit(unit)->metres;
    EverydayWriter writer(seed * 2246822519u + 5u, scene.perMetre);
    SceneRandom& random = writer.random;
    const int solids = 2 + random.below(5);
    const bool isAtOrigin = random.chance(0.5), isPlain = random.chance(0.4),
               canSubtract = random.chance(0.4);
    const double extent = std::array{1.0, 2.5, 8.0}[std::size_t(random.below(3))];
    std::string all;
    for (int i = 0; i < solids; ++i) {
        const ScenePart part = isPlain ? writer.plainSolid() : writer.solid();
        std::string id = random.chance(0.5) ? writer.turned(part.id) : part.id;
        Point place{};
        if (i > 0 || !isAtOrigin) {
            place = random.direction();
            const double distance = scene.perMetre * random.between(0.3, extent);
            for (double& x : place) x *= distance;
            id = writer.moved(id, place);
        }
        scene.anchors.push_back({place, 1.1 * part.reach + 0.05 * scene.perMetre, id});
        all = i == 0 ? id : isPlain ? writer.plainlyCombined(all, id, canSubtract) : writer.combined(all, id);
    }
    scene.json = writer.text(all, unit);
    return scene;
}

EverydayScene everydayScene(uint32_t seed) {
    static constexpr std::array kUnits = {"m", "m", "cm", "mm", "in"};
    // The choice does not enter the seed of the scene.
    return everydayScene(seed, kUnits[std::size_t(SceneRandom(seed).below(5))]);
}

Box boxAround(const EverydayScene& scene) {
    std::optional<Box> box;
    for (const SceneAnchor& anchor : scene.anchors) {
        Box around{anchor.centre, anchor.centre};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            around.lo[axis] -= 1.2 * anchor.radius;
            around.hi[axis] += 1.2 * anchor.radius;
        }
        joinInto(box, around);
    }
    return *box;
}

}  // namespace fw::test
