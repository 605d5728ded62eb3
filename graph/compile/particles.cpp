// Particles: each node a stage of a recipe, and the field that is made of all of them.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "graph/base/words.h"
#include "graph/bounds/region.h"
#include "graph/compile/cached_particles.h"
#include "graph/compile/graph_lowering.h"
#include "graph/compile/particle_recipe.h"

namespace fw {

using language::Value;

namespace {

/// How many cells a blob should reach at least, and reaches at most where the grid is found.
constexpr double kFewRadiusCells = 1.7, kManyRadiusCells = 8.0;
/// Cells along a drop's radius for what they show of it to be round, and cells along a grid, of blobs.
constexpr double kDropCells = 2.0, kBlobResolution = 96;

std::vector<double> valuesOf(const std::vector<LiveParameter>& live) {
    std::vector<double> values;
    for (const LiveParameter& parameter : live) values.push_back(parameter.value);
    return values;
}

/// A field of its own, of the distance of a surface.
std::shared_ptr<const Program> fieldOf(GraphLowering& lowering, const Value& surface) {
    auto field = std::make_shared<Program>();
    field->surface = language::emptySurface(lowering.state).ids;
    field->surface[distanceComponent] = surface.ids[distanceComponent];
    field->ir = lowering.state.ir.compact(field->surface);
    field->opaque = field->surface;
    field->live = lowering.live;
    field->families = findFamilies(field->ir, field->distance());
    field->structureHash = field->ir.hash(field->surface);
    return field;
}

/// The inputs of a particle node as a stage of a recipe; none, reported, where a number depends on the place.
std::optional<ParticleStage> particleStage(GraphLowering& lowering, const NodeAt& at,
                                           const std::vector<NodeInput>& inputs) {
    const Ir& ir = lowering.state.ir;
    ParticleStage stage{.node = at.path()};
    bool fine = true;
    for (const NodeInput& input : inputs) {
        const InputSpec& spec = *input.spec;
        if (spec.value.kind == InputDefault::Kind::position) continue;
        if (spec.type == Type::surface) {
            if (ir.isConstant(input.value.id(), language::kEmptyDistance)) continue;
            const std::shared_ptr<const Program> field = fieldOf(lowering, input.value);
            if (std::ranges::any_of(field->ir.volumes(),
                                    [](const FieldVolumePtr& volume) { return bool(volume->particles); })) {
                lowering.report(
                    at, spec.name,
                    {.message = "cannot be a surface that particles make, for those are not known "
                                "before: take what the particles collide with themselves"});
                fine = false;
            }
            stage.fields[spec.name] = field;
        } else if (spec.value.kind == InputDefault::Kind::numbers) {
            std::array<IrId, 3>& ids = stage.numbers[spec.name];
            for (std::size_t k = 0; k < std::size_t(componentCount(spec.type)); ++k) {
                ids[k] = input.value.ids[k];
                if (ir[ids[k]].positions == 0) continue;
                lowering.report(
                    at, spec.name,
                    {.message = "takes one number for all of space: it cannot depend on the place"});
                fine = false;
                break;
            }
        } else if (spec.value.kind == InputDefault::Kind::text) {
            stage.words[spec.name] = input.value.text;
        }
    }
    return fine ? std::optional(std::move(stage)) : std::nullopt;
}

/// The node's inputs as a stage of this kind.
std::optional<ParticleStage> stageOf(GraphLowering& lowering, const NodeAt& at, ParticleStage::Kind kind) {
    const auto inputs = lowering.inputs(at);
    auto stage = inputs ? particleStage(lowering, at, *inputs) : std::nullopt;
    if (stage) stage->kind = kind;
    return stage;
}

/// The recipe with one more stage.
ParticleRecipe goingOn(ParticleRecipe recipe, ParticleStage stage) {
    if (auto cache = stage.words.extract("cache"); !cache.empty() && !cache.mapped().empty())
        recipe.cache = cache.mapped();
    recipe.stages.push_back(std::move(stage));
    return recipe;
}

Lowered particlesOf(const NodeAt& at, ParticleRecipe recipe) {
    Value value{Type::particles};
    value.particles = std::make_shared<const ParticleRecipe>(std::move(recipe));
    Lowered result;
    result.outputs.push_back({at.type.outputs[0].name, Type::particles, std::move(value)});
    return result;
}

bool makesBlobs(const ParticleStage& toField) {
    return toField.words.find("surface")->second == kParticleSurfaceNames[0];
}

/// The grid about particles, at all moments that are asked for.
struct Reach {
    Box region;
    double least = std::numeric_limits<double>::infinity(), most = 0.0;  ///< of the radius
    double leastDrop = std::numeric_limits<double>::infinity();
};
Reach reachOf(const GraphLowering& lowering, const ParticleStage& own, const ParticleRecipe& particles) {
    const std::vector<LiveParameter>& live = lowering.live;
    const auto& moments = lowering.options.moments;
    std::vector<double> values = valuesOf(live);
    const bool blobs = makesBlobs(own);
    Reach reach;
    const auto lookAt = [&](bool first) {
        const auto [radius, threshold, drop] = surfaceNumbers(lowering.state.ir, particles, own, values);
        const Box then = particleBounds(lowering.state.ir, particles, values, blobs ? radius : 2.0 * drop);
        reach.region = first ? then : joined(reach.region, then);
        reach.least = std::min(reach.least, radius), reach.most = std::max(reach.most, radius);
        reach.leastDrop = std::min(reach.leastDrop, drop);
    };
    if (moments.empty()) lookAt(true);
    for (std::size_t i = 0; i < moments.size(); ++i) {
        for (std::size_t slot = 0; slot < live.size(); ++slot) {
            const auto moving = moments[i].find(live[slot].name);
            if (moving != moments[i].end())
                values[slot] = moving->second.at(std::size_t(live[slot].component));
        }
        lookAt(i == 0);
    }
    return reach;
}

/// Warns of numbers that a sequence of files lacks.
void warnOfGaps(GraphLowering& lowering, const NodeAt& at, const ParticleSequence& sequence) {
    for (std::size_t i = 1; i < sequence.numbers.size(); ++i) {
        const long last = sequence.numbers[i - 1], next = sequence.numbers[i];
        if (next == last + 1) continue;
        const long first = sequence.numbers.front(),
                   lacks = sequence.numbers.back() - first + 1 - long(sequence.numbers.size());
        return lowering.warn(at, "path",
                             "the sequence lacks " + std::to_string(lacks) + " of its files, the first " +
                                 inQuotes(sequence.path(last + 1)) + ": the nearest before is shown");
    }
}

/// Warns of an inflow from which nothing can come: of numbers that never change.
void warnOfDryInflow(GraphLowering& lowering, const NodeAt& at, const ParticleStage& fluid) {
    const auto inflow = fluid.fields.find("inflow");
    if (inflow == fluid.fields.end()) return;
    const Ir& ir = lowering.state.ir;
    for (const char* input : {"inflow_velocity", "tank_min", "tank_max"})
        for (const IrId id : fluid.numbers.find(input)->second)
            if (!ir.isConstant(id)) return;
    const std::vector<double> values = valuesOf(lowering.live);
    const StageNumbers numbers(ir, fluid, values);
    const glm::dvec3 way = kSimulationStep * numbers.vector("inflow_velocity"),
                     lo = numbers.vector("tank_min"), hi = numbers.vector("tank_max");
    if (glm::length(way) == 0.0)
        return lowering.warn(at, "inflow_velocity", "nothing flows in that has no speed");
    const Program& field = *inflow->second;
    for (IrId id = 0; id < field.ir.size(); ++id)
        if (field.ir[id].op == Op::parameter) return;
    const Region region = findRegion(field.ir, field.distance(), {});
    if (region.extent == Extent::unbounded || region.extent == Extent::unproven) return;
    bool outside = region.extent == Extent::empty, thin = false;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = region.box.lo[std::size_t(axis)], high = region.box.hi[std::size_t(axis)];
        outside |= high <= lo[axis] || low >= hi[axis];
        thin |= high - low < std::abs(way[axis]);
    }
    if (outside)
        lowering.warn(at, "inflow",
                      "is outside of the tank, so that nothing flows in: move it, or enlarge the tank");
    else if (thin)
        lowering.warn(at, "inflow",
                      "is thinner than what flows in moves in a sixtieth of a second (" +
                          shortNumber(glm::length(way)) +
                          " m), so that less comes than should: make it thicker");
}

}  // namespace

Lowered lowerEmitter(GraphLowering& lowering, const NodeAt& at) {
    std::optional<ParticleStage> stage = stageOf(lowering, at, ParticleStage::Kind::emitter);
    return stage ? particlesOf(at, goingOn({}, std::move(*stage))) : lowering.failure(at.type.outputs);
}

Lowered lowerParticleFile(GraphLowering& lowering, const NodeAt& at) {
    std::optional<ParticleStage> stage = stageOf(lowering, at, ParticleStage::Kind::file);
    if (!stage) return lowering.failure(at.type.outputs);
    const std::string& path = stage->words["path"];
    if (namesSequence(path)) {
        const Result<ParticleSequencePtr> sequence = readParticleSequence(lowering.state.graphPath, path);
        if (!sequence) {
            lowering.report(at, "path", sequence.error());
            return lowering.failure(at.type.outputs);
        }
        stage->sequence = *sequence;
        warnOfGaps(lowering, at, **sequence);
        return particlesOf(at, goingOn({}, std::move(*stage)));
    }
    const Result<ParticlePlacesPtr> places =
        path.empty() ? noFileNamed(kParticleFile) : readParticlePlaces(lowering.state.graphPath, path);
    if (!places) {
        lowering.report(at, "path", places.error());
        return lowering.failure(at.type.outputs);
    }
    stage->places = *places;
    return particlesOf(at, goingOn({}, std::move(*stage)));
}

Lowered lowerParticleDynamics(GraphLowering& lowering, const NodeAt& at) {
    const auto inputs = lowering.inputs(at);
    std::optional<ParticleStage> stage = inputs ? particleStage(lowering, at, *inputs) : std::nullopt;
    if (!stage) return lowering.failure(at.type.outputs);
    stage->kind = ParticleStage::Kind::dynamics;
    const Value& from = inputOf(*inputs, "particles");
    if (!from.particles) return lowering.failure(at.type.outputs);
    ParticleRecipe recipe = *from.particles;
    if (recipe.stages.front().sequence) {
        lowering.report(at, "particles",
                        {.message = "a sequence of files moves its particles itself: take one file of it"});
        return lowering.failure(at.type.outputs);
    }
    if (recipe.stages.front().kind == ParticleStage::Kind::fluid) {
        lowering.report(
            at, "particles",
            {.message = (recipe.endsInFoam() ? "foam goes with its fluid" : "a fluid moves itself") +
                        std::string(": give the sph_fluid its gravity and what it collides with")});
        return lowering.failure(at.type.outputs);
    }
    return particlesOf(at, goingOn(std::move(recipe), std::move(*stage)));
}

Lowered lowerFluid(GraphLowering& lowering, const NodeAt& at) {
    std::optional<ParticleStage> stage = stageOf(lowering, at, ParticleStage::Kind::fluid);
    if (!stage) return lowering.failure(at.type.outputs);
    if (!stage->fields.contains("source") && !stage->fields.contains("inflow")) {
        lowering.report(
            at, "source",
            {.message = "nothing is fluid: link the surface that is full of it at the start, or an inflow"});
        return lowering.failure(at.type.outputs);
    }
    const std::vector<double> values = valuesOf(lowering.live);
    const StageNumbers numbers(lowering.state.ir, *stage, values);
    const glm::dvec3 lo = numbers.vector("tank_min"), hi = numbers.vector("tank_max");
    for (int axis = 0; axis < 3; ++axis)
        if (!(lo[axis] < hi[axis])) {
            lowering.report(at, "tank_max",
                            {.message = "must be above tank_min along " + std::string(1, "xyz"[axis])});
            return lowering.failure(at.type.outputs);
        }
    warnOfDryInflow(lowering, at, *stage);
    return particlesOf(at, goingOn({}, std::move(*stage)));
}

Lowered lowerFoam(GraphLowering& lowering, const NodeAt& at) {
    const auto inputs = lowering.inputs(at);
    std::optional<ParticleStage> stage = inputs ? particleStage(lowering, at, *inputs) : std::nullopt;
    if (!stage) return lowering.failure(at.type.outputs);
    stage->kind = ParticleStage::Kind::foam;
    const Value& from = inputOf(*inputs, "particles");
    if (!from.particles) return lowering.failure(at.type.outputs);
    ParticleRecipe recipe = *from.particles;
    if (recipe.stages.front().kind != ParticleStage::Kind::fluid || recipe.endsInFoam()) {
        lowering.report(at, "particles",
                        {.message = "only a fluid gives off foam, and '" + recipe.stages.back().node +
                                    "' is none: link the sph_fluid itself"});
        return lowering.failure(at.type.outputs);
    }
    return particlesOf(at, goingOn(std::move(recipe), std::move(*stage)));
}

Lowered lowerParticlesToField(GraphLowering& lowering, const NodeAt& at) {
    const auto inputs = lowering.inputs(at);
    if (!inputs) return lowering.failure(at.type.outputs);
    const std::optional<ParticleStage> own = particleStage(lowering, at, *inputs);
    const Value& from = inputOf(*inputs, "particles");
    auto resolution = lowering.knownNumber(at, *inputs, "resolution");
    const auto margin = lowering.knownNumber(at, *inputs, "margin");
    if (!own || !from.particles || !resolution || !margin) return lowering.failure(at.type.outputs);
    if (*resolution != 0.0 && *resolution < kLeastParticleResolution) {
        lowering.report(at, "resolution",
                        {.message = "must be at least " + std::to_string(kLeastParticleResolution) +
                                    ", or 0 for as many cells as are good"});
        return lowering.failure(at.type.outputs);
    }
    Reach reach = reachOf(lowering, *own, *from.particles);
    Box& region = reach.region;
    bool found = true;
    for (const auto& [name, corner] :
         {std::pair("region_min", &region.lo), std::pair("region_max", &region.hi)}) {
        if (!at.node.input(name)) continue;
        found = false;
        for (int i = 0; i < 3; ++i) {
            const auto given = lowering.knownNumber(at, *inputs, name, i);
            if (!given) return lowering.failure(at.type.outputs);
            (*corner)[std::size_t(i)] = *given;
        }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) region.lo[axis] -= *margin, region.hi[axis] += *margin;
    const bool blobs = makesBlobs(*own);
    const bool chosen = *resolution == 0.0;
    if (chosen)
        resolution = blobs ? kBlobResolution
                           : std::clamp(std::ceil(kDropCells * longestSide(region) / reach.leastDrop),
                                        double(kLeastParticleResolution), double(kMostParticleResolution));
    if (found && blobs)
        resolution = std::min(*resolution, std::floor(kManyRadiusCells * longestSide(region) / reach.most));
    ParticleRecipe recipe = *from.particles;
    if (!recipe.cache.empty())
        if (const Done cached = findCached(lowering.graph, recipe); !cached) {
            Error warning = cached.error();
            warning.severity = Error::Severity::warning;
            lowering.report(at, "particles", std::move(warning));
        }
    const auto volumeOf = [&](double cells) {
        return particleVolume(lowering.state.ir, recipe, *own, region, static_cast<int>(cells));
    };
    Result<FieldVolumePtr> volume = volumeOf(*resolution);
    bool coarser = false;
    while (chosen && volume && double(texelCount(**volume)) > kMostChosenTexels) {
        const double share = std::cbrt(kMostChosenTexels / double(texelCount(**volume)));
        resolution = std::floor(*resolution * share);
        volume = volumeOf(*resolution);
        coarser = true;
    }
    if (!volume) {
        lowering.report(at, found ? "particles" : "region_min", volume.error());
        return lowering.failure(at.type.outputs);
    }
    const double cell = (*volume)->grid.cell;
    const double fine = blobs ? reach.least : reach.leastDrop, cells = blobs ? kFewRadiusCells : kDropCells;
    const double enough = std::ceil(*resolution * cell * cells / fine - 1e-6);
    if (enough > *resolution)
        lowering.warn(
            at, "resolution",
            "cells of " + shortNumber(cell) + " m are wide for " +
                (blobs ? "particles that reach " : "drops with a radius of ") + shortNumber(fine) + " m: " +
                (coarser ? "finer ones would take more than " + std::to_string(kMostChosenMebibytes) +
                               " MiB; raise drop"
                 : enough <= kMostParticleResolution ? "raise the resolution to " + shortNumber(enough)
                 : blobs                             ? "raise the radius"
                                                     : "raise drop") +
                ", or give the grid a smaller region");
    if (inputOf(*inputs, "distance").text == "near") lowering.nearFields.insert(at.path());
    return sampledVolume(lowering, at, *inputs, *volume, tricubicChannel);
}

}  // namespace fw
