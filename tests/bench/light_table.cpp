// The second half of the talk: what ambient occlusion costs and what reprojection and sharing save of it,
// what a frame costs, and how the geometry is used again between its passes.
#include <cmath>

#include "graph/emit/glsl.h"
#include "graph/evaluate/evaluate.h"
#include "runtime/play/session.h"
#include "runtime/system/clock.h"
#include "tests/bench/path_baseline.h"
#include "tests/bench/tables.h"

namespace fw::bench {
namespace {

constexpr int kWidth = 1280, kHeight = 720, kResolution = 128;
constexpr float kDegreesAFrame = 1.0f;
constexpr double kMostOfAllRays = 0.2, kMostOfUnshared = 0.7;
constexpr double kMostFrame = 45, kMostAnimated = 55, kMostPass = 0.1;

const char* metOrMissed(double value, double most) { return value <= most ? "met" : "missed"; }

struct PrimaryWay {
    const char* name;
    const char* slide;
    AmbientOptions options;
};

AmbientOptions with(int raysNew, bool reproject, bool balance) {
    AmbientOptions options{.radius = 0.5f, .bias = 0.02f, .raysNew = raysNew};
    options.reproject = reproject;
    options.balance = balance;
    return options;
}

/// Once around the tower, a degree a frame.
Camera cameraAt(int frame) {
    const double angle = frame * kDegreesAFrame * 3.14159265 / 180;
    return {.position = {7 * std::sin(angle), 3.5, 7 * std::cos(angle)}, .target = {0, 0, 0}, .fov = 40};
}

/// The tower's mesh, and what draws it.
struct Stage {
    Session session;
    MesherResult mesh;
    Renderer renderer;
    SeenBounds bounds;
    RenderOptions options{.width = kWidth, .height = kHeight, .samples = 1, .primary = Primary::measured};
    float lipschitz;
    uint64_t content = 0;

    Stage(Device device, const Program& program)
        : session(std::move(device)), lipschitz(float(program.exactness.lipschitz)) {
        session.setProgram(program);
        mesh = *session.polygonise(request());
        bounds = boundsOf(
            download<gpu::MeshVertex>(session.device(), session.meshBuffers().vertices, mesh.vertices));
        renderer = createRenderer(session.device(), emitField(program));
    }
    static MeshRequest request() { return {Box{{-2.5, -2.5, -2.5}, {2.5, 2.5, 2.5}}, kResolution}; }
    RenderScene scene() const {
        return {.mesh = session.meshBuffers(),
                .vertices = mesh.vertices,
                .triangles = mesh.triangles,
                .grid = {{-2.5f, -2.5f, -2.5f}, {2.5f, 2.5f, 2.5f}, 5.0f / kResolution},
                .lipschitz = lipschitz,
                .bounds = bounds,
                .content = content};
    }
    void turn(int frame) { options.scene.camera = cameraAt(frame); }
    gpu::View view() const {
        return cameraView(*options.scene.camera, bounds, float(kWidth) / float(kHeight));
    }
};

/// Milliseconds of the stage of that name; 0 if there is none.
double stage(const Commands& commands, std::string_view name) {
    for (const StageTime& time : commands.stages)
        if (time.name == name) return time.milliseconds;
    return 0;
}

/// What ambient occlusion takes while the camera moves.
Figure timeAmbient(const Bench& bench, Stage& stage_, const RenderScene& scene) {
    int frame = 0;
    return measure(bench.options.repeats, [&] {
        stage_.turn(frame++);
        Commands commands(stage_.session.device(), true);
        drawFrame(commands, stage_.renderer, scene, stage_.options, stage_.view(), false, 0);
        submit(commands);
        return stage(commands, "ambient");
    });
}

void ambientTable(Bench& bench, Stage& stage_) {
    const PrimaryWay ways[] = {{"16 rays a pixel", "30", with(16, false, false)},
                               {"1 ray, reprojected", "2", with(1, true, false)},
                               {"1 ray, reprojected, 16 in holes", "12", with(16, true, false)},
                               {"the same, shared by the lanes of a tile", "4", with(16, true, true)}};
    Table table{.title = "Ambient occlusion, 1280 x 720, tower, the camera moving (ms)",
                .header = {"way", "the slide", "of 16 rays, slide", "ambient", "of 16 rays"}};
    double all = 0, unshared = 0, shared = 0;
    stage_.options.scene.ground.reset();
    stage_.options.scene.sun.reset();
    stage_.renderer.tracing = true;
    stage_.renderer.trust = 1.0f;
    for (const PrimaryWay& way : ways) {
        stage_.renderer.ambient.options = way.options;
        forgetHistory(stage_.renderer.ambient);
        const Figure figure = timeAmbient(bench, stage_, stage_.scene());
        if (&way == &ways[0]) all = figure.median();
        if (&way == &ways[2]) unshared = figure.median();
        if (&way == &ways[3]) shared = figure.median();
        table.rows.push_back({way.name, way.slide, number(std::stod(way.slide) / 30), text(figure),
                              number(figure.median() / all)});
    }
    table.notes = {"The slide: a GeForce 570, its own scene. Rays of half a metre, at most " +
                       std::to_string(AmbientOptions{}.samplesMoving) +
                       " samples each; the camera "
                       "turns by " +
                       number(kDegreesAFrame) + " degree a frame.",
                   "Shared, of 16 rays everywhere: at most " + number(kMostOfAllRays) + " wanted, " +
                       metOrMissed(shared / all, kMostOfAllRays) + " (" + number(shared / all) + ").",
                   "Shared, of the same unshared: at most " + number(kMostOfUnshared) + " wanted, " +
                       metOrMissed(shared / unshared, kMostOfUnshared) + " (" + number(shared / unshared) +
                       ")."};
    print(table, bench.options.markdown);
}

/// A field that looks its distance up in a volume of side^3 samples over the tower's region.
std::string bakedField(int side) {
    return "const int kSide = " + std::to_string(side) + ";\n" + R"(
layout(binding = FIELD_IMAGES, scalar) readonly buffer Volume { float volume[]; };
void fieldBegin() {}
#ifdef FIELD_VALUE
float fieldValue(vec3 p) {
    vec3 at = clamp((p + 2.5) * (float(kSide - 1) / 5.0), vec3(0.0), vec3(float(kSide) - 1.001)), f = fract(at);
    ivec3 i = ivec3(at);
    int corner = (i.z * kSide + i.y) * kSide + i.x, up = corner + kSide * kSide;
    vec4 x = mix(vec4(volume[corner], volume[corner + kSide], volume[up], volume[up + kSide]),
                 vec4(volume[corner + 1], volume[corner + kSide + 1], volume[up + 1], volume[up + kSide + 1]), f.x);
    vec2 y = mix(x.xz, x.yw, f.y);
    return mix(y.x, y.y, f.z);
}
#endif
)";
}

std::vector<float> baked(const Program& program, int side) {
    std::vector<Point> points;
    for (int z = 0; z < side; ++z)
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                points.push_back(
                    {-2.5 + 5.0 * x / (side - 1), -2.5 + 5.0 * y / (side - 1), -2.5 + 5.0 * z / (side - 1)});
    std::vector<double> values(points.size());
    evaluate(program.ir, program.distance(), program.parameters(), points, values);
    return {values.begin(), values.end()};
}

/// What the picture of a frame without history differs by, 0 to 1, where there is occlusion in `exact`.
double difference(const Picture& exact, const Picture& other) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < exact.pixels.size(); i += 4)
        if (exact.pixels[i] < 253) sum += std::abs(exact.pixels[i] - other.pixels[i]) / 255.0, ++count;
    return sum / double(std::max<std::size_t>(count, 1));
}

void bakedTable(Bench& bench, Stage& stage_, const Program& program) {
    Table table{.title = "16 rays a pixel through the field's code, and through a volume baked from it (ms)",
                .header = {"field", "ambient", "of the code", "off by, of 1"}};
    Picture exact;
    double code = 0;
    for (const int side : {0, 64, 128}) {
        const std::string field = side ? bakedField(side) : stage_.renderer.field;
        Buffer volume;
        RenderScene scene = stage_.scene();
        if (side) {
            const std::vector<float> values = baked(program, side);
            volume = createBuffer(stage_.session.device(), 4 * values.size(), Memory::upload);
            upload(stage_.session.device(), volume, values);
            scene.buffers.images = &volume;
        }
        stage_.renderer.ambient = createAmbient(stage_.session.device(), field, with(16, false, false));
        const Figure figure = timeAmbient(bench, stage_, scene);
        stage_.turn(0);
        RenderOptions options = stage_.options;
        options.show = RENDER_AMBIENT;
        stage_.renderer.shown.reset();
        stage_.renderer.number = 0;
        Picture picture;
        if (!renderLive(stage_.renderer, scene, options, &picture)) return;
        if (!side) exact = picture, code = figure.median();
        table.rows.push_back({side ? "volume of " + std::to_string(side) + " cubed" : "code", text(figure),
                              number(figure.median() / code), number(difference(exact, picture))});
    }
    table.notes = {"The same rays in each. The renderer traces through the code."};
    print(table, bench.options.markdown);
    stage_.renderer.ambient = createAmbient(stage_.session.device(), stage_.renderer.field, {});
}

/// Draws a frame of a moving view: milliseconds of all stages, and of each into `parts`.
double drawTimed(Stage& stage_, std::map<std::string, Figure>& parts) {
    Commands commands(stage_.session.device(), true);
    drawFrame(commands, stage_.renderer, stage_.scene(), stage_.options, stage_.view(), false, 0);
    submit(commands);
    double sum = 0;
    for (const StageTime& time : commands.stages) {
        parts[time.name].runs.push_back(time.milliseconds);
        sum += time.milliseconds;
    }
    return sum;
}

/// 0 of what was never run.
double medianOf(Figure& part) {
    std::ranges::sort(part.runs);
    return part.runs.empty() ? 0.0 : part.median();
}

void frameTable(Bench& bench, Stage& stage_) {
    Table table{.title = "A frame, 1280 x 720, tower at 128 cells, the camera moving (ms)",
                .header = {"primary rays", "mesh", "shadow", "depth", "tiles", "surface", "ambient", "light",
                           "all", "mesh made anew: all"}};
    double best = 1e9, bestAnimated = 1e9, generated = 0, drawn = 0, pass = 0;
    stage_.options.scene = {};
    for (const bool traced : {false, true}) {
        stage_.renderer.tracing = traced;
        stage_.renderer.trust = 1.0f;  // as is measured for this field
        stage_.renderer.ambient.options = {.radius = 0.8f, .bias = 0.01f};
        std::map<std::string, Figure> parts;
        Figure all;
        int frame = 0;
        forgetHistory(stage_.renderer.ambient);
        const auto draw = [&](bool anew) {
            stage_.turn(frame++);
            if (anew) stage_.renderer.shadowStands = false, ++stage_.content;
            return drawTimed(stage_, parts);
        };
        const Figure still = measure(bench.options.repeats, [&] { return draw(false); });
        const Figure animated = measure(bench.options.repeats, [&] {
            const MesherResult made = *stage_.session.polygonise(Stage::request(), true);
            double sum = 0;
            for (const StageTime& time : made.stages) sum += time.milliseconds;
            parts["mesh"].runs.push_back(sum);
            return sum + draw(true);
        });
        const auto part = [&](const char* name) { return medianOf(parts[name]); };
        table.rows.push_back({traced ? "traced" : "drawn", number(part("mesh")), number(part("shadow")),
                              number(part("depth")), number(part("tiles")), number(part("surface")),
                              number(part("ambient")), number(part("light")), text(still), text(animated)});
        best = std::min(best, still.median());
        bestAnimated = std::min(bestAnimated, animated.median());
        if (!traced)
            generated = part("mesh"), drawn = part("depth"), pass = part("shadow");
        else
            pass = std::min(pass, part("shadow"));
    }
    table.notes = {"The frame of an unchanged mesh: at most " + number(kMostFrame) + " wanted, " +
                       metOrMissed(best, kMostFrame) + " (" + number(best) + "). Its shadow map stands.",
                   "Mesh and shadow map made anew for each: at most " + number(kMostAnimated) + " wanted, " +
                       metOrMissed(bestAnimated, kMostAnimated) + " (" + number(bestAnimated) + ").",
                   "A further shadow pass, of generating and drawing the mesh again: at most " +
                       number(kMostPass) + " wanted, " + metOrMissed(pass / (generated + drawn), kMostPass) +
                       " (" + number(pass / (generated + drawn)) + ")."};
    print(table, bench.options.markdown);
}

/// The scene of a picture of paths, as the plain program is told of it.
PathBaseline baselineOf(const RenderOptions& options, const gpu::RenderFrame& frame) {
    return {.size = {options.width, options.height},
            .eye = frame.now.eye,
            .forward = frame.now.forward,
            .right = frame.now.right,
            .up = frame.now.up,
            .zenith = frame.zenith,
            .horizon = frame.horizon,
            .below = frame.groundColor,
            .sun = frame.sun,
            .sunLight = frame.sunLight,
            .sunWide = 1 - std::cos(0.5f * float(options.scene.sun->size) * 3.14159265f / 180),
            .base = glm::vec3(0.8f),
            .roughness = 0.5f,
            .radius = frame.radius,
            .bounces = options.bounces};
}

/// Whole paths of light, beside those of plain C++.
void pathTable(Bench& bench, Stage& stage_) {
    Table table{.title = "Whole paths of light, of up to 4 bounces, tower under a sky, 320 x 180",
                .header = {"by", "paths a second, million", "ms for 16 a pixel", "mean radiance"}};
    RenderOptions options = stage_.options;
    options.width = 320, options.height = 180;
    options.scene = {};
    options.scene.sky = Sky{};
    options.scene.ground.reset();
    options.scene.camera = cameraAt(20);
    options.reference = true;
    options.bounces = 4;
    options.samples = 16;
    PathSums sums;
    options.sums = &sums;
    const RenderScene scene = stage_.scene();
    const Figure ours = measure(bench.options.repeats, [&] {
        sums = {};
        const Clock::time_point start = Clock::now();
        if (!renderPicture(stage_.renderer, scene, options)) return 0.0;
        return millisecondsSince(start);
    });
    const double paths = double(options.width) * options.height * options.samples;
    glm::dvec3 mean(0);
    for (std::size_t i = 0; i < sums.sums.size(); ++i)
        if (i % 4 < 3) mean[int(i % 4)] += sums.sums[i] / paths;
    const PathBaseline plain = baselineOf(options, stage_.renderer.described);
    glm::dvec3 plainMean(0);
    const Figure baseline = measure(bench.options.repeats, [&] {
        const PathBaselineResult result = tracePaths(plain, options.samples);
        plainMean = result.mean;
        return result.milliseconds;
    });
    const auto row = [&](const char* by, const Figure& figure, glm::dvec3 radiance) {
        table.rows.push_back({by, number(paths / figure.median() / 1000), text(figure),
                              number(radiance.x) + ", " + number(radiance.y) + ", " + number(radiance.z)});
    };
    row("plain C++, two threads", baseline, plainMean);
    row("path.comp", ours, mean);
    const double ratio = baseline.median() / ours.median();
    table.notes = {"Ahead of the plain program wanted: " + std::string(metOrMissed(1 / ratio, 1)) + " (" +
                   number(ratio) + " times as fast)."};
    print(table, bench.options.markdown);
}

/// What secondary rays add to a frame.
void secondaryTable(Bench& bench, Stage& stage_) {
    Table table{.title =
                    "A frame with secondary rays, one of each kind a pixel, 1280 x 720, tower at 128 cells, "
                    "the camera moving (ms)",
                .header = {"rays", "ambient", "secondary", "filter", "light", "all", "of none"}};
    const struct {
        const char* name;
        bool bounce, reflections;
    } ways[] = {
        {"none", false, false}, {"bounce", true, false}, {"reflections", false, true}, {"both", true, true}};
    double none = 0, both = 0, filter = 0;
    stage_.renderer.tracing = true;
    stage_.renderer.trust = 1.0f;
    stage_.renderer.ambient.options = {.radius = 0.8f, .bias = 0.01f};
    for (const auto& way : ways) {
        stage_.options.scene = {};
        stage_.options.scene.sky = Sky{};
        stage_.options.scene.bounce = way.bounce;
        stage_.options.scene.reflections = way.reflections;
        forgetHistory(stage_.renderer.ambient);
        std::map<std::string, Figure> parts;
        int frame = 0;
        const Figure all = measure(bench.options.repeats, [&] {
            stage_.turn(frame++);
            return drawTimed(stage_, parts);
        });
        const auto part = [&](const char* name) { return medianOf(parts[name]); };
        if (&way == &ways[0]) none = all.median();
        both = all.median();
        filter = part("filter");
        table.rows.push_back({way.name, number(part("ambient")), number(part("secondary")),
                              number(part("filter")), number(part("light")), text(all),
                              number(all.median() / none)});
    }
    table.notes = {"Both, of none: at most 2.5 wanted, " + std::string(metOrMissed(both / none, 2.5)) + " (" +
                   number(both / none) + "). The filter, of the frame with both: at most 0.15 wanted, " +
                   metOrMissed(filter / both, 0.15) + " (" + number(filter / both) + ")."};
    print(table, bench.options.markdown);
}

/// Drawing the depth of a fine mesh, of all of its clusters and of those that are seen.
void cullTable(Bench& bench, Stage& stage_) {
    constexpr int kFine = 512;
    MeshRequest request = Stage::request();
    request.resolution = kFine;
    const Result<MesherResult> mesh = stage_.session.polygonise(request);
    if (!mesh) return;
    const Device& device = stage_.session.device();
    const MesherBuffers& buffers = stage_.session.meshBuffers();
    Renderer& renderer = stage_.renderer;
    const VkExtent3D extent = {kWidth, kHeight, 1};
    Table table{.title = "Depth of the tower's mesh at " + std::to_string(kFine) + " cells, " +
                         std::to_string(mesh->triangles) + " triangles, 1280 x 720 (ms)",
                .header = {"from", "drawn, %", "all drawn", "culled and drawn", "of all"}};
    const std::pair<const char*, Camera> views[] = {
        {"afar", cameraAt(0)},
        {"near a corner", {.position = {2.0, 1.5, 2.0}, .target = {1, 1, 1}, .fov = 40}},
        {"inside", {.position = {0, 0, 0.1}, .target = {0.5, 0.1, -1}, .fov = 40}}};
    for (const auto& [name, camera] : views) {
        const gpu::View view = cameraView(camera, stage_.bounds, float(kWidth) / float(kHeight));
        const glm::mat4 clip = toClip(view),
                        everything = glm::mat4(glm::vec4(0), glm::vec4(0), glm::vec4(0), {0, 0, 0, 1});
        const bool inside = std::string_view(name) == "inside";
        const auto draw = [&](bool culled) {
            Commands commands(device, true);
            boundClusters(commands, renderer.clusters, buffers, mesh->triangles, stage_.content + 1);
            beginStage(commands, "depth");
            cullClusters(commands, renderer.clusters, buffers, culled ? clip : everything,
                         glm::vec4(view.eye, 1), inside || !culled);
            drawDepth(commands, renderer.depth, renderer.seen, extent, clip, buffers, &renderer.clusters);
            submit(commands);
            return stage(commands, "depth");
        };
        const Figure all = measure(bench.options.repeats, [&] { return draw(false); });
        const Figure culled = measure(bench.options.repeats, [&] { return draw(true); });
        const uint32_t drawn =
            download<gpu::ClusterCounts>(device, renderer.clusters.counts, 1)[0].draw[0] / 3;
        table.rows.push_back({name, number(100.0 * drawn / mesh->triangles), text(all), text(culled),
                              number(culled.median() / all.median())});
    }
    print(table, bench.options.markdown);
}

}  // namespace

void lightTable(Bench& bench) {
    const std::optional<Program> program = benchProgram(bench, Field::tower);
    if (!program) return;
    Result<Device> device = createDevice({});
    if (!device) return;
    Stage stage_(std::move(*device), *program);
    ambientTable(bench, stage_);
    bakedTable(bench, stage_, *program);
    frameTable(bench, stage_);
    secondaryTable(bench, stage_);
    pathTable(bench, stage_);
    cullTable(bench, stage_);
}

}  // namespace fw::bench
