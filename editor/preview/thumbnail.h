// A small picture of one node's own field, for the canvas: made on the host from a tape, so that it waits for
// no kernel and takes nothing from the preview's device.
#pragma once

#include <span>

#include "graph/assets/volume.h"
#include "graph/document/graph.h"
#include "runtime/render/picture.h"

namespace fw::editor {

inline constexpr int kThumbnailSide = 96;  ///< pixels

struct Thumbnail {
    uint64_t made = 0;       ///< Program::structureHash of what it shows
    Picture picture = {};    ///< of kThumbnailSide
    bool particles = false;  ///< whether it shows some
};

/// The solid that the node at `path` (paths.h) gives, seen as the viewport frames it; of particles, those
/// that a picture shows (PreviewResult::particles). The picture is empty where `made` is still right, and
/// where there are no particles yet. Some ms to some hundred, by the size of the field. Errors: the graph's;
/// the node gives no surface; there is nothing to see; the picture does not show its particles.
Result<Thumbnail> thumbnail(const Graph& graph, std::string_view path,
                            std::span<const FieldVolumePtr> particles = {}, uint64_t made = 0);

}  // namespace fw::editor
