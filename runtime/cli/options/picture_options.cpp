// Of the commands that make pictures.
#include <algorithm>
#include <cstring>
#include <map>

#include "runtime/cli/options/groups.h"
#include "runtime/cli/options/options.h"
#include "runtime/cli/options/words.h"
#include "runtime/window/viewer.h"

namespace fw::cli {

CLI::App* addRender(CLI::App& program, RenderCommandOptions& options) {
    CLI::App* command = program.add_subcommand(
        "render",
        "Make a picture of a graph, or with --from, --to, --fps or --turntable one for every frame");
    addMesh(command, options.mesh);
    command
        ->add_option("-o,--output", options.output,
                     "The picture, a .png or .exr file; of a sequence the folder, for 000000.png and so on")
        ->required();
    addOpenJd(command);
    addSequence(command, options.sequence);
    addPart(command, options.sequence);
    command
        ->add_option("--turntable", options.turntable,
                     "A camera that goes once around the solid in so many seconds; --time says what it shows")
        ->check(finite())
        ->check(CLI::Range(0.001, 3600.0))
        ->excludes("--from")
        ->excludes("--to")
        ->excludes("--range");
    command->parse_complete_callback([command] {
        if (command->count("--turntable") == 0) oneMomentOrMany(command);
    });
    static const std::map<std::string, PictureFormat> pictureFormats = {{"png", PictureFormat::png},
                                                                        {"exr", PictureFormat::exr}};
    command
        ->add_option_function<std::string>(
            "--format", [&](const std::string& name) { options.format = pictureFormats.at(name); },
            "png: what a display shows; exr: linear light before exposure and tone map, with depth, normals, "
            "materials and alpha (default: as the output ends, else png)")
        ->check(oneOf({"png", "exr"}));
    command->add_option("--size", options.size, "Width and height in pixels: WxH")->default_str(options.size);
    command
        ->add_option("--samples", options.picture.samples,
                     "Frames that a picture is the mean of: of edges, soft shadows and ambient occlusion")
        ->check(CLI::Range(1, kMostSamples))
        ->default_str(std::to_string(options.picture.samples));
    command
        ->add_option(
            "--view", options.view,
            "What is shown: picture, or a look inside: ao, normals, color, shadow, steps (of sphere "
            "tracing), slice (the field with lines of equal distance), exactness (red where the field "
            "is steeper than a distance, blue where flatter), cells (of the mesher), thickness (of walls), "
            "gap (between walls), wireframe; or particles as points or spheres, in place of their surface")
        ->check(oneOf(renderViews()))
        ->default_str(options.view);
    command
        ->add_option("--least", options.picture.leastWidth,
                     "Of the views thickness and gap: what is narrower is red, with a unit or in the "
                     "document's (default: a power of ten that suits the solid)")
        ->type_name("LENGTH")
        ->check(length());
    command->add_flag("--transparent", options.picture.transparent,
                      "The solid alone, with alpha: no sky, wall or ground behind it, nor its shadow there");
    addQuality(command, options.picture.quality);
    command->add_flag(
        "--reference", options.picture.reference,
        "The ground truth: sees the field itself, without a mesh, with 64 rays of ambient "
        "occlusion a sample (1,024 a pixel), each traced to its end; or, with --bounces, where light "
        "passes through something, or the scene has bounce or reflections, whole paths of light, one a "
        "sample");
    command
        ->add_option("--bounces", options.picture.bounces,
                     "Of --reference: paths of light that are reflected by up to so many opaque surfaces")
        ->check(CLI::Range(1, kMostBounces));
    return command;
}

CLI::App* addPlay(CLI::App& program, PlayOptions& options) {
    CLI::App* command = program.add_subcommand(
        "play",
        "Play a graph's timeline in a window; the graph's file is watched, a change is played at once");
    std::string keys = "In the window:";
    for (const KeyHelp& help : viewerKeys())
        keys += "\n  " + std::string(help.key) +
                std::string(14 - std::min<std::size_t>(std::strlen(help.key), 13), ' ') + help.does;
    command->footer(keys);
    addMesh(command, options.mesh);
    addQuality(command, options.quality);
    command->add_option("--size", options.size, "Width and height in pixels: WxH")->default_str(options.size);
    command->add_flag("--headless", options.headless,
                      "Open no window: make the frames, and say how fast that went");
    command
        ->add_option("--frames", options.frames,
                     "End after as many frames (default: with --headless once through the timeline)")
        ->check(whole(1, 1'000'000));
    return command;
}

}  // namespace fw::cli
