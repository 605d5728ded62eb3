// Boundaries of what is painted: signs against windings, areas that are known, and outlines that close.
#include "graph/outlines/boundary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "graph/outlines/stroke.h"

namespace fw::boundary_test {

using glm::dvec2;
constexpr double kTurn = 2 * std::numbers::pi;

void circle(Pen& pen, dvec2 centre, double radius, bool left = true) {
    pen.moveTo({centre.x + radius, centre.y});
    pen.ellipse(centre, {radius, 0}, {0, radius}, 0, left ? kTurn : -kTurn);
    pen.close();
}
void rectangle(Pen& pen, dvec2 lo, dvec2 hi) {
    pen.moveTo(lo), pen.lineTo({hi.x, lo.y}), pen.lineTo(hi), pen.lineTo({lo.x, hi.y});
    pen.close();
}

double areaOf(const std::vector<Arc>& arcs) {
    double twice = 0;
    for (const Arc& arc : arcs) twice += twiceAreaBeside(arc);
    return 0.5 * twice;
}
double lengthOfAll(const std::vector<Arc>& arcs) {
    double length = 0;
    for (const Arc& arc : arcs) length += lengthOf(arc);
    return length;
}

Painting painted(Pen& pen, bool evenOdd = false) { return {{Fill{pen.taken(), evenOdd}}, {}}; }

TEST(Boundary, OverlapsAreInsideAndNoEdge) {
    Pen pen(1e-6);
    rectangle(pen, {0, 0}, {2, 1}), rectangle(pen, {1, 0}, {3, 1});  // their long sides lie upon each other
    const std::vector<Arc> united = Painted(painted(pen)).boundary().value();
    EXPECT_NEAR(areaOf(united), 3, 1e-12);
    EXPECT_NEAR(lengthOfAll(united), 8, 1e-6);

    rectangle(pen, {0, 0}, {2, 1}), rectangle(pen, {1, 0}, {3, 1});
    EXPECT_NEAR(areaOf(Painted(painted(pen, true)).boundary().value()), 2, 1e-6);

    rectangle(pen, {0, 0}, {1, 1}), rectangle(pen, {1, 0}, {2, 1});  // side by side
    const std::vector<Arc> beside = Painted(painted(pen)).boundary().value();
    EXPECT_NEAR(areaOf(beside), 2, 1e-12);
    EXPECT_NEAR(lengthOfAll(beside), 6, 1e-6);

    rectangle(pen, {0, 0}, {1, 1}), rectangle(pen, {0, 0}, {1, 1});  // twice the same
    EXPECT_NEAR(lengthOfAll(Painted(painted(pen)).boundary().value()), 4, 1e-6);
    rectangle(pen, {0, 0}, {1, 1}), rectangle(pen, {0, 0}, {1, 1});
    EXPECT_TRUE(Painted(painted(pen, true)).boundary().value().empty());
}

TEST(Boundary, TwoDiscsAreALensLess) {
    Pen pen(1e-9);
    circle(pen, {0, 0}, 1), circle(pen, {1, 0}, 1);
    const double lens = kTurn / 3 - std::sqrt(3) / 2;
    EXPECT_NEAR(areaOf(Painted(painted(pen)).boundary().value()), kTurn - lens, 1e-7);
    circle(pen, {0, 0}, 1), circle(pen, {1, 0}, 1, false);  // wound against each other: the lens is not
    EXPECT_NEAR(areaOf(Painted(painted(pen)).boundary().value()), kTurn - 2 * lens, 1e-7);
    circle(pen, {0, 0}, 1), circle(pen, {0, 0}, 0.5, false);
    EXPECT_NEAR(areaOf(Painted(painted(pen)).boundary().value()), 0.75 * kTurn / 2, 1e-7);
}

TEST(Boundary, ClipsCut) {
    Pen pen(1e-9);
    circle(pen, {0, 0}, 1);
    Painting painting = painted(pen);
    rectangle(pen, {0, -2}, {2, 2});
    painting.clips.push_back({Fill{pen.taken()}});
    rectangle(pen, {-2, 0}, {2, 2});
    painting.clips.push_back({Fill{pen.taken()}});
    EXPECT_NEAR(areaOf(Painted(painting).boundary().value()), kTurn / 2, 1e-9);
    painting.fills[0].clips = {0};
    EXPECT_NEAR(areaOf(Painted(painting).boundary().value()), kTurn / 4, 1e-9);
    painting.fills[0].clips = {0, 1};
    const std::vector<Arc> quarter = Painted(painting).boundary().value();
    EXPECT_NEAR(areaOf(quarter), kTurn / 8, 1e-9);
    EXPECT_NEAR(lengthOfAll(quarter), 2 + kTurn / 4, 1e-6);
}

TEST(Boundary, OfAnythingHasTheSidesOfItsWindings) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int round = 0; round < 24; ++round) {
        Pen pen(1e-6);
        const int shapes = 1 << round / 4;
        for (int i = 0; i < shapes; ++i) {
            const dvec2 at{unit(random), unit(random)};
            const auto by = [&] { return at + 0.4 * dvec2(unit(random), unit(random)); };
            if (i % 3 == 0) {
                circle(pen, at, 0.05 + 0.2 * std::abs(unit(random)), unit(random) > 0);
            } else if (i % 3 == 1) {
                pen.moveTo(at);
                pen.curveTo(by(), by(), by());
                pen.curveTo(by(), at);
                pen.close();
            } else {  // corners on a lattice, so that edges lie upon each other
                const dvec2 snapped = glm::floor(at * 8.0) / 8.0;
                rectangle(pen, snapped, snapped + 0.25);
            }
        }
        std::vector<Contour> drawn = pen.taken();
        if (round % 2 != 0) drawn = strokeOf(drawn, {.width = 0.03, .join = StrokeStyle::Join(round % 3)});
        const Painting painting{{Fill{drawn, round % 4 == 0}}, {}};
        const Painted whole(painting);
        const std::vector<Arc> arcs = whole.boundary().value();
        ASSERT_FALSE(arcs.empty());
        ASSERT_LE(arcs.size(), kMostArcs);
        // Counted along a ray, the arcs alone have the same sides: they close.
        const Outline outline(arcs);
        for (int i = 0; i < 4000; ++i) {
            const dvec2 p{1.5 * unit(random), 1.5 * unit(random)};
            const double value = sampleOutline(outline, p.x, p.y).value;
            if (std::abs(value) > 1e-5) {
                EXPECT_EQ(value < 0, whole.has(p)) << round << ": " << p.x << " " << p.y;
            }
        }
    }
}

TEST(Stroke, HasItsJoinsAndCaps) {
    const auto area = [](const std::vector<dvec2>& places, bool closed, StrokeStyle style) {
        Pen pen(1e-7);
        pen.moveTo(places[0]);
        for (std::size_t i = 1; i < places.size(); ++i) pen.lineTo(places[i]);
        if (closed) pen.close();
        const Painting painting{{Fill{strokeOf(pen.taken(), style)}}, {}};
        return areaOf(Painted(painting).boundary().value());
    };
    using Cap = StrokeStyle::Cap;
    using Join = StrokeStyle::Join;
    const std::vector<dvec2> line = {{0, 0}, {2, 0}}, corner = {{0, 0}, {2, 0}, {2, 2}},
                             square = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
    constexpr double w = 0.5, quarter = kTurn / 4 * w * w / 4 / 2;  // of a disc as wide as the stroke
    EXPECT_NEAR(area(line, false, {.width = w}), 1, 1e-9);
    EXPECT_NEAR(area(line, false, {.width = w, .cap = Cap::square}), 1.25, 1e-9);
    EXPECT_NEAR(area(line, false, {.width = w, .cap = Cap::round}), 1 + 4 * quarter, 1e-7);
    const double bent = 2 * 2 * w - w * w / 4;
    EXPECT_NEAR(area(corner, false, {.width = w}), bent + w * w / 4, 1e-7);
    EXPECT_NEAR(area(corner, false, {.width = w, .join = Join::bevel}), bent + w * w / 8, 1e-7);
    EXPECT_NEAR(area(corner, false, {.width = w, .join = Join::round}), bent + quarter, 1e-7);
    EXPECT_NEAR(area(corner, false, {.width = w, .miterLimit = 1.4}), bent + w * w / 8, 1e-7)
        << "sqrt(2) is beyond the limit";
    EXPECT_NEAR(area(square, true, {.width = w}), 4.5 * 4.5 - 3.5 * 3.5, 1e-7);
    EXPECT_NEAR(area(line, false, {.width = w, .dashes = {0.5, 0.25}}), (0.5 + 0.5 + 0.5) * w, 1e-7);
    EXPECT_NEAR(area(line, false, {.width = w, .dashes = {0.5}, .dashOffset = 0.25}), 1.0 * w, 1e-7);
    EXPECT_NEAR(area({{1, 1}, {1, 1}}, false, {.width = w, .cap = Cap::round}), 4 * quarter, 1e-7) << "a dot";
}

TEST(Stroke, OfACircleIsARingAndWiderThanItADisc) {
    Pen pen(1e-7);
    circle(pen, {0, 0}, 1);
    const std::vector<Contour> drawn = pen.taken();
    const auto area = [&](double width) {
        const Painting painting{{Fill{strokeOf(drawn, {.width = width})}}, {}};
        return areaOf(Painted(painting).boundary().value());
    };
    EXPECT_NEAR(area(0.5), kTurn / 2 * (1.25 * 1.25 - 0.75 * 0.75), 1e-6);
    EXPECT_NEAR(area(2.5), kTurn / 2 * 2.25 * 2.25, 1e-6);
}

}  // namespace fw::boundary_test
