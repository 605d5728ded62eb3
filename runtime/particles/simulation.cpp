#include "runtime/particles/simulation.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <utility>

#include "graph/base/words.h"
#include "graph/compile/compile.h"
#include "graph/emit/glsl.h"
#include "shaders/shared.h"

#include "shaders/particles/motion.h"

namespace fw {

namespace {

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

}  // namespace

void setParameters(Commands& commands, const Obstacle& obstacle, const std::vector<double>& values) {
    std::vector<float> numbers = obstacle.program->numbers();
    const std::size_t live = std::min(obstacle.program->live.size(), values.size());
    for (std::size_t slot = 0; slot < live; ++slot) numbers[slot] = float(values[slot]);
    update(commands, obstacle.parameters, numbers.data(), 4 * numbers.size());
}

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

void Simulation::countBirths(const ValuesAt& values) {
    while (born.size() <= std::size_t(state.steps)) {
        const StageNumbers numbers(field().ir, source(), values(double(born.size()) * kSimulationStep));
        born.push_back(born.empty() ? bornFirst(numbers) : bornAfter(born.back(), numbers));
    }
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
