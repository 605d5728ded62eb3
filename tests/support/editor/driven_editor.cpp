#include "tests/support/editor/driven_editor.h"

#include <cmath>
#include <cstdlib>

namespace fw::editor::test {

namespace {

std::string pixelsOf(ImVec2 at) {
    return std::to_string(std::lround(at.x)) + " " + std::to_string(std::lround(at.y));
}

/// The questions at the end are answered when the display has done, and handed on, all before them.
void hand(const std::string& words) {
    const fw::test::ProgramResult sent =
        fw::test::runProgram("xdotool " + words + " getmouselocation getmouselocation");
    EXPECT_EQ(sent.status, 0) << sent.output;
    fw::test::rest(0.02);
}

}  // namespace

DrivenEditor::DrivenEditor(Graph graph, int width, int height) : display(width, height) {
    if (!display.works() || fw::test::runProgram("xdotool version").status != 0) return;
    for (const char* variable : {"XDG_CONFIG_HOME", "XDG_STATE_HOME", "XDG_DATA_HOME"})
        setenv(variable, folder.path(variable).c_str(), 1);
    shell.emplace(ShellOptions{.width = width, .height = height, .scale = 1.0f});
    it.emplace(*shell, std::move(graph), DeviceOptions{});
    startFiles(*it);
    settle();
    moveAway();
}

DrivenEditor::~DrivenEditor() {
    it.reset();
    shell.reset();
    for (const char* variable : {"XDG_CONFIG_HOME", "XDG_STATE_HOME", "XDG_DATA_HOME"}) unsetenv(variable);
}

void DrivenEditor::settle() {
    constexpr int kLeastFrames = 3, kMostFrames = 1000;
    for (int frame = 0; frame < kMostFrames && (shell->waitEvents(0.0) || frame < kLeastFrames); ++frame)
        shell->frame([&] { showEditor(*it); });
}

void DrivenEditor::send(const std::string& words) {
    hand(words);
    settle();
}

void DrivenEditor::during(const std::string& words) {
    hand(words);
    for (int frame = 0; frame < 4; ++frame) {
        shell->waitEvents(0.0);
        shell->frame([&] { showEditor(*it); });
    }
}

void DrivenEditor::moveTo(ImVec2 pixels) { send("mousemove " + pixelsOf(pixels)); }
void DrivenEditor::moveAway() {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    moveTo({size.x - 2, size.y - 2});
}
// xdotool would rest behind a click.
void DrivenEditor::click(ImVec2 pixels) { send("mousemove " + pixelsOf(pixels) + " click --delay 0 1"); }

void DrivenEditor::drag(ImVec2 from, ImVec2 to) {
    const ImVec2 half(0.5f * (from.x + to.x), 0.5f * (from.y + to.y));
    // A gesture goes on as long as the button is held: frames are made between its parts.
    for (const std::string& part : {"mousemove " + pixelsOf(from) + " mousedown 1",
                                    "mousemove " + pixelsOf(half), "mousemove " + pixelsOf(to)})
        during(part);
    send("mouseup 1");
}

void DrivenEditor::waitForPicture() { waitForPicture(false); }
void DrivenEditor::waitForBestPicture() { waitForPicture(true); }

void DrivenEditor::waitForPicture(bool best) {
    constexpr double kLongest = 120.0;  // seconds
    for (double waited = 0; waited < kLongest; waited += 0.02) {
        const bool fresh = exchange(*it);
        if (shell->waitEvents(0.0) || fresh) shell->frame([&] { showEditor(*it); });
        if (it->viewport.shown.revision == it->document.revision() && !(best && it->preview.busy())) break;
        fw::test::rest(0.02);
    }
    settle();
}

ImVec2 DrivenEditor::title(const std::string& node) const {
    const NodeBox* box = it->boxes->find(node);
    return box ? it->canvas.view.toScreen(ImVec2(box->area.centre().x, box->area.lo.y + 0.5f * kTitleHeight))
               : ImVec2();
}

ImVec2 DrivenEditor::socket(const std::string& node, const std::string& name, bool output) const {
    const Row* row = it->boxes->row({node, name}, output);
    return row ? it->canvas.view.toScreen(it->boxes->find(node)->socket(*row)) : ImVec2();
}

ImVec2 DrivenEditor::field(const std::string& node, const std::string& name, int component) const {
    const Row* row = it->boxes->row({node, name}, false);
    return row ? it->canvas.view.toScreen(it->boxes->find(node)->field(*row, component).centre()) : ImVec2();
}

}  // namespace fw::editor::test
