// The questions about files, each a window that waits for its answer.
#include <algorithm>

#include "editor/editor.h"
#include "editor/files/tabs.h"
#include "editor/shell/letters.h"
#include "editor/shell/theme.h"

namespace fw::editor {

namespace {

using Next = Files::Next;

constexpr const char* kQuestion = "Unsaved changes";
constexpr const char* kOffer = "Recovered work";
constexpr const char* kPartly = "Parts of the file were not read";
constexpr const char* kOutside = "Changed outside";
constexpr const char* kVersions = "Versions";
constexpr const char* kExporting = "Files are being made";
constexpr std::size_t kMostShown = 12;  // problems in a message; the list in the panel has all

/// Enter stands for the first button.
bool confirmed() {
    return ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false) ||
           ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_KeyPadEnter), false);
}

bool escaped() { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)); }

/// In the middle, as wide as its texts are to be.
bool beginQuestion(const Editor& editor, const char* title) {
    const ImVec2 whole = ImGui::GetMainViewport()->Size;
    const float width = std::min(560.0f * editor.shell.scale(), 0.95f * whole.x);
    ImGui::SetNextWindowSizeConstraints({width, 0}, {width, 0.9f * whole.y});
    ImGui::SetNextWindowPos({0.5f * whole.x, 0.45f * whole.y}, ImGuiCond_Always, {0.5f, 0.5f});
    return ImGui::BeginPopupModal(title, nullptr,
                                  ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
}

bool button(const Editor& editor, const char* label) {
    return ImGui::Button(label,
                         {std::max(100.0f * editor.shell.scale(), ImGui::CalcTextSize(label).x + 20), 0});
}

void showQuestion(Editor& editor) {
    Files& files = editor.files;
    if (std::exchange(files.asks, false)) ImGui::OpenPopup(kQuestion);
    if (!beginQuestion(editor, kQuestion)) return;
    ImGui::TextWrapped("Save the changes of %s first?", nameOf(editor).c_str());
    if (button(editor, "Save") || confirmed()) {
        ImGui::CloseCurrentPopup();
        if (save(editor)) doNext(editor);  // else there is another question, and what is next waits
    }
    ImGui::SameLine();
    if (button(editor, "Discard")) {
        ImGui::CloseCurrentPopup();
        // It stays until the editor ends: who is asked about another document may stay after all.
        files.givenUp = files.next == Next::quit;
        doNext(editor);
    }
    ImGui::SameLine();
    if (button(editor, "Cancel") || escaped()) {
        ImGui::CloseCurrentPopup();
        files.next = Next::none;
    }
    ImGui::EndPopup();
}

void showPartly(Editor& editor) {
    Files& files = editor.files;
    if (std::exchange(files.asksPartly, false)) ImGui::OpenPopup(kPartly);
    if (!beginQuestion(editor, kPartly)) return;
    ImGui::TextWrapped(
        "%s holds more than could be read of it, and that is not part of this document. Save under another "
        "name, or replace the file: what it holds now is then kept beside it, as %s.old.",
        nameOf(editor).c_str(), nameOf(editor).c_str());
    const Next next = files.next;
    if (button(editor, "Save as …") || confirmed()) {
        ImGui::CloseCurrentPopup();
        saveAs(editor);
        files.next = next;
    }
    ImGui::SameLine();
    if (button(editor, "Replace")) {
        ImGui::CloseCurrentPopup();
        if (saveTo(editor, editor.document.graph().path)) doNext(editor);
    }
    ImGui::SameLine();
    if (button(editor, "Cancel") || escaped()) {
        ImGui::CloseCurrentPopup();
        files.next = Next::none;
    }
    ImGui::EndPopup();
}

void showExporting(Editor& editor) {
    if (std::exchange(editor.files.asksExport, false)) ImGui::OpenPopup(kExporting);
    if (!beginQuestion(editor, kExporting)) return;
    ImGui::TextWrapped(exports(editor)
                           ? "Ending the editor now ends the export too, which then leaves no file."
                           : "Ending the editor now ends the pictures that are being made. Frames that "
                             "are there stay.");
    const bool waits = button(editor, "Wait for it") || confirmed() || escaped();
    ImGui::SameLine();
    if (button(editor, "Quit") || !makesFiles(editor)) editor.quit = true;
    if (waits) editor.quit = false;
    if (waits || editor.quit) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

void showOutside(Editor& editor) {
    Files& files = editor.files;
    if (files.outside && !ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) ImGui::OpenPopup(kOutside);
    if (!beginQuestion(editor, kOutside)) return;
    ImGui::TextWrapped(
        "Another program changed %s, and there are unsaved changes here. Loading it is one step, which undo "
        "takes back.",
        nameOf(editor).c_str());
    const std::string waits = files.waits;
    const bool load = files.outside && button(editor, "Load it");
    ImGui::SameLine();
    const bool keep = button(editor, waits.empty() ? "Keep mine" : "Save mine over it") || !files.outside;
    bool leave = false;
    if (!waits.empty()) {
        ImGui::SameLine();
        leave = button(editor, "Cancel");
    }
    leave = leave || escaped();
    if (load) reload(editor, *files.outside);
    if (leave && !load && !keep) files.undecided = files.outside;
    files.keepsNext = files.keepsNext || (keep && !load);
    if (load || leave) files.next = Next::none;
    if (load || keep || leave) {
        files.outside.reset();
        files.waits.clear();
        ImGui::CloseCurrentPopup();
    }
    if (keep && !load && !waits.empty() && writeFile(editor, waits)) doNext(editor);
    ImGui::EndPopup();
}

void showVersions(Editor& editor) {
    Files& files = editor.files;
    if (std::exchange(files.asksVersions, false)) ImGui::OpenPopup(kVersions);
    if (!beginQuestion(editor, kVersions)) return;
    ImGui::TextWrapped(
        "What %s held before it was saved over. Going back is one step, which undo takes back.",
        nameOf(editor).c_str());
    const Version* chosen = confirmed() ? &files.versions.front() : nullptr;
    for (std::size_t i = 0; i < files.versions.size(); ++i) {
        const Version& version = files.versions[i];
        ImGui::PushID(int(i));
        if (ImGui::Button("Go back")) chosen = &version;
        ImGui::SameLine();
        ImGui::Text("until %s, %.1f kB", words(version.until).c_str(), double(version.bytes) / 1000.0);
        ImGui::PopID();
    }
    if (chosen) restore(editor, *chosen);
    if (chosen || button(editor, "Cancel") || escaped()) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

void showMessage(Editor& editor) {
    Message& message = editor.files.message;
    if (message.title.empty()) return;
    const std::string title = message.title + "###message";
    if (message.opening && !ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) {
        ImGui::OpenPopup(title.c_str());
        message.opening = false;
    }
    if (!beginQuestion(editor, title.c_str())) return;
    ImGui::TextWrapped("%s", message.text.c_str());
    std::string all;
    for (std::size_t i = 0; i < message.problems.size(); ++i) {
        const Error& problem = message.problems[i];
        const bool error = problem.severity == Error::Severity::error;
        all += format(problem) + "\n";
        if (i >= kMostShown) continue;
        ImGui::PushStyleColor(ImGuiCol_Text, themeColor(error ? ThemeColor::error : ThemeColor::warning));
        ImGui::TextWrapped("%s", format(problem).c_str());
        ImGui::PopStyleColor();
    }
    if (message.problems.size() > kMostShown)
        ImGui::Text("and %zu more", message.problems.size() - kMostShown);
    ImGui::Spacing();
    const bool read = button(editor, "OK") || confirmed() || escaped();
    if (!all.empty()) {
        ImGui::SameLine();
        if (button(editor, "Copy")) ImGui::SetClipboardText(all.c_str());
    }
    if (read) {
        message = {};
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

void showOffer(Editor& editor) {
    Files& files = editor.files;
    if (!files.offers || files.left.empty() || !files.message.title.empty()) return;
    if (!ImGui::IsPopupOpen(kOffer)) ImGui::OpenPopup(kOffer);
    if (!beginQuestion(editor, kOffer)) return;
    ImGui::TextWrapped("The editor ended before these changes were saved:");
    for (std::size_t i = 0; i < files.left.size(); ++i) {
        const LeftCopy copy = files.left[i];
        ImGui::PushID(int(i));
        const bool opens = ImGui::Button("Restore") || (files.left.size() == 1 && confirmed());
        ImGui::SameLine();
        const bool remove = ImGui::Button("Delete");
        ImGui::SameLine();
        const std::string when = ", " + copy.when, name = copy.original.empty() ? "untitled" : copy.original;
        wantGlyphs(name);
        const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(when.c_str()).x;
        ImGui::TextUnformatted((fittedEnd(name, room) + when).c_str());
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", name.c_str());
        ImGui::PopID();
        if (opens) restore(editor, copy);
        if (remove) removeCopy(copy);
        if (!opens && !remove) continue;
        files.left.erase(files.left.begin() + std::ptrdiff_t(i));
        break;
    }
    if (files.left.empty() || ImGui::Button("Later") || escaped()) files.offers = false;
    if (!files.offers) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

}  // namespace

void offerVersions(Editor& editor) {
    editor.files.versions = versionsOf(editor.document.graph().path);
    if (editor.files.versions.empty())
        return say(editor,
                   "no versions are kept yet: saving keeps what the file held, once a quarter of an hour");
    editor.files.asksVersions = true;
}

void showFileDialogs(Editor& editor) {
    showQuestion(editor);
    showPartly(editor);
    showExporting(editor);
    showOutside(editor);
    showVersions(editor);
    showMessage(editor);
    showOffer(editor);
}

}  // namespace fw::editor
