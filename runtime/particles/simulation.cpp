#include "runtime/particles/simulation.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <utility>

#include "graph/base/words.h"
#include "graph/compile/compile.h"
#include "graph/emit/glsl.h"
#include "graph/evaluate/region.h"
#include "shaders/shared.h"

#include "shaders/particles/motion.h"

namespace fw {

namespace {

constexpr VkDeviceSize kMostCheckpointBytes = 256u << 20;
constexpr VkDeviceSize kCheckpointBufferBytes = 4u << 20;  // that several share: drivers allow few
constexpr double kLeastSpacing = 1e-6;                     // metres
constexpr double kMostSubsteps = 64, kMostTurns = 256;
constexpr int kTurnsToAnError = 32;
/// Spacings that what flows in is off the tank's lattice, so that none of its places comes to lie just on the
/// inflow's side, where rounding would lose it.
constexpr glm::dvec3 kDriftAside(0.62e-3, 0.75e-3, 0.57e-3);

using Kind = ParticleStage::Kind;

Obstacle obstacleOf(const Device& device, std::shared_ptr<const Program> program) {
    Obstacle obstacle{.program = std::move(program)};
    const std::vector<uint32_t> images = imageWords(obstacle.program->ir.images()),
                                volumes = fieldTexels(obstacle.program->ir);
    reserve(device, obstacle.images, 4 * images.size());
    reserve(device, obstacle.volumes, 4 * volumes.size());
    upload(device, obstacle.images, images);
    upload(device, obstacle.volumes, volumes);
    reserve(device, obstacle.parameters, 4 * obstacle.program->numbers().size(), Memory::upload);
    return obstacle;
}

/// Of the live values, those that the obstacle knows of are the first ones: others may have been added since,
/// and taken away those that it does not read.
void setParameters(Commands& commands, const Obstacle& obstacle, const std::vector<double>& values) {
    std::vector<float> numbers = obstacle.program->numbers();
    const std::size_t live = std::min(obstacle.program->live.size(), values.size());
    for (std::size_t slot = 0; slot < live; ++slot) numbers[slot] = float(values[slot]);
    update(commands, obstacle.parameters, numbers.data(), 4 * numbers.size());
}

}  // namespace

Simulation::Simulation(const Device& device_, std::vector<ParticleFieldPtr> recipes)
    : device(&device_), fields(std::move(recipes)) {
    std::vector<std::string> texts;
    texts.reserve(field().particles.stages.size());  // the options below point there
    std::vector<ShaderOptions> shaders{{.name = "particles/emit.comp"}, {.name = "particles/move.comp"}};
    for (const ParticleStage& stage : field().particles.stages) {
        if (stage.kind != Kind::dynamics) continue;
        ShaderOptions& options = shaders.emplace_back(ShaderOptions{.name = "particles/move.comp"});
        Move& move = moves.emplace_back();
        if (const auto found = stage.fields.find("collide"); found != stage.fields.end()) {
            move.obstacle = obstacleOf(*device, found->second);
            options.field = texts.emplace_back(emitField(*found->second));
            options.defines = {"OBSTACLE"};
        }
    }
    std::vector<Pipeline> made = createComputePipelines(*device, shaders);
    births = std::move(made[0]), flight = std::move(made[1]);
    for (std::size_t i = 0; i < moves.size(); ++i) moves[i].kernel = std::move(made[i + 2]);
    takeAgain(fields);
    if (source().kind != Kind::fluid) return;
    Fluid& flowing = fluid.emplace();
    std::string obstacle;
    if (const auto found = source().fields.find("collide"); found != source().fields.end()) {
        flowing.obstacle = obstacleOf(*device, found->second);
        obstacle = emitField(*found->second);
    }
    std::string outflow;
    if (const auto found = source().fields.find("outflow"); found != source().fields.end()) {
        flowing.outflow = obstacleOf(*device, found->second);
        outflow = emitField(*found->second);
    }
    flowing.kernels = createFluidKernels(*device, obstacle, outflow);
    for (const ParticleFieldPtr& each : fields) {
        if (!each->particles.endsInFoam()) continue;
        const auto kind =
            std::ranges::find(kFoamKinds, each->particles.stages.back().words.find("kinds")->second);
        foams.push_back({.field = each, .shown = int(kind - kFoamKinds) - 1, .particles = {}});
    }
    if (!foams.empty()) foamKernels = createFoamKernels(*device, obstacle);
}

void Simulation::takeAgain(const std::vector<ParticleFieldPtr>& recipes) {
    std::vector<CachedStates> found;
    bool all = true;
    const auto add = [&](const ParticleStage& stage) {
        all = all && stage.cached;
        if (all) found.push_back(*stage.cached);
    };
    add(recipes.front()->particles.simulated());
    for (const ParticleFieldPtr& each : recipes)
        if (each->particles.endsInFoam()) add(each->particles.stages.back());
    if (!all) found.clear();
    const bool held = std::exchange(cacheHolds, true);
    if (found == cached && held) return;
    cached = std::move(found);
    if (cached.empty()) return;
    forget();  // what may be of other values than the cache's
    born.clear();
    state.steps = -1;
}

const Simulation::Foam* Simulation::foamOf(std::size_t recipe) const {
    const auto found = std::ranges::find(foams, fields[recipe], &Foam::field);
    return found == foams.end() ? nullptr : &*found;
}

const Buffer& Simulation::places(std::size_t recipe) const {
    const Foam* const foam = foamOf(recipe);
    if (!foam) return sourcePlaces();
    return foam->shown < 0 ? foam->particles.places : foam->particles.shown;
}

const Buffer* Simulation::velocities(std::size_t recipe) const {
    if (const Foam* const foam = foamOf(recipe)) return &foam->particles.velocities;
    return rests() && (!points || points->velocities.empty()) ? nullptr : &motion();
}

uint32_t Simulation::slots(std::size_t recipe) const {
    const Foam* const foam = foamOf(recipe);
    return foam ? foam->particles.slots : state.slots;
}

namespace {

/// The distance to a surface, with the live values of the graph.
Tape distanceTape(const Program& surface, const std::vector<double>& values) {
    const std::span live(values.data(), std::min(surface.live.size(), values.size()));
    return makeTape(surface.ir, surface.distance(), live);
}

/// Places for a fluid: even spacing in the tank, where the source is, and no nearer to the obstacle, if there
/// is one, than each other's half. The lattice begins at the tank's corner, and so far from it.
Result<std::vector<glm::vec3>> placesIn(const Program& source, const Program* obstacle,
                                        const StageNumbers& numbers, const std::vector<double>& values,
                                        const glm::dvec3& drift = glm::dvec3(0.0)) {
    constexpr double kMostPlaces = 64e6;  // that are looked at
    const std::span<const double> live(values.data(), std::min(source.live.size(), values.size()));
    const double spacing = std::max(numbers.scalar("spacing"), kLeastSpacing);
    const glm::dvec3 lo = numbers.vector("tank_min") + drift, hi = numbers.vector("tank_max"),
                     corner = lo - drift;
    const Region region = findRegion(source.ir, source.distance(), live);
    glm::dvec3 first, count;
    for (int axis = 0; axis < 3; ++axis) {
        const bool bounded = region.extent == Extent::bounded;
        const double least =
                         bounded ? std::max(corner[axis], region.box.lo[std::size_t(axis)]) : corner[axis],
                     most = bounded ? std::min(hi[axis], region.box.hi[std::size_t(axis)]) : hi[axis];
        first[axis] = std::floor((least - lo[axis]) / spacing);
        const double last = std::min(std::ceil((most - lo[axis]) / spacing),
                                     std::floor((hi[axis] - lo[axis]) / spacing + 1e-6));
        count[axis] = region.extent == Extent::empty ? 0.0 : std::max(last - first[axis], 0.0);
    }
    if (!(count.x * count.y * count.z > 0.0)) count = glm::dvec3(0.0);
    if (count.x * count.y * count.z > kMostPlaces)
        return Error{.message = "the spacing is too small for the source's size: raise it"};
    std::vector<glm::vec3> places;
    std::vector<Point> row(std::size_t(count.x));
    std::vector<double> distances(row.size()), room(row.size(), spacing);
    TapeMachine<double> machine;
    const Tape inSource = distanceTape(source, values),
               inObstacle = obstacle ? distanceTape(*obstacle, values) : Tape();
    for (double z = 0; z < count.z; ++z)
        for (double y = 0; y < count.y; ++y) {
            for (std::size_t x = 0; x < row.size(); ++x) {
                const glm::dvec3 p = lo + spacing * (first + glm::dvec3(double(x), y, z) + 0.5);
                row[x] = {p.x, p.y, p.z};
            }
            machine.evaluate(inSource, row, distances);
            if (std::ranges::none_of(distances, [](double distance) { return distance < 0.0; })) continue;
            if (obstacle) machine.evaluate(inObstacle, row, room);
            for (std::size_t x = 0; x < row.size(); ++x)
                if (distances[x] < 0.0 && room[x] >= 0.5 * spacing &&
                    glm::all(glm::greaterThanEqual(glm::dvec3(row[x][0], row[x][1], row[x][2]), corner)))
                    places.emplace_back(row[x][0], row[x][1], row[x][2]);
        }
    if (places.size() > kMostParticles)
        return Error{.message = "the source holds " + std::to_string(places.size()) + " particles, and " +
                                std::to_string(kMostParticles) + " is the most: raise the spacing"};
    return places;
}

}  // namespace

namespace {

/// Of an emitter, how many there were at the start, and after one more step.
double bornFirst(const StageNumbers& emitter) { return std::floor(std::max(emitter.scalar("burst"), 0.0)); }
double bornAfter(double before, const StageNumbers& emitter) {
    return before + std::max(emitter.scalar("rate"), 0.0) * kSimulationStep;
}

}  // namespace

bool Simulation::rests() const { return source().kind == Kind::file && moves.empty() && !source().sequence; }

int Simulation::stepAt(double seconds) {
    return int(std::floor(std::max(seconds, 0.0) / kSimulationStep + 1e-6));
}

Result<bool> Simulation::goTo(double seconds, const ValuesAt& values,
                              const std::function<bool(int done, int all)>& progress) {
    if (!rests() && !(seconds <= kMostSimulated))
        return Error{.message = "particles are simulated for " +
                                std::to_string(int(kMostSimulated / 3600.0)) +
                                " hours at most: choose an earlier time"};
    if (source().sequence) return show(seconds, values(seconds));
    const int wanted = rests() ? 0 : stepAt(seconds);
    if (wanted == state.steps) return false;
    const Result<bool> gone = stepTo(wanted, values, progress);
    showFoam();
    return gone;
}

Result<bool> Simulation::stepTo(int wanted, const ValuesAt& values,
                                const std::function<bool(int done, int all)>& progress) {
    const auto after = std::ranges::upper_bound(checkpoints, wanted, {}, &Checkpoint::steps);
    if (after != checkpoints.begin()) {
        const Checkpoint& last = *(after - 1);
        if (wanted < state.steps || last.steps > state.steps) restore(last);
    }
    if (wanted < state.steps) state.steps = -1;
    if (const int step = lastCached(wanted); step > state.steps)
        if (const Done loaded = load(step, values); !loaded) return loaded.error();
    const int first = std::max(state.steps, 0);
    while (state.steps < wanted) {
        const double time = (state.steps + 1) * kSimulationStep;
        const std::vector<double> now = values(time);
        if (const Done stepped = state.steps < 0 ? start(now) : step(now, values); !stepped) {
            Error error = stepped.error();
            if (time > 0.0) error.message += " (at " + shortNumber(time) + " s)";
            return error;
        }
        if (progress && state.steps > first && !progress(state.steps - first, wanted - first))
            return Error{.message = "the simulation was cancelled"};
    }
    return true;
}

void Simulation::valuesChanged() {
    cacheHolds = false;
    forget();
    born.resize(std::min(born.size(), std::size_t(state.steps + 1)));
    if (state.steps == 0) state.steps = -1;
}

Done Simulation::start(const std::vector<double>& values) {
    forget();  // a past with other values
    apart = 1;
    if (source().kind == Kind::fluid) return fill(values);
    const StageNumbers numbers(field().ir, source(), values);
    if (source().kind == Kind::file) {
        takePoints(source().places);
        Commands commands(*device);
        return taken(commands);
    }
    state.slots = 0;
    born = {bornFirst(numbers)};
    if (const Done room = makeRoom(numbers, born[0]); !room) return room.error();
    Commands commands(*device);
    emit(commands, numbers, 0.0, born[0]);
    return taken(commands);
}

void Simulation::takePoints(ParticlePlacesPtr from) {
    points = std::move(from);
    const std::size_t count = points->places.size();
    state.slots = uint32_t(count);
    std::vector<glm::vec4> places, velocities(count, glm::vec4(0.0f));
    for (const glm::vec3& p : points->places) places.emplace_back(p, 0.0f);
    for (std::size_t i = 0; i < points->velocities.size(); ++i)
        velocities[i] = glm::vec4(points->velocities[i], 0.0f);
    reserve(*device, state.places, 16 * count);
    reserve(*device, state.velocities, 16 * count);
    upload(*device, state.places, places);
    upload(*device, state.velocities, velocities);
}

/// The file of a sequence that is shown at the time; its number stands for the step.
Result<bool> Simulation::show(double seconds, const std::vector<double>& values) {
    const ParticleSequence& sequence = *source().sequence;
    const double framesPerSecond = StageNumbers(field().ir, source(), values).scalar("fps");
    const auto number = sequence.numberAt(std::max(seconds, 0.0), framesPerSecond);
    if (points && number == shown) return false;
    Result<ParticlePlacesPtr> read = readParticlePlaces(sequence.graphPath, sequence.path(number));
    if (!read) return Error{.message = read.error().message, .node = source().node, .input = "path"};
    takePoints(std::move(*read));
    state.steps = 0;
    shown = number;
    return true;
}

Done Simulation::step(const std::vector<double>& now, const ValuesAt& values) {
    Commands commands(*device);
    if (fluid) {
        if (const Done flowed = flow(commands, now, values); !flowed) return flowed.error();
        if (source().fields.contains("inflow") || fluid->outflow) {
            submit(commands);
            if (const Done entered = inflow(values(state.steps * kSimulationStep), now); !entered)
                return entered.error();
            outflow(now);
            Commands kept(*device);
            return taken(kept);
        }
        return taken(commands);
    }
    if (source().kind != Kind::emitter) {
        move(commands, now);
        return taken(commands);
    }
    const StageNumbers numbers(field().ir, source(), now);
    const double before = born[std::size_t(state.steps)], after = bornAfter(before, numbers);
    born.resize(std::max(born.size(), std::size_t(state.steps) + 2));
    born[std::size_t(state.steps) + 1] = after;
    if (const Done room = makeRoom(numbers, after); !room) return room.error();
    move(commands, now);
    emit(commands, numbers, before, after);
    return taken(commands);
}

Done Simulation::fill(const std::vector<double>& values) {
    const StageNumbers numbers(field().ir, source(), values);
    const Program* const obstacle = fluid->obstacle ? fluid->obstacle->program.get() : nullptr;
    const auto full = source().fields.find("source");
    Result<std::vector<glm::vec3>> places = std::vector<glm::vec3>();
    if (full != source().fields.end()) places = placesIn(*full->second, obstacle, numbers, values);
    if (!places) return Error{.message = places.error().message, .node = source().node};
    if (places->empty() && !source().fields.contains("inflow"))
        return Error{
            .message =
                "no place of the source is in the tank and free: move or enlarge one of them, or lower the "
                "spacing",
            .node = source().node};
    state.slots = uint32_t(places->size());
    for (Foam& foam : foams) {
        const double most = StageNumbers(foam.field->ir, foam.stage(), values).scalar("most");
        const auto slots = uint32_t(std::clamp(most, 1.0, double(kMostParticles)));
        if (slots > device->limits.texels())
            return Error{.message = "this device can have " + std::to_string(device->limits.texels()) +
                                    " particles of foam at most: lower most",
                         .node = foam.stage().node};
        clearFoam(*device, foam.particles, slots);
    }
    born.assign(1, double(places->size()));
    drifts.assign(1, kDriftAside * std::max(numbers.scalar("spacing"), kLeastSpacing));
    setFluid(*device, fluid->particles, *places, {});
    Commands commands(*device);
    if (const Done settled =
            recordSettling(commands, fluid->kernels, fluid->particles, configOf(commands, values));
        !settled)
        return Error{.message = settled.error().message, .node = source().node};
    submit(commands);
    if (!places->empty())
        upload(*device, fluid->particles.velocities,
               numbered(std::vector(places->size(), glm::vec3(numbers.vector("velocity"))), 0));
    Commands first(*device);
    return taken(first);
}

FluidConfig Simulation::configOf(Commands& commands, const std::vector<double>& values) const {
    const StageNumbers numbers(field().ir, source(), values);
    FluidConfig config{.spacing = float(std::max(numbers.scalar("spacing"), kLeastSpacing)),
                       .lo = numbers.vector("tank_min"),
                       .hi = numbers.vector("tank_max"),
                       .gravity = numbers.vector("gravity"),
                       .viscosity = float(std::max(numbers.scalar("viscosity"), 0.0)),
                       .tension = float(std::max(numbers.scalar("tension"), 0.0)),
                       .vorticity = float(std::max(numbers.scalar("vorticity"), 0.0)),
                       .error = float(std::max(numbers.scalar("error"), 0.0)),
                       .farOnce = source().words.find("neighbours")->second == "fast"};
    const int turns = int(std::clamp(numbers.scalar("turns"), 0.0, kMostTurns));
    config.iterations = turns > 0 ? turns : config.error > 0.0f ? kTurnsToAnError : config.iterations;
    if (fluid->obstacle) {
        setParameters(commands, *fluid->obstacle, values);
        config.field = fluid->obstacle->buffers();
    }
    return config;
}

namespace {

/// How far an obstacle's surface moves at most, within the box, between two moments: of places on a grid,
/// from which no part of the surface is farther than half their distance, those near it are asked.
double wayOf(const Program& obstacle, const glm::dvec3& lo, const glm::dvec3& hi,
             const std::vector<double>& before, const std::vector<double>& now) {
    constexpr int kSide = 9;
    const std::size_t known = obstacle.live.size();
    if (std::ranges::equal(std::span(before).first(std::min(known, before.size())),
                           std::span(now).first(std::min(known, now.size()))))
        return 0.0;
    const glm::dvec3 apart = (hi - lo) / double(kSide - 1);
    std::vector<Point> places;
    for (int z = 0; z < kSide; ++z)
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const glm::dvec3 p = lo + apart * glm::dvec3(x, y, z);
                places.push_back({p.x, p.y, p.z});
            }
    std::vector<double> first(places.size()), last(places.size());
    TapeMachine<double> machine;
    machine.evaluate(distanceTape(obstacle, before), places, first);
    machine.evaluate(distanceTape(obstacle, now), places, last);
    double way = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (first[i] * last[i] < 0.0 ||
            std::min(std::abs(first[i]), std::abs(last[i])) < 0.5 * glm::length(apart))
            way = std::max(way, std::abs(last[i] - first[i]));
    return way;
}

}  // namespace

/// Parts of a step: as many as are asked for, or else so many that neither the end of a fall through the tank
/// nor what the obstacle moves is more than half a spacing in each, and that each can take the tension.
int Simulation::partsOf(const FluidConfig& config, const std::vector<double>& before,
                        const std::vector<double>& now) const {
    constexpr double kMostForFalls = 8.0, kMostForObstacles = 16.0, kMostForTension = 16.0;
    const double asked = StageNumbers(field().ir, source(), now).scalar("substeps"),
                 half = 0.5 * config.spacing;
    if (asked >= 1.0) return int(std::min(asked, kMostSubsteps));
    const double speed = std::sqrt(2.0 * glm::dot(glm::abs(config.gravity), glm::abs(config.hi - config.lo)));
    const double falls = std::min(std::max(1.0, std::ceil(speed * kSimulationStep / half)), kMostForFalls);
    const double way =
        fluid->obstacle ? wayOf(*fluid->obstacle->program, config.lo, config.hi, before, now) : 0.0;
    const double drawn =
        kSimulationStep *
        std::sqrt(config.tension / (kFluidMostTension * std::pow(double(config.spacing), 3)));
    return int(std::max({falls, std::min(std::ceil(way / half), kMostForObstacles),
                         std::min(std::ceil(drawn), kMostForTension)}));
}

FoamConfig Simulation::configOf(const Foam& foam, const std::vector<double>& values) const {
    const StageNumbers numbers(foam.field->ir, foam.stage(), values);
    return {.amount = float(std::max(numbers.scalar("amount"), 0.0)),
            .speed = float(std::max(numbers.scalar("speed"), 1e-6)),
            .lifetime = float(std::max(numbers.scalar("lifetime"), 0.0)),
            .seed = uint32_t(int64_t(std::clamp(numbers.scalar("seed"), -1e9, 1e9))),
            .step = uint32_t(state.steps)};
}

void Simulation::showFoam() {
    if (state.steps < 0 || std::ranges::none_of(foams, [](const Foam& foam) { return foam.shown >= 0; }))
        return;
    Commands commands(*device);
    for (Foam& foam : foams)
        if (foam.shown >= 0) recordFoamShown(commands, *foamKernels, foam.particles, foam.shown);
    send(commands);
}

Done Simulation::flow(Commands& commands, const std::vector<double>& now, const ValuesAt& values) {
    const FluidConfig config = configOf(commands, now);
    const double begin = state.steps * kSimulationStep;
    const int parts = partsOf(config, values(begin), now);
    const auto moveObstacle = [&](int part) {
        if (!fluid->obstacle || fluid->obstacle->program->live.empty()) return;
        const double time = begin + (part + 1) * kSimulationStep / parts;
        setParameters(commands, *fluid->obstacle, part + 1 < parts ? values(time) : now);
    };
    if (const Done recorded = recordFluidSteps(commands, fluid->kernels, fluid->particles, config,
                                               float(kSimulationStep / parts), parts, moveObstacle);
        !recorded)
        return Error{.message = recorded.error().message, .node = source().node};
    for (Foam& foam : foams)
        recordFoamStep(commands, *foamKernels, foam.particles, configOf(foam, now), fluid->particles, config,
                       float(kSimulationStep));
    return done();
}

/// Adds what has flown in at the end of a step.
Done Simulation::inflow(const std::vector<double>& earlier, const std::vector<double>& now) {
    const auto found = source().fields.find("inflow");
    if (found == source().fields.end()) return done();
    const StageNumbers numbers(field().ir, source(), now);
    const double spacing = std::max(numbers.scalar("spacing"), kLeastSpacing);
    const glm::dvec3 velocity = numbers.vector("inflow_velocity"), way = kSimulationStep * velocity,
                     gone = drifts[std::size_t(state.steps)] + way,
                     drift = gone - spacing * glm::floor(gone / spacing);
    drifts.resize(std::max(drifts.size(), std::size_t(state.steps) + 2));
    drifts[std::size_t(state.steps) + 1] = drift;
    Result<std::vector<glm::vec3>> places = placesIn(
        *found->second, fluid->obstacle ? fluid->obstacle->program.get() : nullptr, numbers, now, drift);
    if (!places) return Error{.message = places.error().message, .node = source().node};
    std::vector<Point> origins, ends;
    for (const glm::dvec3 p : *places) {
        origins.push_back({p.x - way.x, p.y - way.y, p.z - way.z});
        ends.push_back({p.x, p.y, p.z});
    }
    std::vector<double> distances(origins.size()), within(origins.size());
    TapeMachine<double> machine;
    machine.evaluate(distanceTape(*found->second, earlier), origins, distances);
    machine.evaluate(distanceTape(*found->second, now), ends, within);
    std::vector<glm::vec3> entered, fast;
    const glm::dvec3 gravity = numbers.vector("gravity");
    const double most = std::clamp(numbers.scalar("most"), 0.0, double(kMostParticles));
    for (std::size_t i = 0; i < places->size() && fluid->particles.count + entered.size() < most; ++i)
        if (distances[i] >= 0.0) {  // and has fallen since
            const double age = kSimulationStep * within[i] / std::min(within[i] - distances[i], -1e-30);
            entered.emplace_back(glm::dvec3((*places)[i]) + 0.5 * age * age * gravity);
            fast.emplace_back(velocity + age * gravity);
        }
    const double before = born[std::size_t(state.steps)];
    born.resize(std::max(born.size(), std::size_t(state.steps) + 2));
    born[std::size_t(state.steps) + 1] = before + double(entered.size());
    if (!entered.empty()) addToFluid(*device, fluid->particles, entered, fast, uint32_t(uint64_t(before)));
    state.slots = fluid->particles.count;
    return done();
}

/// Takes away what is in the outflow at the end of a step.
void Simulation::outflow(const std::vector<double>& now) {
    if (!fluid->outflow) return;
    Commands commands(*device);
    setParameters(commands, *fluid->outflow, now);
    drainFluid(commands, fluid->kernels, fluid->particles, fluid->outflow->buffers());
    state.slots = fluid->particles.count;
}

Done Simulation::makeRoom(const StageNumbers& emitter, double all) {
    const double life = std::max(emitter.scalar("lifetime"), 0.0);
    const double lived = std::ceil(life / kSimulationStep) + 1.0;
    const bool anyDied = lived <= double(state.steps);
    const double oldest = anyDied ? born[std::size_t(state.steps - int(lived))] : 0.0;
    const double needed = all - std::floor(oldest) + 1.0;
    if (needed > double(kMostParticles))
        return Error{.message = "there would be more than " + std::to_string(kMostParticles) +
                                " particles at a time: lower the rate, the burst or the lifetime",
                     .node = source().node};
    if (needed <= double(state.slots)) return done();
    // What it will come to, if nothing changes; and no step by step.
    const double settled = (state.steps < 0 ? all : 0.0) +
                           std::max(emitter.scalar("rate"), 0.0) * (life + 2.0 * kSimulationStep) + 2.0;
    setSlots(uint32_t(std::min(std::max(1.25 * needed, settled), double(kMostParticles))));
    return done();
}

void Simulation::setSlots(uint32_t slots) {
    const uint32_t old = std::exchange(state.slots, slots);
    std::vector<glm::vec4> places(slots, glm::vec4(std::numeric_limits<float>::quiet_NaN())),
        velocities(slots, glm::vec4(0.0f));
    if (old > 0) {
        const auto oldPlaces = download<glm::vec4>(*device, state.places, old),
                   oldVelocities = download<glm::vec4>(*device, state.velocities, old);
        const auto all = uint64_t(born[std::size_t(state.steps)]);
        for (uint64_t n = all > old ? all - old : 0; n < all; ++n)
            places[n % slots] = oldPlaces[n % old], velocities[n % slots] = oldVelocities[n % old];
    }
    reserve(*device, state.places, 16ull * slots);
    reserve(*device, state.velocities, 16ull * slots);
    upload(*device, state.places, places);
    upload(*device, state.velocities, velocities);
}

void Simulation::emit(Commands& commands, const StageNumbers& emitter, double before, double after) {
    const auto first = uint64_t(before), count = uint64_t(after) - first;
    if (count == 0) return;
    static constexpr std::string_view kShapes[] = {"ball", "box", "disc", "point"};
    gpu::EmitPush push{};
    push.first = uint32_t(first % state.slots);
    push.count = uint32_t(count);
    push.slots = state.slots;
    push.number = uint32_t(first);
    push.seed = uint32_t(int64_t(std::clamp(emitter.scalar("seed"), -1e9, 1e9)));
    push.position = emitter.vector("position");
    push.shape = int(std::ranges::find(kShapes, source().words.find("shape")->second) - kShapes);
    push.size = glm::max(emitter.vector("size"), 0.0);
    push.velocity = emitter.vector("velocity");
    push.spread = float(std::max(emitter.scalar("spread"), 0.0));
    if (state.steps >= 0) {
        push.sooner = float(kSimulationStep / (after - before));
        push.age = float(kSimulationStep * (1.0 - (double(first) + 1.0 - before) / (after - before)));
    }
    const Descriptor bound[] = {{0, state.places}, {1, state.velocities}};
    dispatch(commands, births, spread(commands.device, groupsFor(push.count, MOTION_GROUP)), push, bound);
    barrier(commands);
}

void Simulation::move(Commands& commands, const std::vector<double>& values) {
    const bool mortal = source().kind == Kind::emitter;
    gpu::MotionPush push{};
    push.slots = state.slots;
    push.step = float(kSimulationStep);
    push.time = float((state.steps + 1) * kSimulationStep);
    push.lifetime = mortal ? float(StageNumbers(field().ir, source(), values).scalar("lifetime"))
                           : std::numeric_limits<float>::max();
    push.swirls = 1.0f;
    push.moves = 1;
    const auto run = [&](const Pipeline& kernel, const Obstacle* obstacle) {
        std::vector<Descriptor> bound{
            {0, state.places}, {1, state.velocities}, {2, state.places}, {3, state.velocities}};
        if (obstacle) addField(bound, obstacle->buffers());
        dispatch(commands, kernel, spread(commands.device, groupsFor(state.slots, MOTION_GROUP)), push,
                 bound);
        barrier(commands);
        push.moves = 0;
    };
    if (moves.empty()) run(flight, nullptr);
    std::size_t next = 0;
    for (const ParticleStage& stage : field().particles.stages) {
        if (stage.kind != Kind::dynamics) continue;
        const StageNumbers numbers(field().ir, stage, values);
        push.gravity = numbers.vector("gravity");
        push.drag = float(std::max(numbers.scalar("drag"), 0.0));
        push.attractor = numbers.vector("attractor");
        push.attraction = float(numbers.scalar("attraction"));
        push.turbulence = float(std::max(numbers.scalar("turbulence"), 0.0));
        push.swirls = float(std::max(numbers.scalar("turbulence_size"), 1e-3));
        push.radius = float(std::max(numbers.scalar("radius"), 0.0));
        push.bounce = float(numbers.scalar("bounce"));
        push.friction = float(numbers.scalar("friction"));
        const Move& how = moves[next++];
        if (how.obstacle) setParameters(commands, *how.obstacle, values);
        run(how.kernel, how.obstacle ? &*how.obstacle : nullptr);
    }
}

Done Simulation::taken(Commands& commands) {
    ++state.steps;
    if (!rests() && state.steps % apart == 0) keep(commands);
    send(commands);
    return done();
}

std::vector<uint32_t> Simulation::allSlots() const {
    std::vector<uint32_t> all{state.slots};
    for (const Foam& foam : foams) all.push_back(foam.particles.slots);
    return all;
}

Simulation::Checkpoint Simulation::roomFor(std::vector<uint32_t> slots) {
    if (const auto same = std::ranges::find(dropped, slots, &Checkpoint::slots); same != dropped.end()) {
        Checkpoint room = std::move(*same);
        dropped.erase(same);
        return room;
    }
    dropped.clear();
    const VkDeviceSize bytes = bytesOf(slots);
    Checkpoint room{.steps = 0, .slots = std::move(slots), .kept = open, .at = openFrom};
    if (!open || openFrom + bytes > open->size) {
        open = std::make_shared<const Buffer>(createBuffer(*device, std::max(bytes, kCheckpointBufferBytes)));
        room.kept = open, room.at = 0;
    }
    openFrom = room.at + bytes;
    return room;
}

std::vector<Simulation::StatePart> Simulation::stateParts(std::size_t i, uint32_t slots) const {
    if (i == 0) return {{&sourcePlaces(), 16ull * slots}, {&motion(), 16ull * slots}};
    const FoamParticles& foam = foams[i - 1].particles;
    return {
        {&foam.places, 16ull * slots}, {&foam.velocities, 16ull * slots}, {&foam.ids, foamIdBytes(slots)}};
}

VkDeviceSize Simulation::bytesOf(const std::vector<uint32_t>& slots) const {
    VkDeviceSize sum = 0;
    for (std::size_t i = 0; i < slots.size(); ++i)
        for (const StatePart& each : stateParts(i, slots[i])) sum += each.bytes;
    return sum;
}

template <class Call>
void Simulation::forParts(const Checkpoint& of, Call call) const {
    VkDeviceSize at = of.at;
    for (std::size_t i = 0; i < of.slots.size(); ++i)
        for (const StatePart& each : stateParts(i, of.slots[i])) {
            if (each.bytes > 0) call(*each.buffer, at, each.bytes);
            at += each.bytes;
        }
}

void Simulation::keep(Commands& commands) {
    const auto place = std::ranges::lower_bound(checkpoints, state.steps, {}, &Checkpoint::steps);
    if (place != checkpoints.end() && place->steps == state.steps) return;
    Checkpoint made = roomFor(allSlots());
    made.steps = state.steps;
    forParts(made, [&](const Buffer& buffer, VkDeviceSize at, VkDeviceSize size) {
        copy(commands, buffer, 0, *made.kept, at, size);
    });
    checkpoints.insert(place, std::move(made));
    VkDeviceSize bytes = 0;
    for (const Checkpoint& each : checkpoints) bytes += bytesOf(each.slots);
    if (bytes <= kMostCheckpointBytes || checkpoints.size() < 3) return;
    apart *= 2;
    const auto away = std::stable_partition(checkpoints.begin(), checkpoints.end(),
                                            [&](const Checkpoint& each) { return each.steps % apart == 0; });
    dropped.insert(dropped.end(), away, checkpoints.end());
    checkpoints.erase(away, checkpoints.end());
}

void Simulation::forget() {
    dropped.insert(dropped.end(), checkpoints.begin(), checkpoints.end());
    checkpoints.clear();
}

void Simulation::reserveState(const std::vector<uint32_t>& slots) {
    state.slots = slots.front();
    if (fluid) {
        reserveFluid(*device, fluid->particles, state.slots);
    } else {
        reserve(*device, state.places, 16ull * state.slots);
        reserve(*device, state.velocities, 16ull * state.slots);
    }
    for (std::size_t i = 0; i < foams.size(); ++i) reserveFoam(*device, foams[i].particles, slots[i + 1]);
}

void Simulation::restore(const Checkpoint& from) {
    state.steps = from.steps;
    reserveState(from.slots);
    Commands commands(*device);
    forParts(from, [&](const Buffer& buffer, VkDeviceSize at, VkDeviceSize size) {
        copy(commands, *from.kept, at, buffer, 0, size);
    });
    send(commands);
}

int Simulation::lastCached(int step) const {
    if (cached.empty() || !cacheHolds || rests()) return -1;
    const auto has = [&](int at) {
        return std::ranges::all_of(cached, [&](const CachedStates& each) { return stateIsThere(each, at); });
    };
    if (has(step)) return step;
    for (const int each : statesUpTo(cached.front(), step))
        if (each <= state.steps || has(each)) return each;
    return -1;
}

std::vector<ParticleState> Simulation::states() const {
    std::vector<ParticleState> made;
    const std::vector<uint32_t> slots = allSlots();
    const auto at = std::size_t(std::max(state.steps, 0));
    for (std::size_t i = 0; i < slots.size(); ++i) {
        ParticleState& each = made.emplace_back(ParticleState{.step = uint32_t(at), .slots = slots[i]});
        if (i == 0 && at < born.size()) each.born = born[at];
        if (i == 0 && at < drifts.size())
            for (int axis = 0; axis < 3; ++axis) each.drift[axis] = drifts[at][axis];
        for (const StatePart& part : stateParts(i, slots[i])) {
            const std::size_t from = each.bytes.size();
            each.bytes.resize(from + part.bytes);
            if (part.bytes > 0) downloadBytes(*device, *part.buffer, &each.bytes[from], part.bytes);
        }
    }
    return made;
}

void Simulation::countBirths(const ValuesAt& values) {
    while (born.size() <= std::size_t(state.steps)) {
        const StageNumbers numbers(field().ir, source(), values(double(born.size()) * kSimulationStep));
        born.push_back(born.empty() ? bornFirst(numbers) : bornAfter(born.back(), numbers));
    }
}

Done Simulation::load(int step, const ValuesAt& values) {
    std::vector<ParticleState> loaded;
    std::vector<uint32_t> slots;
    for (std::size_t i = 0; i < cached.size(); ++i) {
        Result<ParticleState> each = readState(cached[i], step);
        if (!each) return each.error();
        slots.push_back(each->slots);
        VkDeviceSize bytes = 0;
        for (const StatePart& part : stateParts(i, each->slots)) bytes += part.bytes;
        if (bytes != each->bytes.size() || each->slots > kMostParticles)
            return Error{.message = "the state of particles " + inQuotes(statePath(cached[i], step)) +
                                    " was damaged: remove it, and simulate again"};
        loaded.push_back(std::move(*each));
    }
    reserveState(slots);
    for (std::size_t i = 0; i < loaded.size(); ++i) {
        std::size_t from = 0;
        for (const StatePart& part : stateParts(i, slots[i])) {
            if (part.bytes > 0) uploadBytes(*device, *part.buffer, &loaded[i].bytes[from], part.bytes);
            from += part.bytes;
        }
    }
    state.steps = step;
    const auto at = std::size_t(step);
    if (source().kind == Kind::emitter) {
        countBirths(values);
    } else if (fluid) {
        born.resize(std::max(born.size(), at + 1));
        born[at] = loaded.front().born;
        drifts.resize(std::max(drifts.size(), at + 1));
        drifts[at] = {loaded.front().drift[0], loaded.front().drift[1], loaded.front().drift[2]};
    }
    return done();
}

std::vector<uint32_t> Simulation::ids(std::size_t recipe) const {
    std::vector<uint32_t> list(slots(recipe));
    if (list.empty()) return list;
    if (const Foam* const foam = foamOf(recipe))
        return download<uint32_t>(*device, foam->particles.ids, list.size());
    if (fluid) {
        const auto velocities = download<glm::vec4>(*device, motion(), list.size());
        for (std::size_t i = 0; i < list.size(); ++i) list[i] = std::bit_cast<uint32_t>(velocities[i].w);
        return list;
    }
    if (points && points->ids.size() == list.size()) return points->ids;
    for (std::size_t i = 0; i < list.size(); ++i) list[i] = uint32_t(i);
    if (source().kind == Kind::emitter) {  // the last with this slot
        const auto all = uint64_t(born[std::size_t(state.steps)]);
        for (uint64_t n = all > list.size() ? all - list.size() : 0; n < all; ++n)
            list[n % list.size()] = uint32_t(n);
    }
    return list;
}

}  // namespace fw
