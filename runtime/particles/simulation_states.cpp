// What is kept of a simulation: its states on the device, and on the disk, from which steps are taken again.
#include <algorithm>
#include <utility>

#include "graph/base/words.h"
#include "runtime/particles/simulation.h"

namespace fw {

namespace {

constexpr VkDeviceSize kMostCheckpointBytes = 256u << 20;
constexpr VkDeviceSize kCheckpointBufferBytes = 4u << 20;  // that several share: drivers allow few

}  // namespace

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
    if (source().kind == ParticleStage::Kind::emitter) {
        countBirths(values);
    } else if (fluid) {
        born.resize(std::max(born.size(), at + 1));
        born[at] = loaded.front().born;
        drifts.resize(std::max(drifts.size(), at + 1));
        drifts[at] = {loaded.front().drift[0], loaded.front().drift[1], loaded.front().drift[2]};
    }
    return done();
}

}  // namespace fw
