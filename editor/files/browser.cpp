#include "editor/files/browser.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

#include "editor/shell/fonts.h"
#include "editor/shell/letters.h"
#include "editor/shell/theme.h"
#include "graph/base/words.h"

namespace fw::editor {

namespace {

namespace fs = std::filesystem;

/// What the window is called, what its button says, and what is typed in it: by the kind.
struct Words {
    const char *title, *button, *hint;
};
constexpr Words kWords[] = {{"Open###files", "Open", "name of a file or a folder"},
                            {"Save as###files", "Save", "name of the file"},
                            {"Choose a folder###files", "Choose", "name of a folder in this one, or none"}};

bool isFolder(const std::string& path) {
    std::error_code error;
    return fs::is_directory(path, error);
}
bool exists(const std::string& path) {
    std::error_code error;
    return fs::exists(path, error);
}

/// Absolute and without "..".
std::string plain(const fs::path& path) {
    std::error_code error;
    std::string text = fs::absolute(path, error).lexically_normal().string();
    if (text.size() > 1 && text.ends_with('/')) text.pop_back();
    return text;
}

/// Each part of the folder's path, a button that leads there.
void showPath(FileBrowser& browser) {
    std::string there;
    const fs::path path = browser.folder;
    int id = 0;
    for (const fs::path& part : path) {
        there = there.empty() || there == "/" ? there + part.string() : there + "/" + part.string();
        ImGui::PushID(id++);
        wantGlyphs(part.string());
        const float width = ImGui::CalcTextSize(part.string().c_str()).x;
        if (id > 1) besideIfFits(width + 2.0f * ImGui::GetStyle().FramePadding.x);
        if (ImGui::SmallButton(part.string().c_str())) {
            enter(browser, there);
            ImGui::PopID();
            return;
        }
        ImGui::PopID();
    }
}

/// The list; whether an entry was double-clicked or confirmed by Enter.
bool showEntries(FileBrowser& browser, float height) {
    bool confirmed = false;
    std::string go;
    ImGui::BeginChild("##entries", {0, height}, true);
    if (browser.folder != "/" && ImGui::Selectable("..")) go = "..";
    const FolderEntry* begun = browser.kind == FileBrowser::Kind::open ? onlyBegunSo(browser) : nullptr;
    for (const FolderEntry& entry : browser.entries) {
        wantGlyphs(entry.name);
        const std::string label = (entry.folder ? "▸ " : "   ") + entry.name;
        if (ImGui::Selectable(label.c_str(), entry.name == browser.name || &entry == begun,
                              ImGuiSelectableFlags_AllowDoubleClick | ImGuiSelectableFlags_DontClosePopups)) {
            const bool byKey = !ImGui::IsMouseReleased(0) && !ImGui::IsMouseClicked(0);
            if (entry.folder && (byKey || ImGui::IsMouseDoubleClicked(0))) go = entry.name;
            if (!entry.folder) {
                browser.name = entry.name;
                browser.problem.clear();
                confirmed = byKey || ImGui::IsMouseDoubleClicked(0);
            }
        }
    }
    ImGui::EndChild();
    if (!go.empty()) enter(browser, go);
    return confirmed;
}

}  // namespace

std::vector<FolderEntry> listFolder(const std::string& folder, std::span<const std::string> endings,
                                    std::string& problem) {
    std::vector<FolderEntry> entries;
    std::error_code error;
    fs::directory_iterator each(folder, error);
    problem = error ? "this folder cannot be read: " + error.message() : std::string();
    for (; !error && each != fs::directory_iterator(); each.increment(error)) {
        const std::string name = each->path().filename().string();
        std::error_code none;
        const bool isDirectory = each->is_directory(none);
        const auto ends = [low = lowered(name)](const std::string& ending) { return low.ends_with(ending); };
        if (name.starts_with('.') || (!isDirectory && std::ranges::none_of(endings, ends))) continue;
        entries.push_back({name, isDirectory});
    }
    std::ranges::sort(entries, [](const FolderEntry& a, const FolderEntry& b) {
        if (a.folder != b.folder) return a.folder;
        return std::pair(lowered(a.name), a.name) < std::pair(lowered(b.name), b.name);
    });
    return entries;
}

const FolderEntry* onlyBegunSo(const FileBrowser& browser) {
    const std::string typed = lowered(browser.name);
    const FolderEntry* found = nullptr;
    for (const FolderEntry& entry : browser.entries)
        if (!typed.empty() && lowered(entry.name).starts_with(typed)) {
            if (found) return nullptr;
            found = &entry;
        }
    return found;
}

void open(FileBrowser& browser, FileBrowser::Kind kind, const std::string& path) {
    browser.kind = kind;
    browser.name.clear();
    if (path.empty()) {
        enter(browser, browser.folder.empty() ? plain(".") : browser.folder);
    } else if (isFolder(path)) {
        enter(browser, plain(path));
    } else {
        const fs::path full = plain(path);
        enter(browser, full.parent_path().string());
        browser.name = full.filename().string();
    }
    browser.opening = true;
}

void enter(FileBrowser& browser, const std::string& folder) {
    const bool up = folder == "..";
    browser.folder = plain(fs::path(browser.folder) / folder);
    browser.entries = listFolder(browser.folder, browser.endings, browser.problem);
    browser.asking = false;
    if (up || browser.kind == FileBrowser::Kind::open) browser.name.clear();
    browser.fresh = true;
}

std::optional<std::string> choose(FileBrowser& browser) {
    browser.problem.clear();
    const bool folders = browser.kind == FileBrowser::Kind::folder;
    if (browser.name.empty()) {
        if (folders) return browser.folder;
        browser.problem = "choose a file or type its name";
        return std::nullopt;
    }
    std::string path = plain(fs::path(browser.folder) / browser.name);
    if (isFolder(path)) {
        enter(browser, path);
        browser.name.clear();
        return std::nullopt;
    }
    if (browser.kind == FileBrowser::Kind::open) {
        for (const std::string& ending : browser.endings)
            if (!exists(path) && exists(path + ending)) path += ending;
        if (exists(path)) return path;
        const FolderEntry* begun = onlyBegunSo(browser);
        if (begun && begun->folder) return enter(browser, begun->name), std::nullopt;
        if (begun) return plain(fs::path(browser.folder) / begun->name);
        browser.problem = "there is no such file here";
        return std::nullopt;
    }
    if (!folders && !lowered(path).ends_with(browser.endings.front())) path += browser.endings.front();
    if (!isFolder(fs::path(path).parent_path().string())) {
        browser.problem = "there is no such folder";
    } else if (folders && exists(path)) {
        browser.problem = "this is a file";
    } else if (exists(path) && !std::exchange(browser.asking, true)) {
        browser.name = fs::path(path).filename().string();
    } else {
        browser.asking = false;
        return path;
    }
    return std::nullopt;
}

std::optional<std::string> show(FileBrowser& browser, float scale) {
    const Words& words = kWords[std::size_t(browser.kind)];
    const char* title = words.title;
    if (std::exchange(browser.opening, false)) {
        ImGui::OpenPopup(title);
        browser.fresh = true;
    }
    const ImVec2 whole = ImGui::GetMainViewport()->Size;
    ImGui::SetNextWindowSize(
        {std::min(640.0f * scale, whole.x * 0.95f), std::min(480.0f * scale, whole.y * 0.95f)},
        ImGuiCond_Appearing);
    ImGui::SetNextWindowPos({0.5f * whole.x, 0.5f * whole.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
    bool stays = true;
    if (!ImGui::BeginPopupModal(title, &stays, ImGuiWindowFlags_NoSavedSettings)) return std::nullopt;
    showPath(browser);
    const float line = ImGui::GetFrameHeightWithSpacing();
    const bool asked = browser.asking;
    bool confirmed = showEntries(browser, -2.0f * line - ImGui::GetTextLineHeightWithSpacing());

    if (std::exchange(browser.fresh, false)) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-1);
    const std::string before = browser.name;
    confirmed |=
        ImGui::InputTextWithHint("##name", words.hint, &browser.name,
                                 ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    if (browser.name != before) browser.asking = false, browser.problem.clear();
    if (browser.asking)
        ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(themeColor(ThemeColor::warning)),
                           "%s exists. Replace it?", browser.name.c_str());
    else
        ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(themeColor(ThemeColor::error)), "%s",
                           browser.problem.c_str());
    const char* label = browser.asking ? "Replace" : words.button;
    confirmed |= ImGui::Button(label, {100 * scale, 0});
    ImGui::SameLine();
    const bool cancelled = ImGui::Button("Cancel", {100 * scale, 0}) ||
                           (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)) && !asked);
    if (asked && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) browser.asking = false;

    std::optional<std::string> chosen;
    if (confirmed) chosen = choose(browser);
    if (browser.asking != asked && browser.asking) browser.fresh = true;  // Enter again says yes
    if (chosen || cancelled) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    return chosen;
}

}  // namespace fw::editor
