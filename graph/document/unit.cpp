#include "graph/document/unit.h"

#include <nlohmann/json.hpp>

namespace fw {

const LengthUnit& unitOf(const Graph& graph) {
    const Json& extra = *graph.extra;
    const auto key = extra.find("unit");
    const LengthUnit* unit =
        key != extra.end() && key->is_string() ? lengthUnit(key->get_ref<const std::string&>()) : nullptr;
    return unit ? *unit : *lengthUnit("m");
}

void setUnit(Graph& graph, const LengthUnit& unit) {
    if (graph.extra->is_null()) graph.extra = Json::object();
    if (unit.metres == 1.0)
        graph.extra->erase("unit");
    else
        (*graph.extra)["unit"] = unit.name;
    if (graph.extra->empty()) graph.extra = nullptr;
}

}  // namespace fw
