#include "editor/document/frames.h"

#include <algorithm>
#include <cassert>
#include <nlohmann/json.hpp>

#include "editor/document/layout.h"
#include "editor/document/wiring.h"

namespace fw::editor {

namespace {

constexpr double kMargin = 24.0;      ///< between a frame and what it is put around
constexpr double kTitleSpace = 32.0;  ///< for its text, above
constexpr Position kEmptySize{320.0, 200.0};

template <std::size_t count>
std::optional<std::array<double, count>> numbersIn(const Json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_array() || found->size() != count) return {};
    std::array<double, count> numbers;
    for (std::size_t i = 0; i < count; ++i) {
        if (!(*found)[i].is_number()) return {};
        numbers[i] = (*found)[i].get<double>();
    }
    return numbers;
}

std::optional<std::string> textIn(const Json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end()) return std::string();
    return found->is_string() ? std::optional(found->get<std::string>()) : std::nullopt;
}

std::optional<Frame> frameOf(const Json& json) {
    if (!json.is_object()) return {};
    const auto at = numbersIn<2>(json, "at"), size = numbersIn<2>(json, "size");
    const auto scope = textIn(json, "scope"), text = textIn(json, "text");
    if (!at || !size || !scope || !text) return {};
    Frame frame{*scope, *at, *size, *text, numbersIn<3>(json, "color"), {}};
    for (const auto& [key, value] : json.items()) {
        const bool known = key == "scope" || key == "at" || key == "size" || key == "text" ||
                           (key == "color" && frame.color);
        if (!known) (*frame.extra)[key] = value;
    }
    return frame;
}

Json jsonOf(const Frame& frame) {
    Json json = Json::object();
    if (!frame.scope.empty()) json["scope"] = frame.scope;
    json["at"] = frame.at;
    json["size"] = frame.size;
    if (!frame.text.empty()) json["text"] = frame.text;
    if (frame.color) json["color"] = *frame.color;
    for (const auto& [key, value] : frame.extra->items()) json[key] = value;
    return json;
}

}  // namespace

std::vector<Frame> framesOf(const Graph& graph) {
    std::vector<Frame> frames;
    if (graph.frames->is_array())
        for (const Json& json : *graph.frames)
            if (auto frame = frameOf(json)) frames.push_back(std::move(*frame));
    return frames;
}

Graph setFrame(const Graph& graph, std::size_t index, const std::optional<Frame>& frame) {
    Graph result = graph;
    Json& list = *result.frames;
    if (!list.is_array()) list = Json::array();
    std::size_t at = 0;
    for (std::size_t before = 0; at < list.size(); ++at)
        if (frameOf(list[at]) && before++ == index) break;
    if (at == list.size()) {
        if (frame) list.push_back(jsonOf(*frame));
    } else if (frame) {
        list[at] = jsonOf(*frame);
    } else {
        list.erase(list.begin() + static_cast<std::ptrdiff_t>(at));
    }
    if (list.empty()) list = nullptr;
    return result;
}

Graph frameNodes(const Graph& graph, std::string_view scope, std::span<const std::string> nodes) {
    const Wiring wiring(graph, scope);
    std::optional<Position> low, high;
    for (const std::string& id : nodes) {
        const auto index = wiring.find(id);
        if (!index) continue;
        const Position at = wiring.scope().nodes[*index].at.value_or(Position{});
        const Position size = aboutSize(wiring.scope(), *index);
        const Position end{at[0] + size[0], at[1] + size[1]};
        low = low ? Position{std::min((*low)[0], at[0]), std::min((*low)[1], at[1])} : at;
        high = high ? Position{std::max((*high)[0], end[0]), std::max((*high)[1], end[1])} : end;
    }
    Frame frame{.scope = std::string(scope), .size = kEmptySize, .text = "", .color = {}, .extra = {}};
    if (low) {
        frame.at = {(*low)[0] - kMargin, (*low)[1] - kMargin - kTitleSpace};
        frame.size = {(*high)[0] + kMargin - frame.at[0], (*high)[1] + kMargin - frame.at[1]};
    }
    return setFrame(graph, framesOf(graph).size(), frame);
}

}  // namespace fw::editor
