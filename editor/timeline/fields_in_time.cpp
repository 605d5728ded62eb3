#include "editor/timeline/fields_in_time.h"

#include <algorithm>
#include <cmath>

#include "editor/document/key_edits.h"
#include "editor/panels/properties.h"
#include "graph/document/named_parameters.h"

namespace fw::editor {

namespace {

constexpr float kMarks = 64.0f;  // so many places for keys in a field

void addKeys(MovedField& field, const Track& track, double length) {
    float last = -1.0f;
    for (const Key& key : track.keys) {
        const float share = std::round(float(std::clamp(key.time / length, 0.0, 1.0)) * kMarks) / kMarks;
        if (share != last) field.keys.push_back(share);
        last = share;
    }
}

}  // namespace

std::map<std::string, MovedField, std::less<>> movedFields(Editor& editor) {
    std::map<std::string, MovedField, std::less<>> fields;
    const Timeline* timeline = editor.canvas.scope.empty() ? timelineOf(editor) : nullptr;
    if (!timeline) return fields;
    const Graph& graph = editor.document.graph();
    const double now = editor.viewport.seconds;
    for (const Track& track : timeline->tracks) {
        const std::optional<AnimatedInput> input = animatedInput(graph, track);
        if (!input) continue;
        const auto [at, added] = fields.try_emplace(input->node + "." + input->input);
        MovedField& field = at->second;
        if (added) {
            field.numbers = inputNumbers(*graph.node(input->node), input->input);
            field.now = float(std::clamp(now / timeline->length, 0.0, 1.0));
            field.set = [plug = Plug{input->node, input->input}, now](const Graph& before,
                                                                      const std::vector<double>& numbers) {
                return setMovedInput(before, plug, now, numbers);
            };
        }
        applyTrack(track, *input, now, field.numbers);
        addKeys(field, track, timeline->length);
    }
    return fields;
}

void showKeyEntries(Editor& editor, const Plug& input) {
    const Timeline* timeline = timelineOf(editor);
    if (!timeline) return;
    const Graph& graph = editor.document.graph();
    const double now = editor.viewport.seconds;
    bool moves = false, here = false;
    for (const Track& track : timeline->tracks)
        if (const auto animated = animatedInput(graph, track))
            if (animated->node == input.node && animated->input == input.name)
                moves = true, here |= keyAt(track, now).has_value();
    const std::string refusal = moves ? std::string() : motionRefusal(graph, input);
    if (ImGui::MenuItem("Insert key", nullptr, false, refusal.empty() && !here))
        return editor.document.apply("Add Key", insertKeyOf(graph, input, now));
    if (!refusal.empty() && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        ImGui::SetTooltip("%s", refusal.c_str());
    if (ImGui::MenuItem("Remove key", nullptr, false, here))
        return editor.document.apply("Remove Key", removeKeyOf(graph, input, now));
    if (ImGui::MenuItem("Remove animation", nullptr, false, moves))
        return editor.document.apply("Remove Animation", removeMotion(graph, input, now));
}

void showFieldMenu(Editor& editor, const std::optional<Plug>& asked) {
    std::optional<Plug>& input = editor.panelState.timelinePanel.fieldMenu;
    if (asked) {
        input = *asked;
        ImGui::OpenPopup("##fieldmenu");
    }
    if (!ImGui::BeginPopup("##fieldmenu")) return;
    if (input && editor.document.graph().node(input->node)) {
        ImGui::TextDisabled("%s", readable(input->name).c_str());
        showKeyEntries(editor, *input);
    } else {
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

}  // namespace fw::editor
