#include "tests/editor/window/looks.h"

#include <imgui_internal.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "editor/commands.h"
#include "editor/panels/side.h"
#include "graph/document/json.h"

namespace fw::editor::test {

namespace {

constexpr const char* kDocument = R"({
  "fieldwright": 1,
  "nodes": [
    {"id": "plan", "type": "polygon", "at": [0, 0],
     "inputs": {"points": [[-1, -1], [1, -1], [1.4, 0.2], [0, 1], [-1, 0.6]]}},
    {"id": "house", "type": "extrude", "at": [240, 0], "inputs": {"surface": {"from": "plan"}, "half_height": 1.5}},
    {"id": "windows", "type": "expression", "label": "Windows in rows", "at": [180, 220],
     "code": "// Tubes along x and z, four to the metre.\nfloat tube(vec2 c, float r) { return length(c) - r; }\nvec3 c = mod(p, 0.5) - 0.25;\nreturn min(tube(c.xy, width), tube(c.yz, width));",
     "inputs": {"width": 0.15}},
    {"id": "pierced", "type": "subtract", "at": [480, 0],
     "inputs": {"a": {"from": "house"}, "b": {"from": "windows"}, "radius": 0.02}},
    {"id": "stone", "type": "material", "label": "Sandstone", "at": [720, 0],
     "inputs": {"surface": {"from": "pierced"}, "base_color": [0.75, 0.66, 0.55]}},
    {"id": "heron", "type": "mesh_file", "at": [480, 330], "inputs": {"path": "heron.glb"}},
    {"id": "bird", "type": "mesh_to_field", "at": [700, 560], "inputs": {"mesh": {"from": "heron"}}},
    {"id": "both", "type": "union", "at": [960, 0], "inputs": {"a": {"from": "stone"}, "b": {"from": "bird"}}},
    {"id": "out", "type": "output", "at": [1200, 0], "inputs": {"surface": {"from": "both"}, "resolution": 160}}
  ],
  "parameters": [{"name": "cut", "node": "pierced", "input": "radius", "min": 0, "max": 0.2},
    {"name": "height", "node": "house", "input": "half_height", "min": 1, "max": 5}],
  "scene": {"camera": {"position": [6, 4, 6], "target": [0, 1, 0], "fov": 40},
            "lights": [{"type": "spot", "position": [2, 3, 2], "target": [0, 0, 0], "angle": 60, "strength": 40}]},
  "timeline": {
    "length": 8,
    "tracks": [
      {"node": "house", "input": "half_height", "interpolation": "cubic",
       "keys": [{"time": 0, "value": 3}, {"time": 3, "value": 1}, {"time": 8, "value": 3}]},
      {"scene": "camera.position", "interpolation": "cubic",
       "keys": [{"time": 0, "value": [6, 4, 6]}, {"time": 4, "value": [-6, 4, 6]}]}
    ]
  }
})";

void run(Editor& editor, const char* id) { command(id).run(editor); }

/// As the preview would have found them.
void find(Editor& editor) {
    Error wrong, slow;
    wrong.message = "the file 'heron.glb' is not there: choose another one, or put it beside the document";
    wrong.node = "heron", wrong.input = "path";
    slow.severity = Error::Severity::warning;
    slow.message = "the code is no exact distance: surfaces may be found a little late";
    slow.node = "windows";
    editor.viewport.shown.findings = {wrong, slow};
}

void select(Editor& editor, const char* node) {
    editor.canvas.select({node});
    editor.canvas.active = node;
}

void closeAll(Editor& editor) {
    ImGui::GetCurrentContext()->OpenPopupStack.resize(0);
    editor.exporting.open = editor.rendering.open = false;
    editor.windows.reference.open = editor.windows.tour = false;
    editor.code.large = editor.outline.open = editor.panels.timeline = false;
    editor.files.message = {};
    editor.files.versions.clear();
    editor.files.left.clear();
    editor.files.offers = false;
    editor.files.next = Files::Next::none;
    editor.files.outside.reset();
    editor.windows.start.open = false;
    editor.viewport.ownCamera = false;
    editor.viewport.pinned.clear();
    splitInto(editor, 1);
    select(editor, "pierced");
    showPanel(editor, "inspector");
}

std::vector<Sample> someSamples() {
    return {{"/samples/tower.field.json", "Tower"},
            {"/samples/goblet.field.json", "Goblet"},
            {"/samples/gyroid_sphere.field.json", "Gyroid sphere"}};
}

constexpr const char* kSide = "##side";
constexpr const char* kPopup = "a popup";  // whichever is open

}  // namespace

std::vector<Look> looks() {
    return {
        {"main", "", [](Editor&) {}},
        {"views", "",
         [](Editor& e) {  // all buttons that the picture can have
             e.viewport.takeCamera();
             e.viewport.pinned = "pierced + windows";
             run(e, "view.four_pictures");
         }},
        {"inspector", kSide, [](Editor& e) { select(e, "stone"); }},
        {"inspector_code", kSide, [](Editor& e) { select(e, "windows"); }},
        {"outliner", kSide, [](Editor& e) { showPanel(e, "outliner"); }},
        {"problems", kSide, [](Editor& e) { showPanel(e, "problems"); }},
        {"parameters", kSide, [](Editor& e) { showPanel(e, "parameters"); }},
        {"scene", kSide, [](Editor& e) { showPanel(e, "scene"); }},
        {"statistics", kSide, [](Editor& e) { showPanel(e, "statistics"); }},
        {"history", kSide, [](Editor& e) { showPanel(e, "history"); }},
        {"library", kSide, [](Editor& e) { showPanel(e, "library"); }},
        {"timeline", "##timeline", [](Editor& e) { e.panels.timeline = true; }},
        {"curves", "##timeline",
         [](Editor& e) {
             e.panels.timeline = true;
             e.panelState.timelinePanel.curves = true;
         }},
        {"export", "Export", [](Editor& e) { run(e, "file.export"); }},
        {"render", "Render", [](Editor& e) { run(e, "file.render"); }},
        {"preferences", "Preferences", [](Editor& e) { run(e, "edit.preferences"); }},
        {"missing", "Missing files", [](Editor& e) { run(e, "file.missing"); }},
        {"shortcuts", "Shortcuts", [](Editor& e) { run(e, "help.shortcuts"); }},
        {"reference", "Node reference", [](Editor& e) { run(e, "help.node"); }},
        {"add_menu", kPopup, [](Editor& e) { run(e, "node.add"); }},
        {"palette", kPopup, [](Editor& e) { run(e, "help.find"); }},
        {"tour", "##tour", [](Editor& e) { e.windows.tour = true; }},
        {"samples", "Samples",
         [](Editor& e) {  // no pictures, which come when they like
             e.files.samples.all = someSamples();
             e.files.samples.textures.assign(e.files.samples.all.size(), nullptr);
             e.files.samples.opening = true;
         }},
        {"start", "##start",
         [](Editor& e) {
             take(e, Graph());
             e.files.preferences.recent = {
                 "/home/ada/houses/Watch tower.field.json",
                 "/home/ada/a folder with a long name/and one in it/Bridge.field.json"};
             e.windows.start.looked = true;
             e.windows.start.samples = someSamples();
             e.windows.start.textures.assign(e.windows.start.samples.size(), nullptr);
             e.windows.start.open = true;
         }},
        {"code", "###code_window",
         [](Editor& e) {
             select(e, "windows");
             e.code.large = true;
         }},
        {"outline", "###outline",
         [](Editor& e) {
             select(e, "plan");
             openOutline(e, "plan", "points");
         }},
        {"open", "###files", [](Editor& e) { run(e, "file.open"); }},
        {"question", "Unsaved changes", [](Editor& e) { e.files.asks = true; }},
        {"message", "###message",
         [](Editor& e) {
             e.files.message = {"Parts were left out",
                                "The file opens without them:", e.viewport.shown.findings, true};
         }},
        {"about", "About Fieldwright", [](Editor& e) { run(e, "help.about"); }},
    };
}

Graph graphOfLooks() {
    Result<Graph> graph = parseGraph(kDocument, "", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    return graph ? *graph : Graph();
}

void show(DrivenEditor& driven, const Look& look) {
    Editor& editor = *driven;
    if (editor.document.graph().nodes.empty()) take(editor, graphOfLooks());
    closeAll(editor);
    find(editor);
    editor.panelState.timelinePanel.curves = false;
    editor.canvas.frameNext = true;
    const auto frame = [&] {
        editor.shell.waitEvents(0.0);
        editor.shell.answer([&] { showEditor(editor); });
    };
    frame();
    look.open(editor);
    for (int i = 0; i < 4; ++i) frame();
}

void resize(DrivenEditor& driven, int width, int height, float scale) {
    Shell& shell = driven->shell;
    shell.resize(width, height);
    shell.setScale(scale);
    for (int i = 0; i < 500; ++i) {
        shell.waitEvents(0.0);
        int w = 0, h = 0;
        glfwGetFramebufferSize(shell.window(), &w, &h);
        if (w == width && h == height) return;
        fw::test::rest(0.01);
    }
    ADD_FAILURE() << "the window does not become " << width << " by " << height;
}

Area placeOf(const Look& look) {
    const std::string wanted = look.window;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    if (wanted.empty()) return {{0, 0}, size};
    const ImGuiContext& context = *ImGui::GetCurrentContext();
    for (const ImGuiWindow* window : context.Windows) {
        const std::string name = window->Name;
        const bool is = wanted == kPopup ? !context.OpenPopupStack.empty() &&
                                               context.OpenPopupStack.back().Window == window
                                         : name.find(wanted) != std::string::npos;
        if (!window->Active || !is) continue;
        const ImRect rect = window->Rect();
        return {{std::max(rect.Min.x, 0.0f), std::max(rect.Min.y, 0.0f)},
                {std::min(rect.Max.x, size.x), std::min(rect.Max.y, size.y)}};
    }
    ADD_FAILURE() << "there is no window " << wanted;
    return {};
}

namespace {

/// Whether the window belongs to what is looked at. Tabs are scrolled, and so are lines of code.
bool countsFor(const Look& look, const std::string& window) {
    const std::string wanted = look.window;
    for (const char* scrolled : {"##lines"})
        if (window.find(scrolled) != std::string::npos) return false;
    const auto side = window.find(kSide);
    if (wanted == kSide) return side != std::string::npos && window.find('/', side) != std::string::npos;
    if (wanted.empty()) return side == std::string::npos;
    if (wanted == kPopup) return window.starts_with("##Popup");
    return window.find(wanted) != std::string::npos;
}

}  // namespace

std::vector<std::string> cutTexts(const Look& look) {
    using Corner = std::tuple<float, float, float, float>;  // of the atlas
    const ImGuiIO& io = ImGui::GetIO();
    static std::map<Corner, unsigned> whole;
    static std::vector<std::pair<Corner, unsigned>> all;
    static std::pair<float, std::size_t> baked;  // the fonts that these are of
    std::pair<float, std::size_t> now{ImGui::GetFontSize(), 0};
    for (const ImFont* font : io.Fonts->Fonts) now.second += std::size_t(font->Glyphs.Size);
    if (std::exchange(baked, now) != now) {
        whole.clear();
        for (const ImFont* font : io.Fonts->Fonts)
            for (const ImFontGlyph& glyph : font->Glyphs)
                if (glyph.Visible) whole[{glyph.U0, glyph.V0, glyph.U1, glyph.V1}] = glyph.Codepoint;
        all.assign(whole.begin(), whole.end());
    }
    const auto glyphAt = [&](float u, float v) {
        for (const auto& [corner, code] : all) {
            const auto& [u0, v0, u1, v1] = corner;
            if (u >= u0 && u <= u1 && v >= v0 && v <= v1) return code;
        }
        return 0u;
    };
    std::vector<std::string> cut;
    const ImDrawData& data = *ImGui::GetDrawData();
    for (int l = 0; l < data.CmdListsCount; ++l) {
        const ImDrawList& list = *data.CmdLists[l];
        const std::string owner = list._OwnerName ? list._OwnerName : "";
        if (!countsFor(look, owner)) continue;
        const bool canvas = owner.find("##canvas") != std::string::npos;  // nodes may lie across its rim
        std::string line;                                                 // of the glyphs one after the other
        float lineY = -1e9f, lineX = 0.0f;
        bool lineCut = false;
        const auto end = [&] {
            if (lineCut) cut.push_back(owner + ": " + line);
            line.clear();
            lineCut = false;
        };
        for (const ImDrawCmd& command : list.CmdBuffer) {
            if (command.UserCallback || command.GetTexID() != io.Fonts->TexID) continue;
            for (unsigned i = 0; i + 5 < command.ElemCount; i += 3) {
                const ImDrawIdx* index = &list.IdxBuffer[int(command.IdxOffset + i)];
                if (index[3] != index[0] || index[4] != index[2]) continue;
                const auto at = [&](int n) -> const ImDrawVert& {
                    return list.VtxBuffer[int(command.VtxOffset + index[n])];
                };
                const ImDrawVert &a = at(0), &c = at(2);
                if (a.uv.x == c.uv.x || a.uv.y == c.uv.y) continue;
                i += 3;  // the other triangle of it
                const auto known = whole.find({a.uv.x, a.uv.y, c.uv.x, c.uv.y});
                unsigned code = known != whole.end() ? known->second : 0;
                bool half = false;
                if (!code) {
                    code = glyphAt(0.5f * (a.uv.x + c.uv.x), 0.5f * (a.uv.y + c.uv.y));
                    if (!code) continue;  // no text
                    for (const auto& [corner, of] : all) {
                        const auto& [u0, v0, u1, v1] = corner;
                        if (of == code && a.uv.x >= u0 && c.uv.x <= u1 && a.uv.y >= v0 && c.uv.y <= v1)
                            half = half || a.uv.x > u0 || c.uv.x < u1;
                    }
                }
                const ImVec4& clip = command.ClipRect;
                const float middle = 0.5f * (a.pos.y + c.pos.y);
                if (middle < clip.y || middle > clip.w) continue;  // scrolled away
                const float kSlack =
                    std::max(1.01f, 0.08f * ImGui::GetFontSize());  // glyphs reach beyond their box
                half = half || (!canvas && (a.pos.x < clip.x - kSlack || c.pos.x > clip.z + kSlack));
                if (std::abs(middle - lineY) > 0.6f * ImGui::GetFontSize() ||
                    std::abs(a.pos.x - lineX) > 1.5f * ImGui::GetFontSize())
                    end();
                lineY = middle, lineX = c.pos.x;
                char letter[5] = {};
                ImTextCharToUtf8(letter, code);
                line += letter;
                lineCut = lineCut || half;
            }
        }
        end();
    }
    return cut;
}

std::vector<std::string> lostWindows(const Look& look) {
    std::vector<std::string> lost;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
        if (!window->Active || window->Hidden || (window->Flags & ImGuiWindowFlags_Tooltip)) continue;
        const ImRect rect = window->Rect();
        const std::string name = window->Name;
        if (!countsFor(look, name)) continue;
        if (!(window->Flags & ImGuiWindowFlags_ChildWindow) &&
            (rect.Min.x < -1 || rect.Min.y < -1 || rect.Max.x > size.x + 1 || rect.Max.y > size.y + 1))
            lost.push_back(name + " reaches out of the screen");
        const bool rows = name.find("##names") != std::string::npos;  // they scroll with those beside them
        if (window->ScrollMax.y > 1.0f && (window->Flags & ImGuiWindowFlags_NoScrollbar) && !rows)
            lost.push_back(name + " is too low for what is in it by " + std::to_string(window->ScrollMax.y));
        if (window->ScrollMax.x > 1.0f && !(window->Flags & ImGuiWindowFlags_HorizontalScrollbar))
            lost.push_back(name + " is too narrow for what is in it by " +
                           std::to_string(window->ScrollMax.x));
    }
    return lost;
}

}  // namespace fw::editor::test
