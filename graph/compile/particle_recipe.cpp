#include "graph/compile/particle_recipe.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/gtx/component_wise.hpp>

#include "graph/assets/volume.h"
#include "graph/base/hash.h"
#include "graph/bounds/region.h"
#include "graph/compile/compile.h"

namespace fw {

namespace {

constexpr double kMostSwirl = 1.75;  // of shaders/particles/move.comp, along an axis

struct Bounds {
    glm::dvec3 lo, hi;
};

/// The farthest along one axis that a body gets in `life` seconds, from 0 at the speed v under the
/// acceleration a: least and most.
std::pair<double, double> flight(double v, double a, double life) {
    double least = 0.0, most = 0.0;
    const auto add = [&](double t) {
        const double at = v * t + 0.5 * a * t * t;
        least = std::min(least, at), most = std::max(most, at);
    };
    add(life);
    if (a != 0.0) add(std::clamp(-v / a, 0.0, life));
    return {least, most};
}

Bounds emitted(const StageNumbers& emitter, const glm::dvec3& least, const glm::dvec3& most) {
    const glm::dvec3 place = emitter.vector("position"), size = glm::max(emitter.vector("size"), 0.0),
                     velocity = emitter.vector("velocity");
    const double life = std::max(emitter.scalar("lifetime"), 0.0),
                 spread = std::max(emitter.scalar("spread"), 0.0);
    Bounds bounds{place - size, place + size};
    for (int axis = 0; axis < 3; ++axis) {
        bounds.lo[axis] += flight(velocity[axis] - spread, least[axis], life).first;
        bounds.hi[axis] += flight(velocity[axis] + spread, most[axis], life).second;
    }
    return bounds;
}

}  // namespace

Box particleBounds(const Ir& ir, const ParticleRecipe& recipe, std::span<const double> parameters,
                   double radius) {
    Bounds bounds{glm::dvec3(0.0), glm::dvec3(0.0)};
    if (recipe.stages.empty()) return {};
    const ParticleStage& source = recipe.stages.front();
    const StageNumbers numbers(ir, source, parameters);
    glm::dvec3 least(0.0), most(0.0);  // accelerations
    for (const ParticleStage& stage : recipe.stages)
        if (stage.kind == ParticleStage::Kind::dynamics) {
            const StageNumbers forces(ir, stage, parameters);
            const glm::dvec3 gravity = forces.vector("gravity");
            const double any = kMostSwirl * std::max(forces.scalar("turbulence"), 0.0) +
                               std::abs(forces.scalar("attraction"));
            least += gravity - any, most += gravity + any;
        }
    switch (source.kind) {
        case ParticleStage::Kind::emitter: bounds = emitted(numbers, least, most); break;
        case ParticleStage::Kind::file: {
            if (source.sequence) {
                const Box& box = source.sequence->bounds;
                bounds = {{box.lo[0], box.lo[1], box.lo[2]}, {box.hi[0], box.hi[1], box.hi[2]}};
                // Between the files that were looked into they may be farther out.
                const double some = 0.05 * glm::compMax(bounds.hi - bounds.lo);
                bounds.lo -= some, bounds.hi += some;
                break;
            }
            glm::vec3 lo = source.places->places.front(), hi = lo;
            for (const glm::vec3& p : source.places->places) lo = glm::min(lo, p), hi = glm::max(hi, p);
            bounds = {lo, hi};
            // Where they move, nobody knows for how long: room for their own size about them.
            if (recipe.stages.size() > 1) {
                const double room = glm::compMax(glm::dvec3(hi) - glm::dvec3(lo));
                bounds.lo -= room, bounds.hi += room;
            }
            break;
        }
        case ParticleStage::Kind::fluid:
            bounds = {numbers.vector("tank_min"), numbers.vector("tank_max")};
            break;
        case ParticleStage::Kind::dynamics:
        case ParticleStage::Kind::foam: break;
    }
    const double margin = std::max(radius, 1e-3);
    Box box;
    for (int axis = 0; axis < 3; ++axis)
        box.lo[axis] = bounds.lo[axis] - margin, box.hi[axis] = bounds.hi[axis] + margin;
    return box;
}

SurfaceNumbers surfaceNumbers(const Ir& ir, const ParticleRecipe& recipe, const ParticleStage& toField,
                              std::span<const double> parameters) {
    constexpr double kDropOfCube = 0.6203504908994;  // radius of the ball as large as a cube of side 1
    constexpr double kLeastShare = 0.04;             // of the radius, squared
    constexpr double kFoamShare = 0.5;               // of the fluid's drop, foam's
    const StageNumbers own(ir, toField, parameters);
    SurfaceNumbers numbers{own.scalar("radius"), own.scalar("threshold"), own.scalar("drop")};
    const double blob = numbers.radius * std::sqrt(std::max(1.0 - std::cbrt(numbers.threshold), kLeastShare));
    const ParticleStage& source = recipe.stages.front();
    if (toField.words.find("surface")->second == kParticleSurfaceNames[0])
        numbers.drop = blob;
    else if (numbers.drop == 0.0)
        numbers.drop = source.kind == ParticleStage::Kind::fluid
                           ? kDropOfCube * StageNumbers(ir, source, parameters).scalar("spacing") *
                                 (recipe.endsInFoam() ? kFoamShare : 1.0)
                           : blob;
    return numbers;
}

namespace {

/// Of what they are, whatever else `ir` holds.
uint64_t hashOfStages(const Ir& ir, std::span<const ParticleStage> stages) {
    std::vector<IrId> roots;
    for (const ParticleStage& stage : stages)
        for (const auto& [name, ids] : stage.numbers) roots.insert(roots.end(), ids.begin(), ids.end());
    const Ir own = ir.compact(roots);
    uint64_t hash = own.hash(roots);
    const auto mix = [&](uint64_t word) { hash = mixed(hash, word); };
    for (const ParticleStage& stage : stages) {
        mix(uint64_t(stage.kind));
        for (const auto& [name, word] : stage.words) mix(std::hash<std::string>()(word));
        for (const auto& [name, program] : stage.fields)
            mix(mixed(std::hash<std::string>()(name), program->structureHash));
        if (stage.places) mix(stage.places->hash);
        if (stage.sequence) mix(stage.sequence->hash);
    }
    return hash;
}

}  // namespace

Result<FieldVolumePtr> particleVolume(const Ir& ir, const ParticleRecipe& recipe,
                                      const ParticleStage& toField, const Box& region, int resolution) {
    constexpr double kMostSide = 1e32;  // metres: it is a float on the device
    VolumeGrid grid;
    if (longestSide(region) > kMostSide)
        return Error{.message =
                         "the grid is more than 1e32 m wide: give region_min and region_max nearer "
                         "corners"};
    for (int axis = 0; axis < 3; ++axis)
        if (!(region.lo[axis] < region.hi[axis]))
            return Error{.message = "the grid has no extent along " + std::string(1, "xyz"[axis]) +
                                    ": give region_min its least corner and region_max its greatest"};
    grid.cell = longestSide(region) / resolution;
    for (int axis = 0; axis < 3; ++axis) {
        const double side = region.hi[axis] - region.lo[axis];
        const int cells = std::max(int(std::ceil(side / grid.cell - 1e-6)), 1);
        grid.size[axis] = cells + 1;
        grid.origin[axis] = region.lo[axis] - 0.5 * (cells * grid.cell - side);
    }
    auto field = std::make_shared<ParticleField>();
    field->particles = recipe;
    const auto method = std::ranges::find(kDensityMethodNames, toField.words.find("method")->second);
    field->method = DensityMethod(method - kDensityMethodNames);
    const auto surface = std::ranges::find(kParticleSurfaceNames, toField.words.find("surface")->second);
    field->surface = ParticleSurface(surface - kParticleSurfaceNames);
    field->trueDistance = toField.words.find("distance")->second == "true";
    field->node = toField.node;
    field->toField = toField;
    std::vector<ParticleStage*> stages{&field->toField};
    for (ParticleStage& stage : field->particles.stages) stages.push_back(&stage);
    std::vector<IrId> roots;
    for (const ParticleStage* stage : stages)
        for (const auto& [name, ids] : stage->numbers) roots.insert(roots.end(), ids.begin(), ids.end());
    field->ir = ir.compact(roots);
    std::size_t next = 0;
    for (ParticleStage* stage : stages)
        for (auto& [name, ids] : stage->numbers)
            for (IrId& id : ids) id = roots[next++];

    const std::vector<ParticleStage>& all = field->particles.stages;
    field->stagesHash = hashOfStages(field->ir, all);
    field->sourceHash =
        hashOfStages(field->ir, std::span(all).first(all.size() - (recipe.endsInFoam() ? 1 : 0)));
    uint64_t hash = mixed(field->ir.hash(roots), field->stagesHash);
    const auto mix = [&](uint64_t word) { hash = mixed(hash, word); };
    mix((uint64_t(field->surface) * 4 + uint64_t(field->method)) * 2 + uint64_t(field->trueDistance));
    for (int axis = 0; axis < 3; ++axis) {
        mix(std::bit_cast<uint64_t>(grid.origin[axis]));
        mix(uint64_t(grid.size[axis]));
    }
    mix(std::bit_cast<uint64_t>(grid.cell));
    hash ^= hash >> 32;
    field->hash = hash;
    return FieldVolumePtr(std::make_shared<const FieldVolume>(grid, std::move(field), hash));
}

}  // namespace fw
