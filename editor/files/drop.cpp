#include "editor/files/drop.h"

#include <cctype>
#include <filesystem>

#include "editor/document/file_nodes.h"
#include "editor/editor.h"
#include "editor/files/assets.h"
#include "graph/base/words.h"
#include "graph/document/json.h"
#include "graph/document/json_tokens.h"
#include "graph/implicit3mf/import.h"
#include "runtime/files/import_graph.h"

namespace fw::editor {

namespace {

namespace fs = std::filesystem;

std::string nameOf(const fs::path& file) { return file.filename().string(); }

/// Or of another program, to be made one.
bool isGraph(const std::string& file) { return lowered(file).ends_with(kGraphEnding) || isImported(file); }

/// "a mesh (.glb, .gltf)" of each kind that has a node.
std::string whatCanBeDropped() {
    std::string text;
    for (const FileKind* kind : fileKindsOfNodes()) {
        text += "a " + std::string(kind->noun) + " (";
        for (const std::string_view ending : kind->endings)
            text += (ending == kind->endings.front() ? "" : ", ") + std::string(ending);
        text += "), ";
    }
    return text + "or a graph (" + std::string(kGraphEnding) + ", or an implicit " + std::string(k3mfEnding) +
           ")";
}

/// Where the nodes of these files go: to the mouse over the canvas, else into the middle of what is seen, or
/// beside the nodes that are seen there if these would be covered and there is room.
Position placeFor(const Editor& editor, ImVec2 mouse, const std::vector<std::string>& files) {
    const CanvasView& view = editor.canvas.view;
    if (view.panel.contains(mouse)) return position(view.toCanvas(mouse));
    constexpr float kAside = 40.0f;
    const Position size = sizeOfFileNodes(files);
    const float wide = float(size[0]), high = float(size[1]);
    const Area seen = view.seen();
    const ImVec2 centre = seen.centre(), middle(centre.x - 0.5f * wide, centre.y - 0.5f * high);
    const auto covered = [&](ImVec2 at) { return Area{at, {at.x + wide, at.y + high}}; };
    std::optional<Area> nodes;
    bool free = true;
    for (const NodeBox& box : editor.boxes->nodes) {
        if (!box.area.overlaps(seen)) continue;
        nodes ? nodes->add(box.area) : void(nodes = box.area);
        free = free && !box.area.overlaps(covered(middle));
    }
    if (free) return position(middle);
    for (const ImVec2 at :
         {ImVec2(nodes->lo.x - kAside - wide, middle.y), ImVec2(middle.x, nodes->hi.y + kAside),
          ImVec2(middle.x, nodes->lo.y - kAside - high), ImVec2(nodes->hi.x + kAside, middle.y)})
        if (seen.contains(at) && seen.contains(covered(at).hi)) return position(at);
    return position(middle);
}

}  // namespace

Result<std::string> bringToDocument(const Editor& editor, const std::string& file, const FileKind& kind,
                                    std::vector<std::string>& told) {
    const std::string name = nameOf(file);
    if (firstBadByte(file) != std::string::npos)
        return Error{.message = "a file's name that is not UTF-8 cannot be in a graph: rename it"};
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return Error{.message = name + " is no ordinary file"};
    if (fs::file_size(file, error) > kind.mostBytes)
        return Error{.message = name + " has more than " + std::to_string(kind.mostBytes >> 20) +
                                " MiB: take a smaller " + std::string(kind.noun)};
    if (kind.apart) {
        const std::string within = fs::path(file).lexically_relative(workFolder(editor)).generic_string();
        return within.empty() || within.starts_with("..") ? file : within;
    }
    const Result<BroughtFile> brought = bringFile(workFolder(editor), file, name, kind);
    if (!brought) return brought.error();
    if (brought->how == BroughtFile::How::copied)
        told.push_back(
            "copied " + name + " beside the document" +
            (brought->path == name ? "" : ", as " + brought->path + " since there is another of its name"));
    if (brought->how == BroughtFile::How::same)
        told.push_back("took the " + brought->path + " that is beside the document: it is the same");
    return brought->path;
}

void drop(Editor& editor, const std::vector<std::string>& files) {
    if (ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup))
        return say(editor,
                   "nothing was done with what was dropped: close the window that asks, and drop it again");
    if (files.size() == 1 && isGraph(files[0])) return openFile(editor, files[0]);
    DroppedFiles known;
    std::vector<std::string> others;
    for (const std::string& file : files) (fileInputFor(file) ? known.files : others).push_back(file);
    if (!others.empty())
        return say(editor,
                   isGraph(others[0])
                       ? "nothing was done with what was dropped: drop one graph by itself to open it"
                       : nameOf(others[0]) + " cannot be dropped here: what can is " + whatCanBeDropped());
    if (known.files.empty()) return;
    // The window system moves the mouse while it drags.
    known.at = placeFor(editor, ImGui::GetMousePos(), known.files);
    if (!editor.document.graph().path.empty() && editor.files.origin != Files::Origin::sample)
        return addDropped(editor, known);
    say(editor, "save the document first: a graph reads files from its own folder");
    editor.files.dropped = std::move(known);
    editor.files.next = Files::Next::drop;
    save(editor);
}

void addDropped(Editor& editor, const DroppedFiles& dropped) {
    std::vector<std::string> told, paths;
    for (const std::string& file : dropped.files) {
        Result<std::string> path = bringToDocument(editor, file, *fileInputFor(file)->input->file, told);
        if (path)
            paths.push_back(std::move(*path));
        else
            told.push_back(path.error().message);
    }
    if (!paths.empty()) {
        Edited edited = addFileNodes(editor.document.graph(), editor.canvas.scope, paths, dropped.at);
        if (edited.nodes.size() < fileNodeCount(paths))
            told.push_back("the graph has no room for more nodes");
        apply(editor, paths.size() == 1 ? "Add File" : "Add Files", std::move(edited));
        editor.panels.next = Part::canvas;
    }
    if (!told.empty()) say(editor, joined(told));
}

}  // namespace fw::editor
