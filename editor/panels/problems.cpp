// What is wrong with the document, errors first. A click goes where it is; what can be done about it at once
// is a button below.
#include "editor/panels/problems.h"

#include <algorithm>

#include "editor/document/paths.h"
#include "editor/editor.h"
#include "editor/shell/theme.h"

namespace fw::editor {

namespace {

/// "Tower · Radius, line 3" as far as it is known.
std::string whereOf(const Error& finding) {
    std::string place = finding.node;
    if (!finding.input.empty()) place += (place.empty() ? "" : " · ") + readable(finding.input);
    if (finding.codeLine > 0) place += ", line " + std::to_string(finding.codeLine);
    if (place.empty() && finding.line > 0) place = "line " + std::to_string(finding.line) + " of the file";
    return place.empty() ? "the document" : place;
}

/// The group that the finding's node shows; empty if it shows none.
std::string groupOf(const Editor& editor, const Error& finding) {
    const auto [scope, id] = placeOf(*editor.graph, finding.node);
    const Node* node = findNode(nodesOf(*editor.graph, scope), id);
    return node ? node->group : std::string();
}

/// Whether the finding is that of the link, and not another of the same node.
bool isAbout(const Editor& editor, const GroupLinks::Link& link, const Error& finding) {
    const std::vector<Error>& found = editor.files.groups.findings();
    return std::ranges::find(found, finding) != found.end() && !wordsOf(link).empty();
}

/// One finding as a row that can be clicked: a sign, where it is, what it is. Whether it was.
bool showFinding(const Error& finding) {
    const bool error = finding.severity == Error::Severity::error;
    const ImU32 color = themeColor(error ? ThemeColor::error : ThemeColor::warning);
    const float em = ImGui::GetFontSize(), left = 1.5f * em;
    const float wide = std::max(ImGui::GetContentRegionAvail().x - left, 4.0f * em);
    const ImVec2 text = ImGui::CalcTextSize(finding.message.c_str(), nullptr, false, wide);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float line = ImGui::GetTextLineHeight(), high = line + text.y + 0.4f * em;
    const bool clicked = ImGui::Selectable("##finding", false, 0, {0, high});
    ImDrawList* list = ImGui::GetWindowDrawList();
    // A sign of its own for either, for those who do not see the colours.
    const ImVec2 c(at.x + 0.6f * em, at.y + 0.6f * em);
    if (error) {
        list->AddCircleFilled(c, 0.42f * em, color);
        const float r = 0.16f * em;
        list->AddLine({c.x - r, c.y - r}, {c.x + r, c.y + r}, themeColor(ThemeColor::canvas), 2.0f);
        list->AddLine({c.x + r, c.y - r}, {c.x - r, c.y + r}, themeColor(ThemeColor::canvas), 2.0f);
    } else {
        list->AddTriangleFilled({c.x, c.y - 0.45f * em}, {c.x + 0.48f * em, c.y + 0.38f * em},
                                {c.x - 0.48f * em, c.y + 0.38f * em}, color);
    }
    list->AddText({at.x + left, at.y}, color, whereOf(finding).c_str());
    list->AddText(ImGui::GetFont(), em, {at.x + left, at.y + line}, themeColor(ThemeColor::text),
                  finding.message.c_str(), nullptr, wide);
    return clicked;
}

/// A problem is looked into no further than these: what mends many is found once the first are gone.
constexpr std::size_t kMostLookedInto = 40;

const ShownProblems& problemsWithRemedies(Editor& editor) {
    ShownProblems& shown = editor.panelState.problems;
    std::vector<Error> now = problemsOf(editor);
    if (shown.drawn == editor.drawn && shown.of == now) return shown;
    shown = {.of = std::move(now), .drawn = editor.drawn};
    for (const Error& error : shown.of) {
        ShownProblems::Problem& problem = shown.all.emplace_back();
        problem.error = error;
        if (shown.all.size() <= kMostLookedInto) problem.remedies = remediesOf(*editor.graph, error);
    }
    return shown;
}

/// The file that the finding's input names, if it is not there.
bool namesMissingFile(const Editor& editor, const Error& finding) {
    const auto [scope, id] = placeOf(*editor.graph, finding.node);
    const Node* node = findNode(nodesOf(*editor.graph, scope), id);
    if (!node) return false;
    for (const NamedFile& file : editor.files.missing.known)
        for (const auto& [name, value] : node->inputs)
            if ((finding.input.empty() || name == finding.input) &&
                value.value == decltype(value.value)(file.path))
                return true;
    return false;
}

/// Small buttons below a finding. What one does is left in `act`.
void showRemedies(Editor& editor, const ShownProblems::Problem& problem, std::function<void()>& act) {
    bool any = false;
    const auto offer = [&](const std::string& label, std::function<void()> what) {
        any ? ImGui::SameLine() : ImGui::Indent(1.5f * ImGui::GetFontSize());
        any = true;
        if (ImGui::SmallButton(label.c_str())) act = std::move(what);
    };
    for (const Remedy& remedy : problem.remedies)
        offer(remedy.label, [&editor, remedy] {
            editor.document.apply(remedy.label, remedy.mend(editor.document.graph()));
        });
    if (const GroupLinks::Link* link = editor.files.groups.of(groupOf(editor, problem.error));
        link && isAbout(editor, *link, problem.error)) {
        const std::string group = link->group;
        if (link->problem.empty() && link->state != LinkState::changedHere)
            offer("Update", [&editor, group] { updateGroup(editor, group); });
        if (link->state != LinkState::fileChanged || !link->problem.empty())
            offer("Write the file", [&editor, group] { writeGroup(editor, group); });
        offer("Make it local", [&editor, group] { unlinkGroup(editor, group); });
    }
    if (namesMissingFile(editor, problem.error))
        offer("Find the file …", [&editor] { openMissingFiles(editor); });
    if (any) ImGui::Unindent(1.5f * ImGui::GetFontSize());
}

}  // namespace

std::vector<Error> problemsOf(const Editor& editor) {
    // What was wrong with the file first: it is not in the graph any more, and the check cannot find it.
    std::vector<Error> all = editor.files.found;
    const auto add = [&](const std::vector<Error>& some) { all.insert(all.end(), some.begin(), some.end()); };
    add(editor.files.groups.findings());
    add(editor.viewport.shown.findings);
    return all;
}

void showProblems(Editor& editor) {
    const ShownProblems& problems = problemsWithRemedies(editor);
    if (problems.all.empty()) {
        ImGui::TextDisabled("No problems: the graph makes what it shows.");
        return;
    }
    const Error* goTo = nullptr;
    std::function<void()> act;
    int id = 0;
    for (const Error::Severity severity : {Error::Severity::error, Error::Severity::warning})
        for (const ShownProblems::Problem& problem : problems.all) {
            const Error& finding = problem.error;
            if (finding.severity != severity) continue;
            ImGui::PushID(id++);
            if (showFinding(finding)) goTo = &finding;
            if (ImGui::BeginPopupContextItem("finding")) {
                if (ImGui::MenuItem("Copy")) ImGui::SetClipboardText(format(finding).c_str());
                ImGui::EndPopup();
            }
            showRemedies(editor, problem, act);
            ImGui::PopID();
        }
    if (goTo) code::goToFinding(editor, *goTo);
    if (act) act();  // which ends what is shown
}

}  // namespace fw::editor
