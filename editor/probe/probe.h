// Understanding what is seen: the probe, which reads every wire of the scope at one point of the picture; the
// plot of a field along a line; and the tools that measure lengths, angles, radii and walls in the picture.
//
//     over the picture        does
//     mouse, probe on         moves the point to what is hit; with Ctrl it stays
//     click, probe on         pins the point there (and selects, as ever); Escape lets it go
//     click with a tool       sets the next point of what is measured, one more begins anew; Escape clears
//
// The fields are compiled and evaluated on a thread of its own (viewport/aside.h): one wish at a time, the
// newest; clicks of tools are answered in their order. Nothing here changes the document, so nothing of it is
// one of the document's hands: what is measured stays while one goes on editing. Lifetime: one in an Editor.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <glm/vec2.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "editor/canvas/canvas.h"
#include "editor/files/browser.h"
#include "editor/probe/along.h"
#include "editor/probe/readings.h"
#include "editor/probe/shapes.h"
#include "editor/viewport/aside.h"
#include "editor/viewport/pick.h"

namespace fw::editor {

struct Editor;

/// What a click in the picture measures.
enum class Measure : unsigned char {
    nothing,
    length,  ///< between two points
    angle,   ///< of three, at the second
    radius,  ///< of the surface at the first, of a circle through three
    wall,
    line  ///< that is plotted
};

/// What is asked of the thread that works.
struct ProbeWish {
    Seen seen;
    std::string scope;
    bool reads = false;                ///< the scope's wires are to be read
    std::optional<Point> point = {};   ///< where; none: at what is hit
    bool hits = false;                 ///< what is seen at `place` is wanted
    glm::dvec2 place{0.0, 0.0};        ///< in the picture, from -1 to 1
    std::optional<Segment> line = {};  ///< to be plotted
    std::string plotted = {};          ///< the node whose field is
    bool operator==(const ProbeWish&) const = default;
};

struct ProbeAnswer {
    std::optional<Point> hit;
    bool reads = false;  ///< there was a point to read at
    std::vector<Reading> readings;
    std::string problem;  ///< why there are none
    std::optional<Plot> plot;
};

/// What the thread that works keeps from one wish to the next.
struct ProbeWork {
    Picker picker;
    ScopeFields fields;

    ProbeAnswer answer(const ProbeWish& wish);
};

struct Probe {
    // The probe is on while its panel is open (Panels::probe).
    std::optional<Point> point;  ///< metres, in the picture's space
    bool pinned = false;
    std::optional<Point> hovered;  ///< what the mouse hits, while a tool waits for it
    std::vector<Reading> readings;
    std::string problem;
    bool selectedOnly = false;  ///< the panel lists the nodes selected alone
    CanvasValues values;        ///< the readings in words

    Measure tool = Measure::nothing;
    Measure what = Measure::length;  ///< the points are of: a length, an angle or a radius
    std::vector<Point> measured;     ///< two points at most of a length, three of the others
    std::optional<Bend> bend;        ///< of the surface at the first point of a radius
    std::optional<WallAt> wall;
    std::string wallProblem;
    std::vector<Point> ends;  ///< of the line that is plotted, none, one or two
    std::string plotted;      ///< whose field
    std::optional<Plot> plot;
    FileBrowser browser;  ///< for the plot's table

    uint64_t document = 0;  ///< that all this is about: Viewport::document
    std::optional<ProbeWish> asked;
    std::deque<std::function<Aside::Answer()>> clicks;  ///< that wait
    ProbeWork work;                                     ///< the thread's aside
    Aside aside{[] { Shell::wake(); }};

    /// The three points, if there are as many.
    std::optional<std::array<Point, 3>> three() const;
    /// The line, if it has both ends.
    std::optional<Segment> line() const;
    /// As it was at the beginning; what is under way has no answer.
    void forget();
};

/// Takes what was answered, and asks for what is out of date. Once a frame, when the picture's mouse is
/// known.
void followProbe(Editor& editor);
/// A click in the picture: whether it was a tool's.
bool takeProbeClick(Editor& editor);
/// The point, the line and what is measured, over the picture.
void showProbeMarks(Editor& editor);

/// Switches the probe on, with its panel in front, or off.
void toggleProbe(Editor& editor);
/// Takes up a tool, or puts it down if it was up.
void useMeasure(Editor& editor, Measure tool);
/// Escape: what was measured goes, then the tool, then the pin. Whether there is anything to go.
bool canClearProbe(const Editor& editor);
void clearProbe(Editor& editor);

/// What was measured, as it is shown and copied: a line each. `size` is about the solid's.
std::string measuredWords(const Probe& probe, double size, const LengthUnit& lengths);
/// Of a length, an angle or a radius whose points are there, in few words; empty if they are not.
std::string shapeWords(const Probe& probe, double size, const LengthUnit& lengths);
/// How large the solid that is seen is, about.
double sizeSeen(const Editor& editor);
/// The readings for the canvas: colours as linear RGB where a wire carries one.
CanvasValues valuesOf(const Boxes& boxes, const std::vector<Reading>& readings, const LengthUnit& lengths);

}  // namespace fw::editor
