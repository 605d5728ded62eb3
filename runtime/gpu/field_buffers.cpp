#include "runtime/gpu/field_buffers.h"

#include <algorithm>
#include <numeric>

#include "shaders/shared.h"

namespace fw {

bool hasFamilies(std::string_view field) { return field.find("#define FIELD_FAMILIES") != field.npos; }

uint32_t longestList(const Families& families) {
    uint32_t most = 0;
    for (uint32_t f = 0; f < families.listed; ++f) most = std::max(most, families.all[f].members);
    return most;
}

uint64_t headBytes(const Families& families, uint64_t places) {
    return places * families.listed * sizeof(gpu::uvec2);
}

void reserveLists(const Device& device, FieldLists& lists, const Families& families, uint64_t places,
                  uint64_t entries) {
    std::vector<uint32_t> all(longestList(families));
    std::iota(all.begin(), all.end(), 0u);
    std::vector<gpu::uvec2> heads;
    std::vector<float> tables;
    for (const Family& family : families.all) {
        if (heads.size() < families.listed) heads.emplace_back(0, family.members);
        tables.insert(tables.end(), family.table.begin(), family.table.end());
    }
    const uint64_t range = device.limits.storageRange;
    reserve(device, lists.lists, std::min((all.size() + entries) * sizeof all[0], range));
    reserve(device, lists.heads, std::min(headBytes(families, places), range));
    reserve(device, lists.tables, tables.size() * sizeof tables[0]);
    upload(device, lists.tables, tables);
    upload(device, lists.lists, all);
    upload(device, lists.heads, heads);
}

void addField(std::vector<Descriptor>& bound, const FieldBuffers& field) {
    if (field.parameters) {
        bound.emplace_back(FIELD_PARAMETERS, *field.parameters);
        bound.emplace_back(FIELD_PARAMETERS_BEFORE, field.before ? *field.before : *field.parameters);
    }
    if (field.images) bound.emplace_back(FIELD_IMAGES, *field.images);
    if (field.volumes) bound.emplace_back(FIELD_VOLUMES, *field.volumes);
    if (!field.lists) return;
    bound.emplace_back(FIELD_TABLES, field.lists->tables);
    bound.emplace_back(FIELD_LISTS, field.lists->lists);
    bound.emplace_back(FIELD_HEADS, field.lists->heads);
}

}  // namespace fw
