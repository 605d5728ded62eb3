#include "editor/canvas/keyboard.h"

#include <cstdio>

namespace fw::editor {

namespace {

constexpr float kAside = 2.0f;  // what lies aside is so many times as far, and no further aside than that

}  // namespace

const NodeBox* neighbour(const Boxes& boxes, std::string_view from, ImVec2 direction) {
    const NodeBox* start = boxes.find(from);
    if (!start) return nullptr;
    const ImVec2 here = start->area.centre();
    const NodeBox* best = nullptr;
    float least = INFINITY;
    for (const NodeBox& box : boxes.nodes) {
        const ImVec2 there = box.area.centre(), by(there.x - here.x, there.y - here.y);
        const float ahead = by.x * direction.x + by.y * direction.y,
                    aside = std::abs(by.x * direction.y - by.y * direction.x);
        if (&box == start || aside > kAside * ahead || ahead + kAside * aside >= least) continue;
        least = ahead + kAside * aside;
        best = &box;
    }
    return best;
}

const NodeBox* nearestNode(const Boxes& boxes, ImVec2 place) {
    const auto distance = [&](const NodeBox& box) {
        const ImVec2 middle = box.area.centre();
        return std::hypot(middle.x - place.x, middle.y - place.y);
    };
    const auto best = std::ranges::min_element(boxes.nodes, {}, distance);
    return best == boxes.nodes.end() ? nullptr : &*best;
}

void step(Canvas& canvas, const Boxes& boxes, ImVec2 direction, bool adds) {
    const NodeBox* next = boxes.find(canvas.active) ? neighbour(boxes, canvas.active, direction)
                                                    : nearestNode(boxes, canvas.view.middle);
    if (!next) return;
    if (!adds) canvas.selection.clear();
    canvas.selection.insert(next->node->id);
    canvas.active = next->node->id;
    bringIntoSight(canvas.view, next->area);
}

void bringIntoSight(CanvasView& view, const Area& area) {
    constexpr float kMargin = 20.0f;  // canvas units
    const Area seen = view.seen(), wanted = area.grown(kMargin);
    const auto by = [](float lo, float hi, float from, float to) {
        return lo < from || hi - lo > to - from ? lo - from : hi > to ? hi - to : 0.0f;
    };
    view.middle.x += by(wanted.lo.x, wanted.hi.x, seen.lo.x, seen.hi.x);
    view.middle.y += by(wanted.lo.y, wanted.hi.y, seen.lo.y, seen.hi.y);
}

ImVec2 freePlace(const Boxes& boxes, ImVec2 place) {
    constexpr float kNear = 20.0f;
    const auto inTheWay = [&](const NodeBox& box) {
        return std::abs(box.area.lo.x - place.x) < kNear && std::abs(box.area.lo.y - place.y) < kNear;
    };
    // Each node is passed once at most, for the place only goes down.
    for (auto box = boxes.nodes.begin();
         (box = std::ranges::find_if(boxes.nodes, inTheWay)) != boxes.nodes.end();)
        place.y = box->area.hi.y + kNear;
    return place;
}

bool typeFirstValue(Canvas& canvas, Document& document, const Boxes& boxes) {
    const NodeBox* box = boxes.find(canvas.active);
    if (!box || !showsFields(canvas.view)) return false;
    for (const Row& row : box->rows) {
        if (!row.typed()) continue;
        bringIntoSight(canvas.view, box->area);
        typeField(canvas.number, document, canvas.scope, *box, row, 0);
        return true;
    }
    return false;
}

}  // namespace fw::editor
