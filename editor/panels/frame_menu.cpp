// A comment frame's words and colour, and its removal: opened by a double click on its title.
#include "editor/panels/properties.h"

namespace fw::editor {

namespace {

constexpr std::array<double, 3> kGrey = {0.5, 0.5, 0.5};

void set(Editor& editor, const std::string& name, const std::optional<Frame>& frame) {
    editor.document.apply(name, setFrame(editor.document.graph(), editor.frameMenu.index, frame));
}

void showColor(Editor& editor, Frame frame) {
    const std::array<double, 3> color = frame.color.value_or(kGrey);
    float shown[3] = {float(color[0]), float(color[1]), float(color[2])};
    Touched touched;
    touched.changed =
        ImGui::ColorEdit3("##color", shown, ImGuiColorEditFlags_DisplayRGB | ImGuiColorEditFlags_DisplayHex);
    touched.active = ImGui::IsItemActive() || (touched.changed && ImGui::IsMouseDown(0));
    frame.color = {double(shown[0]), double(shown[1]), double(shown[2])};
    follow(editor, "##color", touched, "Set Frame Colour",
           [&] { return setFrame(editor.document.graph(), editor.frameMenu.index, frame); });
}

}  // namespace

void showFrameMenu(Editor& editor) {
    FrameMenu& menu = editor.frameMenu;
    const bool opened = std::exchange(menu.opened, false);
    if (opened) ImGui::OpenPopup("##frame");
    if (!ImGui::BeginPopup("##frame")) return;
    const std::vector<Frame>& frames = editor.boxes->frames;
    if (menu.index >= frames.size()) {
        ImGui::CloseCurrentPopup();
        return ImGui::EndPopup();
    }
    const Frame& frame = frames[menu.index];
    if (opened) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(18.0f * ImGui::GetFontSize());
    editText(editor, "##text", frame.text, "What the nodes in it do",
             [index = menu.index](Editor& e, const std::string& text) {
                 Frame named = e.boxes->frames.at(index);
                 named.text = text;
                 e.document.apply("Name Frame", setFrame(e.document.graph(), index, named));
             });
    ImGui::SetNextItemWidth(18.0f * ImGui::GetFontSize());
    showColor(editor, frame);
    const bool plain = frame.color && ImGui::Button("Grey");
    if (frame.color) ImGui::SameLine();
    const bool removed = ImGui::Button("Remove frame");
    if (removed || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter))) ImGui::CloseCurrentPopup();
    if (plain) {
        Frame grey = frame;
        grey.color.reset();
        set(editor, "Set Frame Colour", grey);
    } else if (removed) {
        set(editor, "Remove Frame", std::nullopt);
    }
    ImGui::EndPopup();
}

}  // namespace fw::editor
