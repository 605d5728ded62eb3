#include "editor/probe/probe.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "editor/editor.h"
#include "graph/document/unit.h"

namespace fw::editor {

namespace {

double diagonalOf(const Box& region) { return Segment{region.lo, region.hi}.length(); }

void takeAnswer(Editor& editor, const ProbeAnswer& answer) {
    Probe& probe = editor.probe;
    probe.hovered = answer.hit;
    // Between two parts of the solid the last point stays, so that the mouse can go elsewhere.
    if (answer.hit && !probe.pinned && editor.panels.probe) probe.point = answer.hit;
    if (answer.reads || !answer.problem.empty()) {
        probe.readings = answer.readings;
        probe.problem = answer.problem;
        if (editor.boxes) probe.values = valuesOf(*editor.boxes, probe.readings, unitOf(*editor.graph));
    }
    probe.plot = answer.plot;
}

/// What is to be known in this frame, if anything is.
std::optional<ProbeWish> wishOf(const Editor& editor) {
    const Probe& probe = editor.probe;
    const Viewport& view = editor.viewport;
    const bool on = editor.panels.probe;
    if (!editor.graph || !view.texture || (!on && probe.tool == Measure::nothing)) return std::nullopt;
    const ImGuiIO& io = ImGui::GetIO();
    ProbeWish wish{.seen = seenNow(editor), .scope = editor.canvas.scope, .reads = on};
    wish.line = probe.line(), wish.plotted = probe.plotted;
    wish.hits = view.hovered && !view.drag.busy() && !view.gizmo.drag && !io.KeyCtrl && !io.MouseDown[0] &&
                (!probe.pinned || probe.tool != Measure::nothing);
    if (!wish.hits || probe.pinned) wish.point = probe.point;
    if (wish.hits)
        wish.place = inPicture(view, ImGui::GetIO().MousePos);
    else if (!wish.point && !wish.line)
        return std::nullopt;
    else  // how it is looked at has no part in it
        wish.seen.camera = {}, wish.seen.aspect = 1.0, wish.seen.region = {};
    return wish;
}

std::size_t pointsOf(Measure what) { return what == Measure::length ? 2 : 3; }

/// What a click asks, when it is its turn.
Aside::Answer answerClick(ProbeWork& work, const Seen& seen, glm::dvec2 place, Measure tool) {
    const std::optional<Point> hit = work.picker.hit(seen, place.x, place.y);
    if (!hit) return nullptr;
    std::optional<WallAt> wall;
    if (tool == Measure::wall) wall = wallAt(*work.picker.field(seen), *hit, diagonalOf(seen.region));
    std::optional<Bend> bend;
    if (tool == Measure::radius) bend = bendAt(*work.picker.field(seen), *hit, diagonalOf(seen.region));
    return [hit = *hit, wall, bend, tool](Editor& editor) {
        Probe& probe = editor.probe;
        if (tool == Measure::nothing) {
            probe.point = hit, probe.pinned = true;
            return;
        }
        std::vector<Point>& points = tool == Measure::line ? probe.ends : probe.measured;
        if (tool == Measure::wall) {
            probe.wall = wall;
            probe.wallProblem = wall ? "" : "The solid does not end behind this point.";
            return;
        }
        if (tool == Measure::line) {
            if (points.size() >= 2) points.clear();
            return points.push_back(hit);
        }
        const bool another = std::exchange(probe.what, tool) != tool;
        if (another || points.size() >= pointsOf(tool)) points.clear();
        if (points.empty()) probe.bend = bend;
        points.push_back(hit);
    };
}

/// The outputs, as node and row, from which a wire leads to an input that is a colour.
std::set<std::pair<uint32_t, uint32_t>> colorsAmong(const Boxes& boxes) {
    std::set<std::pair<uint32_t, uint32_t>> colors;
    for (const Wire& wire : boxes.wires) {
        const InputSpec* spec = boxes.nodes[wire.to].rows[wire.toRow].spec;
        if (spec && spec->unit == "color") colors.emplace(wire.from, wire.fromRow);
    }
    return colors;
}

}  // namespace

ProbeAnswer ProbeWork::answer(const ProbeWish& wish) {
    ProbeAnswer answer;
    if (wish.hits) answer.hit = picker.hit(wish.seen, wish.place.x, wish.place.y);
    if (!wish.reads && !wish.line) return answer;
    answer.problem = fields.take(wish.seen, wish.scope);
    if (!answer.problem.empty()) return answer;
    const std::optional<Point> at = wish.point ? wish.point : answer.hit;
    answer.reads = wish.reads && at;
    if (answer.reads) answer.readings = fields.at(*at);
    const std::optional<IrId> root = wish.line ? fields.root(wish.plotted) : std::nullopt;
    if (root) answer.plot = plotOf(makeTape(fields.fields().ir, *root, fields.parameters()), *wish.line);
    return answer;
}

std::optional<std::array<Point, 3>> Probe::three() const {
    if (measured.size() < 3) return std::nullopt;
    return std::array{measured[0], measured[1], measured[2]};
}

std::optional<Segment> Probe::line() const {
    if (ends.size() < 2) return std::nullopt;
    return Segment{ends[0], ends[1]};
}

void Probe::forget() {
    aside.forget();
    asked.reset(), clicks.clear();
    point.reset(), hovered.reset(), wall.reset(), plot.reset(), bend.reset();
    pinned = false;
    readings.clear(), problem.clear(), values.clear(), measured.clear(), wallProblem.clear(), ends.clear();
    plotted.clear();
}

void followProbe(Editor& editor) {
    Probe& probe = editor.probe;
    if (std::exchange(probe.document, editor.viewport.document) != editor.viewport.document) probe.forget();
    if (probe.asked && probe.asked->scope != editor.canvas.scope) probe.values.clear();
    const bool busy = probe.aside.busy();  // before what it answered is taken: else that could be replaced
    if (const Aside::Answer answer = probe.aside.take()) answer(editor);
    if (!editor.canvas.active.empty()) probe.plotted = editor.canvas.active;
    if (busy) return;
    if (!probe.clicks.empty()) {
        probe.aside.ask(std::move(probe.clicks.front()));
        probe.clicks.pop_front();
        return;
    }
    std::optional<ProbeWish> wish = wishOf(editor);
    if (!wish || wish == probe.asked) return;
    probe.asked = wish;
    probe.aside.ask([&work = probe.work, wish = std::move(*wish)]() -> Aside::Answer {
        return [answer = work.answer(wish)](Editor& to) { takeAnswer(to, answer); };
    });
}

bool takeProbeClick(Editor& editor) {
    Probe& probe = editor.probe;
    if (probe.tool == Measure::nothing && !editor.panels.probe) return false;
    probe.clicks.push_back([&work = probe.work, seen = seenNow(editor),
                            place = inPicture(editor.viewport, ImGui::GetIO().MousePos),
                            tool = probe.tool] { return answerClick(work, seen, place, tool); });
    return probe.tool != Measure::nothing;
}

void toggleProbe(Editor& editor) {
    Panels& panels = editor.panels;
    panels.probe = !panels.probe;
    if (panels.probe) panels.wanted = "probe";
    editor.probe.asked.reset();
    if (!panels.probe) editor.probe.values.clear(), editor.probe.pinned = false;
}

void useMeasure(Editor& editor, Measure tool) {
    Probe& probe = editor.probe;
    probe.tool = probe.tool == tool ? Measure::nothing : tool;
    probe.hovered.reset();
    if (probe.tool == Measure::nothing) return;
    // What it measures is told in the panel too.
    if (probe.tool == Measure::line && !editor.panels.probe) toggleProbe(editor);
}

bool canClearProbe(const Editor& editor) {
    const Probe& probe = editor.probe;
    return probe.tool != Measure::nothing || !probe.measured.empty() || probe.wall || probe.pinned ||
           !probe.wallProblem.empty();
}

void clearProbe(Editor& editor) {
    Probe& probe = editor.probe;
    const bool open = probe.tool == Measure::line && probe.ends.size() == 1;
    if (!probe.measured.empty() || probe.wall || !probe.wallProblem.empty() || open) {
        probe.measured.clear(), probe.wall.reset(), probe.wallProblem.clear(), probe.bend.reset();
        if (open) probe.ends.clear();
    } else if (probe.tool != Measure::nothing) {
        probe.tool = Measure::nothing;
        probe.hovered.reset();
    } else {
        probe.pinned = false;
    }
}

double sizeSeen(const Editor& editor) { return diagonalOf(editor.viewport.shown.region); }

std::string shapeWords(const Probe& probe, double size, const LengthUnit& lengths) {
    const auto length = [&](double number) { return withSign(number, "m", lengths); };
    const std::optional<std::array<Point, 3>> three = probe.three();
    switch (probe.what) {
        case Measure::length:
            return probe.measured.size() < 2 ? std::string()
                                             : length(Segment{probe.measured[0], probe.measured[1]}.length());
        case Measure::angle:
            if (!three) return {};
            if (const auto angle = angleOf(*three)) return withSign(*angle, "degrees", lengths);
            return "no angle";
        case Measure::radius:
            if (const auto circle = three ? circleThrough(*three) : std::nullopt)
                return "Radius " + length(circle->radius);
            if (three) return "no circle";
            return probe.measured.empty() || !probe.bend ? std::string()
                                                         : bendWords(*probe.bend, size, lengths);
        default: return {};
    }
}

std::string measuredWords(const Probe& probe, double size, const LengthUnit& lengths) {
    std::string words = shapeWords(probe, size, lengths);
    if (!words.empty() && probe.what == Measure::length) {
        const Point &a = probe.measured[0], &b = probe.measured[1];
        words = "Length " + words;
        constexpr const char* kAxes[] = {"dx", "dy", "dz"};
        for (std::size_t i = 0; i < 3; ++i)
            words +=
                std::string(i == 0 ? "\n" : "   ") + kAxes[i] + " " + withSign(b[i] - a[i], "m", lengths);
    }
    if (!words.empty() && probe.what == Measure::angle) words = "Angle " + words;
    if (probe.wall)
        words += (words.empty() ? "Wall " : "\nWall ") + withSign(probe.wall->thickness(), "m", lengths);
    return words;
}

CanvasValues valuesOf(const Boxes& boxes, const std::vector<Reading>& readings, const LengthUnit& lengths) {
    CanvasValues values;
    const auto colors = colorsAmong(boxes);
    for (const Reading& reading : readings) {
        const NodeBox* box = boxes.find(reading.node);
        const Row* row = box ? boxes.row({reading.node, reading.output}, true) : nullptr;
        if (!row) continue;
        OutputValue value{reading.output, valueWords(reading, 3, lengths)};
        std::optional<std::array<double, 3>> color = reading.color;
        const std::pair place(uint32_t(box - boxes.nodes.data()), uint32_t(row - box->rows.data()));
        if (reading.type == Type::vec3 && reading.numbers.size() == 3 && colors.contains(place))
            color = {reading.numbers[0], reading.numbers[1], reading.numbers[2]};
        if (color) value.color = *color;
        values[reading.node].push_back(std::move(value));
    }
    return values;
}

}  // namespace fw::editor
