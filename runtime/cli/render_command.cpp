// `fieldwright render`: graph file to picture.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>

#include "runtime/cli/mesh_graph.h"
#include "runtime/render/render.h"

namespace fw::cli {

namespace {

/// "1280x720" to {1280, 720}; none if it is not that.
std::optional<std::pair<int, int>> parseSize(const std::string& text) {
    std::pair<int, int> size;
    const char* end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, size.first);
    if (width.ec != std::errc() || width.ptr == end || *width.ptr != 'x') return std::nullopt;
    const auto height = std::from_chars(width.ptr + 1, end, size.second);
    if (height.ec != std::errc() || height.ptr != end) return std::nullopt;
    return size;
}

bool isPng(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), ::tolower);
    return extension == ".png";
}

}  // namespace

int runRender(const RenderCommandOptions& options) {
    const auto size = parseSize(options.size);
    if (!size) {
        std::fprintf(stderr, "fieldwright render: --size %s: write width x height in pixels, as 1280x720\n",
                     options.size.c_str());
        return kBadUsage;
    }
    if (const Done fits = checkPictureSize(size->first, size->second); !fits) {
        std::fprintf(stderr, "fieldwright render: --size %s: %s\n", options.size.c_str(),
                     fits.error().message.c_str());
        return kBadUsage;
    }
    if (!isPng(options.output)) {
        std::fprintf(stderr,
                     "fieldwright render: %s: a picture is a PNG file: give a name that ends in .png\n",
                     options.output.c_str());
        return kBadUsage;
    }

    Progress progress;
    int status = kDone;
    std::optional<MeshedGraph> meshed = meshGraph(options.mesh, progress, false, status);
    if (!meshed) return status;
    progress.start("light", 60);
    RenderOptions render{.width = size->first, .height = size->second, .cancel = &interrupted};
    render.progress = [&progress](int percent) { progress.show(60 + percent * 2 / 5); };
    const Result<Picture> picture = meshed->session.render(meshed->mesh, render);
    if (!picture) return interrupted ? stopped() : badInput(options.mesh, picture.error());
    const Done written = savePicture(*picture, options.output, &interrupted);
    if (!written) return interrupted ? stopped() : (print(written.error()), kSystemFailure);
    progress.finish();
    if (meshed->mesh.capped)
        std::fprintf(stderr, "%s: note: the surface leaves the region and was closed at its boundary\n",
                     options.output.c_str());
    return kDone;
}

}  // namespace fw::cli
