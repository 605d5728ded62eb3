#include "editor/panels/tour.h"

#include "editor/commands.h"
#include "editor/files/samples.h"

namespace fw::editor {

namespace {

struct Step {
    const char* title;
    const char* text;  ///< "KEY" in it: the key that adds a node
};
constexpr Step kSteps[] = {
    {"A box for the window",
     "Press KEY with the mouse over an empty place of the canvas, type box and press Enter."},
    {"Long and narrow",
     "Click the numbers of the new box and type: half extents of 0.15, 0.5 and 2. So it is as wide as the "
     "small windows, and passes through the whole tower."},
    {"Repeat it",
     "Drag from the box's Surface to an empty place and let go. The list has what such a wire may lead to: "
     "type repeat and press Enter."},
    {"Four in a row",
     "Give Repeat a period of 0.5, 0 and 0 (where it is 0 nothing is repeated), and a count of 4, 0 and 0."},
    {"A place to cut",
     "Press KEY, type subtract and press Enter. Drag the new node onto the wire that leads into Output: it "
     "goes in between."},
    {"Cut", "Drag from the Surface of Repeat to B of the new Subtract. What B has is cut out of what A has."},
};
static_assert(std::size(kSteps) == kTourSteps);

/// The node that feeds the input, if there is one.
const Node* sourceOf(const Graph& graph, const Node& node, std::string_view input) {
    const InputValue* value = node.input(input);
    const Link* link = value ? std::get_if<Link>(&value->value) : nullptr;
    return link ? graph.node(link->node) : nullptr;
}

/// A component of what the document gives; 0 where it gives nothing, or a wire.
double number(const Node& node, std::string_view input, std::size_t component) {
    const InputValue* value = node.input(input);
    const auto* list = value ? std::get_if<std::vector<double>>(&value->value) : nullptr;
    return list && component < list->size() ? (*list)[component] : 0.0;
}

bool isBox(const Node& node) { return node.type == "box" || node.type == "box_max"; }
bool isWindow(const Node& box) {
    return isBox(box) && number(box, "half_extents", 0) < 0.3 && number(box, "half_extents", 2) > 1.0;
}
bool isRow(const Node& repeat) {
    return number(repeat, "period", 0) > 0.0 && number(repeat, "period", 1) == 0.0 &&
           number(repeat, "period", 2) == 0.0 && number(repeat, "count", 0) > 1.0;
}

}  // namespace

std::size_t tourStepsDone(const Graph& graph) {
    // The subtractions one after the other that lead to the output: the sample has two.
    std::vector<const Node*> cuts;
    for (const Node& node : graph.nodes) {
        if (roleOf(node.type) != NodeRole::output) continue;
        for (const Node* at = sourceOf(graph, node, "surface"); at && at->type == "subtract";
             at = sourceOf(graph, *at, "a")) {
            cuts.push_back(at);
            if (cuts.size() > graph.nodes.size()) return 0;  // a cycle, which files may have
        }
    }
    std::size_t boxes = 0, done = 0;
    for (const Node& node : graph.nodes) boxes += isBox(node) ? 1 : 0;
    if (boxes > 2) done = 1;
    for (const Node& node : graph.nodes)
        if (isWindow(node)) done = std::max<std::size_t>(done, 2);
    for (const Node& node : graph.nodes) {
        const Node* box = node.type == "repeat" ? sourceOf(graph, node, "surface") : nullptr;
        if (!box || !isWindow(*box)) continue;
        std::size_t steps = 3;
        if (isRow(node)) steps = cuts.size() > 2 ? 5 : 4;
        for (const Node* cut : cuts)
            if (steps == 5 && sourceOf(graph, *cut, "b") == &node) steps = 6;
        done = std::max(done, steps);
    }
    return done;
}

void startTour(Editor& editor) {
    const std::string folder = samplesFolder();
    if (folder.empty()) return say(editor, "the samples are not installed: the tour has no tower to show");
    editor.windows.tour = true;
    openFile(editor, folder + "/tower.field.json");
}

void showTour(Editor& editor) {
    bool& open = editor.windows.tour;
    if (!open) return;
    const Area& canvas = editor.canvas.view.panel;
    const float em = ImGui::GetFontSize();
    ImGui::SetNextWindowPos({canvas.lo.x + em, canvas.lo.y + em});
    ImGui::SetNextWindowSize({24.0f * em, 0.0f});
    if (!ImGui::Begin("##tour", nullptr,
                      ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNav |
                          ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoSavedSettings |
                          ImGuiWindowFlags_AlwaysAutoResize))
        return ImGui::End();
    const std::size_t done = tourStepsDone(editor.document.graph());
    const std::string keys = keysOf(command("node.add"), editor.files.preferences);
    if (done == kTourSteps) {
        ImGui::TextUnformatted("✓ There is the row of windows");
        ImGui::TextWrapped(
            "%s",
            ("Undo takes back step by step, Save keeps the tower under a name of your "
             "own. " +
             keysOf(command("help.find"), editor.files.preferences) + " finds every command, " +
             keysOf(command("help.node"), editor.files.preferences) + " explains the node under the mouse.")
                .c_str());
    } else {
        const Step& step = kSteps[done];
        ImGui::TextDisabled("%zu of %zu", done + 1, kTourSteps);
        ImGui::SameLine();
        ImGui::TextUnformatted(step.title);
        std::string text = step.text;
        if (const auto at = text.find("KEY"); at != std::string::npos)
            text.replace(at, 3, keys.substr(0, keys.find(' ')));
        ImGui::TextWrapped("%s", text.c_str());
    }
    if (ImGui::SmallButton(done == kTourSteps ? "End" : "Skip the tour")) open = false;
    ImGui::End();
}

}  // namespace fw::editor
