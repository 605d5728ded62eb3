// The shapes of random scenes.
#include <algorithm>
#include <array>
#include <cmath>

#include "tests/support/graph/random_scene.h"

namespace fw::test {

namespace {

double lengthOf(double x, double y, double z = 0.0) { return std::sqrt(x * x + y * y + z * z); }

}  // namespace

ScenePart SceneWriter::shape() {
    switch (random.below(10)) {
        case 0:
        case 1:
        case 2: return solidOfRevolution();
        case 3:
        case 4:
        case 5: return polyhedron();
        case 6: return alongSpline();
        case 7: return codeShape();
        default: return fromFlatShape();
    }
}

ScenePart SceneWriter::solidOfRevolution() {
    const double r = metres(0.2, 0.9), s = metres(0.1, 0.6), h = metres(0.2, 1.2);
    const auto n = [](double value) { return sceneNumber(value); };
    switch (random.below(13)) {
        case 0: return {add("sphere", {{"radius", n(r)}}), r};
        case 1:
            return {add("cylinder", {{"radius", n(r)},
                                     {"half_height", n(h)},
                                     {"rounding", random.chance(0.3) ? n(0.2 * s) : "0"}}),
                    lengthOf(r, h)};
        case 2: {
            const Point a{metres(-0.8, 0.8), metres(-0.8, 0.8), metres(-0.8, 0.8)};
            const Point b{metres(-0.8, 0.8), metres(-0.8, 0.8), metres(-0.8, 0.8)};
            return {add("capsule", {{"a", sceneVector(a)}, {"b", sceneVector(b)}, {"radius", n(0.5 * s)}}),
                    std::max(lengthOf(a[0], a[1], a[2]), lengthOf(b[0], b[1], b[2])) + 0.5 * s};
        }
        case 3: return {add("torus", {{"major_radius", n(r)}, {"minor_radius", n(0.4 * s)}}), r + 0.4 * s};
        case 4:
            return {add("capped_torus", {{"half_angle", n(random.between(20, 160))},
                                         {"major_radius", n(r)},
                                         {"minor_radius", n(0.4 * s)}}),
                    r + 0.4 * s};
        case 5:
            return {
                add("link", {{"half_length", n(h)}, {"major_radius", n(r)}, {"minor_radius", n(0.3 * s)}}),
                r + h + 0.3 * s};
        case 6: return {add("cone", {{"radius", n(r)}, {"height", n(h)}}), lengthOf(r, h)};
        case 7:
            return {
                add("capped_cone", {{"half_height", n(h)}, {"radius_bottom", n(r)}, {"radius_top", n(s)}}),
                lengthOf(std::max(r, s), h)};
        case 8:
            return {add("round_cone", {{"radius_bottom", n(r)}, {"radius_top", n(s)}, {"height", n(h)}}),
                    std::max(r, s + h)};
        case 9: return {add("ellipsoid", {{"radii", sceneVector({r, s, h})}}), std::max({r, s, h})};
        case 10:
            return {add("cut_sphere", {{"radius", n(r)}, {"height", n(r * random.between(-0.8, 0.7))}}), r};
        case 11:
            return {add("solid_angle", {{"half_angle", n(random.between(15, 150))}, {"radius", n(r)}}), r};
        default:
            return {add("vesica", {{"half_height", n(r)}, {"radius", n(r * random.between(0.2, 0.9))}}), r};
    }
}

ScenePart SceneWriter::polyhedron() {
    const Point half{metres(0.1, 0.9), metres(0.1, 0.9), metres(0.1, 0.9)};
    const double size = metres(0.3, 1.0), h = metres(0.2, 1.0);
    const double diagonal = lengthOf(half[0], half[1], half[2]);
    switch (random.below(10)) {
        case 0:
        case 1:
            return {add("box", {{"half_extents", sceneVector(half)},
                                {"rounding", random.chance(0.3) ? length(0.01, 0.1) : "0"}}),
                    diagonal};
        case 2: return {add("box_max", {{"half_extents", sceneVector(half)}}), diagonal};
        case 3:
            return {
                add("box_frame", {{"half_extents", sceneVector(half)}, {"thickness", length(0.03, 0.08)}}),
                diagonal};
        case 4: return {add("octahedron", {{"size", sceneNumber(size)}}), size};
        case 5:
            return {add("pyramid", {{"half_side", sceneNumber(size)}, {"height", sceneNumber(h)}}),
                    std::max(lengthOf(size, size), h)};
        case 6: {
            const int sides = 3 + random.below(7);
            return {add("prism", {{"sides", std::to_string(sides)},
                                  {"apothem", sceneNumber(0.6 * size)},
                                  {"half_height", sceneNumber(h)}}),
                    lengthOf(sides == 3 ? 1.2 * size : 0.85 * size, h)};
        }
        case 7: return {add("tetrahedron", {{"size", sceneNumber(size)}}), size};
        case 8: return {add("dodecahedron", {{"size", sceneNumber(size)}}), size};
        default: return {add("icosahedron", {{"size", sceneNumber(size)}}), size};
    }
}

ScenePart SceneWriter::flatShape() {
    const double r = metres(0.15, 0.6), s = metres(0.1, 0.5);
    switch (random.below(8)) {
        case 0: return {add("circle", {{"radius", sceneNumber(r)}}), r};
        case 1:
        case 2:
            return {add("rectangle", {{"half_extents", "[" + sceneNumber(r) + ", " + sceneNumber(s) + "]"}}),
                    lengthOf(r, s)};
        case 3: {
            const int sides = 3 + random.below(6);
            return {
                add("regular_polygon", {{"sides", std::to_string(sides)}, {"apothem", sceneNumber(0.5 * r)}}),
                r};
        }
        case 4:
            return {add("star", {{"points", std::to_string(3 + random.below(6))},
                                 {"outer_radius", sceneNumber(r)},
                                 {"inner_radius", sceneNumber(r * random.between(0.35, 0.8))}}),
                    r};
        case 5: {
            // A quadrilateral with a corner on each half axis, one of which may be a notch.
            const double b = metres(0.1, 0.6), c = metres(-0.1, 0.6);
            const auto corner = [](double x, double y) {
                return "[" + sceneNumber(x) + ", " + sceneNumber(y) + "]";
            };
            return {add("polygon", {{"points", "[" + corner(r, 0) + ", " + corner(0, b) + ", " +
                                                   corner(-c, 0) + ", " + corner(0, -s) + "]"}}),
                    std::max({r, b, std::abs(c), s})};
        }
        case 6: {
            const int teeth = 7 + random.below(10);
            const double module = 2.0 * r / (teeth + 2);
            return {add("gear", {{"module", sceneNumber(module)}, {"teeth", std::to_string(teeth)}}),
                    1.02 * r};
        }
        default: {
            static constexpr std::array kWords = {"A", "ok", "Sg", "T1"};
            const char* word = kWords[std::size_t(random.below(int(kWords.size())))];
            return {add("text", {{"string", "\"" + std::string(word) + "\""}, {"size", sceneNumber(r)}}),
                    1.3 * r};
        }
    }
}

ScenePart SceneWriter::fromFlatShape() {
    const ScenePart flat = flatShape();
    const double h = metres(0.05, 0.6);
    switch (random.below(5)) {
        case 0:
        case 1: {
            const double offset = random.chance(0.5) ? 0.0 : metres(0.1, 0.6);
            const std::string angle = random.chance(0.3) ? sceneNumber(random.between(60, 300)) : "360";
            return {add("revolve",
                        {{"surface", link(flat.id)}, {"offset", sceneNumber(offset)}, {"angle", angle}}),
                    flat.reach + offset};
        }
        case 2: {
            const ScenePart top = flatShape();
            return {add("loft", {{"bottom", link(flat.id)},
                                 {"top", link(top.id)},
                                 {"height", sceneNumber(2.0 * h)},
                                 {"between", random.chance(0.5) ? "\"linear\"" : "\"smooth\""}}),
                    lengthOf(std::max(flat.reach, top.reach), 2.0 * h)};
        }
        default:
            return {add("extrude", {{"surface", link(flat.id)},
                                    {"half_height", sceneNumber(h)},
                                    {"rounding", random.chance(0.3) ? length(0.01, 0.05) : "0"}}),
                    lengthOf(flat.reach, h)};
    }
}

ScenePart SceneWriter::alongSpline() {
    std::string spline;
    double reach = 0.0;
    if (random.chance(0.25)) {
        const double radius = metres(0.2, 0.7), top = metres(0.1, 0.7), height = metres(0.3, 1.5);
        spline = add("helix", {{"radius", sceneNumber(radius)},
                               {"top_radius", sceneNumber(top)},
                               {"height", sceneNumber(height)},
                               {"turns", sceneNumber(random.between(1, 3))},
                               {"left", random.chance(0.3) ? "true" : "false"}});
        reach = lengthOf(std::max(radius, top), height);
    } else {
        std::string knots;
        const int knotCount = 3 + random.below(3);
        for (int i = 0; i < knotCount; ++i) {
            const Point at{metres(-0.9, 0.9), metres(-0.7, 0.7), metres(-0.7, 0.7)};
            // A smooth curve can leave the box of its knots.
            reach = std::max(reach, 1.4 * lengthOf(at[0], at[1], at[2]));
            const double share = random.between(0.6, 1.3), twist = random.between(-60, 60);
            knots += (i ? ", [" : "[") + sceneNumber(at[0]) + ", " + sceneNumber(at[1]) + ", " +
                     sceneNumber(at[2]) + ", " + sceneNumber(share) + ", " + sceneNumber(twist) + "]";
        }
        spline = add("spline", {{"knots", "[" + knots + "]"},
                                {"kind", random.chance(0.7) ? "\"smooth\"" : "\"straight\""},
                                {"closed", random.chance(0.2) ? "true" : "false"}});
    }
    if (random.chance(0.15)) {
        const double radius = metres(0.2, 0.6), pitch = metres(0.15, 0.3), turns = random.between(1, 5);
        return {add("spring", {{"radius", sceneNumber(radius)},
                               {"pitch", sceneNumber(pitch)},
                               {"turns", sceneNumber(turns)},
                               {"wire", length(0.03, 0.07)}}),
                lengthOf(radius, pitch * turns) + 0.1 * unit};
    }
    if (random.chance(0.5)) {
        const double radius = metres(0.05, 0.2);
        return {add("tube", {{"spline", link(spline)},
                             {"radius", sceneNumber(radius)},
                             {"ends", random.chance(0.5) ? "\"round\"" : "\"flat\""}}),
                reach + 1.3 * radius};
    }
    const double width = metres(0.04, 0.2), height = metres(0.03, 0.15);
    const std::string flat =
        add("rectangle", {{"half_extents", "[" + sceneNumber(width) + ", " + sceneNumber(height) + "]"}});
    return {add("sweep", {{"surface", link(flat)}, {"spline", link(spline)}}),
            reach + 1.5 * (width + height)};
}

ScenePart SceneWriter::codeShape() {
    const std::string u = sceneNumber(unit);
    const std::string toMetres = unit == 1.0 ? "" : "p = p / " + u + "; ";
    const std::string back = unit == 1.0 ? "" : " * " + u;
    const auto n = [&](double low, double high) { return sceneNumber(random.between(low, high)); };
    const auto code = [&](const std::string& text) { return add("expression", {}, text); };
    switch (random.below(8)) {
        case 0: {
            const double c = random.between(0.1, 0.7);
            return {code(toMetres + "return (p.x*p.x + p.y*p.y*p.y*p.y + p.z*p.z - " + sceneNumber(c) + ")" +
                         back + ";"),
                    unit * (std::sqrt(c) + std::sqrt(std::sqrt(c)))};
        }
        case 1: {
            const double a = random.between(0.3, 2), b = random.between(0.3, 2), c = random.between(0.3, 2);
            return {code(toMetres + "return (" + sceneNumber(a) + "*p.x*p.x + " + sceneNumber(b) +
                         "*p.y*p.y + " + sceneNumber(c) + "*pow(p.z, 4) - 0.3 + 0.1*p.x*p.z)" + back + ";"),
                    2.5 * unit};
        }
        case 2: {
            // A torus as a polynomial.
            const double major = random.between(0.4, 0.8), minor = random.between(0.1, 0.3);
            const std::string sum = sceneNumber(major * major - minor * minor);
            return {code(toMetres + "k = dot(p, p) + " + sum + "; return (k*k - " +
                         sceneNumber(4.0 * major * major) + "*(p.x*p.x + p.z*p.z))" + back + ";"),
                    unit * (major + minor + 0.05)};
        }
        case 3:
            // The heart of Taubin.
            return {code(toMetres +
                         "a = p.x*p.x + 2.25*p.z*p.z + p.y*p.y - 1; "
                         "return (a*a*a - p.x*p.x*p.y*p.y*p.y - 0.1125*p.z*p.z*p.y*p.y*p.y)" +
                         back + ";"),
                    1.6 * unit};
        case 4: {
            // A box that is rotated by hand.
            const Point half{metres(0.2, 0.8), metres(0.2, 0.8), metres(0.2, 0.8)};
            const std::string c = n(0.2, 1.4), t = n(0.2, 1.4), a = n(0.2, 1.4);
            return {code("c = cos(" + c + "); s = sin(" + t + "); a = " + a +
                         "; p.xz = vec2(c * p.x - s * p.z, s * p.x + c * p.z) / sqrt(c*c + s*s); " +
                         "p.xy = vec2(cos(a) * p.x - sin(a) * p.y, sin(a) * p.x + cos(a) * p.y); " +
                         "return box(p, vec3(" + sceneNumber(half[0]) + ", " + sceneNumber(half[1]) + ", " +
                         sceneNumber(half[2]) + "));"),
                    lengthOf(half[0], half[1], half[2])};
        }
        case 5: {
            // Balls at random positions.
            const std::string balls = std::to_string(3 + random.below(6));
            const std::string hash = std::to_string(random.below(50));
            const std::string width = length(0.8, 2), radius = length(0.1, 0.4);
            return {
                code("d = 1e9; for (int i = 0; i < " + balls + "; i++) { h = hash3(vec3(i, 3, " + hash +
                     ")); d = min(d, length(p - (h - 0.5) * " + width + ") - " + radius + "); } return d;"),
                2.2 * unit};
        }
        case 6: {
            // Two metaballs, whose field has an upper bound.
            const std::string half = n(0.2, 0.45);
            ScenePart part{
                code(toMetres + "a = p - vec3(" + half + ", 0, 0); b = p + vec3(" + half +
                     ", 0.1, 0); return (1 - 0.15 / max(dot(a, a), 0.0001) - 0.15 / max(dot(b, b), 0.0001))" +
                     back + ";"),
                1.2 * unit};
            part.distanceLike = false;
            return part;
        }
        default: {
            // A superellipsoid.
            const double r = random.between(0.3, 0.9);
            return {
                code(toMetres + "q = abs(p) / " + sceneNumber(r) +
                     "; return 0.3 * (pow(pow(q.x, 3) + pow(q.y, 3) + pow(q.z, 3), 1 / 3) - 1)" + back + ";"),
                1.7 * r * unit};
        }
    }
}

}  // namespace fw::test
