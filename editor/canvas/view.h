// Where on the canvas one looks: pan and zoom, between canvas units and the window's pixels.
#pragma once

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "editor/document/edits.h"

namespace fw::editor {

inline constexpr float kLeastZoom = 0.05f, kMostZoom = 2.0f;
inline constexpr float kWheel = 1.15f;  ///< zoom of a notch of the wheel

struct Area {
    ImVec2 lo{0, 0}, hi{0, 0};

    float width() const { return hi.x - lo.x; }
    float height() const { return hi.y - lo.y; }
    ImVec2 centre() const { return {0.5f * (lo.x + hi.x), 0.5f * (lo.y + hi.y)}; }
    bool contains(ImVec2 p) const { return p.x >= lo.x && p.x < hi.x && p.y >= lo.y && p.y < hi.y; }
    ImVec2 nearest(ImVec2 p) const { return {std::clamp(p.x, lo.x, hi.x), std::clamp(p.y, lo.y, hi.y)}; }
    bool overlaps(const Area& other) const {
        return lo.x < other.hi.x && other.lo.x < hi.x && lo.y < other.hi.y && other.lo.y < hi.y;
    }
    void add(ImVec2 p) {
        lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
        hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
    }
    void add(const Area& other) { add(other.lo), add(other.hi); }
    Area grown(float by) const { return {{lo.x - by, lo.y - by}, {hi.x + by, hi.y + by}}; }
};

struct CanvasView {
    ImVec2 middle{0, 0};  ///< in canvas units, in the middle of the panel
    float zoom = 1.0f;    ///< pixels a canvas unit, kLeastZoom to kMostZoom times the interface's scale
    float scale = 1.0f;   ///< of the interface
    Area panel;           ///< pixels; set each frame

    float unit() const { return zoom * scale; }
    ImVec2 toScreen(ImVec2 p) const {
        const ImVec2 c = panel.centre();
        return {c.x + (p.x - middle.x) * unit(), c.y + (p.y - middle.y) * unit()};
    }
    ImVec2 toCanvas(ImVec2 p) const {
        const ImVec2 c = panel.centre();
        return {middle.x + (p.x - c.x) / unit(), middle.y + (p.y - c.y) / unit()};
    }
    Area toScreen(const Area& area) const { return {toScreen(area.lo), toScreen(area.hi)}; }
    Area seen() const { return {toCanvas(panel.lo), toCanvas(panel.hi)}; }

    void pan(ImVec2 pixels) { middle = {middle.x - pixels.x / unit(), middle.y - pixels.y / unit()}; }
    /// What is under `cursor` (pixels) stays there.
    void zoomTo(float wanted, ImVec2 cursor) {
        const ImVec2 before = toCanvas(cursor);
        zoom = std::clamp(wanted, kLeastZoom, kMostZoom);
        const ImVec2 after = toCanvas(cursor);
        middle = {middle.x + before.x - after.x, middle.y + before.y - after.y};
    }
    /// All of the area in the panel, no larger than life.
    void frame(const Area& area) {
        constexpr float kMargin = 40.0f;
        const float x = (panel.width() - 2 * kMargin) / (std::max(area.width(), 1.0f) * scale),
                    y = (panel.height() - 2 * kMargin) / (std::max(area.height(), 1.0f) * scale);
        zoom = std::clamp(std::min({x, y, 1.0f}), kLeastZoom, kMostZoom);
        middle = area.centre();
    }
};

/// A file may hold any number; beyond these nothing can be told apart, or drawn.
inline constexpr double kFarthestPlace = 1e6;
inline ImVec2 vec(const Position& p) {
    return {float(std::clamp(p[0], -kFarthestPlace, kFarthestPlace)),
            float(std::clamp(p[1], -kFarthestPlace, kFarthestPlace))};
}
/// In whole units: places in files stay short.
inline Position position(ImVec2 p) { return {std::round(double(p.x)), std::round(double(p.y))}; }

}  // namespace fw::editor
