#include "editor/viewport/split.h"

#include <algorithm>
#include <cmath>

#include "editor/editor.h"
#include "editor/viewport/projection.h"

namespace fw::editor {

namespace {

constexpr Side kFirstSides[] = {Side::front, Side::front, Side::right, Side::top};  // of all but the first

Pane paneOf(const Viewport& viewport) {
    return {viewport.place, viewport.texture, viewport.shown.seen, viewport.hovered,
            viewport.split.panes[viewport.split.hand].shown};
}

/// Whether it is so of one of the pictures, that under the hand among them.
template <class Is>
bool anyPane(const Viewport& viewport, Is is) {
    const Split& split = viewport.split;
    for (std::size_t i = 0; i < split.count; ++i)
        if (is(i == split.hand ? paneOf(viewport) : split.panes[i])) return true;
    return false;
}

}  // namespace

Camera Eye::own() const {
    return orthographic ? throughLensOf(orbit, kParallelFov).camera() : orbit.camera();
}

Eyes firstEyes() {
    Eyes eyes;
    for (std::size_t i = 1; i < eyes.size(); ++i) eyes[i].awaits = kFirstSides[i];
    return eyes;
}

std::array<Area, kMostPictures> placesOf(const Area& room, std::size_t count, float gap) {
    std::array<Area, kMostPictures> places;
    places[0] = room;
    if (count < 2) return places;
    const bool wide = room.width() >= room.height();
    const ImVec2 from(std::floor(room.lo.x), std::floor(room.lo.y));
    const ImVec2 whole(std::floor(room.hi.x) - from.x, std::floor(room.hi.y) - from.y);
    const bool across = count > 2 || wide, down = count > 2 || !wide;
    const ImVec2 cell(across ? std::floor(0.5f * (whole.x - gap)) : whole.x,
                      down ? std::floor(0.5f * (whole.y - gap)) : whole.y);
    const auto at = [&](int column, int row) {
        const ImVec2 lo(from.x + float(column) * (cell.x + gap), from.y + float(row) * (cell.y + gap));
        return Area{lo, {lo.x + cell.x, lo.y + cell.y}};
    };
    if (count == 2) {
        places[0] = at(0, 0), places[1] = at(wide ? 1 : 0, wide ? 0 : 1);
        return places;
    }
    places[1] = at(0, 1), places[2] = at(1, 1);
    places[0] = count == 3 ? Area{at(0, 0).lo, at(1, 0).hi} : at(1, 0);
    if (count > 3) places[3] = at(0, 0);
    return places;
}

void takeHand(Viewport& viewport, std::size_t picture) {
    Split& split = viewport.split;
    if (picture == split.hand) return;
    split.panes[split.hand] = paneOf(viewport);
    viewport.eyes[split.hand] = viewport;
    split.hand = picture;
    const Pane& pane = split.panes[picture];
    static_cast<Eye&>(viewport) = viewport.eyes[picture];
    viewport.place = pane.place, viewport.texture = pane.texture, viewport.hovered = pane.hovered;
    viewport.shown.seen = pane.seen;
}

Borrowed::Borrowed(Viewport& viewport_, std::size_t picture)
    : viewport(viewport_), before(viewport_.split.hand) {
    takeHand(viewport, picture);
}
Borrowed::~Borrowed() { takeHand(viewport, before); }

bool anyHovered(const Viewport& viewport) {
    return anyPane(viewport, [](const Pane& pane) { return pane.hovered; });
}

bool isOverAny(const Viewport& viewport, ImVec2 place) {
    return anyPane(viewport, [&](const Pane& pane) { return pane.place.contains(place); });
}

void splitInto(Editor& editor, std::size_t count) {
    Viewport& viewport = editor.viewport;
    Split& split = viewport.split;
    if (split.hand >= count) takeHand(viewport, 0);
    for (std::size_t i = count; i < kMostPictures; ++i)
        if (Pane& pane = split.panes[i]; pane.texture) {
            editor.shell.forget(pane.texture);
            pane = {};
        }
    split.count = count;
    if (count > 1) split.last = count;
}

void resetEyes(Viewport& viewport) {
    const Eyes first = firstEyes();
    viewport.eyes = first;
    static_cast<Eye&>(viewport) = first[viewport.split.hand];
}

void aimEyes(Viewport& viewport) {
    const Box& region = viewport.shown.region;
    const double radius = 0.5 * std::hypot(region.hi[0] - region.lo[0], region.hi[1] - region.lo[1],
                                           region.hi[2] - region.lo[2]);
    if (viewport.shown.picture.width == 0 || !std::isfinite(radius) || radius <= 0.0) return;
    for (std::size_t i = 1; i < viewport.split.count; ++i) {
        const Borrowed borrowed(viewport, i);
        if (!viewport.awaits || viewport.width() == 0) continue;
        viewport.ownCamera = viewport.orthographic = true;
        viewport.orbit = Orbit{};
        lookFrom(viewport.orbit, *viewport.awaits);
        frame(viewport.orbit,
              {0.5 * (region.lo[0] + region.hi[0]), 0.5 * (region.lo[1] + region.hi[1]),
               0.5 * (region.lo[2] + region.hi[2])},
              radius, double(viewport.aspect()));
        viewport.awaits.reset();
    }
}

void wishPictures(Viewport& viewport, PreviewWish& wish) {
    aimEyes(viewport);
    const std::size_t hand = viewport.split.hand;
    for (std::size_t i = 0; i < viewport.split.count; ++i) {
        const Borrowed borrowed(viewport, i);
        PreviewEye eye;
        if (!viewport.awaits) eye.width = viewport.width(), eye.height = viewport.height();
        if (viewport.ownCamera) eye.camera = viewport.own();
        if (i == 0)
            wish.camera = eye.camera, wish.width = eye.width, wish.height = eye.height;
        else
            wish.others.push_back(std::move(eye));
    }
    wish.first = hand;
}

void takePictures(Viewport& viewport, Shell& shell, PreviewResult result) {
    const auto handOver = [&] {  // what was made the scene's camera is seen until a picture of it has come
        if (viewport.shown.revision >= viewport.handedIn) viewport.handed.reset();
        if (viewport.handed) viewport.shown.seen = *viewport.handed;
    };
    const std::vector<PreviewSight> others = std::exchange(result.others, {});
    const Borrowed first(viewport, 0);
    if (!result.picture.pixels.empty()) viewport.texture = shell.show(viewport.texture, result.picture);
    viewport.shown = std::move(result);
    handOver();
    for (std::size_t i = 1; i < viewport.split.count && i <= others.size(); ++i) {
        const PreviewSight& other = others[i - 1];
        std::shared_ptr<const Picture>& shown = viewport.split.panes[i].shown;
        if (!other.picture) continue;
        const Borrowed borrowed(viewport, i);
        viewport.shown.seen = other.seen;
        if (other.picture != shown) viewport.texture = shell.show(viewport.texture, *other.picture);
        viewport.split.panes[i].shown = other.picture;
        handOver();
    }
    // They are aimed when they are wished for next.
    for (std::size_t i = 1; i < viewport.split.count; ++i)
        if (viewport.eyes[i].awaits) Shell::wake();
}

}  // namespace fw::editor
