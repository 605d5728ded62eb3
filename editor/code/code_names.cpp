// To where a name is defined, and another name for what it stands for.
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include "editor/code/code_editor.h"
#include "editor/document/expression_inputs.h"
#include "editor/editor.h"
#include "editor/panels/properties.h"
#include "editor/panels/side.h"
#include "editor/shell/theme.h"

namespace fw::editor::code {

namespace {

using UseKind = language::NameUse::Kind;

constexpr double kMarked = 2.0;  // seconds that an input's row is marked

/// The names of the text as it is now, whatever a thread is at.
const language::CodeNames& namesNow(CodeEditor& code) {
    if (!code.names || code.names->version != code.text.version) {
        std::vector<std::string> inputs;
        for (const CodeInput& input : code.inputs) inputs.push_back(input.name);
        code.names =
            std::make_shared<const NamesOfText>(readNames(stringOf(code.text), code.text.version, inputs));
    }
    return code.names->names;
}

void goToInput(Editor& editor, const std::string& name) {
    CodeEditor& code = editor.code;
    const NodeBox* box = editor.boxes->find(code.node);
    for (const Row& row : box->rows) {
        if (row.output || row.name != name) continue;
        if (const Link* link = row.value ? std::get_if<Link>(&row.value->value) : nullptr) {
            const std::string source = pathOf(editor, link->node);
            commit(editor);
            code.large = false;
            return reveal(editor, source);
        }
    }
    code.wantedInput = name;
    code.wantedUntil = now() + kMarked;
    code.wantedScroll = true;
    if (code.large) return;
    showPanel(editor, "inspector");
    editor.panels.next.reset();  // the keyboard stays
}

}  // namespace

void goToDefinition(Editor& editor) {
    CodeEditor& code = editor.code;
    const language::CodeNames& names = namesNow(code);
    const language::NameUse* use = names.at(offsetOf(code.text, code.text.cursor));
    if (!use) return;
    const std::string name = stringOf(code.text).substr(use->begin, use->length);
    switch (use->kind) {
        case UseKind::variable:
        case UseKind::function: {
            if (use->index < 0) return;
            const language::CodeDefinition& definition = names.definitions[std::size_t(use->index)];
            const language::NameUse& there = names.uses[definition.use];
            select(code.text,
                   {spotOf(code.text, there.begin), spotOf(code.text, there.begin + there.length)});
            code.view.follow = code.view.focus = true;
            return;
        }
        case UseKind::node:
            editor.windows.reference.search[0] = 0;
            editor.windows.reference.type = language::calledNode(name)->id;
            editor.windows.reference.open = editor.windows.reference.opened = true;
            return;
        case UseKind::input: return goToInput(editor, name);
        default:
            if (const Entry* entry = libraryEntry(name, use->kind))
                say(editor, entry->signature + ": " + entry->doc);
    }
}

void beginRename(Editor& editor) {
    CodeEditor& code = editor.code;
    const language::CodeNames& names = namesNow(code);
    const language::NameUse* use = names.at(offsetOf(code.text, code.text.cursor));
    const bool can = use && (use->kind == UseKind::input || use->index >= 0);
    if (!can)
        return say(editor,
                   "nothing here can have another name: put the cursor on an input, a variable or a function "
                   "of the code");
    const std::string name = stringOf(code.text).substr(use->begin, use->length);
    code.renaming = {true, true, use->kind, name, name, {}, use->index, code.text.version};
    code.list.open = false;
}

namespace {

void renameInput(Editor& editor) {
    CodeEditor& code = editor.code;
    const Renaming& renaming = code.renaming;
    const std::string text = stringOf(code.text);
    const Graph typed = setCode(editor.document.graph(), code.scope, code.node, text);
    Result<Graph> renamed = renameExpressionInput(typed, code.scope, {code.node, renaming.from}, renaming.to);
    if (!renamed) {
        code.renaming.problem = renamed.error().message;
        return;
    }
    code.base = text;  // it goes along
    editor.document.apply("Rename Input " + renaming.from, std::move(*renamed));
    code.renaming = {};
    code.view.focus = true;
}

void renameInText(Editor& editor) {
    CodeEditor& code = editor.code;
    const Renaming& renaming = code.renaming;
    const std::string text = stringOf(code.text);
    const language::CodeNames& names = namesNow(code);
    std::string problem =
        isName(renaming.to)
            ? language::nameRefusal(text, names, renaming.to)
            : inQuotes(renaming.to) + " is no name: use letters, digits and '_', a letter first";
    for (const std::string& input : names.inputs)
        if (input == renaming.to) problem = "the expression has an input " + inQuotes(input) + " already";
    if (!problem.empty()) {
        code.renaming.problem = std::move(problem);
        return;
    }
    const std::size_t at = offsetOf(code.text, code.text.cursor);
    std::ptrdiff_t grown = 0;
    for (const language::NameUse& use : names.uses)
        if (use.kind == renaming.kind && use.index == renaming.index && use.begin + use.length <= at)
            grown += std::ptrdiff_t(renaming.to.size()) - std::ptrdiff_t(use.length);
    const std::string made = language::renamed(text, names, renaming.to, [&](const language::NameUse& use) {
        return use.kind == renaming.kind && use.index == renaming.index;
    });
    newStep(code.text);
    replace(code.text, {{}, endOf(code.text)}, made);
    place(code.text, spotOf(code.text, std::size_t(std::max<std::ptrdiff_t>(0, std::ptrdiff_t(at) + grown))));
    newStep(code.text);
    code.renaming = {};
    code.view.focus = true;
}

}  // namespace

void showRename(Editor& editor, const Heard& heard) {
    constexpr const char* kPopup = "##rename";
    CodeEditor& code = editor.code;
    Renaming& renaming = code.renaming;
    if (std::exchange(renaming.opened, false)) ImGui::OpenPopup(kPopup);
    if (!renaming.open) return;
    ImGui::SetNextWindowPos({heard.cursor.x, heard.cursor.y + 2.0f}, ImGuiCond_Appearing);
    if (!ImGui::BeginPopup(kPopup)) {
        renaming = {};
        code.view.focus = true;
        return;
    }
    ImGui::TextUnformatted(("Another name for " + renaming.from).c_str());
    ImGui::SetNextItemWidth(16.0f * ImGui::GetFontSize());
    if (ImGui::IsWindowAppearing() || !renaming.problem.empty()) ImGui::SetKeyboardFocusHere();
    const bool entered = ImGui::InputText(
        "##to", &renaming.to, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    if (ImGui::IsItemEdited()) renaming.problem.clear();
    const bool escaped =
        ImGui::IsItemDeactivated() && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    if (!renaming.problem.empty()) {
        ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + 22.0f * ImGui::GetFontSize());
        ImGui::PushStyleColor(ImGuiCol_Text, themeColor(ThemeColor::error));
        ImGui::TextUnformatted(renaming.problem.c_str());
        ImGui::PopStyleColor();
        ImGui::PopTextWrapPos();
    }
    const bool input = renaming.kind == UseKind::input;
    if (entered && renaming.to == renaming.from)
        renaming = {}, code.view.focus = true;
    else if (entered)
        input ? renameInput(editor) : renameInText(editor);
    if (escaped) renaming = {}, code.view.focus = true;
    if (!renaming.open) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

}  // namespace fw::editor::code
