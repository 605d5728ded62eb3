// `fieldwright render`: graph file to picture, or to a numbered picture for every frame.
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "graph/compile/effort.h"
#include "runtime/cli/kept_paths.h"
#include "runtime/cli/mesh_graph.h"
#include "runtime/cli/sequence.h"
#include "runtime/export/outputs.h"
#include "runtime/render/renderer.h"
#include "runtime/system/interruption.h"
#include "runtime/system/output_file.h"

namespace fw::cli {

namespace {

uint32_t viewOf(const RenderCommandOptions& options) {
    const std::vector<std::string>& views = renderViews();
    return static_cast<uint32_t>(std::find(views.begin(), views.end(), options.view) - views.begin());
}

}  // namespace

const std::vector<std::string>& renderViews() {
    static const std::vector<std::string> names = {"picture", "ao",        "normals", "color",
                                                   "shadow",  "steps",     "slice",   "exactness",
                                                   "cells",   "wireframe", "points",  "spheres"};
    return names;  // in the order of RENDER_PICTURE and the following
}

std::string nameOf(PictureFormat format) { return format == PictureFormat::exr ? "exr" : "png"; }

PictureFormat formatOf(const RenderCommandOptions& options) {
    if (options.format) return *options.format;
    return lowerExtension(options.output) == ".exr" ? PictureFormat::exr : PictureFormat::png;
}

Done save(const Picture& picture, const LightPicture& light, PictureFormat format, const std::string& path,
          const std::function<void()>& kept) {
    return format == PictureFormat::exr ? saveLight(light, path, kept) : savePicture(picture, path, kept);
}

RenderOptions renderOptions(const RenderCommandOptions& options, std::pair<int, int> size,
                            const Player& player) {
    RenderOptions render{.width = size.first, .height = size.second, .samples = options.samples};
    render.reference = options.reference;
    constexpr int kBounces = 8;
    const Result<Scene> scene = player.scene();
    const bool wanted = player.program().transmits() || (scene && (scene->bounce || scene->reflections));
    render.bounces = options.bounces > 0                         ? options.bounces
                     : wanted && player.program().stages.empty() ? kBounces
                                                                 : 0;
    render.show = viewOf(options);
    render.cutout = options.transparent;
    return render;
}

FieldBy renderedBy(const RenderCommandOptions& options) {
    const uint32_t view = viewOf(options);
    return options.reference || view == RENDER_AMBIENT || showsField(view) ? FieldBy::kernels
                                                                           : options.quality;
}

void noteDraft(Player& player, const RenderCommandOptions& options) {
    const std::string why = player.whyDraft();
    if (!why.empty() && options.quality == FieldBy::sooner)
        std::fprintf(stderr, "%s: note: a draft, of the mesh alone: %s; --quality full waits for it\n",
                     options.output.c_str(), why.c_str());
}

int runRender(const RenderCommandOptions& options) {
    const auto size = pictureSize("render", options.size);
    if (!size) return kBadUsage;
    if (options.bounces > 0 && (!options.reference || viewOf(options) != RENDER_PICTURE)) {
        std::fprintf(
            stderr,
            "fieldwright render: --bounces is of paths of light: give --reference too, and no --view\n");
        return kBadUsage;
    }
    if (options.quality == FieldBy::tapes && renderedBy(options) != options.quality) {
        std::fprintf(stderr,
                     "fieldwright render: %s traces the field, and --quality draft is a picture of the mesh "
                     "alone: leave one of them out\n",
                     options.reference ? "--reference" : ("--view " + options.view).c_str());
        return kBadUsage;
    }
    if (formatOf(options) == PictureFormat::exr && viewOf(options) != RENDER_PICTURE) {
        std::fprintf(stderr, "fieldwright render: an OpenEXR file holds light: leave out --view\n");
        return kBadUsage;
    }
    if (options.transparent && viewOf(options) != RENDER_PICTURE) {
        std::fprintf(stderr, "fieldwright render: --transparent is of the picture: leave out --view\n");
        return kBadUsage;
    }
    if (options.from || options.to || options.framesPerSecond || options.range)
        return runSequence(options, *size);
    const PictureFormat format = formatOf(options);
    if (lowerExtension(options.output) != "." + nameOf(format)) {
        std::fprintf(
            stderr,
            "fieldwright render: %s: a picture is a PNG or an OpenEXR file: give a name that ends in "
            "%s, or the times of a sequence (--from, --to, --fps)\n",
            options.output.c_str(),
            options.format ? ("." + nameOf(format) + ", or leave out --format").c_str() : ".png or .exr");
        return kBadUsage;
    }
    if (options.overwrite) {
        std::fprintf(
            stderr,
            "fieldwright render: --overwrite is for a sequence: give --from, --to, --fps or --range\n");
        return kBadUsage;
    }
    if (const Done distinct = checkDistinct(options.mesh.graph.path, {options.output}); !distinct)
        return print(distinct.error()), kBadUsage;
    MeshOptions kept = options.mesh;
    kept.outputs = {options.output};

    Progress progress;
    int status = kDone;
    std::optional<Player> player =
        openPlayer(kept, progress, {.liveParameters = false, .fieldBy = renderedBy(options)}, status);
    if (!player) return status;
    progress.start("mesh", 50);
    RenderOptions render = renderOptions(options, *size, *player);
    const Result<MesherResult> mesh = player->meshOnDevice(render.show);
    if (!mesh) return badInput(options.mesh, mesh.error());
    if (mesh->triangles == 0 && !(showsParticles(render.show) && player->particles() > 0))
        return badInput(options.mesh,
                        nothingToSee(!player->regionFound(), player->region(), player->resolution()));
    progress.start("light", 60);
    render.progress = [&progress](int percent) { progress.show(60 + percent * 2 / 5); };
    LightPicture light;
    if (format == PictureFormat::exr) render.light = &light;
    std::optional<KeptPaths> keptPaths;
    PathSums sums;
    if (render.reference && render.bounces > 0 && render.show == RENDER_PICTURE) {
        keptPaths.emplace(options.output, *player, render);
        sums = keptPaths->read();
        const auto tell = [&sums, &options] {
            whenEnded({.said = "; " + std::to_string(sums.paths) + " of " + std::to_string(options.samples) +
                               " samples are kept: the same command goes on"});
        };
        if (sums.paths > 0) {
            std::fprintf(stderr, "%s: note: goes on from %d samples that were kept\n", options.output.c_str(),
                         sums.paths);
            tell();
        }
        render.sums = &sums;
        render.keepSums = [&keptPaths, &sums, tell] {
            if (keptPaths->write(sums)) tell();  // the picture does not depend on it
        };
        if (const Result<Scene> scene = player->scene(); scene && scene->fog && scene->fog->density > 0.0)
            std::fprintf(stderr, "%s: note: paths of light leave out the scene's fog\n",
                         options.output.c_str());
    }
    const Result<Picture> picture = player->frame(render);
    if (!picture) return badInput(options.mesh, picture.error());
    const auto isThere = [&] {
        if (keptPaths) keptPaths->remove();
        whenEnded({.said = "; the picture was written"});
    };
    if (const Done written = save(*picture, light, format, options.output, isThere); !written)
        return print(written.error()), kSystemFailure;
    progress.finish();
    noteDraft(*player, options);
    if (const std::optional<Error> coarser = player->coarser()) print(*coarser);
    if (mesh->capped)
        std::fprintf(stderr, "%s: note: the surface leaves the region and was closed at its boundary\n",
                     options.output.c_str());
    return kDone;
}

}  // namespace fw::cli
