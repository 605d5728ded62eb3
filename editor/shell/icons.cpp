#include "editor/shell/icons.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "editor/shell/theme.h"

namespace fw::editor {

void drawIcon(ImDrawList& list, Category category, ImVec2 centre, float side, ImU32 ink) {
    const float r = 0.5f * side, thick = std::max(1.0f, std::round(0.1f * side));
    const auto at = [&](float x, float y) { return ImVec2(centre.x + r * x, centre.y + r * y); };
    const auto line = [&](float x, float y, float u, float v) {
        list.AddLine(at(x, y), at(u, v), ink, thick);
    };
    const auto ring = [&](float x, float y, float radius) {
        list.AddCircle(at(x, y), r * radius, ink, 0, thick);
    };
    const auto dot = [&](float x, float y, float radius) { list.AddCircleFilled(at(x, y), r * radius, ink); };
    const auto closed = [&](std::span<const ImVec2> corners) {
        std::array<ImVec2, 8> points;
        for (std::size_t i = 0; i < corners.size(); ++i) points[i] = at(corners[i].x, corners[i].y);
        list.AddPolyline(points.data(), int(corners.size()), ink, ImDrawFlags_Closed, thick);
    };
    const auto square = [&](float x, float y, float half) {
        list.AddRectFilled(at(x - half, y - half), at(x + half, y + half), ink);
    };
    switch (category) {
        case Category::shape: {  // a cube from a corner
            const ImVec2 rim[] = {{0, -1}, {0.87f, -0.5f}, {0.87f, 0.5f},
                                  {0, 1},  {-0.87f, 0.5f}, {-0.87f, -0.5f}};
            closed(rim);
            line(0, 0, 0, 1), line(0, 0, 0.87f, -0.5f), line(0, 0, -0.87f, -0.5f);
            return;
        }
        case Category::shape2d: {  // a pentagon
            std::array<ImVec2, 5> corners;
            for (std::size_t i = 0; i < corners.size(); ++i) {
                const float angle = 0.4f * std::numbers::pi_v<float> * float(i);
                corners[i] = {0.95f * std::sin(angle), 0.05f - 0.95f * std::cos(angle)};
            }
            return closed(corners);
        }
        case Category::spline:  // a wave
            for (int i = -6; i < 6; ++i) {
                const float x = 0.16f * float(i), y = 0.16f * float(i + 1);
                line(x, 0.6f * std::sin(3.4f * x), y, 0.6f * std::sin(3.4f * y));
            }
            return;
        case Category::combine: ring(-0.35f, 0, 0.6f), ring(0.35f, 0, 0.6f); return;
        case Category::domain:  // one thing at four places
            for (const float x : {-0.55f, 0.55f})
                for (const float y : {-0.55f, 0.55f}) square(x, y, 0.32f);
            return;
        case Category::field: ring(0, 0, 0.95f), dot(0, 0, 0.4f); return;  // distances from a point
        case Category::maths:
            line(-0.5f, -0.95f, -0.5f, 0.05f), line(-1, -0.45f, 0, -0.45f);  // plus
            line(0.15f, 0.5f, 0.95f, 0.5f);                                  // minus
            return line(0.75f, -0.9f, -0.75f, 0.9f);
        case Category::material:  // a ball with a light on it
            ring(0, 0, 0.95f);
            return dot(-0.3f, -0.3f, 0.3f);
        case Category::mesh: {  // a triangle of triangles
            const ImVec2 rim[] = {{0, -0.95f}, {0.95f, 0.8f}, {-0.95f, 0.8f}};
            const ImVec2 inner[] = {{0.48f, -0.08f}, {0, 0.8f}, {-0.48f, -0.08f}};
            closed(rim);
            return closed(inner);
        }
        case Category::particles:
            dot(-0.6f, 0.6f, 0.26f), dot(0.1f, 0.75f, 0.26f), dot(-0.25f, 0, 0.26f), dot(0.6f, 0.15f, 0.26f);
            return dot(0.25f, -0.7f, 0.26f);
        case Category::structure:  // two that lead to a third
            square(-0.65f, -0.6f, 0.32f), square(-0.65f, 0.6f, 0.32f), square(0.65f, 0, 0.32f);
            line(-0.65f, -0.6f, 0.65f, 0), line(-0.65f, 0.6f, 0.65f, 0);
            return;
    }
}

void drawBadge(ImDrawList& list, Category category, ImVec2 centre, float side) {
    const float half = std::round(0.5f * side);
    const ImVec2 middle(std::round(centre.x), std::round(centre.y));
    list.AddRectFilled({middle.x - half, middle.y - half}, {middle.x + half, middle.y + half},
                       categoryColor(category), 0.2f * side);
    drawIcon(list, category, middle, 0.72f * side, themeColor(ThemeColor::onTitle));
}

}  // namespace fw::editor
