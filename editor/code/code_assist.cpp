// Completions, signatures, and what a name is on hover.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui_internal.h>

#include <algorithm>

#include "editor/code/code_editor.h"
#include "editor/editor.h"
#include "editor/shell/theme.h"

namespace fw::editor::code {

namespace {

constexpr int kRows = 8;             // of the list
constexpr float kListWidth = 34.0f;  // em; and that of a page
constexpr float kDocWidth = 34.0f;

/// The letters of a name before the cursor.
Range lettersBefore(const Text& text) {
    const std::string& line = text.lines[std::size_t(text.cursor.line)];
    int from = text.cursor.byte;
    while (from > 0 && inWord(line[std::size_t(from) - 1]) && !(line[std::size_t(from) - 1] & 0x80)) --from;
    return {{text.cursor.line, from}, text.cursor};
}

void fillList(CodeEditor& code, Range letters) {
    CompletionList& list = code.list;
    list.letters = letters;
    const language::CodeNames none;
    // Names may be of a text that is some letters older: what was defined there is offered all the same.
    const std::size_t byte = offsetOf(code.text, letters.from);
    list.own = entriesAt(code.names ? code.names->names : none, code.inputs, byte);
    const std::string typed = stringOf(code.text, letters);
    // The name that is being written is defined by that.
    if (code.names)
        std::erase_if(list.own, [&](const Entry& each) {
            return each.name == typed && each.kind == language::NameUse::Kind::variable &&
                   std::ranges::none_of(
                       code.names->names.definitions, [&](const language::CodeDefinition& definition) {
                           return definition.name == typed && definition.to >= byte && definition.from < byte;
                       });
        });
    list.found = ranked(list.own, typed);
    list.chosen = list.first = 0;
    list.open = !list.found.empty();
}

void take(CodeEditor& code) {
    CompletionList& list = code.list;
    const Entry& entry = *list.found[std::size_t(list.chosen)];
    Text& text = code.text;
    const bool calls = entry.kind == language::NameUse::Kind::function ||
                       entry.kind == language::NameUse::Kind::builtin ||
                       entry.kind == language::NameUse::Kind::node;
    // The rest of a name that the cursor is in goes too.
    Range range{list.letters.from, text.cursor};
    const std::string& line = text.lines[std::size_t(range.to.line)];
    while (range.to.byte < int(line.size()) && inWord(line[std::size_t(range.to.byte)])) ++range.to.byte;
    const bool bracket = range.to.byte < int(line.size()) && line[std::size_t(range.to.byte)] == '(';
    newStep(text);
    replace(text, range, entry.name + (calls && !bracket ? "(" : ""));
    newStep(text);
    code.view.follow = true;
    list.open = false;
}

/// Whether Enter would change nothing: the name is there already.
bool complete(const CodeEditor& code) {
    return code.list.found[std::size_t(code.list.chosen)]->name == stringOf(code.text, code.list.letters);
}

const char* kindWord(language::NameUse::Kind kind) {
    using Kind = language::NameUse::Kind;
    switch (kind) {
        case Kind::word: return "word";
        case Kind::type: return "type";
        case Kind::constant: return "constant";
        case Kind::input: return "input";
        case Kind::variable: return "variable";
        case Kind::function: return "function";
        case Kind::builtin: return "built in";
        case Kind::node: return "node";
        default: return "";
    }
}

Ink inkFor(language::NameUse::Kind kind) {
    using Kind = language::NameUse::Kind;
    switch (kind) {
        case Kind::word: return Ink::word;
        case Kind::type: return Ink::type;
        case Kind::constant: return Ink::constant;
        case Kind::input: return Ink::input;
        case Kind::node: return Ink::node;
        case Kind::builtin:
        case Kind::function: return Ink::function;
        default: return Ink::plain;
    }
}

/// A window that takes no keyboard, at a place on the screen: below `y`, or above `above` where there is no
/// room.
constexpr ImGuiWindowFlags kFloating =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
    ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoScrollWithMouse;

ImVec2 placeFor(float x, float below, float above, ImVec2 size) {
    const ImGuiViewport* whole = ImGui::GetMainViewport();
    const ImVec2 lo = whole->WorkPos, hi(lo.x + whole->WorkSize.x, lo.y + whole->WorkSize.y);
    ImVec2 at(x, below);
    if (below + size.y > hi.y && above - size.y >= lo.y) at.y = above - size.y;
    at.y = std::max(lo.y, std::min(at.y, hi.y - size.y));
    at.x = std::max(lo.x, std::min(at.x, hi.x - size.x));
    return at;
}

/// The signature in the font of code, wrapped, its n-th argument marked; its size. Draws only with a list.
ImVec2 layOutSignature(ImDrawList* list, ImFont* font, const Entry& entry, int argument, ImVec2 at,
                       float wide) {
    const float size = font->FontSize, line = std::round(1.3f * size);
    std::vector<std::pair<std::string, bool>> words;  // and whether it is marked
    const std::size_t open = entry.signature.find('(');
    if (entry.arguments.empty() || open == std::string::npos) {
        words.emplace_back(entry.signature, false);
    } else {
        words.emplace_back(entry.signature.substr(0, open + 1), false);
        for (std::size_t i = 0; i < entry.arguments.size(); ++i) {
            const bool last = i + 1 == entry.arguments.size();
            // Of "a, b, …" the last stands for all that follow.
            const bool on = int(i) == argument || (last && argument > int(i) && entry.arguments[i] == "…");
            words.emplace_back(entry.arguments[i] + (last ? ")" : ", "), on);
        }
    }
    ImVec2 pen(0, 0), most(0, line);
    for (const auto& [word, on] : words) {
        const float width = font->CalcTextSizeA(size, FLT_MAX, 0.0f, word.c_str()).x;
        if (pen.x > 0 && pen.x + width > wide) pen = {2.0f * size, pen.y + line};
        if (list) {
            if (on)
                list->AddRectFilled({at.x + pen.x - 1, at.y + pen.y},
                                    {at.x + pen.x + width, at.y + pen.y + line},
                                    themeColor(ThemeColor::header), 2.0f);
            list->AddText(font, size, {at.x + pen.x, at.y + pen.y + 0.5f * (line - size)},
                          on ? themeColor(ThemeColor::argument) : inkColor(Ink::plain), word.c_str());
        }
        pen.x += width;
        most = {std::max(most.x, pen.x), pen.y + line};
    }
    return most;
}

ImFont* codeFont(const Editor& editor) { return editor.shell.fonts().codeOf(ImGui::GetFontSize()); }

/// A signature with its sentences, in ImGui's current window.
void showPageOf(Editor& editor, const Entry& entry, int argument) {
    const float em = ImGui::GetFontSize(), wide = kDocWidth * em;
    ImFont* font = codeFont(editor);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::Dummy(layOutSignature(ImGui::GetWindowDrawList(), font, entry, argument, at, wide));
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + wide);
    if (argument >= 0 && argument < int(entry.argumentDocs.size()))
        ImGui::TextUnformatted(
            (entry.arguments[std::size_t(argument)] + ": " + entry.argumentDocs[std::size_t(argument)])
                .c_str());
    if (!entry.doc.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, themeColor(ThemeColor::quiet));
        ImGui::TextUnformatted(entry.doc.c_str());
        ImGui::PopStyleColor();
    }
    ImGui::PopTextWrapPos();
}

/// What a name of the text is; none for what says nothing.
std::optional<Entry> entryOfUse(const CodeEditor& code, const language::NameUse& use) {
    using Kind = language::NameUse::Kind;
    const std::string name = stringOf(code.text).substr(use.begin, use.length);
    switch (use.kind) {
        case Kind::input:
            for (const CodeInput& input : code.inputs)
                if (input.name == name) return entryOf(input);
            return std::nullopt;
        case Kind::variable:
        case Kind::function:
            if (use.index < 0) return std::nullopt;
            return entryOf(code.names->names.definitions[std::size_t(use.index)]);
        case Kind::member:
        case Kind::unknown: return std::nullopt;
        default:
            if (const Entry* entry = libraryEntry(name, use.kind)) return *entry;
            return std::nullopt;
    }
}

/// The function that is called by this name: of the code, an input, the library.
std::optional<Entry> entryOfCall(const CodeEditor& code, const std::string& name) {
    using Kind = language::NameUse::Kind;
    if (code.names)
        for (const language::CodeDefinition& each : code.names->names.definitions)
            if (each.function && each.name == name) return entryOf(each);
    for (const CodeInput& input : code.inputs)
        if (input.name == name) {
            Entry entry = entryOf(input);
            entry.signature = name + "(vec3 position)";
            entry.arguments = argumentsOf(entry.signature);
            return entry;
        }
    for (const Kind kind : {Kind::builtin, Kind::node, Kind::type})
        if (const Entry* entry = libraryEntry(name, kind)) {
            Entry found = *entry;
            if (kind == Kind::type) {
                found.signature = name == "vec2" || name == "float2"   ? name + "(x, y)"
                                  : name == "vec3" || name == "float3" ? name + "(x, y, z)"
                                                                       : name + "(x)";
                found.arguments = argumentsOf(found.signature);
            }
            return found;
        }
    return std::nullopt;
}

}  // namespace

bool steerList(CodeEditor& code) {
    CompletionList& list = code.list;
    const ImGuiIO& io = ImGui::GetIO();
    if (!list.open || !code.view.inside) return false;
    const auto key = [](int which, bool repeats = true) { return ImGui::IsKeyPressed(which, repeats); };
    const int count = int(list.found.size());
    if (!io.KeyCtrl && !io.KeyShift && !io.KeyAlt) {
        const int by = int(key(GLFW_KEY_DOWN)) - int(key(GLFW_KEY_UP)) +
                       kRows * (int(key(GLFW_KEY_PAGE_DOWN)) - int(key(GLFW_KEY_PAGE_UP)));
        if (std::abs(by) == 1) list.chosen = (list.chosen + by + count) % count;
        if (std::abs(by) > 1) list.chosen = std::clamp(list.chosen + by, 0, count - 1);
        if (key(GLFW_KEY_ESCAPE, false)) {
            list.open = false;
            return true;
        }
        const bool enter = key(GLFW_KEY_ENTER, false) || key(GLFW_KEY_KP_ENTER, false);
        if (enter && complete(code)) {
            list.open = false;  // and the line ends, as the key says
            return false;
        }
        if (enter || key(GLFW_KEY_TAB, false)) {
            take(code);
            return true;
        }
    }
    const bool over = io.MousePos.x >= list.lo.x && io.MousePos.x < list.hi.x && io.MousePos.y >= list.lo.y &&
                      io.MousePos.y < list.hi.y;
    if (over && io.MouseWheel != 0.0f)
        list.first = std::clamp(list.first - int(io.MouseWheel * 3.0f), 0, std::max(0, count - kRows));
    else if (list.chosen < list.first || list.chosen >= list.first + kRows)
        list.first = std::clamp(list.chosen < list.first ? list.chosen : list.chosen - kRows + 1, 0,
                                std::max(0, count - kRows));
    return list.open;
}

void followList(CodeEditor& code, const Heard& heard) {
    CompletionList& list = code.list;
    Text& text = code.text;
    if (!code.view.inside || text.selects()) return void(list.open = false);
    if (!heard.changed && !heard.moved && !heard.complete) return;
    const Range letters = lettersBefore(text);
    const std::string& line = text.lines[std::size_t(text.cursor.line)];
    const char first = letters.empty() ? char(0) : line[std::size_t(letters.from.byte)];
    const bool name = first != 0 && (first < '0' || first > '9');
    const bool behindDot = letters.from.byte > 0 && line[std::size_t(letters.from.byte) - 1] == '.';
    const bool quiet = code.colouring.quiet(text, text.cursor);
    if (heard.complete && !quiet && !behindDot && (name || letters.empty())) return fillList(code, letters);
    const bool typed = !heard.typed.empty() && inWord(heard.typed.back());
    const bool goesOn = list.open && heard.changed;
    if (!name || behindDot || quiet || !(typed || goesOn)) return void(list.open = false);
    fillList(code, letters);
    // Nothing is offered to who has written all of the only name that it could be.
    if (list.open && list.found.size() == 1 && complete(code)) list.open = false;
}

void showList(Editor& editor, const Heard& heard) {
    CodeEditor& code = editor.code;
    CompletionList& list = code.list;
    if (!list.open) {
        list.lo = list.hi = {};
        return;
    }
    const float em = ImGui::GetFontSize(), wide = kListWidth * em, pad = 0.5f * em;
    ImFont* font = codeFont(editor);
    const int rows = std::min(kRows, int(list.found.size()));
    const float row = std::round(1.35f * em);
    const Entry& chosen = *list.found[std::size_t(list.chosen)];
    const ImVec2 signature = layOutSignature(nullptr, font, chosen, -1, {}, wide - 2 * pad);
    const ImVec2 doc = ImGui::CalcTextSize(chosen.doc.c_str(), nullptr, false, wide - 2 * pad);
    const float below = signature.y + (chosen.doc.empty() ? 0.0f : doc.y) + 2 * pad;
    const ImVec2 size(wide, float(rows) * row + pad + below);
    const ImVec2 letters = heard.placeOf(list.letters.from);
    const ImVec2 at =
        placeFor(letters.x - pad - heard.cell.x, letters.y + heard.cell.y + 2, letters.y - 2, size);
    list.lo = at, list.hi = {at.x + size.x, at.y + float(rows) * row + 0.5f * pad};
    ImGui::SetNextWindowPos(at);
    ImGui::SetNextWindowSize(size);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ImGui::GetStyleColorVec4(ImGuiCol_PopupBg));
    ImGui::Begin("##completions", nullptr, kFloating);
    ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
    ImDrawList* draw = ImGui::GetWindowDrawList();
    for (int i = 0; i < rows; ++i) {
        const int index = list.first + i;
        const Entry& entry = *list.found[std::size_t(index)];
        const ImVec2 lo(at.x, at.y + 0.25f * pad + float(i) * row), hi(at.x + wide, lo.y + row);
        if (index == list.chosen)
            draw->AddRectFilled(lo, hi, ImGui::GetColorU32(ImGuiCol_HeaderHovered), 2.0f);
        draw->AddText(font, font->FontSize, {lo.x + pad + heard.cell.x, lo.y + 0.5f * (row - font->FontSize)},
                      inkColor(inkFor(entry.kind)), entry.name.c_str());
        const char* word = kindWord(entry.kind);
        draw->AddText({hi.x - pad - ImGui::CalcTextSize(word).x, lo.y + 0.5f * (row - em)},
                      themeColor(ThemeColor::quiet), word);
        if (ImGui::IsMouseClicked(0) && ImGui::IsMouseHoveringRect(lo, hi, false)) {
            list.chosen = index;
            take(code);
            break;
        }
    }
    const float y = at.y + float(rows) * row + pad;
    draw->AddLine({at.x, y - 0.5f * pad}, {at.x + wide, y - 0.5f * pad}, ImGui::GetColorU32(ImGuiCol_Border));
    layOutSignature(draw, font, chosen, -1, {at.x + pad, y}, wide - 2 * pad);
    draw->AddText(ImGui::GetFont(), em, {at.x + pad, y + signature.y + 2}, themeColor(ThemeColor::quiet),
                  chosen.doc.c_str(), nullptr, wide - 2 * pad);
    ImGui::End();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar();
}

void showSignature(Editor& editor, const Heard& heard) {
    CodeEditor& code = editor.code;
    code.list.call.reset();
    if (!code.view.inside || code.view.search.focus || code.text.selects()) return;
    const std::optional<CallAt> call = callAt(code.text, code.colouring, code.text.cursor);
    if (!call) return code.list.closedCall.reset();
    if (code.list.closedCall == call->begin) return;
    const std::optional<Entry> entry = entryOfCall(code, call->name);
    if (!entry || entry->arguments.empty()) return;
    code.list.call = call->begin;
    const float em = ImGui::GetFontSize();
    const ImVec2 text =
        layOutSignature(nullptr, codeFont(editor), *entry, call->argument, {}, kDocWidth * em);
    std::string about;
    if (call->argument < int(entry->argumentDocs.size()))
        about = entry->argumentDocs[std::size_t(call->argument)];
    const ImVec2 doc =
        about.empty() ? ImVec2() : ImGui::CalcTextSize(about.c_str(), nullptr, false, kDocWidth * em);
    const float pad = 0.4f * em;
    const ImVec2 size(std::max(text.x, doc.x) + 2 * pad, text.y + doc.y + 2 * pad);
    // Above the line, so that the list has the room below; never over the text's own line.
    const ImVec2 begin = heard.placeOf(call->begin), line = heard.placeOf(code.text.cursor);
    ImVec2 at(begin.x, std::min(begin.y, line.y) - size.y - 2);
    if (at.y < ImGui::GetMainViewport()->WorkPos.y) at.y = line.y + heard.cell.y + 2;
    at.x = placeFor(at.x, at.y, at.y, size).x;
    if (code.list.open && at.y > line.y) return;
    ImGui::SetNextWindowPos(at);
    ImGui::SetNextWindowSize(size);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ImGui::GetStyleColorVec4(ImGuiCol_PopupBg));
    ImGui::Begin("##signature", nullptr, kFloating | ImGuiWindowFlags_NoInputs);
    ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
    ImDrawList* draw = ImGui::GetWindowDrawList();
    layOutSignature(draw, codeFont(editor), *entry, call->argument, {at.x + pad, at.y + pad}, kDocWidth * em);
    if (!about.empty())
        draw->AddText(ImGui::GetFont(), em, {at.x + pad, at.y + pad + text.y}, themeColor(ThemeColor::quiet),
                      about.c_str(), nullptr, kDocWidth * em);
    ImGui::End();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar();
}

void showHover(Editor& editor, const Heard& heard) {
    CodeEditor& code = editor.code;
    std::optional<Spot> spot = heard.hovered;
    if (code.list.open || code.renaming.open || code.view.dragging) spot.reset();
    if (spot) spot = wordAt(code.text, *spot).from;
    if (spot != code.hovered) code.hovered = spot, code.hoveredFrom = now();
    if (!code.hovered || now() - code.hoveredFrom < kHoverDelay) return;
    std::string said;
    bool error = false;
    for (const Mark& mark : code.marks)
        if (mark.range.from <= *heard.hovered &&
            *heard.hovered < std::max(mark.range.to, after(code.text, mark.range.from)))
            said += (said.empty() ? "" : "\n") + mark.message, error |= mark.error;
    std::optional<Entry> entry;
    if (code.names && code.names->version == code.text.version &&
        !code.colouring.quiet(code.text, *heard.hovered))
        if (const language::NameUse* use = code.names->names.at(offsetOf(code.text, *heard.hovered)))
            entry = entryOfUse(code, *use);
    if (said.empty() && !entry) return;
    // Below the line, so that it covers nothing of it; above it where there is no room.
    const ImVec2 word = heard.placeOf(*code.hovered);
    const bool above = word.y > 0.75f * ImGui::GetMainViewport()->Size.y;
    ImGui::SetNextWindowPos({word.x, above ? word.y - 4.0f : word.y + heard.cell.y + 4.0f}, ImGuiCond_Always,
                            {0.0f, above ? 1.0f : 0.0f});
    ImGui::BeginTooltip();
    if (!said.empty()) {
        ImGui::PushTextWrapPos(kDocWidth * ImGui::GetFontSize());
        ImGui::PushStyleColor(ImGuiCol_Text, themeColor(error ? ThemeColor::error : ThemeColor::warning));
        ImGui::TextUnformatted(said.c_str());
        ImGui::PopStyleColor();
        ImGui::PopTextWrapPos();
    }
    if (entry) showPageOf(editor, *entry, -1);
    ImGui::EndTooltip();
}

}  // namespace fw::editor::code
