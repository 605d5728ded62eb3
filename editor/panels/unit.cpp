#include "editor/panels/unit.h"

#include "editor/document/unit_edits.h"
#include "editor/panels/properties.h"
#include "graph/base/words.h"
#include "graph/document/unit.h"

namespace fw::editor {

namespace {

constexpr NumberRange kDensityRange{.min = 1e-6, .max = 1e3, .speed = 0.01, .unit = "g/cm³"};
constexpr double kFirstDensity = 1.0;  // water's
constexpr std::size_t kMostNamed = 4;  // nodes in a message

Graph withUnit(Graph graph, const LengthUnit& unit) {
    setUnit(graph, unit);
    return graph;
}
Graph withDensity(Graph graph, std::optional<double> density) {
    setDensity(graph, density);
    return graph;
}

void keepTheSizes(Editor& editor, const LengthUnit& unit) {
    OtherUnit other = keepSizes(editor.document.graph(), unit);
    editor.document.apply("Change Unit", std::move(other.graph));
    if (other.left.empty()) return;
    const std::size_t named = std::min(kMostNamed, other.left.size()), more = other.left.size() - named;
    other.left.resize(named);
    say(editor, "numbers that may be lengths stay as they are: " + listed(other.left) +
                    (more > 0 ? " and " + std::to_string(more) + " more" : ""));
}

/// What becomes of the document in another unit.
void offerUnit(Editor& editor) {
    const LengthUnit& old = unitOf(editor.document.graph());
    const LengthUnit* const unit = lengthUnit(editor.panelState.otherUnit);
    if (!unit || !ImGui::BeginPopup("other unit")) return;
    const std::string one = std::string("1 ") + old.name;
    const auto choice = [&](const std::string& label, const char* tip) {
        const bool chosen = ImGui::Selectable(label.c_str());
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tip);
        return chosen;
    };
    if (choice("Keep sizes: " + one + " becomes " + withSign(old.metres / unit->metres, "m", *unit),
               "Every length is reckoned into the new unit: inputs, parameters, keys, camera and lamps"))
        keepTheSizes(editor, *unit);
    if (choice("Keep numbers: " + one + " becomes 1 " + unit->name, "The same numbers mean other sizes"))
        editor.document.apply("Change Unit", withUnit(editor.document.graph(), *unit));
    ImGui::EndPopup();
}

}  // namespace

void showUnit(Editor& editor) {
    if (!beginProperties("unit")) return;
    const Graph& graph = editor.document.graph();
    const LengthUnit& now = unitOf(graph);
    propertyRow("Unit", "What a length of 1 is. Lengths are typed and shown in it.");
    const auto words = [](const LengthUnit& unit) { return std::string(unit.words) + ", " + unit.name; };
    bool other = false;
    if (ImGui::BeginCombo("##unit", words(now).c_str())) {
        for (const LengthUnit& unit : lengthUnits())
            if (ImGui::Selectable(words(unit).c_str(), &unit == &now) && &unit != &now)
                editor.panelState.otherUnit = unit.name, other = true;
        ImGui::EndCombo();
    }
    if (other) ImGui::OpenPopup("other unit");
    offerUnit(editor);
    const std::optional<double> density = densityOf(editor.document.graph());
    propertyRow("Density", "Of what the solid is made of, for its mass: PLA has 1.24, steel 7.85.",
                density ? ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.x : 0.0f);
    if (density) {
        editNumbers(editor, "##density", std::span(&*density, 1), kDensityRange, "Set Density",
                    [](const Graph& in, std::span<const double> to) { return withDensity(in, to[0]); });
        ImGui::SameLine();
        if (ImGui::Button("×##density"))
            editor.document.apply("Remove Density", withDensity(editor.document.graph(), std::nullopt));
    } else if (ImGui::SmallButton("Set##density")) {
        editor.document.apply("Set Density", withDensity(editor.document.graph(), kFirstDensity));
    }
    endProperties();
}

}  // namespace fw::editor
