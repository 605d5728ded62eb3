#include "graph/document/unit.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace fw {

namespace {

constexpr std::array kUnits = {LengthUnit{"mm", "millimetres", 0.001}, LengthUnit{"cm", "centimetres", 0.01},
                               LengthUnit{"in", "inches", 0.0254}, LengthUnit{"m", "metres", 1.0}};

}  // namespace

std::span<const LengthUnit> lengthUnits() { return kUnits; }

const LengthUnit* lengthUnit(std::string_view name) {
    const auto found = std::ranges::find(kUnits, name, &LengthUnit::name);
    return found == kUnits.end() ? nullptr : &*found;
}

const LengthUnit& unitOf(const Graph& graph) {
    const Json& extra = *graph.extra;
    const auto key = extra.find("unit");
    const LengthUnit* unit =
        key != extra.end() && key->is_string() ? lengthUnit(key->get_ref<const std::string&>()) : nullptr;
    return unit ? *unit : kUnits.back();
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
