// Drawings made elsewhere, as outlines: what an SVG file paints, or the flat outlines of a DXF file.
//
// Of an SVG file (1.1, and what of 2 is drawn alike) all that is painted is one outline: fills by their
// rules, strokes with their joins, caps and dashes, through groups, transforms, `use`, nested pages and
// clips; colours do not matter. What is less than half opaque is not painted. What cannot be followed (text,
// pictures, masks) is left away and named. Of a DXF file lines, arcs, circles, ellipses, polylines, splines
// and inserted blocks are joined where they meet; contours within others are holes by turns. No file but the
// one that is named is ever opened.
//
// A drawing is brought to a unit: the longer side of its page is 1, the page's centre the origin, +Y up.
// `Outline::scale` says how large it is by its own units. A DXF file's page is its contents' box.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "graph/base/result.h"
#include "graph/outlines/boundary.h"
#include "graph/outlines/outline.h"

namespace fw {

/// What is painted, brought to a unit; see above.
struct Drawing {
    Painting painting;
    std::vector<Contour> paths = {};        ///< along which it is drawn, in their order
    double scale = 1;                       ///< of a unit by its file, metres
    std::vector<std::string> remarks = {};  ///< what was left away, a sentence each, no full stop
};

/// The drawing in a file's bytes, or the part of it that has this id or label (of an SVG file) or is on this
/// layer; all if `part` is empty. Errors, with a message only: what is damaged or beyond the limits; nothing
/// is painted; no such part.
Result<Drawing> readSvg(const std::string& bytes, const std::string& part);
/// `open`: lines that close no outline will do.
Result<Drawing> readDxf(const std::string& bytes, const std::string& part, bool open = false);

/// Reads a file of the kind kSvgFile or kDxfFile (file_kind.h), told by its ending. `path` is relative to the
/// folder of the file `graphPath`, as openAsset() has it. The Error has a message only.
Result<OutlinePtr> readDrawing(const std::string& graphPath, const std::string& path,
                               const std::string& part);

/// The paths of a drawing, brought to a unit.
struct DrawnPaths {
    std::vector<Contour> paths;  ///< in the order in which they are painted
    double scale = 1;            ///< of a unit by its file, metres
    std::string file;            ///< absolute path
};
using DrawnPathsPtr = std::shared_ptr<const DrawnPaths>;
/// The same of the lines along which it is drawn, open ones too. Of a DXF file those that close come first.
Result<DrawnPathsPtr> readPaths(const std::string& graphPath, const std::string& path,
                                const std::string& part);

}  // namespace fw
