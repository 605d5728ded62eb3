#include "graph/outlines/drawing.h"

#include <deque>
#include <mutex>
#include <numbers>
#include <utility>

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

constexpr std::size_t kKeptDrawings = 4;

/// A drawing's file that is open, and what tells it, and the wanted part, from every other.
struct OpenDrawing {
    Asset asset;
    const FileKind& kind;
    std::string key;
};
Result<OpenDrawing> openDrawing(const std::string& graphPath, const std::string& path,
                                const std::string& part) {
    const bool svg = endsAs(kSvgFile, path);
    const FileKind& kind = svg ? kSvgFile : kDxfFile;
    if (!svg && !endsAs(kDxfFile, path)) return wrongEnding(path, kDrawingFile);
    Result<Asset> asset = openAsset(graphPath, path, kind);
    if (!asset) return asset.error();
    std::string key = asset->file + '\0' + part;
    for (const int64_t word : asset->stamp) key += '\0' + std::to_string(word);
    return OpenDrawing{std::move(*asset), kind, std::move(key)};
}
Result<Drawing> readOpen(const OpenDrawing& open, const std::string& path, const std::string& part,
                         bool openLines = false) {
    const Result<std::string> bytes = open.asset.read();
    if (!bytes) return fileProblem(path, open.kind, bytes.error().message);
    Result<Drawing> drawing =
        &open.kind == &kSvgFile ? readSvg(*bytes, part) : readDxf(*bytes, part, openLines);
    if (!drawing) return fileProblem(path, open.kind, drawing.error().message);
    return drawing;
}

}  // namespace

Result<OutlinePtr> readDrawing(const std::string& graphPath, const std::string& path,
                               const std::string& part) {
    if (path.empty()) return keptOutline("washer", [] { return outlineOf(washer(), "", ""); });
    const Result<OpenDrawing> open = openDrawing(graphPath, path, part);
    if (!open) return open.error();
    const FileKind& kind = open->kind;
    return keptOutline(open->key, [&]() -> Result<OutlinePtr> {
        const Result<Drawing> drawing = readOpen(*open, path, part);
        if (!drawing) return drawing.error();
        const Result<OutlinePtr> made = outlineOf(
            drawing->painting, "the " + std::string(kind.noun) + " " + inQuotes(path), "simplify it");
        if (!made) return made;
        if (!*made) return fileProblem(path, kind, "paints nothing that has an area");
        Outline outline = **made;
        outline.file = open->asset.file;
        outline.scale = drawing->scale;
        outline.remarks = drawing->remarks;
        return OutlinePtr(std::make_shared<const Outline>(std::move(outline)));
    });
}

Result<DrawnPathsPtr> readPaths(const std::string& graphPath, const std::string& path,
                                const std::string& part) {
    if (path.empty())
        return std::make_shared<const DrawnPaths>(DrawnPaths{washer().fills[0].contours, 1, ""});
    static std::mutex mutex;
    static std::deque<std::pair<std::string, DrawnPathsPtr>> recent;  // for a graph that is compiled again
    const Result<OpenDrawing> open = openDrawing(graphPath, path, part);
    if (!open) return open.error();
    const std::lock_guard lock(mutex);
    for (const auto& [key, paths] : recent)
        if (key == open->key) return paths;
    Result<Drawing> drawing = readOpen(*open, path, part, true);
    if (!drawing) return drawing.error();
    recent.emplace_back(open->key, std::make_shared<const DrawnPaths>(DrawnPaths{
                                       std::move(drawing->paths), drawing->scale, open->asset.file}));
    if (recent.size() > kKeptDrawings) recent.pop_front();
    return recent.back().second;
}

}  // namespace fw
