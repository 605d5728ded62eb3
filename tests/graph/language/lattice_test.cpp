// Lattices against their struts, one by one; even walls; and what grading makes of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/evaluate/evaluate.h"

namespace fw::lattice_test {

using Vec = std::array<double, 3>;

Vec operator+(const Vec& a, const Vec& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vec operator-(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec operator*(double s, const Vec& a) { return {s * a[0], s * a[1], s * a[2]}; }
double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// A lattice node's program.
Program lattice(const std::string& inputs, const std::string& type = "lattice") {
    const Result<Graph> graph = parseGraph(
        R"({"fieldwright": 1, "nodes": [{"id": "n", "type": ")" + type + R"(", "inputs": {)" + inputs +
            R"(}}, {"id": "out", "type": "output", "inputs": {"surface": {"from": "n"}}}]})",
        "lattice.field.json", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    Result<Program> made = compile(*graph);
    EXPECT_TRUE(made) << format(made.error());
    return made ? std::move(*made) : Program();
}
std::vector<ValueGradient> valuesAt(const Program& program, const std::vector<Point>& places) {
    std::vector<ValueGradient> found(places.size());
    evaluateGradient(program.ir, program.distance(), {}, places, found);
    return found;
}
std::vector<Point> places(std::size_t count, double reach, uint32_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> along(-reach, reach);
    std::vector<Point> made(count);
    for (Point& p : made) p = {along(random), along(random), along(random)};
    return made;
}

struct Strut {
    Vec a, b;
};
double distanceTo(const Strut& strut, const Vec& p) {
    const Vec along = strut.b - strut.a, off = p - strut.a;
    const double t = std::clamp(dot(off, along) / dot(along, along), 0.0, 1.0);
    const Vec rest = off - t * along;
    return std::sqrt(dot(rest, rest));
}

/// The struts within two cells of the origin, of cells of size 1: pairs of nodes that are so far apart.
std::vector<Strut> bonds(const std::vector<Vec>& basis, double length) {
    std::vector<Vec> nodes;
    for (int k = -2; k <= 2; ++k)
        for (int j = -2; j <= 2; ++j)
            for (int i = -2; i <= 2; ++i)
                for (const Vec& at : basis) nodes.push_back(Vec{double(i), double(j), double(k)} + at);
    std::vector<Strut> struts;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (std::abs(std::sqrt(dot(nodes[i] - nodes[j], nodes[i] - nodes[j])) - length) < 1e-9)
                struts.push_back({nodes[i], nodes[j]});
    return struts;
}

TEST(Lattice, StrutsAreWhereTheCrystalHasThem) {
    const std::vector<Vec> cubic = {{0, 0, 0}}, face = {{0, 0, 0}, {.5, .5, 0}, {.5, 0, .5}, {0, .5, .5}};
    std::vector<Vec> body = cubic, diamond = face, kelvin;
    body.push_back({.5, .5, .5});
    for (const Vec& at : face) diamond.push_back(at + Vec{.25, .25, .25});
    for (int axis = 0; axis < 3; ++axis)  // half way between the faces of a truncated octahedron's squares
        for (const auto& [u, v] : {std::pair(.25, .5), {.5, .25}}) {
            Vec at{0, 0, 0};
            at[std::size_t((axis + 1) % 3)] = u, at[std::size_t((axis + 2) % 3)] = v;
            kelvin.push_back(at);
            at[std::size_t((axis + 1) % 3)] = 1 - u, at[std::size_t((axis + 2) % 3)] = 1 - v;
            kelvin.push_back(at);
        }
    std::vector<Strut> faceCentred;  // the corners of each face with its middle
    for (const Strut& strut : bonds(face, std::sqrt(.5))) {
        const auto isCorner = [](const Vec& a) {
            return a[0] == std::round(a[0]) && a[1] == std::round(a[1]) && a[2] == std::round(a[2]);
        };
        if (isCorner(strut.a) || isCorner(strut.b)) faceCentred.push_back(strut);
    }
    std::vector<Strut> hexagonal;
    for (int j = -4; j <= 4; ++j)
        for (int i = -4; i <= 4; ++i)
            for (int half = 0; half < 2; ++half)
                for (int layer = -1; layer <= 1; ++layer)
                    for (int corner = 0; corner < 6; ++corner) {
                        const auto at = [&](int n, double y) {
                            const double angle = n * std::acos(-1.0) / 3, r = 1 / std::sqrt(3.0);
                            return Vec{std::sqrt(3.0) * (i + 0.5 * half) + r * std::cos(angle), y,
                                       j + 0.5 * half + r * std::sin(angle)};
                        };
                        hexagonal.push_back({at(corner, layer), at(corner + 1, layer)});
                        hexagonal.push_back({at(corner, -2), at(corner, 2)});
                    }
    const std::pair<const char*, std::vector<Strut>> kinds[] = {
        {"cubic", bonds(cubic, 1)},
        {"body centred", bonds(body, std::sqrt(.75))},
        {"face centred", faceCentred},
        {"octet", bonds(face, std::sqrt(.5))},
        {"kelvin", bonds(kelvin, std::sqrt(.125))},
        {"diamond", bonds(diamond, std::sqrt(3.0) / 4)},
        {"hexagonal", hexagonal}};
    const std::vector<Point> tried = places(1500, 0.99, 3);
    for (const auto& [kind, struts] : kinds) {
        SCOPED_TRACE(kind);
        ASSERT_GT(struts.size(), 20u);
        const double cell = 0.3, thickness = 0.02;
        const Program program =
            lattice(R"("kind": ")" + std::string(kind) + R"(", "cell": 0.3, "thickness": 0.02)");
        std::vector<Point> scaled = tried;
        for (Point& p : scaled) p = cell * p;
        const std::vector<ValueGradient> found = valuesAt(program, scaled);
        for (std::size_t i = 0; i < tried.size(); ++i) {
            double nearest = 1e9;
            for (const Strut& strut : struts) nearest = std::min(nearest, distanceTo(strut, tried[i]));
            ASSERT_NEAR(found[i].value, cell * nearest - 0.5 * thickness, 1e-7)
                << tried[i][0] << ' ' << tried[i][1] << ' ' << tried[i][2];
        }
    }
}

constexpr const char* kWinding[] = {"gyroid", "schwarz p", "schwarz d", "neovius", "lidinoid", "split p"};

TEST(Lattice, NoSurfaceIsSteeperThanItIsDeclared) {
    const std::vector<Point> tried = places(40000, 1.0, 4);
    for (const char* kind : kWinding) {
        const Program program = lattice(R"("kind": ")" + std::string(kind) + R"(", "cell": 0.7)");
        double steepest = 0;
        for (const ValueGradient& found : valuesAt(program, tried))
            steepest = std::max(steepest, std::sqrt(dot(found.gradient, found.gradient)));
        EXPECT_LE(steepest, program.exactness.lipschitz) << kind;
        EXPECT_GE(steepest, 0.8 * program.exactness.lipschitz) << kind;
    }
}

TEST(Lattice, WallsAreAsThickAsTheyAreToBe) {
    // From places on one side of the wall along the normal to the other side.
    for (const char* kind : kWinding) {
        const double thickness = 0.03;
        const Program program =
            lattice(R"("kind": ")" + std::string(kind) + R"(", "cell": 1, "thickness": 0.03)");
        std::vector<Point> at = places(3000, 0.5, 5);
        for (int step = 0; step < 30; ++step) {
            const std::vector<ValueGradient> found = valuesAt(program, at);
            for (std::size_t i = 0; i < at.size(); ++i)
                at[i] = at[i] - found[i].value / std::max(dot(found[i].gradient, found[i].gradient), 0.1) *
                                    found[i].gradient;
        }
        const std::vector<ValueGradient> outside = valuesAt(program, at);
        std::vector<Point> beyond = at;
        for (std::size_t i = 0; i < at.size(); ++i)
            beyond[i] = at[i] - thickness / std::sqrt(dot(outside[i].gradient, outside[i].gradient)) *
                                    outside[i].gradient;
        const std::vector<ValueGradient> other = valuesAt(program, beyond);
        std::vector<double> off;
        for (std::size_t i = 0; i < at.size(); ++i)
            if (std::abs(outside[i].value) < 1e-9) off.push_back(std::abs(other[i].value));
        ASSERT_GT(off.size(), at.size() / 2) << kind;
        std::ranges::sort(off);
        EXPECT_LT(off[off.size() / 2], 0.03 * thickness) << kind;
        EXPECT_LT(off[off.size() * 95 / 100], 0.15 * thickness) << kind;
    }
}

TEST(Lattice, GradingHalvesCells) {
    const std::vector<Point> tried = places(500, 0.8, 6);
    for (const char* kind : {"octet", "cubic", "kelvin", "gyroid"}) {
        SCOPED_TRACE(kind);
        const auto of = [&](double cell, const std::string& grade) {
            return valuesAt(lattice(R"("kind": ")" + std::string(kind) + R"(", "thickness": 0.02, "cell": )" +
                                    std::to_string(cell) + R"(, "grade": )" + grade),
                            tried);
        };
        const std::vector<ValueGradient> whole = of(0.8, "0"), half = of(0.4, "0"), once = of(0.8, "1"),
                                         almost = of(0.8, "0.99999"), quarter = of(0.2, "0"),
                                         twice = of(0.8, "2"), between = of(0.8, "0.5");
        for (std::size_t i = 0; i < tried.size(); ++i) {
            EXPECT_NEAR(once[i].value, half[i].value, 1e-9);
            EXPECT_NEAR(almost[i].value, half[i].value, 1e-5);
            EXPECT_NEAR(twice[i].value, quarter[i].value, 1e-9);
            EXPECT_LE(between[i].value, std::max(whole[i].value, half[i].value) + 0.01);
            EXPECT_GE(between[i].value, std::min(whole[i].value, half[i].value) - 1e-9);
        }
    }
}

}  // namespace fw::lattice_test
