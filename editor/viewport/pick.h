// Which node made what is seen at a place of the picture.
//
// The ray through the pixel is followed through the compiled field, cut in halves as long as interval
// arithmetic cannot rule out that it meets the solid: so no step is too long, whatever the field. Then an
// offset is put behind each node that begins a surface (a shape, an expression), with a live distance, and
// the field at the point is differentiated by all of them at once, backwards through its operations: the node
// whose offset moves the field most is the one that the point belongs to. That sees through booleans,
// repeats, groups and whatever else stands between, and knows no type of node.
//
// A thousand nodes take some 20 ms at the first place, most of it to compile them; that is kept for the next.
// Lifetime: a Picker serves one thread at a time, and any document.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>

#include "graph/document/graph.h"
#include "graph/document/scene.h"
#include "graph/evaluate/evaluate.h"

namespace fw::editor {

/// What the picture shows.
struct Seen {
    std::shared_ptr<const Graph> graph;
    uint64_t revision = 0;    ///< of the document: another one where a file that it names has changed
    std::string pinned = {};  ///< the node shown; empty: the output
    double seconds = 0.0;     ///< since the timeline's start
    Box region = {};          ///< what lies outside is not drawn
    Camera camera = {};
    double aspect = 1.0;                         ///< width by height
    std::vector<FieldVolumePtr> particles = {};  ///< as PreviewResult

    bool operator==(const Seen&) const = default;
};

class Picker {
  public:
    Picker();
    ~Picker();

    /// The node's path, as the compiler names it (document/paths.h); empty where nothing is hit, or the graph
    /// has errors. x and y are from -1 to 1, y upwards.
    std::string pick(const Seen& seen, double x, double y);
    /// Where the solid is hit first, in the picture's space; none where pick() hits nothing.
    std::optional<Point> hit(const Seen& seen, double x, double y);
    /// The field of what is seen, as it is measured; nullptr if the graph has errors. Until the next call.
    const Tape* field(const Seen& seen);

  private:
    struct Probed;
    /// The field of what is seen with its offsets, compiled unless that is what was asked last.
    const Probed& probedOf(const Seen& seen);

    Seen asked;
    std::unique_ptr<Probed> probed;  ///< of what was asked
};

/// The document with the node in place of its output, if one is pinned, at a time; `seconds` become those of
/// the timeline.
Graph shownAt(const Graph& graph, const std::string& pinned, double& seconds);

/// The box around the solid that this node of the document makes, in its own space; none if it makes none, or
/// has no end.
std::optional<Box> solidOf(const Graph& graph, const std::string& node, double seconds);

}  // namespace fw::editor
