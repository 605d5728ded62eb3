#include "tests/support/graph/random_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fw::test {

namespace {

/// The farthest that a solid can be from its local origin before it is made smaller, in metres.
constexpr double kMaxReach = 3.0;

}  // namespace

double norm(const Point& p) { return std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]); }

std::string sceneNumber(double value) {
    constexpr std::int64_t kDecimals = 10'000'000;
    const std::int64_t scaled = std::llround(value * double(kDecimals));
    std::string text = std::to_string(std::abs(scaled) / kDecimals);
    if (const std::int64_t fraction = std::abs(scaled) % kDecimals) {
        std::string digits = std::to_string(kDecimals + fraction).substr(1);
        digits.erase(digits.find_last_not_of('0') + 1);
        text += "." + digits;
    }
    return (scaled < 0 ? "-" : "") + text;
}

std::string sceneVector(const Point& value) {
    return "[" + sceneNumber(value[0]) + ", " + sceneNumber(value[1]) + ", " + sceneNumber(value[2]) + "]";
}

Point SceneRandom::direction() {
    for (;;) {
        Point p{};
        for (double& x : p) x = between(-1.0, 1.0);
        const double length = norm(p);
        if (length < 0.1 || length > 1.0) continue;
        for (double& x : p) x /= length;
        return p;
    }
}

std::string SceneWriter::add(const char* type, const Inputs& inputs, const std::string& code) {
    const std::string id = type + std::to_string(++count);
    nodes += "  {\"id\": \"" + id + "\", \"type\": \"" + type + "\"";
    if (!inputs.empty()) {
        nodes += ", \"inputs\": {";
        for (std::size_t i = 0; i < inputs.size(); ++i)
            nodes += (i ? ", \"" : "\"") + std::string(inputs[i].first) + "\": " + inputs[i].second;
        nodes += "}";
    }
    if (!code.empty()) nodes += ", \"code\": \"" + code + "\"";
    nodes += "},\n";
    return id;
}

std::string SceneWriter::combine(const std::string& type, const std::string& a, const std::string& b) {
    Inputs inputs = {{"a", link(a)}, {"b", link(b)}};
    if (type == "morph") {
        // Between solids that are far apart there is nothing halfway.
        inputs.push_back(
            {"t", sceneNumber(random.chance(0.5) ? random.between(0, 0.1) : random.between(0.9, 1))});
    } else if (random.chance(0.5)) {
        static constexpr std::array kProfiles = {"round", "chamfer", "stairs", "exact", "groove"};
        inputs.push_back({"radius", length(0.03, 0.4)});
        const std::string profile = kProfiles[std::size_t(random.below(int(kProfiles.size())))];
        inputs.push_back({"profile", "\"" + profile + "\""});
        if (profile == "stairs") inputs.push_back({"steps", std::to_string(2 + random.below(5))});
    }
    return add(type.c_str(), inputs);
}

ScenePart SceneWriter::placed(const ScenePart& part) {
    const std::string surface = link(part.id);
    const auto angle = [&] { return random.between(-180, 180); };
    ScenePart result = part;
    switch (random.below(7)) {
        case 0: {
            const Point offset{part.reach * random.between(-0.5, 0.5), part.reach * random.between(-0.5, 0.5),
                               part.reach * random.between(-0.5, 0.5)};
            result.id = add("translate", {{"surface", surface}, {"offset", sceneVector(offset)}});
            result.reach += norm(offset);
            return result;
        }
        case 1: {
            const Point angles{angle(), angle(), angle()};
            result.id = add("rotate", {{"surface", surface}, {"angles", sceneVector(angles)}});
            animated.push_back({result.id, "angles.y", angles[1], angles[1] + 270});
            return result;
        }
        case 2: {
            const double factor = random.between(0.4, 1.8);
            result.id = add("scale", {{"surface", surface}, {"factor", sceneNumber(factor)}});
            result.reach *= factor;
            return result;
        }
        case 3: {
            const Point factors{random.between(0.5, 1.8), random.between(0.5, 1.8), random.between(0.5, 1.8)};
            result.id = add("stretch", {{"surface", surface}, {"factors", sceneVector(factors)}});
            result.reach *= std::max({factors[0], factors[1], factors[2]});
            return result;
        }
        case 4: {
            const Point offset{part.reach * random.between(-0.4, 0.4), part.reach * random.between(-0.4, 0.4),
                               part.reach * random.between(-0.4, 0.4)};
            const double factor = random.between(0.5, 1.6);
            result.id = add("transform", {{"surface", surface},
                                          {"translation", sceneVector(offset)},
                                          {"rotation", sceneVector({angle(), angle(), angle()})},
                                          {"scale", sceneNumber(factor)}});
            result.reach = factor * part.reach + norm(offset);
            return result;
        }
        case 5: {
            const double offset = part.reach * random.between(-0.3, 0.2);
            const Point normal = random.chance(0.3) ? Point{1, 0, 0} : random.direction();
            result.id =
                add("mirror",
                    {{"surface", surface}, {"normal", sceneVector(normal)}, {"offset", sceneNumber(offset)}});
            result.reach += 2.0 * std::abs(offset);
            return result;
        }
        default:
            result.id = add("material", {{"surface", surface}, {"base_color", "[0.7, 0.3, 0.1]"}});
            return result;
    }
}

ScenePart SceneWriter::repeated(const ScenePart& part) {
    ScenePart result = part;
    const char* neighbours = random.chance(0.8) ? "true" : "false";
    if (random.chance(0.5)) {
        Point period{}, copies{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const int number = random.chance(0.5) ? 1 : 2 + random.below(3);
            period[axis] = random.chance(0.2) ? 0.0 : part.reach * random.between(1.0, 2.5);
            copies[axis] = number;
        }
        result.id = add("repeat", {{"surface", link(part.id)},
                                   {"period", sceneVector(period)},
                                   {"count", sceneVector(copies)},
                                   {"neighbours", neighbours}});
        for (std::size_t axis = 0; axis < 3; ++axis) period[axis] *= 0.5 * (copies[axis] - 1.0);
        result.reach += norm(period);
        return result;
    }
    std::string source = part.id;
    if (random.chance(0.7)) {
        const double offset = part.reach * random.between(0.5, 2.0);
        source = add("translate", {{"surface", link(source)}, {"offset", sceneVector({offset, 0, 0})}});
        result.reach += offset;
    }
    const Point axis = random.chance(0.3) ? Point{0, 1, 0} : random.direction();
    result.id = add("polar_repeat", {{"surface", link(source)},
                                     {"count", std::to_string(2 + random.below(8))},
                                     {"axis", sceneVector(axis)},
                                     {"neighbours", neighbours}});
    return result;
}

ScenePart SceneWriter::deformed(const ScenePart& part) {
    const std::string surface = link(part.id);
    const double sign = random.chance(0.5) ? 1.0 : -1.0;
    const double metresOfReach = part.reach / unit;
    ScenePart result = part;
    switch (random.below(6)) {
        case 0:
        case 1: {
            const double rate = sign * random.between(10, 90) / unit;
            result.id = add("twist", {{"surface", surface}, {"rate", sceneNumber(rate)}});
            animated.push_back({result.id, "rate", rate, -1.5 * rate});
            return result;
        }
        case 2: {
            const double rate = sign * random.between(5, 50) / unit;
            result.id = add("bend", {{"surface", surface}, {"rate", sceneNumber(rate)}});
            animated.push_back({result.id, "rate", rate, 0.2 * rate});
            return result;
        }
        case 3: {
            const double rate = sign * random.between(0.03, 0.25) / std::max(metresOfReach, 0.7);
            result.id = add("taper", {{"surface", surface}, {"rate", sceneNumber(rate / unit)}});
            result.reach *= 1.0 + std::abs(rate) * metresOfReach;
            result.distanceLike = false;  // its values grow a hundred times slower on one side
            return result;
        }
        case 4: {
            const Point half{metres(0.0, 0.5), metres(0.0, 0.5), random.chance(0.5) ? 0.0 : metres(0.0, 0.5)};
            result.id = add("elongate", {{"surface", surface}, {"half_extents", sceneVector(half)}});
            result.reach += norm(half);
            return result;
        }
        default: {
            const double k = random.between(0.05, 0.35), a = random.between(0.5, 4.0);
            const std::string bend = sceneNumber(k / unit), wave = sceneNumber(k * unit),
                              shear = sceneNumber(k);
            std::string code;
            switch (random.below(4)) {
                case 0:
                    code = "return vec3(p.x, p.y + " + bend + " * p.x * p.x, p.z);";
                    result.reach *= 1.0 + k * metresOfReach;
                    break;
                case 1:
                    code = "return vec3(p.x + " + wave + " * sin(" + sceneNumber(a / unit) +
                           " * p.y), p.y, p.z);";
                    result.reach += k * unit;
                    break;
                case 2:
                    code = "return vec3(p.x + " + shear + " * p.y, p.y, p.z);";
                    result.reach *= 1.0 + k;
                    break;
                default:
                    code = "a = " + sceneNumber(a / unit) +
                           " * length(p); return vec3(cos(a) * p.x - sin(a) * p.z, p.y, sin(a) * p.x + "
                           "cos(a) * p.z);";
            }
            const std::string position = add("expression", {}, code);
            result.id = add("warp", {{"surface", surface}, {"p", link(position)}});
            return result;
        }
    }
}

ScenePart SceneWriter::offsetPart(const ScenePart& part) {
    const std::string surface = link(part.id);
    ScenePart result = part;
    const double size = std::min(part.reach, unit);
    const auto measure = [&](const char* type, Inputs inputs) {
        inputs.push_back({"surface", surface});
        inputs.push_back({"resolution", std::to_string(16 + random.below(9))});
        // Distances are measured once, so no input upstream can be animated.
        animated.clear();
        result.reach *= 1.1;
        return add(type, inputs);
    };
    switch (random.below(7)) {
        case 0: {
            const double distance = size * random.between(-0.03, 0.15);
            result.id = add("offset", {{"surface", surface}, {"distance", sceneNumber(distance)}});
            result.reach += 2.0 * std::abs(distance);
            return result;
        }
        case 1: {
            const double thickness = size * random.between(0.015, 0.06);
            result.id = add("shell", {{"surface", surface}, {"thickness", sceneNumber(thickness)}});
            result.reach += 2.0 * thickness;
            return result;
        }
        case 2:
        case 3: {
            const double amplitude = size * random.between(0.02, 0.12);
            std::string amount;
            if (random.chance(0.4)) {
                static constexpr std::array kKinds = {"\"perlin\"", "\"simplex\"", "\"worley\""};
                const std::string noise = add("noise", {{"kind", kKinds[std::size_t(random.below(3))]},
                                                        {"scale", sceneNumber(random.between(1, 5) / unit)},
                                                        {"octaves", std::to_string(1 + random.below(3))},
                                                        {"seed", std::to_string(random.below(100))}});
                amount =
                    add("math", {{"op", "\"multiply\""}, {"a", link(noise)}, {"b", sceneNumber(amplitude)}});
            } else {
                const std::string rate = sceneNumber(random.between(3, 15) / unit);
                amount = add("expression", {},
                             "return " + sceneNumber(amplitude) + " * sin(" + rate + " * p.x) * sin(" + rate +
                                 " * p.y) * sin(" + rate + " * p.z);");
            }
            result.id = add("displace", {{"surface", surface}, {"amount", link(amount)}});
            result.reach += 3.0 * amplitude;
            return result;
        }
        case 4: {
            const std::string rate = sceneNumber(random.between(2, 6) / unit), depth = length(0.1, 0.4);
            result.id = add("expression", {{"s", surface}},
                            "return max(s, sin(" + rate + " * p.y) * " + depth + ");");
            return result;
        }
        case 5:
            if (random.chance(0.5)) return placed(part);
            result.id = measure("true_distance", {});
            return result;
        default:
            if (random.chance(0.5)) return placed(part);
            // A large outer radius would leave nothing of thin solids.
            result.id =
                random.chance(0.5)
                    ? measure("round_edges", {{"radius", sceneNumber(size * random.between(0.1, 0.2))},
                                              {"edges", "\"inner\""}})
                    : measure("round_edges", {{"radius", sceneNumber(0.03 * size)}});
            return result;
    }
}

ScenePart SceneWriter::cut(const ScenePart& part) {
    ScenePart result = part;
    switch (random.below(3)) {
        case 0: {
            std::string drill =
                add("infinite_cylinder", {{"radius", sceneNumber(part.reach * random.between(0.1, 0.4))}});
            if (random.chance(0.5))
                drill = add("rotate",
                            {{"surface", link(drill)},
                             {"angles", sceneVector({random.between(-90, 90), 0, random.between(-90, 90)})}});
            result.id = combine("subtract", part.id, drill);
            return result;
        }
        case 1: {
            const std::string half =
                add("plane", {{"normal", sceneVector(random.direction())},
                              {"offset", sceneNumber(part.reach * random.between(0.0, 0.4))}});
            result.id = combine("intersect", part.id, half);
            return result;
        }
        default: {
            const std::string lattice =
                add("gyroid", {{"period", sceneNumber(part.reach * random.between(0.4, 1.0))},
                               {"thickness", sceneNumber(part.reach * random.between(0.04, 0.08))}});
            result.id = add("intersect", {{"a", link(part.id)}, {"b", link(lattice)}});
            return result;
        }
    }
}

ScenePart SceneWriter::operation(const ScenePart& part) {
    ScenePart result = part;
    switch (random.below(12)) {
        case 0:
        case 1:
        case 2:
        case 3: result = placed(part); break;
        case 4:
        case 5: result = repeated(part); break;
        case 6:
        case 7:
        case 8: result = deformed(part); break;
        case 9:
        case 10: result = part.distanceLike ? offsetPart(part) : placed(part); break;
        default: result = cut(part);
    }
    if (result.reach > kMaxReach * unit) {
        const double factor = 1.5 * unit / result.reach;
        result.id = add("scale", {{"surface", link(result.id)}, {"factor", sceneNumber(factor)}});
        result.reach *= factor;
    }
    return result;
}

namespace {

/// A random solid about the local origin.
ScenePart solidPart(SceneWriter& writer) {
    ScenePart part = writer.shape();
    if (writer.random.chance(0.2)) {
        // Two shapes that overlap, in any boolean.
        static constexpr std::array kTypes = {"union", "intersect", "subtract", "xor", "morph"};
        ScenePart other = writer.shape();
        if (writer.random.chance(0.5)) other = writer.operation(other);
        const double offset = 0.3 * std::min(part.reach, other.reach);
        Point shift = writer.random.direction();
        for (double& x : shift) x *= offset;
        const std::string moved = writer.add(
            "translate", {{"surface", SceneWriter::link(other.id)}, {"offset", sceneVector(shift)}});
        const char* type = kTypes[std::size_t(writer.random.below(int(kTypes.size())))];
        part = {writer.combine(type, part.id, moved),
                std::max(part.reach, other.reach + offset) + 0.1 * writer.unit,
                part.distanceLike && other.distanceLike};
    }
    for (int operations = writer.random.below(4); operations > 0; --operations) part = writer.operation(part);
    return part;
}

/// Where the next solid is placed.
Point placementOf(SceneWriter& writer, bool first) {
    SceneRandom& random = writer.random;
    if (first && random.chance(0.6)) return {};
    double distance = random.between(2, 9);
    if (!first && random.chance(0.15)) distance = random.between(0.3, 2);
    if (random.chance(0.1)) distance = 40;
    // A document in millimetres has 300 m beyond the region that can be searched.
    if (writer.unit == 1.0 && random.chance(0.07)) distance = 300;
    Point place = random.direction();
    for (double& x : place) x *= distance * writer.unit;
    return place;
}

std::string timelineText(SceneWriter& writer, const std::vector<SceneAnchor>& anchors) {
    SceneRandom& random = writer.random;
    const auto track = [&](const std::string& node, const std::string& input,
                           const std::vector<double>& values) {
        std::string keys;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double time = 4.0 * double(i) / double(values.size() - 1);
            keys += (i ? ", " : "") + std::string("{\"time\": ") + sceneNumber(time) +
                    ", \"value\": " + sceneNumber(values[i]) + ", \"interpolation\": \"" +
                    (random.chance(0.6) ? "cubic" : "linear") + "\"}";
        }
        return "  {\"node\": \"" + node + "\", \"input\": \"" + input + "\", \"keys\": [" + keys + "]}";
    };
    const SceneAnchor& moving = anchors[std::size_t(random.below(int(anchors.size())))];
    std::string tracks;
    static constexpr std::array kInputs = {"offset.x", "offset.y", "offset.z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (axis > 0 && random.chance(0.5)) continue;
        std::vector<double> values{moving.centre[axis]};
        for (int keys = 1 + random.below(3); keys > 0; --keys)
            values.push_back(moving.centre[axis] + writer.metres(-6, 6));
        tracks += (tracks.empty() ? "" : ",\n") + track(moving.placement, kInputs[axis], values);
    }
    for (const SceneWriter::Animated& one : writer.animated)
        if (random.chance(0.8)) tracks += ",\n" + track(one.node, one.input, {one.from, one.to, one.from});
    return ",\n \"timeline\": {\"length\": 4, \"loop\": \"once\", \"tracks\": [\n" + tracks + "]}";
}

RandomScene sceneOf(uint32_t seed, bool moving) {
    // Neighbouring seeds give unrelated scenes, and the moving ones are others than those at rest.
    SceneRandom choice(seed * 2u + (moving ? 1u : 0u));
    RandomScene scene{seed, choice.chance(0.15) ? 1000.0 : 1.0, {}, {}};
    SceneWriter writer(seed * 2654435761u + (moving ? 77u : 0u), scene.unit);
    SceneRandom& random = writer.random;
    std::string all;
    const int solids = 2 + random.below(4);
    for (int i = 0; i < solids; ++i) {
        const ScenePart part = solidPart(writer);
        const Point place = placementOf(writer, i == 0);
        std::string id = part.id;
        if (random.chance(0.3)) {
            const Point angles{random.between(-180, 180), random.between(-180, 180),
                               random.between(-180, 180)};
            id = writer.add("rotate", {{"surface", SceneWriter::link(id)}, {"angles", sceneVector(angles)}});
            writer.animated.push_back({id, "angles.z", angles[2], angles[2] - 200});
        }
        if (place != Point{} || moving)
            id =
                writer.add("translate", {{"surface", SceneWriter::link(id)}, {"offset", sceneVector(place)}});
        scene.anchors.push_back({place, 1.1 * part.reach + 0.05 * scene.unit, id});
        if (i == 0) {
            all = id;
            continue;
        }
        // No morph: nobody fades between solids that stand metres apart; solidPart() fades those at one
        // place.
        const double kind = random.between(0, 1);
        const char* type = kind < 0.75   ? "union"
                           : kind < 0.85 ? "subtract"
                           : kind < 0.95 ? "xor"
                                         : "intersect";
        if (type == std::string("intersect")) {
            // Two solids apart have nothing in common; a large box around most of the scene has.
            all = writer.combine("union", all, id);
            const double half = 12 * scene.unit;
            id = writer.add("box", {{"half_extents", sceneVector({half, half, half})}});
        }
        all = writer.combine(type, all, id);
    }
    scene.json =
        "{\"fieldwright\": 1,\n \"nodes\": [\n" + writer.nodes +
        "  {\"id\": \"out\", \"type\": \"output\", \"inputs\": {\"surface\": " + SceneWriter::link(all) +
        "}}]" + (scene.unit == 1.0 ? "" : ",\n \"unit\": \"mm\"");
    if (moving) scene.json += timelineText(writer, scene.anchors);
    scene.json += "}\n";
    return scene;
}

}  // namespace

RandomScene randomScene(uint32_t seed) { return sceneOf(seed, false); }
RandomScene randomMovingScene(uint32_t seed) { return sceneOf(seed, true); }

}  // namespace fw::test
