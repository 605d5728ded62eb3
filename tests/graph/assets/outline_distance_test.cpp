// Distances of text and of drawings against brute force: the curves as others read or as they were written,
// halved until what a chord leaves of them is known to be nothing. No code is shared with what is judged.
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <sstream>

#include "graph/outlines/drawing.h"
#include "graph/outlines/letters.h"

namespace fw::outline_distance_test {

using glm::dvec2;

constexpr int kPlaces = 100'000;
constexpr double kWanted = 1e-5;     // of the size of a letter or a page
constexpr double kReference = 1e-8;  // how exact the brute force is, the same

/// A smooth curve over 0 to 1.
struct Curve {
    std::function<dvec2(double)> at;
    double bent;  ///< its second derivative is nowhere longer
    dvec2 middle;
    double reach;  ///< about the middle, of all its places

    Curve(std::function<dvec2(double)> at_, double bent_) : at(std::move(at_)), bent(bent_) {
        constexpr int kParts = 64;
        middle = at(0.5), reach = 0;
        for (int i = 0; i <= kParts; ++i)
            reach = std::max(reach, glm::distance(middle, at(double(i) / kParts)));
        reach += bent / (8.0 * kParts * kParts);  // what is between them
    }
};

double toSegment(dvec2 a, dvec2 b, dvec2 p) {
    const dvec2 along = b - a;
    const double size = glm::dot(along, along);
    return glm::distance(p,
                         a + (size > 0 ? std::clamp(glm::dot(p - a, along) / size, 0.0, 1.0) : 0.0) * along);
}

/// Lowers `nearest` to the distance of a part of a curve. A chord is as far from the curve as an eighth of
/// the second derivative times the square of its span at most: what cannot be nearer is let go.
void approach(const Curve& curve, double from, double to, dvec2 a, dvec2 b, dvec2 p, double& nearest) {
    const double off = curve.bent * (to - from) * (to - from) / 8, chord = toSegment(a, b, p);
    if (chord - off >= nearest) return;
    if (off < kReference) {
        nearest = std::min(nearest, chord);
        return;
    }
    const double middle = 0.5 * (from + to);
    const dvec2 m = curve.at(middle);
    nearest = std::min(nearest, glm::distance(p, m) + kReference);
    const bool firstIsNearer = toSegment(a, m, p) < toSegment(m, b, p);
    if (firstIsNearer) approach(curve, from, middle, a, m, p, nearest);
    approach(curve, middle, to, m, b, p, nearest);
    if (!firstIsNearer) approach(curve, from, middle, a, m, p, nearest);
}

double distanceTo(const std::vector<Curve>& curves, dvec2 p) {
    double nearest = 1e300;
    for (const Curve& curve : curves)
        nearest = std::min(nearest, glm::distance(p, curve.middle) + kReference);
    for (const Curve& curve : curves)
        if (glm::distance(p, curve.middle) - curve.reach < nearest)
            approach(curve, 0, 1, curve.at(0), curve.at(1), p, nearest);
    return nearest;
}

Curve bezier(std::vector<dvec2> p) {
    const auto degree = double(p.size() - 1);
    double bent = 0;
    for (std::size_t i = 0; i + 2 < p.size(); ++i)
        bent = std::max(bent, degree * (degree - 1) * glm::length(p[i] - 2.0 * p[i + 1] + p[i + 2]));
    return {[p = std::move(p)](double t) {  // de Casteljau
                std::array<dvec2, 4> q{};
                std::copy(p.begin(), p.end(), q.begin());
                for (std::size_t n = p.size() - 1; n > 0; --n)
                    for (std::size_t i = 0; i < n; ++i) q[i] = (1 - t) * q[i] + t * q[i + 1];
                return q[0];
            },
            bent};
}

/// centre + cos(w) u + sin(w) v.
Curve ellipse(dvec2 centre, dvec2 u, dvec2 v, double from, double to) {
    return {[=](double t) {
                const double w = from + t * (to - from);
                return centre + std::cos(w) * u + std::sin(w) * v;
            },
            (to - from) * (to - from) * (glm::length(u) + glm::length(v))};
}

/// Half of the places anywhere in the square about 0, the others close to the curves.
void expectDistances(const OutlinePtr& outline, const std::vector<Curve>& curves, dvec2 half) {
    ASSERT_TRUE(outline);
    std::mt19937 random(12);
    std::uniform_real_distribution<double> unit(-1, 1);
    double worst = 0;
    dvec2 where{0, 0};
    for (int i = 0; i < kPlaces; ++i) {
        dvec2 p = half * dvec2(unit(random), unit(random));
        if (i % 2 != 0) {
            const Curve& curve = curves[std::size_t(random()) % curves.size()];
            p = curve.at(0.5 + 0.5 * unit(random)) +
                std::exp2(-12 + 10 * unit(random)) * dvec2(unit(random), unit(random));
        }
        const double found = std::abs(sampleOutline(*outline, p.x, p.y).value);
        if (const double off = std::abs(found - distanceTo(curves, p)); off > worst) worst = off, where = p;
    }
    EXPECT_LT(worst, kWanted) << "at " << where.x << " " << where.y;
}

// ---- Text, whose curves FreeType reads

/// The curves of letters beside each other, without kerning; em.
std::vector<Curve> lettersByFreeType(const char* file, const std::u32string& text) {
    FT_Library library = nullptr;
    FT_Face face = nullptr;
    EXPECT_EQ(FT_Init_FreeType(&library), 0);
    if (FT_New_Face(library, file, 0, &face) != 0) return {};
    struct Reading {
        std::vector<Curve> curves;
        dvec2 origin{0, 0}, at{0, 0};
        double em = 1;
        dvec2 place(const FT_Vector* p) const { return origin + dvec2(p->x, p->y) / em; }
        int to(std::vector<dvec2> points) {
            points.insert(points.begin(), at);
            at = points.back();
            curves.push_back(bezier(std::move(points)));
            return 0;
        }
    } reading;
    // A pixel for each of the font's units, of which FreeType counts 64ths: with whole units it would round
    // the places between two control points.
    EXPECT_EQ(FT_Set_Pixel_Sizes(face, 0, face->units_per_EM), 0);
    reading.em = 64.0 * face->units_per_EM;
    FT_Outline_Funcs pen{};
    pen.move_to = [](const FT_Vector* p, void* data) {
        auto& to = *static_cast<Reading*>(data);
        to.at = to.place(p);
        return 0;
    };
    pen.line_to = [](const FT_Vector* p, void* data) {
        auto& to = *static_cast<Reading*>(data);
        return to.to({to.place(p)});
    };
    pen.conic_to = [](const FT_Vector* c, const FT_Vector* p, void* data) {
        auto& to = *static_cast<Reading*>(data);
        return to.to({to.place(c), to.place(p)});
    };
    pen.cubic_to = [](const FT_Vector* c, const FT_Vector* d, const FT_Vector* p, void* data) {
        auto& to = *static_cast<Reading*>(data);
        return to.to({to.place(c), to.place(d), to.place(p)});
    };
    for (const char32_t letter : text) {
        if (FT_Load_Char(face, letter, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP) != 0) return {};
        EXPECT_EQ(FT_Outline_Decompose(&face->glyph->outline, &pen, &reading), 0);
        reading.origin.x += double(face->glyph->linearHoriAdvance) / 0x10000 / face->units_per_EM;
    }
    FT_Done_Face(face);
    FT_Done_FreeType(library);
    return std::move(reading.curves);
}

void expectText(const char* file, const std::string& family, const std::string& text,
                const std::u32string& letters) {
    const std::vector<Curve> curves = lettersByFreeType(file, letters);
    if (curves.empty()) GTEST_SKIP() << "needs " << file << ": run ./.install test";
    const Result<OutlinePtr> outline = outlineOfText("", text,
                                                     {.family = family,
                                                      .align = TextLayout::Align::left,
                                                      .anchor = TextLayout::Anchor::baseline,
                                                      .kerning = false});
    ASSERT_TRUE(outline) << outline.error().message;
    expectDistances(*outline, curves, {6, 1.5});
}

TEST(OutlineDistance, OfTextIsThatToTheFontsCurves) {
    expectText("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "DejaVu Sans", "g&@8Qß%Ωi", U"g&@8Qß%Ωi");
}

// Fonts of PostScript's kind have cubic curves.
TEST(OutlineDistance, OfTextIsThatToCubicCurves) {
    expectText("/usr/share/fonts/opentype/urw-base35/C059-Roman.otf", "C059", "g&@8Qß%Si", U"g&@8Qß%Si");
}

// ---- Drawings, whose curves are written here

std::string written(dvec2 p) {
    std::ostringstream words;
    words.precision(17);
    words << ' ' << p.x << ' ' << p.y;
    return words.str();
}

/// From the space of a page of 100 by 100, y downwards, to the drawing's.
dvec2 onPage(dvec2 p) { return {(p.x - 50) / 100, (50 - p.y) / 100}; }

TEST(OutlineDistance, OfAnSvgIsThatToItsCurves) {
    std::mt19937 random(12);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Curve> curves;
    std::string path = "M50 10";
    dvec2 at{50, 10};
    for (int i = 0; i < 8; ++i) {  // a wavy ring of curves of both degrees
        const double angle = 2 * std::numbers::pi * (i + 1) / 8 - std::numbers::pi / 2;
        const dvec2 next =
            i == 7 ? dvec2(50, 10)
                   : dvec2(50, 50) + (30 + 15 * unit(random)) * dvec2(std::cos(angle), std::sin(angle));
        const dvec2 along = next - at, out{along.y, -along.x};
        const dvec2 b = at + 0.3 * along + (0.6 * unit(random)) * out,
                    c = at + 0.7 * along + (0.6 * unit(random) - 0.2) * out;
        if (i % 3 == 2) {
            path += " Q" + written(b) + written(next);
            curves.push_back(bezier({onPage(at), onPage(b), onPage(next)}));
        } else {
            path += " C" + written(b) + written(c) + written(next);
            curves.push_back(bezier({onPage(at), onPage(b), onPage(c), onPage(next)}));
        }
        at = next;
    }
    // In the middle a hole that is an ellipse, turned.
    const double turned = 30 * std::numbers::pi / 180;
    const dvec2 u = 9.0 * dvec2(std::cos(turned), -std::sin(turned)),
                v = 4.0 * dvec2(std::sin(turned), std::cos(turned)), middle{52, 48};
    const dvec2 start = middle + dvec2(u.x, -u.y), end = middle - dvec2(u.x, -u.y);
    path += "z M" + written(start) + " A 9 4 30 0 1" + written(end) + " A 9 4 30 0 1" + written(start) + "z";
    curves.push_back(ellipse(onPage(middle), u / 100.0, v / 100.0, 0, 2 * std::numbers::pi));
    const Result<Drawing> drawing =
        readSvg("<svg viewBox='0 0 100 100'><path fill-rule='evenodd' d='" + path + "'/></svg>", "");
    ASSERT_TRUE(drawing) << drawing.error().message;
    const Result<OutlinePtr> outline = outlineOf(drawing->painting, "", "");
    ASSERT_TRUE(outline) << outline.error().message;
    expectDistances(*outline, curves, {0.6, 0.6});
}

/// A B-spline's basis function, by its definition. (Cox and de Boor, 1972)
double basis(const std::vector<double>& knots, std::size_t i, int degree, double t) {
    if (degree == 0) return t >= knots[i] && t < knots[i + 1];
    const auto p = std::size_t(degree);
    const double rising = knots[i + p] - knots[i], falling = knots[i + p + 1] - knots[i + 1];
    return (rising > 0 ? (t - knots[i]) / rising * basis(knots, i, degree - 1, t) : 0) +
           (falling > 0 ? (knots[i + p + 1] - t) / falling * basis(knots, i + 1, degree - 1, t) : 0);
}

TEST(OutlineDistance, OfADxfIsThatToItsCurves) {
    std::vector<Curve> curves;
    const auto group = [](int code, double value) {
        std::ostringstream words;
        words.precision(17);
        words << code << '\n' << value << '\n';
        return words.str();
    };
    // It reaches from -1 to 1 by a circle about all, so that its unit is half of the file's.
    const auto unit = [](dvec2 p) { return 0.5 * p; };
    std::string entities = "0\nCIRCLE\n10\n0\n20\n0\n40\n1\n";
    curves.push_back(ellipse({0, 0}, {0.5, 0}, {0, 0.5}, 0, 2 * std::numbers::pi));
    // A closed cubic spline with knots at uneven distances, a hole.
    constexpr std::size_t kControls = 9, kOwn = 6;  // the last three are the first three again
    std::vector<dvec2> controls;
    for (std::size_t i = 0; i < kControls; ++i) {
        const double angle = 2 * std::numbers::pi * double(i % kOwn) / kOwn,
                     radius = 0.35 + 0.1 * double(i % kOwn % 2);
        controls.push_back({-0.3 + radius * std::cos(angle), radius * std::sin(angle)});
    }
    const std::array<double, kOwn> steps = {1, 2, 0.5, 1, 1.5, 0.75};
    std::vector<double> knots = {0};
    for (std::size_t i = 0; i < kControls + 3; ++i) knots.push_back(knots.back() + steps[i % kOwn]);
    entities += "0\nSPLINE\n70\n8\n71\n3\n";
    for (const double knot : knots) entities += group(40, knot);
    for (const dvec2 p : controls) entities += group(10, p.x) + group(20, p.y);
    for (std::size_t span = 3; span < kControls; ++span) {
        // A cubic is known by four places of it; its ends and what its inner controls must be then.
        std::array<dvec2, 4> on{};
        for (std::size_t k = 0; k < 4; ++k) {
            const double t =
                knots[span] + (knots[span + 1] - knots[span]) * (k < 3 ? double(k) / 3 : 1 - 1e-12);
            for (std::size_t i = 0; i < kControls; ++i) on[k] += basis(knots, i, 3, t) * unit(controls[i]);
        }
        curves.push_back(bezier({on[0], (-5.0 * on[0] + 18.0 * on[1] - 9.0 * on[2] + 2.0 * on[3]) / 6.0,
                                 (2.0 * on[0] - 9.0 * on[1] + 18.0 * on[2] - 5.0 * on[3]) / 6.0, on[3]}));
    }
    // Half an ellipse with a line, and a polyline with a bulge.
    entities += "0\nELLIPSE\n10\n0.5\n20\n0.3\n11\n0.25\n21\n0.1\n40\n0.5\n41\n0\n42\n3.141592653589793\n";
    curves.push_back(ellipse({0.25, 0.15}, {0.125, 0.05}, {-0.025, 0.0625}, 0, std::numbers::pi));
    entities += "0\nLINE\n10\n0.25\n20\n0.2\n11\n0.75\n21\n0.4\n";
    curves.push_back(bezier({unit({0.25, 0.2}), unit({0.75, 0.4})}));
    entities += "0\nLWPOLYLINE\n70\n1\n10\n0.4\n20\n-0.2\n10\n0.7\n20\n-0.2\n42\n1\n10\n0.4\n20\n-0.6\n";
    curves.push_back(bezier({unit({0.4, -0.2}), unit({0.7, -0.2})}));
    curves.push_back(bezier({unit({0.4, -0.6}), unit({0.4, -0.2})}));
    // From 0.7 -0.2 to 0.4 -0.6 half a circle, counter-clockwise.
    curves.push_back(ellipse(unit({0.55, -0.4}), unit({0.15, 0.2}), unit({-0.2, 0.15}), 0, std::numbers::pi));
    const Result<Drawing> drawing =
        readDxf("0\nSECTION\n2\nENTITIES\n" + entities + "0\nENDSEC\n0\nEOF\n", "");
    ASSERT_TRUE(drawing) << drawing.error().message;
    EXPECT_TRUE(drawing->remarks.empty());
    const Result<OutlinePtr> outline = outlineOf(drawing->painting, "", "");
    ASSERT_TRUE(outline) << outline.error().message;
    expectDistances(*outline, curves, {0.6, 0.6});
}

}  // namespace fw::outline_distance_test
