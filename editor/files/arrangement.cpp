#include "editor/files/arrangement.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "editor/editor.h"
#include "editor/panels/side.h"

namespace fw::editor {

namespace {

constexpr int kLeastWindow = 200;  // pixels

template <class Value>
void take(const Json& all, const char* key, Value& value) {
    const auto found = all.find(key);
    if (found == all.end()) return;
    if constexpr (std::is_same_v<Value, bool>) {
        if (found->is_boolean()) value = found->get<bool>();
    } else if constexpr (std::is_same_v<Value, float>) {
        if (found->is_number()) value = std::clamp(found->get<float>(), kLeastPart, kMostPart);
    } else if (found->is_string()) {
        value = found->get<std::string>();
    }
}

}  // namespace

Json arrangementOf(const Editor& editor) {
    const Panels& panels = editor.panels;
    Json all = Json::object();
    const auto [width, height] = editor.shell.windowSize();
    all["window"] = {width, height};
    for (const SidePanel& panel : sidePanels()) all[panel.id] = panels.*panel.open;
    all["timeline"] = panels.timeline;
    all["minimap"] = editor.canvas.minimap;
    all["costs"] = editor.canvas.costs;
    all["exactness"] = editor.canvas.exactness;
    all["grid"] = editor.viewport.grid;
    all["pictures"] = editor.viewport.split.count;
    all["side"] = panels.side;
    all["top"] = panels.top;
    all["low"] = panels.low;
    all["front"] = panels.front;
    return all;
}

void arrange(Editor& editor, const Json& all) {
    if (!all.is_object()) return;
    Panels& panels = editor.panels;
    for (const SidePanel& panel : sidePanels()) take(all, panel.id, panels.*panel.open);
    take(all, "timeline", panels.timeline);
    take(all, "minimap", editor.canvas.minimap);
    take(all, "costs", editor.canvas.costs);
    take(all, "exactness", editor.canvas.exactness);
    take(all, "grid", editor.viewport.grid);
    if (const auto found = all.find("pictures"); found != all.end() && found->is_number_integer())
        splitInto(editor, std::size_t(std::clamp(found->get<int>(), 1, int(kMostPictures))));
    take(all, "side", panels.side);
    take(all, "top", panels.top);
    take(all, "low", panels.low);
    take(all, "front", panels.wanted);
    const bool there = std::ranges::any_of(sidePanels(), [&](const SidePanel& panel) {
        return panel.id == panels.wanted && panels.*panel.open;
    });
    if (!there) panels.wanted.clear();
}

std::optional<std::pair<int, int>> windowSizeOf(const Json& panels) {
    const auto found = panels.is_object() ? panels.find("window") : panels.end();
    if (!panels.is_object() || found == panels.end() || !found->is_array() || found->size() != 2 ||
        !found->at(0).is_number_integer() || !found->at(1).is_number_integer())
        return std::nullopt;
    const auto side = [&](std::size_t i) {
        return std::clamp(found->at(i).get<int>(), kLeastWindow, kMostPictureSide);
    };
    return std::pair(side(0), side(1));
}

void keepArrangement(const Editor& editor, const std::string& path) {
    std::string problem;
    Preferences preferences = readPreferences(path, problem);
    preferences.panels = arrangementOf(editor);
    preferences.taken = editor.files.preferences.taken;
    // The editor ends: there is nobody left to be told that its window will open as it did before.
    (void)savePreferences(preferences, path);
}

}  // namespace fw::editor
