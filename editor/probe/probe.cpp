#include "editor/probe/probe.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "editor/editor.h"

namespace fw::editor {

namespace {

std::string metres(double length) {
    char text[40];
    std::snprintf(text, sizeof text, "%.6g m", length);
    return text;
}

double reachOf(const Seen& seen) {
    const Segment diagonal{seen.region.lo, seen.region.hi};
    return diagonal.length();
}

void takeAnswer(Editor& editor, const ProbeAnswer& answer) {
    Probe& probe = editor.probe;
    probe.hovered = answer.hit;
    // Between two parts of the solid the last point stays, so that the mouse can go elsewhere.
    if (answer.hit && !probe.pinned && editor.panels.probe) probe.point = answer.hit;
    if (answer.reads || !answer.problem.empty()) {
        probe.readings = answer.readings;
        probe.problem = answer.problem;
        if (editor.boxes) probe.values = valuesOf(*editor.boxes, probe.readings);
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

/// What a click asks, when it is its turn.
Aside::Answer answerClick(ProbeWork& work, const Seen& seen, glm::dvec2 place, Measure tool) {
    const std::optional<Point> hit = work.picker.hit(seen, place.x, place.y);
    if (!hit) return nullptr;
    std::optional<WallAt> wall;
    if (tool == Measure::wall) wall = wallAt(*work.picker.field(seen), *hit, reachOf(seen));
    return [hit = *hit, wall, tool](Editor& editor) {
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
        if (points.size() >= 2) points.clear();
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

std::optional<Segment> Probe::line() const {
    if (ends.size() < 2) return std::nullopt;
    return Segment{ends[0], ends[1]};
}

void Probe::forget() {
    aside.forget();
    asked.reset(), clicks.clear();
    point.reset(), hovered.reset(), wall.reset(), plot.reset();
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
        probe.measured.clear(), probe.wall.reset(), probe.wallProblem.clear();
        if (open) probe.ends.clear();
    } else if (probe.tool != Measure::nothing) {
        probe.tool = Measure::nothing;
        probe.hovered.reset();
    } else {
        probe.pinned = false;
    }
}

std::string measuredWords(const Probe& probe) {
    std::string words;
    if (probe.measured.size() == 2) {
        const Point &a = probe.measured[0], &b = probe.measured[1];
        words = "Length " + metres(Segment{a, b}.length());
        constexpr const char* kAxes[] = {"dx", "dy", "dz"};
        for (std::size_t i = 0; i < 3; ++i)
            words += std::string(i == 0 ? "\n" : "   ") + kAxes[i] + " " + metres(b[i] - a[i]);
    }
    if (probe.wall) words += (words.empty() ? "Wall " : "\nWall ") + metres(probe.wall->thickness());
    return words;
}

CanvasValues valuesOf(const Boxes& boxes, const std::vector<Reading>& readings) {
    CanvasValues values;
    const auto colors = colorsAmong(boxes);
    for (const Reading& reading : readings) {
        const NodeBox* box = boxes.find(reading.node);
        const Row* row = box ? boxes.row({reading.node, reading.output}, true) : nullptr;
        if (!row) continue;
        OutputValue value{reading.output, valueWords(reading, 3)};
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
