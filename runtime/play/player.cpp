#include "runtime/play/player.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "graph/base/words.h"
#include "graph/bounds/region.h"
#include "graph/check/check.h"
#include "graph/compile/moving_region.h"
#include "graph/compile/single_precision.h"
#include "graph/document/json.h"
#include "graph/document/named_parameters.h"

namespace fw {

namespace {

/// Steps over the timeline and cells of the meshes that a picture frames.
constexpr int kOutlineSteps = 16, kOutlineResolution = 40;
constexpr int kMostHalvings = 2;

Error problem(const Graph& graph, std::string message) {
    return {.message = std::move(message), .file = graph.path};
}

Error inGraph(const Graph& graph, Error error) {
    error.file = graph.path;
    return error;
}

std::stop_token stopToken(const PlayerOptions& options) {
    return options.stop ? options.stop() : std::stop_token();
}

/// The first error that check() finds; the rest goes to `warnings`, which may be null.
std::optional<Error> firstError(const Graph& graph, std::vector<Error>* warnings) {
    for (Error& finding : check(graph)) {
        if (finding.severity == Error::Severity::error) return std::move(finding);
        if (warnings) warnings->push_back(std::move(finding));
    }
    return std::nullopt;
}

/// Tells `baking`, which may be empty, of all that the baker does.
MeshFieldBaker toldBaker(const Device& device, const std::function<void(double)>& baking) {
    MeshFieldBaker bake = meshFieldBaker([gpu = &device] { return gpu; }, {.progress = baking});
    if (!baking) return bake;
    return [bake = std::move(bake), baking](const MeshFieldRecipe& recipe) {
        baking(0.0);
        Result<FieldVolumePtr> volume = bake(recipe);
        baking(1.0);  // also of what was on the disk, or failed
        return volume;
    };
}

/// The kernels that the document's scene asks for.
FieldKernelOptions kernelsFor(const Graph& graph, const Program& program, uint32_t view) {
    FieldKernelOptions kernels{.lamps = false, .view = view};
    const Result<Scene> scene = readScene(*graph.scene);
    if (!scene) return kernels;
    kernels.lamps = !scene->lights.empty();
    kernels.sun = scene->sun && scene->sun->traced;
    kernels.secondary = secondaryKinds(*scene, program.transmits());
    return kernels;
}

}  // namespace

Result<Player> Player::open(const std::string& path, const PlayerOptions& options,
                            std::vector<Error>* warnings) {
    // The device starts while the graph is read: on software Vulkan that takes longer than the rest.
    DeviceOptions deviceOptions = options.deviceOptions;
    deviceOptions.pick = options.device;
    OpeningDevice opening(std::launch::async, deviceOptions);
    Result<Graph> graph = readGraph(path, warnings);
    if (!graph) return graph.error();
    if (std::optional<Error> error = firstError(*graph, warnings)) return std::move(*error);
    Result<Device>& device = opening.get();
    if (!device) return device.error();
    Player player(std::move(*device), options);
    Result<Prepared> prepared = player.prepare(std::move(*graph), options);
    if (!prepared) return prepared.error();
    player.adopt(std::move(*prepared));
    return player;
}

Result<Player> Player::create(Graph graph, Device&& device, const PlayerOptions& options) {
    if (!options.checked)
        if (std::optional<Error> error = firstError(graph, nullptr)) return std::move(*error);
    Player player(std::move(device), options);
    Result<Prepared> prepared = player.prepare(std::move(graph), options);
    if (!prepared) {
        device = player.session.release();
        return prepared.error();
    }
    player.adopt(std::move(*prepared));
    return player;
}

Player::Player(Device device, PlayerOptions options_)
    : session(std::move(device), options_.fieldBy),
      bake(toldBaker(session.device(), options_.baking)),
      options(std::move(options_)) {}

Result<Player::Prepared> Player::prepare(Graph graph, const PlayerOptions& wishes) const {
    CompileOptions compileOptions;
    compileOptions.bake = bake;
    compileOptions.triangles = wishes.triangles;
    compileOptions.byShape = wishes.byShape;
    compileOptions.stop = stopToken(wishes);
    std::set<std::string> exposed = wishes.live;
    if (wishes.liveParameters)
        for (const NamedParameter& parameter : namedParameters(graph))
            exposed.insert(parameter.node + "." + parameter.input);
    Result<LiveProgram> live = compileLive(std::move(graph), std::move(compileOptions), exposed);
    if (!live) return live.error();
    Prepared made{std::move(*live), {}, false, true, {}};
    const Result<Scene> scene = readScene(*made.graph.scene);
    if (scene && scene->sky && scene->sky->isPicture()) {
        Result<EnvironmentMapPtr> map = readEnvironment(made.graph.path, scene->sky->image);
        if (!map) return problem(made.graph, "the scene's sky.image: " + map.error().message);
        made.environment = std::move(*map);
    }
    if (const Done found = findSharedRegion(made, wishes); !found) return found.error();
    if (auto note = precisionLoss(made.graph, made.program, *made.region))
        made.program.notes.push_back(std::move(*note));
    return made;
}

Done Player::findSharedRegion(Prepared& prepared, const PlayerOptions& options) {
    Program& program = prepared.program;
    const int resolution = options.resolution > 0 ? options.resolution : program.resolution;
    const MeshRequest request{options.region, resolution};
    RegionContext context{&prepared.graph, 0.0, stopToken(options)};
    prepared.regionFound = !options.region && !program.region;
    if (!prepared.regionFound || !prepared.fieldMoves) {
        const std::vector<double> values = prepared.valuesAt(0.0);
        for (std::size_t slot = 0; slot < values.size(); ++slot) program.live[slot].value = values[slot];
        const Result<Box> box = meshRegion(program, request, context);
        if (!box) return inGraph(prepared.graph, box.error());
        prepared.region = *box;
        return done();
    }
    const MovingRegion found = findMovingRegion(prepared, context.stop);
    if (context.stop.stop_requested()) return inGraph(prepared.graph, cancelledError());
    if (found.region.extent == Extent::bounded) {
        prepared.region = padded(found.region.box, resolution, 1.5);
        prepared.regionIsProven = !found.unproven;
        return done();
    }
    if (found.region.extent == Extent::empty && !prepared.timeline.tracks.empty())
        return problem(prepared.graph, "the solid is empty at every time of its timeline");
    context.time = found.time;
    const std::vector<double> values = prepared.valuesAt(found.time);
    for (std::size_t slot = 0; slot < values.size(); ++slot) program.live[slot].value = values[slot];
    Error error = regionError(program, found.region, context);
    if (error.code != Error::Code::cancelled && found.region.extent != Extent::empty)
        error.message += " (at " + shortNumber(found.time) + " s)";
    return inGraph(prepared.graph, std::move(error));
}

void Player::adopt(Prepared prepared) {
    const std::vector<double> values = prepared.valuesAt(seconds);
    for (std::size_t slot = 0; slot < values.size(); ++slot) prepared.program.live[slot].value = values[slot];
    const bool same = meshed && session.program().structureHash == prepared.program.structureHash &&
                      session.program().parameters() == values && now.region == prepared.region &&
                      now.program.resolution == prepared.program.resolution &&
                      now.program.method == prepared.program.method &&
                      now.program.stages == prepared.program.stages;
    if (session.program().structureHash != prepared.program.structureHash ||
        now.program.resolution != prepared.program.resolution)
        halvings = 0;
    const bool moved = prepared.fieldMoves || now.fieldMoves;
    const bool other = !moveAlike(now.timeline, prepared.timeline) || now.inputs != prepared.inputs;
    now = std::move(prepared);
    if (other) session.valuesChanged();  // before others are given, which know of it
    give();
    if (same && !moved) return;
    meshed.reset();
    points.clear();
}

void Player::give() {
    if (options.compileBehind)
        session.replaceProgram(now.program, kernelsFor(now.graph, now.program, options.view));
    else
        session.setProgram(now.program);
}

void Player::renewDevice() {
    const DeviceOptions asked = device().asked;
    meshed.reset();
    halvings = 0;
    session = Session(Device(), options.fieldBy);  // the lost one goes before another comes
    session = Session(reopenDevice(asked), options.fieldBy);
    bake = toldBaker(session.device(), options.baking);
    const std::vector<double> values = now.valuesAt(seconds);
    for (std::size_t slot = 0; slot < values.size(); ++slot) now.program.live[slot].value = values[slot];
    give();
}

std::vector<std::string> Player::files() const {
    std::vector<std::string> list;
    if (!now.graph.path.empty()) list.push_back(now.graph.path);
    for (const FieldImagePtr& image : session.program().ir.images())
        if (!image->file.empty()) list.push_back(image->file);
    for (const OutlinePtr& outline : session.program().ir.outlines())
        if (!outline->file.empty()) list.push_back(outline->file);
    for (const SplineTablePtr& table : session.program().ir.splines())
        if (!table->spline->file.empty()) list.push_back(table->spline->file);
    if (now.environment) list.push_back(now.environment->file);
    for (const FieldVolumePtr& volume : session.program().ir.volumes()) {
        if (volume->mesh) list.push_back(volume->mesh->file);
        if (!volume->particles) continue;
        if (const std::string& cache = volume->particles->particles.cache; !cache.empty())
            list.push_back((std::filesystem::path(now.graph.path).parent_path() / cache).string());
        for (const ParticleStage& stage : volume->particles->particles.stages)
            if (stage.places || stage.sequence)
                list.push_back(stage.places ? stage.places->file : stage.sequence->file);
    }
    return list;
}

std::vector<PlayerParameter> Player::parameters() const {
    std::vector<PlayerParameter> list;
    const std::set<std::string> moving = animatedInputs(now.graph, now.timeline);
    for (const NamedParameter& parameter : namedParameters(now.graph)) {
        const Node* node = now.graph.node(parameter.node);
        list.push_back({.name = parameter.name,
                        .value = node ? inputNumbers(*node, parameter.input) : std::vector<double>{},
                        .min = parameter.min,
                        .max = parameter.max,
                        .animated = moving.contains(parameter.node + "." + parameter.input)});
    }
    return list;
}

Done Player::set(std::string_view name, std::span<const double> value) {
    const std::string parameterName(name);
    const std::optional<NamedParameter> parameter = findParameter(now.graph, name);
    if (parameter) {
        const std::string key = parameter->node + "." + parameter->input;
        const std::size_t count = inputNumbers(*now.graph.node(parameter->node), parameter->input).size();
        if (value.size() != count)
            return problem(now.graph, "the parameter '" + parameterName + "' takes " + std::to_string(count) +
                                          (count == 1 ? " number" : " numbers") + ", not " +
                                          std::to_string(value.size()));
        for (const double number : value)
            if (!std::isfinite(number))
                return problem(now.graph,
                               "the parameter '" + parameterName + "' takes numbers, not NaN or infinity");
        if (animatedInputs(now.graph, now.timeline).contains(key))
            return problem(now.graph, "the parameter '" + parameterName + "' is moved by the timeline");
    }
    Graph changed = now.graph;
    if (const Done set = setParameter(changed, parameterName, value); !set) return set.error();
    const auto input = now.inputs.find(parameter->node + "." + parameter->input);
    if (input == now.inputs.end()) {
        if (std::optional<Error> error = firstError(changed, nullptr)) return std::move(*error);
        Result<Prepared> prepared = prepare(std::move(changed), options);
        if (!prepared) return prepared.error();
        adopt(std::move(*prepared));
    } else {
        if (input->second.value == std::vector(value.begin(), value.end())) return done();
        now.graph = std::move(changed);
        input->second.value.assign(value.begin(), value.end());
        if (now.regionFound) now.region.reset();
        points.clear();
        session.valuesChanged();
        seek(seconds);
    }
    chosen[parameterName].assign(value.begin(), value.end());
    return done();
}

void Player::seek(double to) {
    seconds = to;
    const std::vector<double> values = now.valuesAt(seconds);
    const std::vector<LiveParameter>& live = session.program().live;
    for (std::size_t slot = 0; slot < values.size(); ++slot) {
        if (live[slot].value == values[slot]) continue;
        session.setParameter(slot, values[slot]);
        if (now.read[slot]) meshed.reset();
    }
}

void Player::goBack(double to) noexcept {
    try {
        seek(to);
    } catch (const SystemError&) {
        seconds = to;  // whoever goes on with this device hears of it
    }
}

int Player::askedResolution() const {
    return options.resolution > 0 ? options.resolution : now.program.resolution;
}

int Player::resolution() const {
    const int cells = std::max(askedResolution() >> halvings, 1);
    return mostCells > 0 ? std::min(cells, mostCells) : cells;
}

void Player::coarsen(int cells) {
    const int before = resolution();
    mostCells = cells;
    if (resolution() != before) meshed.reset();
}

std::optional<Error> Player::coarser() const {
    if (halvings == 0) return std::nullopt;
    return Error{.message = "a mesh of " + std::to_string(askedResolution()) +
                            " cells along its longest side does not fit into the device: it has " +
                            std::to_string(resolution()) + " (" + full + ")",
                 .file = now.graph.path,
                 .severity = Error::Severity::warning};
}

template <class Work>
auto Player::halvedIfFull(Work work) -> decltype(work()) {
    for (;;) {
        try {
            return work();
        } catch (const DeviceTooSmall& error) {
            if (halvings == kMostHalvings) throw;
            full = error.what();
        }
        ++halvings;
        meshed.reset();
        session.dropMesh();
    }
}

Result<MesherResult> Player::meshOnDevice(uint32_t show) {
    return halvedIfFull([&] { return makeMesh(true, show); });
}

Result<MesherResult> Player::makeMesh(bool stages, uint32_t show) {
    const Result<bool> changed = session.simulate(
        timelineTime(), [&](double at) { return now.valuesAt(at); }, !showsParticles(show),
        options.simulating);
    if (!changed) {
        Error error = changed.error();
        error.file = now.graph.path;
        return error;
    }
    if (*changed) meshed.reset();
    if (meshed) return *meshed;
    if (!now.region)
        if (const Done found = findSharedRegion(now, options); !found) return found.error();
    const double time = timelineTime();
    const bool isOnTimeline = time >= 0.0 && time <= now.timeline.length;
    const bool mayLeave = now.regionFound && now.fieldMoves && !(isOnTimeline && now.regionIsProven);
    Result<MesherResult> result = MesherResult{};
    Box region = *now.region;
    if (!mayLeave) result = session.polygonise({region, resolution(), options.method, stages});
    if (result && (mayLeave || result->capped) && now.regionFound) {
        const Region own = findRegion(session.program(), stopToken(options));
        if (stopToken(options).stop_requested()) return inGraph(now.graph, cancelledError());
        if (own.extent == Extent::bounded)
            region = joined(region, padded(own.box, resolution(), 1.5));
        else if (own.extent != Extent::empty)
            return inGraph(now.graph,
                           regionError(session.program(), own, {&now.graph, time, stopToken(options)}));
        result = session.polygonise({region, resolution(), options.method, stages});
    }
    if (!result) return problem(now.graph, result.error().message);
    meshed = *result;
    lastCapped = result->capped;
    lastRegion = region;
    return result;
}

Result<Mesh> Player::mesh(MaterialParts parts) {
    return halvedIfFull([&]() -> Result<Mesh> {
        const Result<MesherResult> result = makeMesh(true);
        if (!result) return result.error();
        return session.download(*result, parts);
    });
}

Result<std::vector<Mesh>> Player::levels(std::size_t count, MaterialParts parts) {
    return halvedIfFull([&]() -> Result<std::vector<Mesh>> {
        const Result<MesherResult> result = makeMesh(true);
        if (!result) return result.error();
        return session.downloadLevels(*result, count, parts);
    });
}

Result<std::span<const gpu::MeshVertex>> Player::outline() {
    if (!points.empty()) return std::span<const gpu::MeshVertex>(points);
    std::vector<gpu::MeshVertex> found;
    const auto add = [&](bool stages) -> Done {
        const Result<MesherResult> result = makeMesh(stages);
        if (!result) return result.error();
        const auto more =
            download<gpu::MeshVertex>(session.device(), session.meshBuffers().vertices, result->vertices);
        found.insert(found.end(), more.begin(), more.end());
        return done();
    };
    Done added = done();
    if (lacksParticles(now.program)) {
        // Where they will be is not known before they were there: the corners of what they are looked for in.
        if (!now.region) added = findSharedRegion(now, options);
        for (int corner = 0; added && corner < 8; ++corner) {
            gpu::MeshVertex& point = found.emplace_back();
            for (int axis = 0; axis < 3; ++axis)
                point.position[axis] =
                    float((corner >> axis & 1 ? now.region->hi : now.region->lo)[std::size_t(axis)]);
        }
    } else if (now.fieldMoves) {
        const struct Rest {
            Player& player;
            const double seconds = player.seconds;
            const int resolution = std::exchange(player.options.resolution, kOutlineResolution);
            ~Rest() {
                player.options.resolution = resolution;
                player.meshed.reset();
                player.goBack(seconds);
            }
        } rest{*this};
        for (int i = 0; i <= kOutlineSteps && added; ++i) {
            seek(now.timeline.length * i / kOutlineSteps);
            meshed.reset();
            added = add(false);
        }
    } else {
        added = add(true);
    }
    if (!added) return added.error();
    points = std::move(found);
    return std::span<const gpu::MeshVertex>(points);
}

template <class Draw>
auto Player::look(RenderOptions wishes, Draw draw) -> decltype(draw(MesherResult{}, wishes)) {
    const auto framed = outline();  // first: it makes meshes of its own
    if (!framed) return framed.error();
    const Result<MesherResult> result = meshOnDevice(wishes.show);
    if (!result) return result.error();
    if (result->triangles == 0 && framed->empty())
        return problem(now.graph,
                       "the solid is empty or smaller than a cell at " + std::to_string(seconds) + " s");
    const Result<Scene> scene = this->scene();
    if (!scene) return scene.error();
    const std::optional<Camera> camera = wishes.scene.camera;
    wishes.scene = *scene;
    if (camera) wishes.scene.camera = camera;
    wishes.environment = now.environment;
    if (wishes.framed.empty()) wishes.framed = *framed;
    auto drawn = draw(*result, wishes);
    if (!drawn) return problem(now.graph, drawn.error().message);
    return drawn;
}

std::pair<int, double> Player::shutter(const RenderOptions& wishes) const {
    const Result<Scene> scene = this->scene();
    const std::optional<Camera> camera = wishes.scene.camera || !scene ? wishes.scene.camera : scene->camera;
    const double open = camera ? camera->shutter / 360.0 : 0.0;
    if (!moves() || open == 0.0) return {1, 0.0};
    // As many samples each, or nearly.
    const int samples = std::max(wishes.samples, 1), each = (samples + kMostMoments - 1) / kMostMoments;
    const int moments = samples / each;
    const double rate = wishes.framesPerSecond > 0.0 ? wishes.framesPerSecond : now.timeline.framesPerSecond;
    return {moments, open / rate / moments};
}

Result<Picture> Player::frame(const RenderOptions& options_) {
    RenderOptions part = options_;
    const std::pair<int, double> open = shutter(options_);
    const int moments = open.first;
    const double apart = open.second;  // seconds; clang keeps no binding for what is called later
    const struct Rest {
        Player& player;
        const double seconds = player.seconds;
        ~Rest() {
            if (player.seconds != seconds) player.goBack(seconds);
        }
    } rest{*this};
    part.moments = moments;
    return halvedIfFull([&] {
        for (part.moment = 0;; ++part.moment) {
            if (moments > 1) seek(rest.seconds + apart * (part.moment + 0.5));
            Result<Picture> picture = look(part, [&](const MesherResult& mesh, const RenderOptions& wishes) {
                return session.render(mesh, wishes);
            });
            if (!picture || part.moment + 1 == moments) return picture;
        }
    });
}

Result<bool> Player::showTo(const RenderOptions& asked, Picture* onHost) {
    return halvedIfFull([&] {
        return look(asked, [&](const MesherResult& mesh, const RenderOptions& wishes) {
            return session.renderLive(mesh, wishes, onHost);
        });
    });
}

Result<bool> Player::sketch(const RenderOptions& asked, Picture& picture) {
    return halvedIfFull([&] {
        return look(asked, [&](const MesherResult& mesh, const RenderOptions& wishes) {
            return session.sketch(mesh, wishes, picture);
        });
    });
}

Result<Scene> Player::scene() const {
    Result<Scene> scene = readScene(sceneAt(now.graph, now.timeline, timelineTime()));
    if (!scene) return problem(now.graph, scene.error().message + " (at " + std::to_string(seconds) + " s)");
    return scene;
}

Result<std::optional<Camera>> Player::camera(float aspect) {
    const Result<Scene> scene = this->scene();
    if (!scene) return scene.error();
    if (scene->camera) return scene->camera;
    const auto framed = outline();
    if (!framed) return framed.error();
    return framed->empty() ? std::nullopt : std::optional(framingCamera(*framed, aspect));
}

Done Player::reload(Graph graph) { return reload(std::move(graph), options); }

bool Player::compiling() {
    const bool meshing = session.compiling(), drafting = session.drafting();
    return meshing || drafting;
}

Done Player::reload(Graph graph, const PlayerOptions& options_) {
    const PlayerOptions changed = options_;  // it may be our own
    std::vector<std::pair<std::string, std::vector<double>>> kept;
    for (const auto& [name, value] : chosen) {
        const std::optional<NamedParameter> parameter = findParameter(graph, name);
        const Node* node = parameter ? graph.node(parameter->node) : nullptr;
        if (node && inputNumbers(*node, parameter->input).size() == value.size() &&
            setParameter(graph, name, value))
            kept.emplace_back(name, value);
    }
    if (!changed.checked)
        if (std::optional<Error> error = firstError(graph, nullptr)) return std::move(*error);
    Result<Prepared> prepared = prepare(std::move(graph), changed);
    if (!prepared) return prepared.error();
    if (changed.resolution != options.resolution || changed.method != options.method)
        meshed.reset(), halvings = 0;
    options = changed;
    adopt(std::move(*prepared));
    chosen.clear();
    for (auto& [name, value] : kept) chosen.emplace(std::move(name), std::move(value));
    return done();
}

}  // namespace fw
