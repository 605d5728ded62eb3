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

namespace {

/// The document's key becomes the value; null: it goes.
void setKey(Graph& graph, const char* key, Json value) {
    if (graph.extra->is_null()) graph.extra = Json::object();
    if (value.is_null())
        graph.extra->erase(key);
    else
        (*graph.extra)[key] = std::move(value);
    if (graph.extra->empty()) graph.extra = nullptr;
}

}  // namespace

void setUnit(Graph& graph, const LengthUnit& unit) {
    setKey(graph, "unit", unit.metres == 1.0 ? Json() : Json(unit.name));
}

std::optional<double> densityOf(const Graph& graph) {
    const Json& extra = *graph.extra;
    const auto key = extra.find("density");
    return key != extra.end() && key->is_number() ? std::optional(key->get<double>()) : std::nullopt;
}

void setDensity(Graph& graph, std::optional<double> density) {
    setKey(graph, "density", density ? Json(*density) : Json());
}

}  // namespace fw
