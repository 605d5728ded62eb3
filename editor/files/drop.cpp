#include "editor/files/drop.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>

#include "editor/document/meshes.h"
#include "editor/editor.h"
#include "graph/assets/triangle_mesh.h"
#include "graph/document/json_tokens.h"

namespace fw::editor {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kGraphEnding = ".field.json";
constexpr std::string_view kMeshEndings[] = {".glb", ".gltf", ".obj", ".stl", ".ply"};

std::string nameOf(const fs::path& file) { return file.filename().string(); }

std::string lower(std::string text) {
    for (char& each : text) each = char(std::tolower(static_cast<unsigned char>(each)));
    return text;
}

bool isMesh(const std::string& file) {
    return std::ranges::count(kMeshEndings, lower(fs::path(file).extension().string())) > 0;
}
bool isGraph(const std::string& file) { return lower(file).ends_with(kGraphEnding); }

bool sameContent(const fs::path& a, const fs::path& b) {
    std::error_code error;
    const auto size = fs::file_size(a, error);
    if (error || size != fs::file_size(b, error) || error) return false;
    std::ifstream one(a, std::ios::binary), other(b, std::ios::binary);
    std::vector<char> left(1u << 20), right(left.size());
    while (one && other) {
        one.read(left.data(), std::streamsize(left.size()));
        other.read(right.data(), std::streamsize(right.size()));
        if (one.gcount() != other.gcount() ||
            !std::equal(left.begin(), left.begin() + one.gcount(), right.begin()))
            return false;
    }
    return one.eof() && other.eof();
}

/// From the folder to the file, symbolic links followed; empty if that is not in the folder's tree.
std::string pathWithin(const fs::path& folder, const fs::path& file) {
    std::error_code error;
    const fs::path root = fs::weakly_canonical(folder, error), real = fs::weakly_canonical(file, error);
    const fs::path inside = real.lexically_relative(root);
    return inside.empty() || *inside.begin() == ".." ? std::string() : inside.generic_string();
}

/// A copy of the file in the folder, or one that is there already: the name of it. What was done goes to
/// `told`.
Result<std::string> copied(const fs::path& folder, const fs::path& file, std::vector<std::string>& told) {
    const std::string wanted = nameOf(file);
    std::error_code error;
    std::string name = wanted;
    for (int i = 2; fs::exists(fs::symlink_status(folder / name, error)); ++i) {
        if (pathWithin(folder, folder / name) == name && sameContent(folder / name, file)) {
            told.push_back("took the " + name + " that is beside the document: it is the same");
            return name;
        }
        name = file.stem().string() + "-" + std::to_string(i) + file.extension().string();
    }
    if (!fs::copy_file(file, folder / name, error)) {
        const std::string why = error.message();
        if (error != std::errc::file_exists) fs::remove(folder / name, error);  // what there was room for
        return Error{.message = wanted + " cannot be copied to " + folder.string() + ": " + why};
    }
    told.push_back("copied " + wanted + " beside the document" +
                   (name == wanted ? "" : ", as " + name + " since there is another of its name"));
    return name;
}

/// The path of the mesh from the document's folder on, the file brought there if need be.
Result<std::string> bring(const fs::path& folder, const std::string& file, std::vector<std::string>& told) {
    const std::string name = nameOf(file);
    if (firstBadByte(file) != std::string::npos)
        return Error{.message = "a file's name that is not UTF-8 cannot be in a graph: rename it"};
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return Error{.message = name + " is no ordinary file"};
    if (fs::file_size(file, error) > kMostMeshFileBytes)
        return Error{.message = name + " has more than " + std::to_string(kMostMeshFileBytes >> 20) +
                                " MiB: drop a smaller mesh"};
    if (std::string path = pathWithin(folder, file); !path.empty()) return path;
    if (lower(name).ends_with(".gltf"))
        return Error{.message =
                         name +
                         " lies elsewhere and refers to other files: drop a .glb, which has all in one, "
                         "or move it with them to the document's folder"};
    return copied(folder, file, told);
}

/// Where nodes of `count` meshes go: to the mouse over the canvas, else into the middle of what is seen, or
/// beside the nodes that are seen there if these would be covered and there is room.
Position placeFor(const Editor& editor, ImVec2 mouse, std::size_t count) {
    const CanvasView& view = editor.canvas.view;
    if (view.panel.contains(mouse)) return position(view.toCanvas(mouse));
    constexpr float kAside = 40.0f;
    const Position size = sizeOfMeshPairs(count);
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

std::string joined(const std::vector<std::string>& words) {
    std::string all;
    for (const std::string& each : words) all += (all.empty() ? "" : "; ") + each;
    return all;
}

}  // namespace

void drop(Editor& editor, const std::vector<std::string>& files) {
    if (ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup))
        return say(editor,
                   "nothing was done with what was dropped: close the window that asks, and drop it again");
    if (files.size() == 1 && isGraph(files[0])) return proceed(editor, Files::Next::open, files[0]);
    DroppedMeshes meshes;
    std::vector<std::string> others;
    for (const std::string& file : files) (isMesh(file) ? meshes.files : others).push_back(file);
    if (!others.empty())
        return say(editor, isGraph(others[0])
                               ? "nothing was done with what was dropped: drop one graph by itself to open it"
                               : nameOf(others[0]) +
                                     " cannot be dropped here: what can are meshes (.glb, .gltf, .obj, "
                                     ".stl, .ply) and a graph (.field.json)");
    if (meshes.files.empty()) return;
    // The window system moves the mouse while it drags.
    meshes.at = placeFor(editor, ImGui::GetMousePos(), meshes.files.size());
    if (!editor.document.graph().path.empty() && editor.files.origin != Files::Origin::sample)
        return addDropped(editor, meshes);
    say(editor, "save the document first: a graph reads meshes from its own folder");
    editor.files.dropped = std::move(meshes);
    editor.files.next = Files::Next::drop;
    save(editor);
}

void addDropped(Editor& editor, const DroppedMeshes& meshes) {
    std::vector<std::string> told, paths;
    for (const std::string& file : meshes.files) {
        Result<std::string> path = bring(workFolder(editor), file, told);
        if (path)
            paths.push_back(std::move(*path));
        else
            told.push_back(path.error().message);
    }
    if (!paths.empty()) {
        Edited edited = addMeshes(editor.document.graph(), editor.canvas.scope, paths, meshes.at);
        if (edited.nodes.size() < 2 * paths.size()) told.push_back("the graph has no room for more nodes");
        apply(editor, paths.size() == 1 ? "Add Mesh" : "Add Meshes", std::move(edited));
        editor.panels.next = Part::canvas;
    }
    if (!told.empty()) say(editor, joined(told));
}

}  // namespace fw::editor
