#include "runtime/render/places.h"

#include "shaders/shared.h"
// after shared.h
#include "shaders/render/render.h"

namespace fw {

namespace {

constexpr uint32_t kGroup = 64;                               // boxes of a work group
constexpr uint64_t kEntriesOfABox = 64, kEntriesAhead = 512;  // a guess; the coarsest boxes list nearly all

uint64_t cubed(uint64_t side) { return side * side * side; }

}  // namespace

void listPlaces(Commands& commands, Places& places, const Families& families, const FieldBuffers& field,
                glm::vec3 lo, glm::vec3 hi, uint64_t content) {
    if (places.content == content) return;
    places.content = content;
    const Device& device = commands.device;
    uint64_t boxes = 1;
    for (uint32_t side = RENDER_LEAST_PLACES; side <= RENDER_PLACES; side *= 2) boxes += cubed(side);
    const uint64_t entries =
        kEntriesOfABox * boxes * families.listed + kEntriesAhead * longestList(families) * families.listed;
    reserveLists(device, places.lists, families, boxes, entries);
    reserve(device, places.listed, sizeof(uint32_t));
    fill(commands, places.listed, 0);
    barrier(commands);
    FieldBuffers read = field;
    read.lists = &places.lists;
    std::vector<Descriptor> bound = {{0, places.listed}};
    addField(bound, read);
    gpu::PlacesPush push{.lo = lo, .hi = hi, .side = 0, .listStart = longestList(families)};
    for (push.side = RENDER_LEAST_PLACES; push.side <= RENDER_PLACES; push.side *= 2) {
        dispatch(commands, places.list, {groupsFor(uint32_t(cubed(push.side)), kGroup), 1, 1}, push, bound);
        barrier(commands);
    }
}

}  // namespace fw
