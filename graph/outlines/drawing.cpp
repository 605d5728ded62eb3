#include "graph/outlines/drawing.h"

#include <numbers>

#include "graph/base/asset_file.h"

namespace fw {

namespace {

/// What stands for a drawing that is not named.
Painting washer() {
    Pen pen(1e-6);
    for (const double radius : {0.5, 0.2}) {
        pen.moveTo({radius, 0});
        pen.ellipse({0, 0}, {radius, 0}, {0, radius}, 0, 2 * std::numbers::pi);
        pen.close();
    }
    return {.fills = {{.contours = pen.taken(), .evenOdd = true}}, .clips = {}};
}

}  // namespace

Result<OutlinePtr> readDrawing(const std::string& graphPath, const std::string& path,
                               const std::string& part) {
    if (path.empty()) return keptOutline("washer", [] { return outlineOf(washer(), "", ""); });
    const bool svg = endsAs(kSvgFile, path);
    const FileKind& kind = svg ? kSvgFile : kDxfFile;
    if (!svg && !endsAs(kDxfFile, path)) return wrongEnding(path, kDrawingFile);
    const Result<Asset> asset = openAsset(graphPath, path, kind);
    if (!asset) return asset.error();
    std::string key = asset->file + '\0' + part;
    for (const int64_t word : asset->stamp) key += '\0' + std::to_string(word);
    return keptOutline(key, [&]() -> Result<OutlinePtr> {
        const Result<std::string> bytes = asset->read();
        if (!bytes) return fileProblem(path, kind, bytes.error().message);
        const Result<Drawing> drawing = svg ? readSvg(*bytes, part) : readDxf(*bytes, part);
        if (!drawing) return fileProblem(path, kind, drawing.error().message);
        const Result<OutlinePtr> made = outlineOf(
            drawing->painting, "the " + std::string(kind.noun) + " " + inQuotes(path), "simplify it");
        if (!made) return made;
        if (!*made) return fileProblem(path, kind, "paints nothing that has an area");
        Outline outline = **made;
        outline.file = asset->file;
        outline.scale = drawing->scale;
        outline.remarks = drawing->remarks;
        return OutlinePtr(std::make_shared<const Outline>(std::move(outline)));
    });
}

}  // namespace fw
