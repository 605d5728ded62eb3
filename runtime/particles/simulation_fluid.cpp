// What fluids do of a simulation: how a tank is filled, parts of a step, what flows in and out, foam.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "graph/bounds/region.h"
#include "graph/compile/compile.h"
#include "runtime/particles/simulation.h"

namespace fw {

namespace {

constexpr double kLeastSpacing = 1e-6;  // metres
constexpr double kMostSubsteps = 64, kMostTurns = 256;
constexpr int kTurnsToAnError = 32;
/// Spacings that what flows in is off the tank's lattice, so that none of its places comes to lie just on the
/// inflow's side, where rounding would lose it.
constexpr glm::dvec3 kDriftAside(0.62e-3, 0.75e-3, 0.57e-3);

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

}  // namespace fw
