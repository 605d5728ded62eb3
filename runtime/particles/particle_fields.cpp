#include "runtime/particles/particle_fields.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "graph/evaluate/affine.h"

namespace fw {

namespace {

Error atNode(Error error, const ParticleField& field) {
    if (error.node.empty()) error.node = field.node;
    return error;
}

/// Where the program shows a volume: at least one place, that of no change.
std::vector<glm::mat4> placesOf(const Program& program, std::size_t volume) {
    constexpr std::size_t kMost = 64;
    const std::vector<double> parameters = program.parameters();
    std::set<std::array<IrId, 3>> seen;
    std::vector<glm::mat4> places;
    for (IrId id = 0; id < program.ir.size() && places.size() < kMost; ++id) {
        const IrNode& node = program.ir[id];
        if (node.op != Op::volume) continue;
        const std::array<IrId, 3> at = {node.operands[0], node.operands[1], node.operands[2]};
        if (program.ir.layer(node).volume->volume != program.ir.volumes()[volume].get() ||
            !seen.insert(at).second)
            continue;
        const std::optional<Affine> toField = affineOf(program.ir, at, parameters);
        if (!toField) continue;
        const Affine toWorld = inverse(*toField);
        glm::mat4& place = places.emplace_back(glm::dmat4(toWorld.linear));
        place[3] = glm::vec4(toWorld.offset, 1);
    }
    if (places.empty()) places.emplace_back(1.0f);
    return places;
}

}  // namespace

namespace {

/// Whether to make these samples takes more than a fraction of a second on some devices.
bool takesLong(const ParticleVolumeConfig& config) {
    constexpr std::size_t kSomeSamples = 1u << 20, kManySamples = 1u << 24;
    const bool exact = config.method == DensityMethod::exact || config.trueDistance;
    return config.method == DensityMethod::proxies ||
           config.grid.samples() > (exact ? kSomeSamples : kManySamples);
}

}  // namespace

uint32_t firstTexel(const Program& program, std::size_t volume) {
    std::size_t first = 0;
    for (std::size_t i = 0; i < volume; ++i) first += texelCount(*program.ir.volumes()[i]);
    return uint32_t(first);
}

bool lacksParticles(const Program& program) {
    return std::ranges::any_of(program.ir.volumes(), [](const FieldVolumePtr& volume) {
        return volume->particles && !volume->made();
    });
}

void ParticleFields::setProgram(const Program& program) {
    std::vector<Part> next;
    for (std::size_t i = 0; i < program.ir.volumes().size(); ++i)
        if (const ParticleFieldPtr& field = program.ir.volumes()[i]->particles;
            field && !program.ir.volumes()[i]->made())
            next.push_back({.volume = i, .field = field, .simulation = {}, .recipe = 0});
    for (Part& part : next) {
        if (part.simulation) continue;
        std::vector<ParticleFieldPtr> together;  // unlike each other
        for (Part& other : next) {
            if (other.field->sourceHash != part.field->sourceHash) continue;
            const auto same =
                std::ranges::find(together, other.field->stagesHash, &ParticleField::stagesHash);
            other.recipe = std::size_t(same - together.begin());
            if (same == together.end()) together.push_back(other.field);
        }
        const auto known = std::ranges::find_if(parts, [&](const Part& before) {
            return std::ranges::equal(before.simulation->recipes(), together, {}, &ParticleField::stagesHash,
                                      &ParticleField::stagesHash);
        });
        if (known != parts.end()) known->simulation->takeAgain(together);
        const auto simulation =
            known != parts.end() ? known->simulation : std::make_shared<Simulation>(*device, together);
        for (Part& other : next)
            if (other.field->sourceHash == part.field->sourceHash) other.simulation = simulation;
    }
    parts = std::move(next);
}

std::vector<std::shared_ptr<Simulation>> ParticleFields::simulations() const {
    std::vector<std::shared_ptr<Simulation>> list;
    for (const Part& part : parts)
        if (std::ranges::find(list, part.simulation) == list.end()) list.push_back(part.simulation);
    return list;
}

void ParticleFields::valuesChanged() {
    for (Part& part : parts) part.simulation->valuesChanged();
}

uint64_t ParticleFields::slots() const {
    uint64_t sum = 0;
    for (const Part& part : parts) sum += part.simulation->slots(part.recipe);
    return sum;
}

std::vector<ParticleCloud> ParticleFields::clouds(const Program& program) const {
    std::vector<ParticleCloud> made;
    for (const Part& part : parts)
        for (const glm::mat4& toWorld : placesOf(program, part.volume))
            made.push_back({.places = &part.simulation->places(part.recipe),
                            .velocities = part.simulation->velocities(part.recipe),
                            .slots = part.simulation->slots(part.recipe),
                            .radius = float(part.numbers.drop),
                            .toWorld = toWorld});
    return made;
}

Result<ParticleChanges> ParticleFields::make(const Program& program, double seconds, const ValuesAt& values,
                                             const Buffer& volumes, bool surfaces,
                                             const std::function<bool(int, int)>& progress) {
    ParticleChanges changes;
    const std::vector<double> now = parts.empty() ? std::vector<double>() : values(seconds);
    for (Part& part : parts) {
        const Result<bool> moved = part.simulation->goTo(seconds, values, progress);
        if (moved && !*moved) continue;  // where another part has taken it, if others are there
        for (Part& other : parts) other.moved |= other.simulation == part.simulation;
        if (!moved) return atNode(moved.error(), *part.field);
    }
    for (Part& part : parts) {
        const ParticleField& field = *part.field;
        const SurfaceNumbers madeWith =
            std::exchange(part.numbers, {});  // no samples, should anything go wrong
        const bool moved = std::exchange(part.moved, false);
        const SurfaceNumbers numbers = surfaceNumbers(field.ir, field.particles, field.toField, now);
        const bool same = numbers == madeWith;
        changes.places |= moved || !same;
        if (same && surfaces == part.surface && !(moved && surfaces)) {
            part.numbers = numbers;
            continue;
        }
        if (!(numbers.radius > 0.0) || !(numbers.threshold > 0.0))
            return atNode(Error{.message = "the radius and the threshold must be above 0"}, field);
        if (!kernels) kernels = createParticleVolumeKernels(*device);
        const ParticleVolumeConfig config{.grid = program.ir.volumes()[part.volume]->grid,
                                          .numbers = numbers,
                                          .surface = field.surface,
                                          .method = field.method,
                                          .trueDistance = field.trueDistance};
        Commands commands(*device);
        commands.parted = takesLong(config);
        if (const Done recorded = recordParticleVolume(commands, *kernels, buffers, config,
                                                       part.simulation->places(part.recipe),
                                                       surfaces ? part.simulation->slots(part.recipe) : 0,
                                                       volumes, firstTexel(program, part.volume));
            !recorded)
            return atNode(recorded.error(), field);
        send(commands);
        part.numbers = numbers, part.surface = surfaces;
        changes.fields = true;
    }
    return changes;
}

std::vector<FieldVolumePtr> downloadParticles(const Device& device, const Program& program,
                                              const Buffer& volumes) {
    std::vector<FieldVolumePtr> made;
    for (std::size_t i = 0; i < program.ir.volumes().size(); ++i)
        if (const FieldVolume& volume = *program.ir.volumes()[i]; volume.particles)
            made.push_back(downloadVolume(device, volume, volumes, firstTexel(program, i)));
    return made;
}

void useParticles(Program& program, std::span<const FieldVolumePtr> made) {
    for (std::size_t i = 0; i < program.ir.volumes().size(); ++i) {
        const FieldVolumePtr volume = program.ir.volumes()[i];
        if (!volume->particles || volume->made()) continue;
        const auto its = std::ranges::find_if(made, [&](const FieldVolumePtr& other) {
            return other->particles->node == volume->particles->node;
        });
        if (its != made.end()) program.ir.replaceVolume(i, *its);
    }
}

Done makeParticles(Program& program, const Graph& graph, double seconds, const CompileOptions& options,
                   const Device& device, const std::function<bool(int, int)>& progress) {
    if (!lacksParticles(program)) return done();
    const Result<LiveProgram> live = compileLive(graph, options);
    if (!live) return live.error();
    const Program& played = live->program;
    Buffer volumes;
    std::size_t texels = 0;
    for (const FieldVolumePtr& volume : played.ir.volumes()) texels += texelCount(*volume);
    reserve(device, volumes, kTexelBytes * texels);
    ParticleFields fields(device);
    fields.setProgram(played);
    const auto values = [&](double at) { return live->valuesAt(at); };
    const Result<ParticleChanges> made =
        fields.make(played, timelineTime(live->timeline, seconds), values, volumes, true, progress);
    if (!made) {
        Error error = made.error();
        error.file = graph.path;
        return error;
    }
    useParticles(program, downloadParticles(device, played, volumes));
    program.notes = played.notes;  // of grids with room for all times
    return done();
}

}  // namespace fw
