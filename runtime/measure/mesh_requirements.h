// What a mesh must be to be kept: "closed,manifold,wall=0.8mm", held against the report of it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "graph/base/result.h"
#include "runtime/measure/mesh_report.h"

namespace fw {

struct Requirement {
    std::size_t rule = 0;  ///< which of the names that requirementNames() lists
    std::string
        number;  ///< of those that take one, as it was typed; of lengths with a unit, or in the report's
};

/// Requirements parted by commas. Error: what is not one, and which there are.
Result<std::vector<Requirement>> parseRequirements(std::string_view text);

/// "closed manifold … error=LENGTH": each name, with what its number is.
std::string requirementNames();

/// Whether one of them can be checked only with the field that the mesh was made of.
bool needField(const std::vector<Requirement>& requirements);
/// Whether one of them needs the distances between the mesh and the field's surface.
bool needDistances(const std::vector<Requirement>& requirements);

/// Why the mesh is not as required, one sentence for each requirement that it misses. "closed" includes
/// "complete" where the report knows of completeness and the region was found.
std::vector<std::string> unmet(const std::vector<Requirement>& requirements, const Report& report);

}  // namespace fw
