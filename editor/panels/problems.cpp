// What is wrong with the document, errors first. A click goes where it is.
#include <algorithm>

#include "editor/editor.h"
#include "editor/shell/theme.h"

namespace fw::editor {

namespace {

/// "Tower · Radius, line 3" as far as it is known.
std::string placeOf(const Error& finding) {
    std::string place = finding.node;
    if (!finding.input.empty()) place += (place.empty() ? "" : " · ") + readable(finding.input);
    if (finding.codeLine > 0) place += ", line " + std::to_string(finding.codeLine);
    if (place.empty() && finding.line > 0) place = "line " + std::to_string(finding.line) + " of the file";
    return place.empty() ? "the document" : place;
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
    list->AddText({at.x + left, at.y}, color, placeOf(finding).c_str());
    list->AddText(ImGui::GetFont(), em, {at.x + left, at.y + line}, themeColor(ThemeColor::text),
                  finding.message.c_str(), nullptr, wide);
    return clicked;
}

}  // namespace

void showProblems(Editor& editor) {
    // What was wrong with the file first: it is not in the graph any more, and the check cannot find it.
    std::vector<Error> findings = editor.files.found;
    findings.insert(findings.end(), editor.viewport.shown.findings.begin(),
                    editor.viewport.shown.findings.end());
    if (findings.empty()) {
        ImGui::TextDisabled("No problems: the graph makes what it shows.");
        return;
    }
    const Error* goTo = nullptr;
    int id = 0;
    for (const Error::Severity severity : {Error::Severity::error, Error::Severity::warning})
        for (const Error& finding : findings) {
            if (finding.severity != severity) continue;
            ImGui::PushID(id++);
            if (showFinding(finding)) goTo = &finding;
            if (ImGui::BeginPopupContextItem("finding")) {
                if (ImGui::MenuItem("Copy")) ImGui::SetClipboardText(format(finding).c_str());
                ImGui::EndPopup();
            }
            ImGui::PopID();
        }
    if (goTo) code::goToFinding(editor, *goTo);
}

}  // namespace fw::editor
