// `fieldwright render`: graph file to picture, or to a numbered picture for every frame.
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "graph/compile/effort.h"
#include "runtime/cli/mesh_graph.h"
#include "runtime/cli/sequence.h"
#include "runtime/export/outputs.h"
#include "runtime/pictures/kept_paths.h"
#include "runtime/render/renderer.h"
#include "runtime/system/interruption.h"
#include "runtime/system/output_file.h"

namespace fw::cli {

namespace {

uint32_t viewOf(const RenderCommandOptions& options) {
    const std::vector<std::string>& views = renderViews();
    return static_cast<uint32_t>(std::find(views.begin(), views.end(), options.view) - views.begin());
}

/// What the options ask of a picture.
PictureWish wishOf(const RenderCommandOptions& options, std::pair<int, int> size) {
    PictureWish wish = options.picture;
    wish.width = size.first, wish.height = size.second;
    wish.view = viewOf(options);
    wish.format = options.format                             ? *options.format
                  : lowerExtension(options.output) == ".exr" ? PictureFormat::exr
                                                             : PictureFormat::png;
    return wish;
}

}  // namespace

void notePicture(Player& player, const PictureWish& wish, const std::string& output) {
    if (showsWidths(wish.view)) {
        const double least = double(renderOptions(wish, player).leastWidth);
        const auto words = [&](double times) { return withSign(times * least, "m", unitOf(player.graph())); };
        std::fprintf(stderr, "%s: note: red is narrower than %s, green %s, blue %s or more%s\n",
                     output.c_str(), words(1).c_str(), words(2).c_str(),
                     words(double(RENDER_MOST_WIDTHS)).c_str(), wish.leastWidth.empty() ? " (--least)" : "");
    }
    const std::string why = player.whyDraft();
    if (!why.empty() && wish.quality == FieldBy::sooner)
        std::fprintf(stderr, "%s: note: a draft, of the mesh alone: %s; --quality full waits for it\n",
                     output.c_str(), why.c_str());
}

int runRender(const RenderCommandOptions& options) {
    const auto size = pictureSize("render", options.size);
    if (!size) return kBadUsage;
    const PictureWish wish = wishOf(options, *size);
    if (wish.bounces > 0 && (!wish.reference || wish.view != RENDER_PICTURE)) {
        std::fprintf(
            stderr,
            "fieldwright render: --bounces is of paths of light: give --reference too, and no --view\n");
        return kBadUsage;
    }
    if (wish.quality == FieldBy::tapes && renderedBy(wish) != wish.quality) {
        std::fprintf(stderr,
                     "fieldwright render: %s traces the field, and --quality draft is a picture of the mesh "
                     "alone: leave one of them out\n",
                     wish.reference ? "--reference" : ("--view " + options.view).c_str());
        return kBadUsage;
    }
    if (wish.format == PictureFormat::exr && wish.view != RENDER_PICTURE) {
        std::fprintf(stderr, "fieldwright render: an OpenEXR file holds light: leave out --view\n");
        return kBadUsage;
    }
    if (wish.transparent && wish.view != RENDER_PICTURE) {
        std::fprintf(stderr, "fieldwright render: --transparent is of the picture: leave out --view\n");
        return kBadUsage;
    }
    if (!wish.leastWidth.empty() && !showsWidths(wish.view)) {
        std::fprintf(stderr,
                     "fieldwright render: --least is of widths: give --view thickness or --view gap too\n");
        return kBadUsage;
    }
    if (options.sequence.frames.asked() || options.turntable) return renderSequence(options, wish);
    if (lowerExtension(options.output) != "." + nameOf(wish.format)) {
        std::fprintf(
            stderr,
            "fieldwright render: %s: a picture is a PNG or an OpenEXR file: give a name that ends in "
            "%s, or the times of a sequence (--from, --to, --fps)\n",
            options.output.c_str(),
            options.format ? ("." + nameOf(wish.format) + ", or leave out --format").c_str()
                           : ".png or .exr");
        return kBadUsage;
    }
    if (options.sequence.overwrite) {
        std::fprintf(stderr,
                     "fieldwright render: --overwrite is for a sequence: give --from, --to, --fps, --range "
                     "or --turntable\n");
        return kBadUsage;
    }
    if (const Done distinct = checkDistinct(options.mesh.graph.path, {options.output}); !distinct)
        return print(distinct.error()), kBadUsage;
    MeshOptions kept = options.mesh;
    kept.outputs = {options.output};

    Progress progress;
    int status = kDone;
    std::optional<Player> player =
        openPlayer(kept, progress, {.liveParameters = false, .fieldBy = renderedBy(wish)}, status);
    if (!player) return status;
    progress.start("mesh", 50);
    RenderOptions render = renderOptions(wish, *player);
    const Result<MesherResult> mesh = player->meshOnDevice(render.show);
    if (!mesh) return badInput(options.mesh, mesh.error());
    if (mesh->triangles == 0 && !(showsParticles(render.show) && player->particles() > 0))
        return badInput(options.mesh,
                        nothingToSee(!player->regionFound(), player->region(), player->resolution()));
    progress.start("light", 60);
    render.progress = [&progress](int percent) { progress.show(60 + percent * 2 / 5); };
    LightPicture light;
    if (wish.format == PictureFormat::exr) render.light = &light;
    std::optional<KeptPaths> keptPaths;
    if (tracesPaths(render)) {
        const auto tell = [&wish](int paths) {
            whenEnded({.said = "; " + std::to_string(paths) + " of " + std::to_string(wish.samples) +
                               " samples are kept: the same command goes on"});
        };
        keptPaths.emplace(options.output, *player, render);
        if (const int paths = keptPaths->goOn(render, tell); paths > 0) {
            std::fprintf(stderr, "%s: note: goes on from %d samples that were kept\n", options.output.c_str(),
                         paths);
            tell(paths);
        }
    }
    if (leavesOutFog(render, *player))
        std::fprintf(stderr, "%s: note: paths of light leave out the scene's fog\n", options.output.c_str());
    const Result<Picture> picture = player->frame(render);
    if (!picture) return badInput(options.mesh, picture.error());
    const auto isThere = [&] {
        if (keptPaths) keptPaths->remove();
        whenEnded({.said = "; the picture was written"});
    };
    if (const Done written = save(*picture, light, wish.format, options.output, isThere); !written)
        return print(written.error()), kSystemFailure;
    progress.finish();
    notePicture(*player, wish, options.output);
    if (const std::optional<Error> coarser = player->coarser()) print(*coarser);
    if (mesh->capped)
        std::fprintf(stderr, "%s: note: the surface leaves the region and was closed at its boundary\n",
                     options.output.c_str());
    return kDone;
}

}  // namespace fw::cli
