#include "runtime/play/session.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "graph/bounds/region.h"
#include "graph/compile/effort.h"
#include "graph/compile/unbounded_node.h"
#include "graph/document/timeline.h"
#include "graph/emit/glsl.h"
#include "runtime/measure/field_measure.h"
#include "runtime/mesh/creases.h"
#include "runtime/mesh/materials.h"
#include "runtime/mesh/split_materials.h"
#include "runtime/mesher/host.h"
#include "runtime/stages/decimate.h"
#include "runtime/stages/levels_of_detail.h"
#include "runtime/stages/project_host.h"
#include "runtime/system/behind.h"
#include "runtime/system/clock.h"

namespace fw {

namespace {

/// Beyond these, in metres, squares of lengths leave the range of single precision.
constexpr double kLeastCell = 1e-16, kFarthestCorner = 1e15;
/// Views that show one content in turn. Live values rest if it is shown more often.
constexpr int kMaxViews = 4;

Error problem(std::string message) { return {.message = std::move(message)}; }

void checkFits(const Device& device, const char* what, uint64_t bytes, uint64_t most) {
    if (bytes > most)
        throw SystemError("the " + std::string(what) + " are " + std::to_string((bytes >> 20) + 1) +
                          " MiB, and device '" + device.name() + "' can read " + std::to_string(most >> 20) +
                          ": lower their resolution");
}

Error tooLargeToLookInto(const Program& program) {
    return problem("this view traces the field, whose code would keep the driver busy for about " +
                   std::to_string(std::lround(secondsToCompile(program))) +
                   " s: ask for full quality, or choose another view");
}

/// The node that makes the context's graph unbounded; nothing if none is found.
std::optional<UnboundedNode> unboundedNode(const RegionContext& context) {
    if (!context.graph) return std::nullopt;
    const Result<Timeline> timeline = readTimeline(*context.graph);
    if (!timeline) return std::nullopt;
    UnboundedNodeOptions options;
    options.time = context.time;
    options.stop = context.stop;
    return findUnboundedNode(atTime(*context.graph, *timeline, options.time), options);
}

}  // namespace

RegionContext regionContext(const Graph& graph, double seconds, std::stop_token stop) {
    const Result<Timeline> timeline = readTimeline(graph);
    return {&graph, timeline ? timelineTime(*timeline, seconds) : seconds, std::move(stop)};
}

Error regionError(const Program& program, const Region& found, const RegionContext& context) {
    if (found.extent == Extent::empty) {
        const bool hasParticles =
            std::ranges::any_of(program.ir.volumes(), [](const auto& v) { return bool(v->particles); });
        return problem("the solid is empty: the field is nowhere negative; " +
                       std::string(hasParticles
                                       ? "if there are no particles yet, look at a later time (--time)"
                                       : "check the nodes that cut it (subtract, intersect) and its sizes"));
    }
    const std::optional<UnboundedNode> node = unboundedNode(context);
    if (context.stop.stop_requested()) return cancelledError();
    const bool isUnbounded = found.extent == Extent::unbounded;
    const std::string what = node ? describe(*node)
                             : isUnbounded
                                 ? "the solid is unbounded"
                                 : "the solid cannot be proven bounded: " + describeUnproven(found.unproven);
    const bool saysWhere = (node ? node->extent : found.extent) == Extent::unproven;
    // Bits of the axes that the field depends on.
    const bool isFlat = program.ir[program.distance()].positions == 0b011;
    return problem(what + (saysWhere ? "; " : ": ") +
                   (isFlat ? "it is a flat shape, the same at every z: extrude or revolve it, " : "") +
                   "intersect it with a box, or give a region (--region, or region_min and region_max of a "
                   "polygonize node)");
}

Result<Box> meshRegion(const Program& program, const MeshRequest& request, const RegionContext& context) {
    if (request.region || program.region) {
        const Box& box = request.region ? *request.region : *program.region;
        for (int axis = 0; axis < 3; ++axis) {
            if (!std::isfinite(box.lo[axis]) || !std::isfinite(box.hi[axis]))
                return problem("the region has a corner that is not a number");
            if (!(box.lo[axis] < box.hi[axis]))
                return problem("the region has no extent along " + std::string(1, "xyz"[axis]) +
                               ": give its least corner first");
        }
        return box;
    }
    const int resolution = request.resolution > 0 ? request.resolution : program.resolution;
    const Region found = findRegion(program, context.stop);
    if (context.stop.stop_requested()) return cancelledError();
    if (found.extent != Extent::bounded) return regionError(program, found, context);
    return padded(found.box, resolution, 1.5);
}

Result<CellGrid> cellGrid(const Box& region, int resolution) {
    if (resolution < 1 || resolution > kMostResolution)
        return problem("the resolution must be between 1 and " + std::to_string(kMostResolution) + " cells");
    const double longest = longestSide(region), cell = longest / resolution;
    double farthest = 0.0;
    for (int axis = 0; axis < 3; ++axis)
        farthest = std::max({farthest, std::abs(region.lo[axis]), std::abs(region.hi[axis])});
    if (!(cell >= kLeastCell) || !(farthest <= kFarthestCorner))
        return problem("the region is too " + std::string(cell < kLeastCell ? "small" : "large") +
                       " for single precision, in which lengths are squared: scale the model");
    CellGrid grid{};
    for (int axis = 0; axis < 3; ++axis) {
        const double side = region.hi[axis] - region.lo[axis];
        grid.cells[axis] =
            std::clamp(static_cast<int>(std::lround(resolution * side / longest)), 1, resolution);
        grid.origin[axis] = static_cast<float>(region.lo[axis]);
        grid.cellSize[axis] = static_cast<float>(side / grid.cells[axis]);
    }
    return grid;
}

void prepareKernels(const Program& program, const std::function<bool()>& goOn) {
    if (secondsToCompile(program) <= kMostSecondsToCompile) prepareMesher(emitField(program), goOn);
}

Session::Session(Device device, FieldBy by_) : gpu(std::make_unique<Device>(std::move(device))), by(by_) {}

Session::~Session() {
    if (overtaken) *overtaken = true;
}

Session& Session::operator=(Session&& other) noexcept {
    if (this == &other) return *this;
    std::destroy_at(this);
    return *std::construct_at(this, std::move(other));
}

void Session::take(Program program) {
    finish(*gpu);  // what runs may be of the program before
    const bool sameImages = images && program.ir.images() == current.ir.images();
    const bool sameVolumes = volumes && program.ir.volumes() == current.ir.volumes() &&
                             program.ir.outlines() == current.ir.outlines() &&
                             program.ir.splines() == current.ir.splines();
    std::vector<uint32_t> words, texels;
    if (!sameImages) words = imageWords(program.ir.images());
    if (!sameVolumes) texels = fieldTexels(program.ir);
    checkFits(*gpu, "pixels of all images", words.size() * sizeof(uint32_t), gpu->limits.storageRange);
    checkFits(*gpu, "samples of all fields on grids", texels.size() * sizeof(uint32_t),
              DeviceLimits::kTexelBytes * gpu->limits.texels());
    current = std::move(program);
    stepConstants.reset();
    if (!sameImages) {
        reserve(*gpu, images, words.size() * sizeof(uint32_t));
        upload(*gpu, images, words);
    }
    if (!sameVolumes) {
        reserve(*gpu, volumes, texels.size() * sizeof(uint32_t));
        upload(*gpu, volumes, texels);
    }
    if (lacksParticles(current)) {
        if (!particles) particles.emplace(*gpu);
        particles->setProgram(current);
    } else {
        particles.reset();
    }
    const std::vector<float> values = current.numbers();
    reserve(*gpu, parameters, values.size() * sizeof(float), Memory::upload);
    upload(*gpu, parameters, values);
    reserve(*gpu, parametersBefore, values.size() * sizeof(float), Memory::upload);
    upload(*gpu, parametersBefore, values);
}

bool Session::tapesAreSooner(int resolution) const {
    if (by != FieldBy::sooner) return by == FieldBy::tapes;
    const double compiling = secondsToCompile(current);
    return compiling > kMostSecondsToCompile && secondsByTapes(current, resolution) < compiling;
}

bool Session::beyondDriver() const {
    return by == FieldBy::tapes || (by == FieldBy::sooner && secondsToCompile(current) > kMostSecondsBehind);
}

double Session::weightOfCode() {
    if (codedHash != current.structureHash) {
        codeAdditions = codeWeight(current.ir, current.distance(), current.families);
        codedHash = current.structureHash;
    }
    return codeAdditions;
}

bool Session::isTracedForLong() {
    if (by != FieldBy::sooner || !gpu->software) return false;
    if (weighedHash != current.structureHash) {
        const Box region{{grid.lo.x, grid.lo.y, grid.lo.z}, {grid.hi.x, grid.hi.y, grid.hi.z}};
        secondsTraced = secondsToTrace(weightAtSurface(current, region));
        weighedHash = current.structureHash;
    }
    return secondsTraced > kMostSecondsToTrace;
}

std::string Session::whyDraft() {
    if (tapes)
        return "the driver would take about " + std::to_string(std::lround(2 * secondsToCompile(current))) +
               " s to compile the field";
    if (isTracedForLong())
        return "light that is traced through the field would take about " +
               std::to_string(std::lround(secondsTraced)) + " s for each sample of 640 x 360 pixels";
    return "";
}

void Session::dropRenderer() {
    if (renderer && renderer->pixels) lastPicture = std::move(renderer->pixels);
    renderer.reset();
}

const Image* Session::picture() const {
    if (renderer && renderer->pixels) return &renderer->pixels;
    return lastPicture ? &lastPicture : nullptr;
}

bool Session::setProgram(Program program, std::vector<StageTime>* stages) {
    take(std::move(program));
    if (std::exchange(kernelsBehind, false)) dropRenderer();
    if (hasMesherKernels() || tapesAreSooner(current.resolution)) return false;
    buildKernels(stages);
    return true;
}

void Session::buildKernels(std::vector<StageTime>* stages) {
    const auto start = Clock::now();
    const std::string field = emitField(current);
    if (stages) stages->push_back({"emit", millisecondsSince(start)});
    const auto compiling = Clock::now();
    pipelines = createMesherPipelines(*gpu, field, current.hasMaterial(), pipelines);
    dropRenderer();
    if (stages) stages->push_back({"pipelines", millisecondsSince(compiling)});
    builtHash = current.structureHash;
    built = true;
}

void Session::replaceProgram(Program program, const FieldKernelOptions& kernels) {
    take(std::move(program));
    if (!std::exchange(kernelsBehind, true)) dropRenderer(), hasKernels = false;
    kernelOptions = kernels;
    kernelOptions.when = Compile::behind;
    drafting();
}

bool Session::compiling() {
    if (next.valid() && next.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
        MesherPipelines made = next.get();
        finish(*gpu);
        if (nextHash == current.structureHash && !hasMesherKernels()) {
            pipelines = std::move(made);
            if (!kernelsBehind) dropRenderer();
            builtHash = nextHash;
            built = true;
        }
    }
    if (hasMesherKernels() || !kernelsBehind || beyondDriver()) return false;
    if (!next.valid()) {  // one structure at a time; what was replaced meanwhile is passed over
        nextHash = current.structureHash;
        next = std::async(std::launch::async, [device = gpu.get(), program = current, previous = pipelines] {
            workBehind();
            return createMesherPipelines(*device, emitField(program), program.hasMaterial(), previous,
                                         nullptr, Compile::behind);
        });
    }
    return true;
}

bool Session::meshesOnHost() { return compiling() || (kernelsBehind && !hasMesherKernels()); }

bool Session::drafting() {
    if (!kernelsBehind || beyondDriver()) return false;
    const bool meshing = compiling();  // the mesher's kernels come first
    const auto there = [&] { return hasKernels && kernelsHash == current.structureHash; };
    const auto wanted = [&] { return nextKernelsHash == current.structureHash && overtaken && !*overtaken; };
    if (nextKernels.valid() && nextKernels.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
        std::optional<FieldKernels> made = nextKernels.get();
        if (made && wanted() && !there()) {
            finish(*gpu);
            if (!renderer) renderer = createRenderer(*gpu);
            setField(*renderer, std::move(*made));
            kernelsHash = nextKernelsHash;
            hasKernels = true;
            ++content;
        }
    }
    if (there()) return false;
    if (nextKernels.valid()) {
        if (!wanted()) *overtaken = true;
    } else if (!meshing) {
        nextKernelsHash = current.structureHash;
        overtaken = std::make_shared<std::atomic<bool>>(false);
        FieldKernelOptions options = kernelOptions;
        options.cancel = overtaken.get();
        nextKernels = std::async(std::launch::async,
                                 [device = gpu.get(), program = current, options, flag = overtaken] {
                                     workBehind();
                                     return createFieldKernels(*device, emitField(program), options);
                                 });
    }
    return true;
}

void Session::setParameter(std::size_t slot, double value) {
    current.live.at(slot).value = value;
    ++content;
    const auto narrow = static_cast<float>(value);
    uploadBytes(*gpu, parameters, &narrow, sizeof narrow, slot * sizeof narrow);
}

Result<bool> Session::simulate(double seconds, const ValuesAt& values, bool surfaces,
                               const std::function<bool(int done, int all)>& progress) {
    if (!particles) return false;
    const Result<ParticleChanges> changes =
        particles->make(current, seconds, values, volumes, surfaces, progress);
    if (!changes) return changes.error();
    if (changes->fields || (changes->places && !surfaces)) ++content;
    return changes->fields;
}

void Session::valuesChanged() {
    if (particles) particles->valuesChanged();
}

std::vector<FieldVolumePtr> Session::particleVolumes() const {
    if (!particles) return {};
    return downloadParticles(*gpu, current, volumes);
}

Program Session::onHost() const {
    Program program = current;
    useParticles(program, particleVolumes());
    return program;
}

Result<MesherResult> Session::polygonise(const MeshRequest& request, bool timed) {
    const int resolution = request.resolution > 0 ? request.resolution : current.resolution;
    const Result<Box> region = meshRegion(current, {request.region, resolution});
    if (!region) return region.error();
    const Result<CellGrid> cells = cellGrid(*region, resolution);
    if (!cells) return cells.error();

    MesherConfig config{.origin = cells->origin, .cellSize = cells->cellSize, .cells = cells->cells};
    grid.lo = config.origin;
    grid.hi = config.origin + config.cellSize * glm::vec3(config.cells);
    grid.cellSize = static_cast<float>(longestSide(*region) / resolution);
    ++content;
    config.field = fieldBuffers();
    config.families = &current.families;
    config.colors = current.hasMaterial();
    config.tile = request.tile;
    config.method = request.method.value_or(current.method);
    config.timed = timed;
    config.weight = weightOfCode();
    std::optional<MesherHost> host;
    std::optional<Program> evaluated;
    const bool waits = compiling();
    tapes = !waits && !hasMesherKernels() && (kernelsBehind || tapesAreSooner(resolution));
    if (waits || tapes) {
        evaluated = onHost();
        const std::span<const IrId> color(&evaluated->surface[baseColorComponent], 3);
        config.host = &host.emplace(evaluated->ir, evaluated->distance(), evaluated->parameters(),
                                    config.colors ? color : std::span<const IrId>());
    } else if (!hasMesherKernels()) {
        buildKernels(nullptr);
    }
    Result<MesherResult> result = runMesher(*gpu, pipelines, buffers, config);
    if (result && request.stages && !current.stages.empty())
        if (const Done staged = runStages(*result, *region, evaluated ? &*evaluated : nullptr, timed);
            !staged)
            return staged.error();
    return result;
}

Done Session::runStages(MesherResult& result, const Box& region, const Program* evaluated, bool timed) {
    if (!stagePipelines) stagePipelines = createMeshStagePipelines(*gpu);
    MeshStageConfig config{.pipelines = &*stagePipelines,
                           .lo = grid.lo,
                           .hi = grid.hi,
                           .cellSize = grid.cellSize,
                           .field = fieldBuffers(),
                           .timed = timed};
    const bool projects = std::ranges::any_of(current.stages, &projectsVertices);
    if (evaluated && projects)
        config.projectOnHost =
            [&, tape = makeTape(evaluated->ir, evaluated->distance(), evaluated->parameters())](
                auto push, auto vertices) { projectOnHost(tape, push, vertices); };
    if (!evaluated && projects && (!stagePipelines->project || projectionHash != current.structureHash)) {
        stagePipelines->project = createProjection(*gpu, emitField(current));
        projectionHash = current.structureHash;
    }
    std::optional<Program> measured;
    std::optional<MeasureOptions> measure;  // made by the first decimation
    config.decimate = [&](Mesh& mesh, const MeshStage& stage) {
        if (!measured) measured = onHost();
        if (stage.error > 0.0 && !measure) measure = measureOf(*measured, region);
        if (stage.byShape) mesh.colors.clear();
        return decimate(mesh, {stage.error, std::size_t(stage.triangles)}, measure.value_or(MeasureOptions{}),
                        stage.byShape ? std::vector<uint32_t>() : materialsOfVertices(mesh, *measured));
    };
    return runMeshStages(*gpu, stageBuffers, buffers, result, current.stages, config);
}

float Session::constant(int component) const {
    const IrId id = current.surface[component];
    return current.ir.isConstant(id) ? static_cast<float>(current.ir.number(id))
                                     : static_cast<float>(kDefaultMaterial[std::size_t(component) - 1]);
}

glm::vec3 Session::constantVector(int component) const {
    return {constant(component), constant(component + 1), constant(component + 2)};
}

glm::vec3 Session::baseColor() const { return constantVector(baseColorComponent); }

Material Session::material() const {
    return {.roughness = constant(roughnessComponent),
            .metallic = constant(metallicComponent),
            .emission = constantVector(emissionComponent),
            .transmission = constant(transmissionComponent),
            .ior = constant(iorComponent),
            .absorption = constantVector(absorptionComponent)};
}

void Session::dropMesh() {
    buffers = MesherBuffers();
    stageBuffers = MeshStageBuffers();
}

std::string Session::materialName() const {
    const IrId id = current.surface[painterComponent];
    return current.ir.isConstant(id) ? current.painters[std::size_t(current.ir.number(id))] : "";
}

Mesh Session::download(const MesherResult& result, MaterialParts wanted) const {
    return finished(downloadMesh(*gpu, buffers, result), result.creases, wanted);
}

std::vector<Mesh> Session::downloadLevels(const MesherResult& result, std::size_t levels,
                                          MaterialParts wanted) const {
    if (levels == 1) return {download(result, wanted)};
    Mesh finest = downloadMesh(*gpu, buffers, result);
    // Where textures tell what it looks like, no border needs triangles.
    const bool textured = wanted == MaterialParts::besideTextures;
    const Program program = onHost();
    const auto labels = [&](const Mesh& level) {
        return textured ? std::vector<uint32_t>() : materialsOfVertices(level, program);
    };
    std::vector<glm::vec3> colors = textured ? std::exchange(finest.colors, {}) : std::vector<glm::vec3>();
    std::vector<Mesh> made = coarserLevels(finest, levels - 1, labels);
    if (textured) finest.colors = std::move(colors);
    const bool smoothed = std::ranges::any_of(current.stages, [](const MeshStage& stage) {
        return stage.kind == MeshStage::Kind::smooth && stage.times > 0;
    });
    for (Mesh& level : made) level = finished(std::move(level), !smoothed, wanted);
    made.insert(made.begin(), finished(std::move(finest), result.creases, wanted));
    return made;
}

Mesh Session::finished(Mesh mesh, bool creases, MaterialParts wanted) const {
    mesh.baseColor = baseColor();
    mesh.material = material();
    mesh.materialName = materialName();
    const bool parts = wanted != MaterialParts::none && hasManyMaterials(current);
    const Program program = parts ? onHost() : Program();
    std::vector<glm::vec3> places;
    if (parts && wanted == MaterialParts::cut) places = splitMaterials(mesh, program);
    if (creases) splitCreases(mesh);
    if (parts && places.empty()) places = middlesOf(mesh);
    if (parts) partByMaterial(mesh, program, places, wanted == MaterialParts::besideTextures);
    return mesh;
}

double Session::stepConstant(Quality quality) {
    const bool searches = !std::isfinite(current.exactness.lipschitz) && !particles;
    if (!searches) return current.exactness.lipschitz;
    // Positions are rounded, so rays may leave the box by this part of its size.
    const double margin =
        1e-5 * double(std::max({grid.hi.x - grid.lo.x, grid.hi.y - grid.lo.y, grid.hi.z - grid.lo.z}));
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
        box.lo[std::size_t(axis)] = grid.lo[axis] - margin;
        box.hi[std::size_t(axis)] = grid.hi[axis] + margin;
    }
    if (quality != Quality::live) return stepConstants.of(current, box, kMaxStillConstant, true);
    const bool sameContent = liveContent == content;
    liveFrames = sameContent ? liveFrames + 1 : 0;
    const double constant =
        stepConstants.of(current, box, kMaxLiveConstant, current.live.empty() || liveFrames >= kMaxViews);
    // A resting view is the mean of frames, which all step in the same way.
    const bool wasKnown = std::exchange(steppedByConstant, std::isfinite(constant));
    if (sameContent && wasKnown != steppedByConstant) ++content;
    liveContent = content;
    return constant;
}

template <class Draw>
auto Session::draw(const MesherResult& result, RenderOptions options, Draw draw, Quality quality)
    -> decltype(draw(std::declval<Renderer&>(), std::declval<RenderScene&>(), options)) {
    // Beside the field, a changed mesh would not be seen: where there are stages, the mesh alone is drawn.
    const bool looksInto = showsField(options.show) || options.show == RENDER_AMBIENT;
    if (tapes && looksInto) return tooLargeToLookInto(current);
    const bool sketches = quality == Quality::sketch;
    const bool draft =
        drafting() || sketches || !current.stages.empty() || (!looksInto && (tapes || isTracedForLong()));
    std::optional<Renderer>& with = sketches ? sketcher : renderer;
    if (!with) with = createRenderer(*gpu);
    if (!draft && renderer->field.empty())
        setField(*renderer, std::move(*createFieldKernels(*gpu, emitField(current))));
    std::vector<gpu::MeshVertex> points;
    if (options.framed.empty() && result.vertices > 0) {
        points = fw::download<gpu::MeshVertex>(*gpu, buffers.vertices, result.vertices);
        options.framed = points;
    }
    const Material constants = material();
    const gpu::DraftMaterial look{
        .base = baseColor(),
        .roughness = constants.roughness,
        .emission = constants.emission,
        .metallic = constants.metallic,
        .colored = result.colors && 12ull * result.vertices <= gpu->limits.storageRange};
    const double lipschitz = draft ? current.exactness.lipschitz : stepConstant(quality);
    std::vector<ParticleCloud> clouds;
    if (particles && showsParticles(options.show)) clouds = particles->clouds(current);
    const RenderScene scene{.mesh = buffers,
                            .vertices = result.vertices,
                            .triangles = result.triangles,
                            .grid = grid,
                            .lipschitz = static_cast<float>(lipschitz),
                            .lipschitzWithinGrid = !std::isfinite(current.exactness.lipschitz),
                            .buffers = fieldBuffers(),
                            .families = &current.families,
                            .transmits = current.transmits(),
                            .bounds = boundsOf(options.framed),
                            .particles = clouds,
                            .draft = draft ? std::optional(look) : std::nullopt,
                            .content = content};
    return draw(*with, scene, options);
}

Result<Picture> Session::render(const MesherResult& result, const RenderOptions& options) {
    rememberParameters();
    return draw(
        result, options,
        [](Renderer& with, const RenderScene& scene, const RenderOptions& wishes) {
            return renderPicture(with, scene, wishes);
        },
        Quality::still);
}

void Session::rememberParameters() {
    if (!current.live.empty()) upload(*gpu, parametersBefore, current.numbers());
}

Result<bool> Session::renderLive(const MesherResult& result, const RenderOptions& options, Picture* onHost) {
    Result<bool> drawn = draw(
        result, options,
        [&](Renderer& with, const RenderScene& scene, const RenderOptions& wishes) {
            return fw::renderLive(with, scene, wishes, onHost);
        },
        Quality::live);
    if (drawn && *drawn) rememberParameters();
    return drawn;
}

Result<bool> Session::sketch(const MesherResult& result, const RenderOptions& options, Picture& onHost) {
    return draw(
        result, options,
        [&](Renderer& with, const RenderScene& scene, const RenderOptions& wishes) {
            return fw::renderLive(with, scene, wishes, &onHost);
        },
        Quality::sketch);
}

}  // namespace fw
