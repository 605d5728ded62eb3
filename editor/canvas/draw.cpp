// How the canvas looks. The farther one is away, the less is drawn: below kFieldZoom numbers are not boxed,
// below kTextZoom there is no text.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "editor/canvas/canvas.h"
#include "editor/ramps/hand.h"
#include "editor/shell/icons.h"
#include "editor/shell/theme.h"

namespace fw::editor {

namespace {

constexpr float kFieldZoom = 0.6f, kTextZoom = 0.47f;  // pixels a unit
constexpr float kGrid = 24.0f;
constexpr float kRounding = 5.0f;
constexpr float kLeastShape = 2.0f;  // pixels: what is smaller has neither shape nor round corners
constexpr float kWireWidth = 2.5f;
constexpr int kPiecesOfRow = 3;   // between two stops of a ramp
constexpr float kDimmed = 0.25f;  // what does not count beside what does

ImU32 faded(ImU32 color, float alpha) {
    ImVec4 c = ImGui::ColorConvertU32ToFloat4(color);
    c.w *= alpha;
    return ImGui::ColorConvertFloat4ToU32(c);
}

struct Pen {
    ImDrawList* list;
    const CanvasView& view;
    ImFont* font;
    float size;  // of text, pixels

    void text(ImVec2 at, ImU32 color, std::string_view words, float width = 0.0f) const {
        // Whole pixels, for crisp glyphs.
        const ImVec2 pixel(std::floor(at.x), std::floor(at.y - 0.5f * size));
        if (width <= 0.0f)
            return list->AddText(font, size, pixel, color, words.data(), words.data() + words.size());
        // What does not fit ends with a sign for that.
        const char *begin = words.data(), *end = begin + words.size(), *fits = end;
        const float whole = font->CalcTextSizeA(size, width, 0.0f, begin, end, &fits).x;
        if (fits == end) return list->AddText(font, size, pixel, color, begin, end);
        const float sign = this->width("…");
        float until = std::min(whole, width);
        if (sign < width) until = font->CalcTextSizeA(size, width - sign, 0.0f, begin, end, &fits).x;
        list->AddText(font, size, pixel, color, begin, fits);
        if (sign < width) list->AddText(font, size, {std::floor(pixel.x + until), pixel.y}, color, "…");
    }
    float width(std::string_view words) const {
        return font->CalcTextSizeA(size, FLT_MAX, 0.0f, words.data(), words.data() + words.size()).x;
    }
};

void drawGrid(const Pen& pen) {
    const CanvasView& view = pen.view;
    float step = kGrid;
    while (step * view.unit() < 14.0f) step *= 4.0f;
    const Area seen = view.seen();
    const ImU32 color = themeColor(ThemeColor::grid);
    // So far away that the next place is the same one there is no grid.
    if (seen.lo.x + step == seen.lo.x || seen.hi.x + step == seen.hi.x || seen.lo.y + step == seen.lo.y ||
        seen.hi.y + step == seen.hi.y)
        return;
    for (float x = std::floor(seen.lo.x / step) * step; x < seen.hi.x; x += step) {
        const float at = std::floor(view.toScreen({x, 0}).x);
        pen.list->AddRectFilled({at, view.panel.lo.y}, {at + 1, view.panel.hi.y}, color);
    }
    for (float y = std::floor(seen.lo.y / step) * step; y < seen.hi.y; y += step) {
        const float at = std::floor(view.toScreen({0, y}).y);
        pen.list->AddRectFilled({view.panel.lo.x, at}, {view.panel.hi.x, at + 1}, color);
    }
}

void drawFrames(const Pen& pen, const Boxes& boxes) {
    for (const Frame& frame : boxes.frames) {
        if (frame.scope != boxes.scope) continue;
        const ImVec2 at = vec(frame.at), size = vec(frame.size);
        const Area area = pen.view.toScreen(Area{at, {at.x + size.x, at.y + size.y}});
        if (!area.overlaps(pen.view.panel)) continue;
        const auto color = frame.color.value_or(std::array{0.5, 0.5, 0.5});
        const ImU32 ink =
            ImGui::ColorConvertFloat4ToU32({float(color[0]), float(color[1]), float(color[2]), 1.0f});
        pen.list->AddRectFilled(area.lo, area.hi, faded(ink, 0.16f), kRounding);
        pen.list->AddRect(area.lo, area.hi, faded(ink, 0.6f), kRounding);
        if (pen.view.unit() > 0.5f * kTextZoom)
            pen.text({area.lo.x + 8, area.lo.y + 13 * pen.view.unit()}, themeColor(ThemeColor::text),
                     frame.text, area.width() - 16);
    }
}

/// The wire with gaps: `on` pixels of every `period`. Steps that are very long have none.
void drawBroken(const Pen& pen, const Curve& wire, ImU32 color, float width, float on, float period) {
    constexpr int kSteps = 64;
    constexpr float kMostGaps = 2000.0f;  // in a step
    ImVec2 last = pen.view.toScreen(wire.points[0]);
    float along = 0.0f;
    for (int i = 1; i <= kSteps; ++i) {
        const ImVec2 next = pen.view.toScreen(wire.at(float(i) / kSteps));
        const float length = std::hypot(next.x - last.x, next.y - last.y);
        const auto at = [&](float pixels) {
            const float part = length > 0.0f ? (pixels - along) / length : 0.0f;
            return ImVec2(last.x + part * (next.x - last.x), last.y + part * (next.y - last.y));
        };
        Area step{last, last};
        step.add(next);
        const bool seen = step.grown(width).overlaps(pen.view.panel);
        if (seen && !(length < kMostGaps * period))
            pen.list->AddLine(last, next, color, width);
        else if (seen)
            for (float from = 0.0f; from < along + length; from += period) {
                const float a = std::max(from, along), b = std::min(from + on, along + length);
                if (a < b) pen.list->AddLine(at(a), at(b), color, width);
            }
        along = std::fmod(along + length, period);
        last = next;
    }
}

void drawWire(const Pen& pen, const Curve& wire, ImU32 color, float width,
              WireTrust trust = WireTrust::exact) {
    ImVec2 p[4];
    for (int i = 0; i < 4; ++i) p[i] = pen.view.toScreen(wire.points[i]);
    // Whole pixels: then a piece is two triangles whose soft edge is a texture, otherwise six.
    const float whole = std::max(1.0f, std::round(width));
    if (trust == WireTrust::exact)
        pen.list->AddBezierCubic(p[0], p[1], p[2], p[3], color, whole);
    else
        drawBroken(pen, wire, color, whole, (trust == WireTrust::bound ? 4.0f : 1.0f) * whole,
                   (trust == WireTrust::bound ? 7.0f : 3.0f) * whole);
    // Which way it leads: an arrowhead in the middle.
    const ImVec2 middle = pen.view.toScreen(wire.at(0.5f)), on = pen.view.toScreen(wire.at(0.54f));
    const float x = on.x - middle.x, y = on.y - middle.y, length = std::sqrt(x * x + y * y);
    if (length < 1e-3f || pen.view.unit() < kTextZoom) return;
    const ImVec2 d(5.0f * pen.view.unit() * x / length, 5.0f * pen.view.unit() * y / length);
    pen.list->AddTriangleFilled({middle.x + d.x, middle.y + d.y},
                                {middle.x - d.x - d.y, middle.y - d.y + d.x},
                                {middle.x - d.x + d.y, middle.y - d.y - d.x}, color);
}

void drawWires(const Pen& pen, const Canvas& canvas, const Boxes& boxes, const CanvasMarks& marks) {
    const Area seen = pen.view.seen();
    const bool lit = canvas.lit.size() == boxes.wires.size();
    for (std::size_t i = 0; i < boxes.wires.size(); ++i) {
        const Wire& wire = boxes.wires[i];
        const Curve path = curve(boxes.start(wire), boxes.end(wire));
        if (!path.area().grown(4).overlaps(seen)) continue;
        const NodeBox &from = boxes.nodes[wire.from], &to = boxes.nodes[wire.to];
        ImU32 color = typeColor(from.rows[wire.fromRow].type);
        const bool chosen =
            lit ? canvas.lit[i]
                : canvas.selection.contains(from.node->id) || canvas.selection.contains(to.node->id);
        if (lit && !chosen)
            color = faded(color, kDimmed);
        else if (!chosen)
            color = faded(color, from.node->muted || to.node->muted ? 0.35f : 0.8f);
        const NodeExactness* known = canvas.exactness && from.rows[wire.fromRow].type == Type::surface
                                         ? marks.exactness(from.node->id)
                                         : nullptr;
        drawWire(pen, path, color,
                 (chosen ? 1.4f : 1.0f) * kWireWidth * pen.view.scale * std::max(pen.view.zoom, 0.5f),
                 known ? trustOf(known->exactness) : WireTrust::exact);
        if (!marks.spoiledBy.empty() && from.node->id == marks.spoiledBy) {
            const ImVec2 middle = pen.view.toScreen(path.at(0.3f));
            pen.list->AddCircle(middle, 4.0f * pen.view.unit(), themeColor(ThemeColor::warning), 0, 1.5f);
        }
    }
}

void drawSocket(const Pen& pen, ImVec2 at, const std::optional<Type>& type, bool filled, bool dimmed) {
    const ImU32 ink = dimmed ? faded(typeColor(type), kDimmed) : typeColor(type),
                paper = themeColor(ThemeColor::node);
    const float r = kSocketRadius * pen.view.unit();
    // Too small for a shape: a dot of two triangles, for there are thousands.
    if (r < kLeastShape) return pen.list->AddRectFilled({at.x - r, at.y - r}, {at.x + r, at.y + r}, ink);
    const auto polygon = [&](std::initializer_list<ImVec2> unit) {
        ImVec2 points[8];
        int count = 0;
        for (const ImVec2& p : unit) points[count++] = {at.x + r * p.x, at.y + r * p.y};
        pen.list->AddConvexPolyFilled(points, count, filled ? ink : paper);
        pen.list->AddPolyline(points, count, ink, ImDrawFlags_Closed, 1.5f);
    };
    switch (socketShape(type)) {
        case SocketShape::circle:
            pen.list->AddCircleFilled(at, r, filled ? ink : paper);
            pen.list->AddCircle(at, r, ink, 0, 1.5f);
            return;
        case SocketShape::square:
            return polygon({{-0.85f, -0.85f}, {0.85f, -0.85f}, {0.85f, 0.85f}, {-0.85f, 0.85f}});
        case SocketShape::diamond: return polygon({{0, -1.2f}, {1.2f, 0}, {0, 1.2f}, {-1.2f, 0}});
        case SocketShape::triangle: return polygon({{-0.8f, -1.1f}, {1.2f, 0}, {-0.8f, 1.1f}});
        case SocketShape::pentagon:
            return polygon({{0, -1.15f}, {1.1f, -0.35f}, {0.68f, 0.95f}, {-0.68f, 0.95f}, {-1.1f, -0.35f}});
        case SocketShape::hexagon:
            return polygon({{-0.55f, -1}, {0.55f, -1}, {1.1f, 0}, {0.55f, 1}, {-0.55f, 1}, {-1.1f, 0}});
    }
}

/// A ramp's colours where other rows have their value.
void drawStops(const Pen& pen, const NodeBox& box, const Row& row) {
    const ramps::List stops{Type::stops, entriesOf(row)};
    const auto how = std::ranges::find(box.rows, "interpolation", &Row::name);
    const Area place =
        pen.view.toScreen(Area{{box.area.centre().x, box.area.lo.y + row.y - 0.3f * kRowHeight},
                               {box.area.hi.x - 10.0f, box.area.lo.y + row.y + 0.3f * kRowHeight}});
    ramps::drawRamp(pen.list, place.lo, place.hi, stops, how != box.rows.end() ? valueText(*how) : "",
                    ramps::placesOf(stops), kPiecesOfRow);
}

void drawRows(const Pen& pen, const Canvas& canvas, const NodeBox& box) {
    // While a wire is under the mouse, those sockets count that it fits.
    const CanvasGesture& gesture = canvas.gesture;
    const bool wires = gesture.kind == CanvasGesture::Kind::wire;
    const auto counts = [&](const Row& row) {
        if (!wires) return true;
        const Plug plug{box.node->id, row.name};
        return row.output == gesture.plugIsOutput ? plug == gesture.plug : gesture.partners.contains(plug);
    };
    const ImU32 ink = themeColor(ThemeColor::text), quiet = themeColor(ThemeColor::quiet);
    const bool words = pen.view.unit() >= kTextZoom;
    for (const Row& row : box.rows) {
        const ImVec2 at = pen.view.toScreen(box.socket(row));
        if (words && !box.node->collapsed && !box.reroute) {
            const std::string name = readable(row.name);
            const float inset = 12.0f * pen.view.unit();
            if (row.output) {
                pen.text({at.x - inset - pen.width(name), at.y}, ink, name);
            } else {
                const float room =
                    (row.fields == 1 ? 0.5f * box.area.width() - 14.0f : box.area.width() - 24.0f);
                pen.text({at.x + inset, at.y}, row.linked ? quiet : ink, name, room * pen.view.unit());
                const bool ramp = row.type == Type::stops && !row.linked;
                if (ramp) drawStops(pen, box, row);
                std::string value = row.fields == 0 && !row.linked && !ramp ? valueText(row) : std::string();
                std::ranges::replace(value, '\n', ' ');
                if (!value.empty())
                    pen.text({at.x + 0.5f * box.area.width() * pen.view.unit(), at.y}, quiet, value,
                             (0.5f * box.area.width() - 10.0f) * pen.view.unit());
                // Too small to be edited, but not too small to be read.
                if (row.fields > 0 && pen.view.unit() < kFieldZoom) {
                    const std::vector<double> numbers = numbersOf(row);
                    for (int i = 0; i < row.fields; ++i) {
                        const Area field = pen.view.toScreen(box.field(row, i));
                        const double number = i < int(numbers.size()) ? numbers[std::size_t(i)] : 0.0;
                        const std::string text = row.type == Type::string    ? readable(valueText(row))
                                                 : row.type == Type::boolean ? (number != 0.0 ? "on" : "off")
                                                                             : numberText(number);
                        pen.text({field.lo.x, field.centre().y}, quiet, text, field.width());
                    }
                }
            }
        }
        if (pen.view.unit() > 0.5f * kTextZoom)
            drawSocket(pen, at, row.type, row.output || row.linked, !counts(row));
    }
}

void drawNode(const Pen& pen, const Canvas& canvas, const NodeBox& box, const CanvasMarks& marks) {
    const Area area = pen.view.toScreen(box.area);
    const bool chosen = canvas.selection.contains(box.node->id);
    const float alpha = box.node->muted ? 0.45f : 1.0f, corner = kRounding * pen.view.unit();
    const float round = corner < kLeastShape ? 0.0f : corner;
    const auto finding = marks.findings.find(box.node->id);
    const bool found = finding != marks.findings.end();
    const ImU32 alarm = !found ? 0
                        : finding->second->severity == Error::Severity::error
                            ? themeColor(ThemeColor::error)
                            : themeColor(ThemeColor::warning);
    if (box.reroute) {
        pen.list->AddCircleFilled(area.centre(), 0.5f * area.width(), themeColor(ThemeColor::node));
        if (!box.rows.empty())
            pen.list->AddCircle(area.centre(), 0.5f * area.width(),
                                chosen ? themeColor(ThemeColor::selected) : typeColor(box.rows[0].type), 0,
                                2.0f * pen.view.scale);
        return;
    }
    const ImU32 edge =
        chosen  ? themeColor(canvas.active == box.node->id ? ThemeColor::active : ThemeColor::selected)
        : found ? alarm
                : themeColor(ThemeColor::edge);
    const float border = (chosen ? 2.0f : 1.0f) * pen.view.scale;
    const ImU32 title = box.type ? categoryColor(box.type->category) : themeColor(ThemeColor::error);
    const float strip = std::min(kTitleHeight * pen.view.unit(), area.height());
    const auto fill = [&](const Area& inside) {
        pen.list->AddRectFilled(inside.lo, inside.hi, faded(themeColor(ThemeColor::node), alpha), round);
        pen.list->AddRectFilled(
            inside.lo, {inside.hi.x, area.lo.y + strip}, faded(title, alpha), round,
            box.node->collapsed ? ImDrawFlags_RoundCornersAll : ImDrawFlags_RoundCornersTop);
    };
    if (round > 0.0f || alpha < 1.0f) {
        fill(area);
        pen.list->AddRect(area.lo, area.hi, edge, round, 0, border);
    } else {  // what shows of a rectangle below
        pen.list->AddRectFilled(area.lo, area.hi, edge);
        fill(area.grown(-border));
    }
    if (pen.view.unit() >= 0.7f * kTextZoom) {
        const float unit = pen.view.unit(), middle = area.lo.y + 0.5f * strip,
                    before = box.type ? 27.0f : 9.0f, room = area.width() - (before + 25.0f) * unit;
        if (box.type)
            drawIcon(*pen.list, box.type->category, {area.lo.x + 15.0f * unit, middle}, 12.0f * unit,
                     themeColor(ThemeColor::onTitle));
        pen.text({area.lo.x + before * unit, middle},
                 themeColor(box.type ? ThemeColor::onTitle : ThemeColor::canvas), titleOf(box), room);
        if (marks.pinned.contains(box.node->id))
            pen.list->AddCircleFilled({area.hi.x - 30.0f * pen.view.unit(), middle}, 4.0f * pen.view.unit(),
                                      themeColor(ThemeColor::active));
    }
    drawRows(pen, canvas, box);
    if (box.node->muted)
        pen.list->AddLine({area.lo.x, area.lo.y + 0.5f * strip}, {area.hi.x, area.lo.y + 0.5f * strip},
                          themeColor(ThemeColor::quiet), 1.5f * pen.view.scale);
    if (found) {
        const ImVec2 at(area.hi.x - 13.0f * pen.view.unit(), area.lo.y + 0.5f * strip);
        pen.list->AddCircleFilled(at, 8.0f * pen.view.unit(), alarm);
        if (pen.view.unit() >= kTextZoom)
            pen.text({at.x - 0.5f * pen.width("!"), at.y}, themeColor(ThemeColor::node), "!");
    }
}

/// What the outputs give at the place probed: in their rows, or below a node without rows.
void drawValues(const Pen& pen, const NodeBox& box, const CanvasValues& all) {
    if (pen.view.unit() < kTextZoom) return;
    const auto its = all.find(box.node->id);
    const bool small = box.reroute || box.node->collapsed;
    const float unit = pen.view.unit(), side = 0.8f * pen.size;
    for (const Row& row : box.rows) {
        if (!row.output) continue;
        const OutputValue* value = nullptr;
        if (its != all.end())
            for (const OutputValue& each : its->second)
                if (each.output == row.name) value = &each;
        const std::string words = value ? value->words : "–";
        const ImU32 ink = themeColor(value ? ThemeColor::active : ThemeColor::quiet);
        const bool colored = value && value->color;
        const float wide = pen.width(words) + (colored ? side + 5.0f * unit : 0.0f);
        ImVec2 at;
        float room = 0.0f;
        if (small) {
            const Area area = pen.view.toScreen(box.area);
            at = {area.centre().x - 0.5f * wide, area.hi.y + 0.5f * pen.size + 4.0f * unit};
            pen.list->AddRectFilled({at.x - 4.0f * unit, at.y - 0.6f * pen.size},
                                    {at.x + wide + 4.0f * unit, at.y + 0.6f * pen.size},
                                    themeColor(ThemeColor::node), 0.5f * kRounding * unit);
        } else {
            const ImVec2 socket = pen.view.toScreen(box.socket(row));
            at = {pen.view.toScreen(box.area.lo).x + 10.0f * unit, socket.y};
            room = socket.x - 18.0f * unit - pen.width(readable(row.name)) - at.x;
        }
        if (colored) {
            const ImVec2 lo(at.x, at.y - 0.5f * side), hi(at.x + side, at.y + 0.5f * side);
            pen.list->AddRectFilled(lo, hi, shownColor(*value->color));
            pen.list->AddRect(lo, hi, themeColor(ThemeColor::edge));
            at.x += side + 5.0f * unit, room -= side + 5.0f * unit;
        }
        if (small)
            pen.text(at, ink, words);
        else if (room > 0.0f)
            pen.text(at, ink, words, room);
        if (small) break;  // its outputs have one place
    }
}

/// A tag on the node's upper edge with its part of what a sample of the field costs, the redder the more.
void drawCost(const Pen& pen, const NodeBox& box, double part) {
    const float heat = float(std::sqrt(part));  // else all but the first would look alike
    const ImU32 color = ImGui::ColorConvertFloat4ToU32(
        {0.25f + 0.65f * heat, 0.45f - 0.25f * heat, 0.3f - 0.15f * heat, 1.0f});
    const Area area = pen.view.toScreen(box.area);
    pen.list->AddRect(area.lo, area.hi, color, kRounding * pen.view.unit(), 0,
                      (1.0f + 2.0f * heat) * pen.view.scale);
    if (pen.view.unit() < kTextZoom) return;
    char text[16];
    std::snprintf(text, sizeof text, part < 0.095 ? "%.1f %%" : "%.0f %%", 100.0 * part);
    const float inset = 5.0f * pen.view.unit(), high = pen.size + 4.0f * pen.view.unit();
    const ImVec2 hi(area.hi.x, area.lo.y - 2.0f * pen.view.unit()),
        lo(hi.x - pen.width(text) - 2.0f * inset, hi.y - high);
    pen.list->AddRectFilled(lo, hi, color, 0.5f * kRounding * pen.view.unit());
    pen.text({lo.x + inset, 0.5f * (lo.y + hi.y)}, themeColor(ThemeColor::onTitle), text);
}

/// The node's own field above it, as wide as the node.
void drawThumbnail(const Pen& pen, const NodeBox& box, const Thumbnails::Shown& shown) {
    const Area area = pen.view.toScreen(thumbnailArea(box));
    pen.list->AddRectFilled(area.lo, area.hi, themeColor(ThemeColor::node), kRounding * pen.view.unit());
    if (shown.problem.empty() && shown.texture)
        pen.list->AddImage(shown.texture, area.lo, area.hi);
    else if (pen.view.unit() >= kTextZoom)
        pen.list->AddText(pen.font, pen.size, {area.lo.x + 8, area.lo.y + 8}, themeColor(ThemeColor::quiet),
                          shown.problem.empty() ? "…" : shown.problem.c_str(), nullptr, area.width() - 16);
    pen.list->AddRect(area.lo, area.hi, themeColor(ThemeColor::edge), kRounding * pen.view.unit());
}

void drawMinimap(const Pen& pen, const Canvas& canvas, const Boxes& boxes) {
    const Area place = minimapArea(canvas.view), all = minimapShows(canvas, boxes);
    const float scale = place.width() / all.width();
    const auto shrink = [&](const Area& area) {
        return Area{
            {place.lo.x + (area.lo.x - all.lo.x) * scale, place.lo.y + (area.lo.y - all.lo.y) * scale},
            {place.lo.x + (area.hi.x - all.lo.x) * scale, place.lo.y + (area.hi.y - all.lo.y) * scale}};
    };
    pen.list->PushClipRect(place.lo, place.hi, true);
    pen.list->AddRectFilled(place.lo, place.hi, faded(themeColor(ThemeColor::canvas), 0.85f));
    for (const NodeBox& box : boxes.nodes) {
        const Area small = shrink(box.area);
        const bool chosen = canvas.selection.contains(box.node->id);
        const ImU32 color = chosen     ? themeColor(ThemeColor::selected)
                            : box.type ? categoryColor(box.type->category)
                                       : themeColor(ThemeColor::error);
        pen.list->AddRectFilled(
            small.lo, {std::max(small.hi.x, small.lo.x + 2), std::max(small.hi.y, small.lo.y + 2)}, color);
    }
    const Area seen = shrink(canvas.view.seen());
    pen.list->AddRectFilled(seen.lo, seen.hi, faded(themeColor(ThemeColor::text), 0.08f));
    pen.list->AddRect(seen.lo, seen.hi, faded(themeColor(ThemeColor::text), 0.7f));
    pen.list->PopClipRect();
    pen.list->AddRect(place.lo, place.hi, themeColor(ThemeColor::edge));
}

/// The wire, box, lasso or cut under the mouse.
void drawGesture(const Pen& pen, const Canvas& canvas, const Boxes& boxes) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const ImU32 ink = themeColor(ThemeColor::selected);
    using Kind = CanvasGesture::Kind;
    const CanvasGesture& gesture = canvas.gesture;
    const auto trail = [&](ImU32 color, bool closed) {
        std::vector<ImVec2> points;
        for (ImVec2 p : gesture.trail) points.push_back(pen.view.toScreen(p));
        pen.list->AddPolyline(points.data(), int(points.size()), color, closed ? ImDrawFlags_Closed : 0,
                              1.5f * pen.view.scale);
    };
    if (gesture.kind == Kind::box) {
        Area box{pen.view.toScreen(gesture.begin), pen.view.toScreen(gesture.begin)};
        box.add(mouse);
        pen.list->AddRectFilled(box.lo, box.hi, faded(ink, 0.1f));
        pen.list->AddRect(box.lo, box.hi, ink);
    } else if (gesture.kind == Kind::lasso) {
        trail(ink, gesture.trail.size() > 2);  // a line there and back would have no width
    } else if (gesture.kind == Kind::cut) {
        trail(themeColor(ThemeColor::error), false);
    } else if (gesture.kind == Kind::reroute || gesture.kind == Kind::lazy) {
        trail(ink, false);
    } else if (gesture.kind == Kind::wire) {
        const NodeBox* box = boxes.find(gesture.plug.node);
        const Row* row = boxes.row(gesture.plug, gesture.plugIsOutput);
        if (!box || !row) return;
        const ImVec2 fixed = box->socket(*row), loose = pen.view.toCanvas(mouse);
        const ImU32 color = gesture.refused.empty() ? typeColor(row->type) : themeColor(ThemeColor::error);
        drawWire(pen, gesture.plugIsOutput ? curve(fixed, loose) : curve(loose, fixed), color,
                 kWireWidth * pen.view.scale);
    }
}

}  // namespace

WireTrust trustOf(const Exactness& exactness) {
    return exactness.exact() ? WireTrust::exact : exactness.bound() ? WireTrust::bound : WireTrust::steep;
}

bool hasMinimap(const Canvas& canvas, const Boxes& boxes) {
    const Area place = minimapArea(canvas.view), &panel = canvas.view.panel;
    return canvas.minimap && !boxes.nodes.empty() && 2.0f * place.width() < panel.width() &&
           2.0f * place.height() < panel.height();
}

Area minimapArea(const CanvasView& view) {
    constexpr float kWidth = 180.0f, kHeight = 120.0f, kMargin = 10.0f;
    const ImVec2 hi(view.panel.hi.x - kMargin * view.scale, view.panel.hi.y - kMargin * view.scale);
    return {{hi.x - kWidth * view.scale, hi.y - kHeight * view.scale}, hi};
}

Area minimapShows(const Canvas& canvas, const Boxes& boxes) {
    Area all = boxes.around();
    all.add(canvas.view.seen());
    const Area place = minimapArea(canvas.view);
    const float aspect = place.width() / place.height();
    const ImVec2 middle = all.centre();
    const float half = 0.5f * std::max(all.width(), all.height() * aspect);
    return {{middle.x - half, middle.y - half / aspect}, {middle.x + half, middle.y + half / aspect}};
}

void drawCanvas(const Canvas& canvas, const Boxes& boxes, const CanvasMarks& marks, const Shell& shell) {
    const float size = shell.fonts().crisp(kTextSize * canvas.view.unit());
    const Pen pen{ImGui::GetWindowDrawList(), canvas.view, shell.fonts().of(size), size};
    pen.list->PushClipRect(canvas.view.panel.lo, canvas.view.panel.hi, true);
    drawGrid(pen);
    drawFrames(pen, boxes);
    const Area seen = canvas.view.seen().grown(2 * kSocketRadius);
    for (const auto& [id, thumbnail] : marks.thumbnails)
        if (const NodeBox* box = boxes.find(id); box && thumbnailArea(*box).overlaps(seen))
            drawThumbnail(pen, *box, *thumbnail);
    drawWires(pen, canvas, boxes, marks);
    for (const NodeBox& box : boxes.nodes) {
        if (!box.area.overlaps(seen)) continue;
        drawNode(pen, canvas, box, marks);
        if (const auto cost = marks.costs.find(box.node->id); cost != marks.costs.end())
            drawCost(pen, box, cost->second);
        if (marks.values) drawValues(pen, box, *marks.values);
    }
    drawGesture(pen, canvas, boxes);
    if (hasMinimap(canvas, boxes)) drawMinimap(pen, canvas, boxes);
    pen.list->PopClipRect();
}

}  // namespace fw::editor
