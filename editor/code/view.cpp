#include "editor/code/view.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "editor/code/view_keys.h"
#include "editor/shell/theme.h"

namespace fw::editor::code {

namespace {

constexpr double kBlink = 0.5, kBlinks = 10.0;  // seconds that the caret is lit, or dark; that it blinks for
constexpr float kMargin = 4.0f;                 // pixels at scale 1

// By Ink.
constexpr ThemeColor kInks[] = {
    ThemeColor::text,          // plain
    ThemeColor::codeWord,      // word
    ThemeColor::codeType,      // type
    ThemeColor::codeConstant,  // constant
    ThemeColor::codeInput,     // input
    ThemeColor::codeFunction,  // function
    ThemeColor::codeNode,      // node
    ThemeColor::codeString,    // string
    ThemeColor::codeComment,   // comment
    ThemeColor::error,         // unknown
    ThemeColor::error,         // wrong
};
static_assert(std::size(kInks) == std::size_t(Ink::wrong) + 1);

/// Where things are in this frame.
struct Page {
    ImVec2 origin;        ///< of line 0 and column 0
    ImVec2 lo, hi;        ///< what is seen of the text
    float gutter = 0.0f;  ///< width of the line numbers
    ImVec2 cell;
    int first = 0, last = 0;  ///< lines that are seen

    float x(float column) const { return origin.x + column * cell.x; }
    float y(int line) const { return origin.y + float(line) * cell.y; }
    int lines() const { return std::max(1, int((hi.y - lo.y) / cell.y)); }
};

Spot spotUnder(const Text& text, const Page& page, ImVec2 at) {
    const float line = std::floor((at.y - page.origin.y) / page.cell.y);
    return spotAt(text, int(std::clamp(line, -1.0f, float(text.lines.size()))),
                  std::max(0.0f, (at.x - page.origin.x) / page.cell.x));
}

void measure(View& view, const Text& text) {
    if (std::exchange(view.measured, text.version) == text.version) return;
    view.widest = 0;
    for (const std::string& line : text.lines) view.widest = std::max(view.widest, int(line.size()));
}

/// Takes the keyboard, as ImGui's text fields do.
void activate(View& view) {
    ImGuiContext& g = *ImGui::GetCurrentContext();
    ImGuiWindow* window = ImGui::GetCurrentWindow();
    ImGui::SetActiveID(view.id, window);
    ImGui::SetFocusID(view.id, window);
    ImGui::FocusWindow(window);
    g.ActiveIdUsingNavDirMask |= 0xF;
    g.ActiveIdUsingNavInputMask |= 1u << ImGuiNavInput_Cancel;
    for (const ImGuiKey key : {ImGuiKey_Home, ImGuiKey_End, ImGuiKey_PageUp, ImGuiKey_PageDown, ImGuiKey_Tab})
        g.ActiveIdUsingKeyInputMask |= ImU64(1) << key;
    view.focus = false;
    view.touched = now();
}

/// Click: the cursor; twice: the word; three times: the line. A drag goes on as it began.
void followMouse(View& view, const Shown& shown, const Page& page, bool hovered, Heard& heard) {
    Text& text = shown.text;
    const ImGuiIO& io = ImGui::GetIO();
    const Spot under = spotUnder(text, page, io.MousePos);
    if (hovered && io.MouseClicked[0]) {
        view.clicks = io.MouseClickedCount[0];
        view.dragging = true;
        heard.moved = true;
        newStep(text);
        if (io.KeyCtrl) {
            place(text, under);
            heard.definition = true;
            view.dragging = false;
        } else if (view.clicks >= 3) {
            view.taken = lineAt(text, under.line);
            select(text, view.taken);
        } else if (view.clicks == 2) {
            view.taken = wordAt(text, under);
            select(text, view.taken);
        } else {
            place(text, under, io.KeyShift);
            view.taken = {text.anchor, text.anchor};
        }
        view.touched = now();
    } else if (view.dragging && io.MouseDown[0]) {
        if (io.MouseDelta.x == 0.0f && io.MouseDelta.y == 0.0f && page.lo.y <= io.MousePos.y &&
            io.MousePos.y <= page.hi.y)
            return;
        Range whole{under, under};
        if (view.clicks >= 3) whole = lineAt(text, under.line);
        if (view.clicks == 2) whole = wordAt(text, under);
        const bool forward = whole.to > view.taken.from;
        place(text, forward ? view.taken.from : view.taken.to);
        place(text, forward ? std::max(whole.to, view.taken.to) : whole.from, true);
        view.follow = true;
        view.touched = now();
    } else {
        view.dragging = false;
    }
}

void fillRange(ImDrawList* list, const Text& text, const Page& page, Range range, ImU32 color) {
    for (int i = std::max(range.from.line, page.first); i <= std::min(range.to.line, page.last); ++i) {
        const float from = i == range.from.line ? float(columnOf(text, range.from)) : 0.0f;
        float to = i == range.to.line
                       ? float(columnOf(text, range.to))
                       : float(columnOf(text, {i, int(text.lines[std::size_t(i)].size())})) + 0.5f;
        if (to <= from) continue;
        list->AddRectFilled({page.x(from), page.y(i)}, {page.x(to), page.y(i + 1)}, color);
    }
}

/// A wave below the characters, two pixels high.
void drawWave(ImDrawList* list, const Text& text, const Page& page, const Mark& mark, float scale) {
    const ImU32 color = themeColor(mark.error ? ThemeColor::error : ThemeColor::warning);
    for (int i = std::max(mark.range.from.line, page.first); i <= std::min(mark.range.to.line, page.last);
         ++i) {
        const float from = i == mark.range.from.line ? float(columnOf(text, mark.range.from)) : 0.0f;
        float to = i == mark.range.to.line
                       ? float(columnOf(text, mark.range.to))
                       : float(columnOf(text, {i, int(text.lines[std::size_t(i)].size())}));
        to = std::max(to, from + 1.0f);
        const float step = 2.0f * scale, y = page.y(i + 1) - 1.5f * scale;
        float x = page.x(from);
        bool up = false;
        for (const float end = page.x(to); x < end; x += step, up = !up)
            list->AddLine({x, up ? y - step : y}, {std::min(x + step, end), up ? y : y - step}, color,
                          1.3f * scale);
    }
}

void drawLine(ImDrawList* list, const Shown& shown, const Page& page, int line) {
    const Text& text = shown.text;
    const std::string& string = text.lines[std::size_t(line)];
    const std::vector<Stretch>& pieces = shown.colouring.line(text, line);
    int byte = 0, column = 0;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        const Stretch piece = pieces[k];
        for (; byte < piece.begin; ++byte)
            column += string[std::size_t(byte)] == '\t' ? kTabWidth - column % kTabWidth
                                                        : (string[std::size_t(byte)] & 0xC0) != 0x80;
        const float x = page.x(float(column));
        if (x > page.hi.x) return;
        const char* begin = string.data() + piece.begin;
        // Of a comment that is far longer than the window only what may be seen.
        const int most = int((page.hi.x - x) / page.cell.x) * 4 + 8;
        list->AddText(shown.font, shown.font->FontSize, {x, page.y(line)},
                      inkColor(shown.colouring.ink(text, line, k, shown.names)), begin,
                      begin + std::min(piece.length, most));
    }
}

void drawNumbers(ImDrawList* list, const Shown& shown, const Page& page, const View& view) {
    for (int i = page.first; i <= page.last; ++i) {
        const std::string number = std::to_string(i + 1);
        const bool here = view.inside && i == shown.text.cursor.line;
        list->AddText(shown.font, shown.font->FontSize,
                      {page.lo.x - 1.5f * page.cell.x - float(number.size()) * page.cell.x, page.y(i)},
                      themeColor(here ? ThemeColor::text : ThemeColor::codeNumber), number.c_str());
    }
}

void drawBrackets(ImDrawList* list, View& view, const Shown& shown, const Page& page) {
    const Text& text = shown.text;
    if (view.framed != text.version || view.framedAt != text.cursor) {
        view.framed = text.version, view.framedAt = text.cursor;
        view.pair = brackets(text, shown.colouring);
    }
    if (!view.pair) return;
    const bool lonely = view.pair->first == view.pair->second;
    for (const Spot spot : {view.pair->first, view.pair->second}) {
        const float x = page.x(float(columnOf(text, spot)));
        list->AddRect({x, page.y(spot.line)}, {x + page.cell.x, page.y(spot.line + 1)},
                      themeColor(lonely ? ThemeColor::error : ThemeColor::quiet), 2.0f);
    }
}

bool lit(const View& view) {
    const double since = now() - view.touched;
    return since >= kBlinks || std::fmod(since, 2.0 * kBlink) < kBlink;
}

void drawPage(View& view, const Shown& shown, const Page& page) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const Text& text = shown.text;
    drawNumbers(list, shown, page, view);
    list->PushClipRect({page.lo.x - 2.0f, page.lo.y}, page.hi, true);
    const int row = text.cursor.line;
    if (view.inside && !text.selects())
        list->AddRectFilled({page.lo.x - 2.0f, page.y(row)}, {page.hi.x, page.y(row + 1)},
                            themeColor(ThemeColor::codeLine));
    if (view.search.open)
        for (const Range& range : findAll(text, view.search.words, page.first, page.last))
            fillRange(list, text, page, range, themeColor(ThemeColor::codeFound));
    if (text.selects())
        fillRange(list, text, page, text.selection(),
                  themeColor(view.inside ? ThemeColor::textSelected : ThemeColor::codeNotSelected));
    if (view.inside) drawBrackets(list, view, shown, page);
    for (int i = page.first; i <= page.last; ++i) drawLine(list, shown, page, i);
    for (const Mark& mark : shown.marks)
        if (mark.range.to.line >= page.first && mark.range.from.line <= page.last)
            drawWave(list, text, page, mark, shown.scale);
    if (view.inside && lit(view)) {
        const float x = std::round(page.x(float(columnOf(text, text.cursor)))),
                    wide = std::max(1.0f, std::round(1.5f * shown.scale));
        list->AddRectFilled({x, page.y(row)}, {x + wide, page.y(row + 1)}, themeColor(ThemeColor::text));
    }
    list->PopClipRect();
}

/// Scrolls so far that the cursor is seen.
void scrollToCursor(const Text& text, const Page& page) {
    const float x = page.x(float(columnOf(text, text.cursor))), top = page.y(text.cursor.line);
    const float side = 3.0f * page.cell.x;
    if (top < page.lo.y) ImGui::SetScrollY(ImGui::GetScrollY() + top - page.lo.y);
    if (top + page.cell.y > page.hi.y) ImGui::SetScrollY(ImGui::GetScrollY() + top + page.cell.y - page.hi.y);
    if (x < page.lo.x + side) ImGui::SetScrollX(std::max(0.0f, ImGui::GetScrollX() + x - page.lo.x - side));
    if (x > page.hi.x - side) ImGui::SetScrollX(ImGui::GetScrollX() + x - page.hi.x + side);
}

void searchOn(View& view, Text& text, bool backward) {
    const auto found = find(text, view.search.words, backward);
    if (found) select(text, *found);
    view.follow = true;
}

/// The row with the words to be found. Whether the keyboard is in it.
bool showSearch(View& view, Text& text, float scale) {
    ImGui::SetCursorPos({std::round(kMargin * scale), std::round(0.5f * kMargin * scale)});
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("Find");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(std::max(60.0f * scale, ImGui::GetContentRegionAvail().x - 150.0f * scale));
    if (view.search.focus) ImGui::SetKeyboardFocusHere();
    const bool focusing = std::exchange(view.search.focus, false);
    const std::string before = view.search.words;
    const bool next =
        ImGui::InputText("##find", &view.search.words,
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    const bool inside = ImGui::IsItemActive();
    const bool escaped =
        ImGui::IsItemDeactivated() && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    if (view.search.words != before && !escaped) {
        // As it is typed, from where the last place found begins.
        const Spot from = text.selection().from;
        place(text, from);
        searchOn(view, text, false);
    }
    if (next) searchOn(view, text, ImGui::GetIO().KeyShift), view.search.focus = true;
    ImGui::SameLine();
    if (ImGui::SmallButton("<")) searchOn(view, text, true), view.focus = true;
    ImGui::SameLine();
    if (ImGui::SmallButton(">")) searchOn(view, text, false), view.focus = true;
    ImGui::SameLine();
    const std::size_t count = view.search.words.empty()
                                  ? 0
                                  : findAll(text, view.search.words, 0, int(text.lines.size()) - 1).size();
    ImGui::TextDisabled("%zu found", count);
    if (escaped) {
        view.search.open = false;
        view.focus = true;
    }
    return inside || focusing || view.search.focus;
}

}  // namespace

ImU32 inkColor(Ink ink) { return themeColor(kInks[std::size_t(ink)]); }
ImU32 paperColor() { return themeColor(ThemeColor::canvas); }

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double nextBlink(const View& view) {
    const double since = now() - view.touched;
    if (!view.inside || since >= kBlinks) return std::numeric_limits<double>::infinity();
    return kBlink - std::fmod(since, kBlink) + 0.001;
}

Heard showText(View& view, const Shown& shown, const char* id, ImVec2 size) {
    Text& text = shown.text;
    Heard heard;
    const bool was = view.inside;
    ImGui::PushStyleColor(ImGuiCol_ChildBg, paperColor());
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::BeginChild(id, size, true,
                      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoScrollbar |
                          ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NavFlattened);
    ImGui::PopStyleColor();
    const bool searched = view.search.open;
    bool searching = searched && showSearch(view, text, shown.scale);
    const bool closed = searched && !view.search.open;  // by a key that has been heard
    const uint64_t before = text.version;
    const Spot cursorBefore = text.cursor;

    ImGui::BeginChild(
        "##lines", {0, 0}, false,
        ImGuiWindowFlags_NoMove | ImGuiWindowFlags_HorizontalScrollbar | ImGuiWindowFlags_NavFlattened);
    ImGui::PopStyleVar();
    ImGuiWindow* window = ImGui::GetCurrentWindow();
    view.id = window->GetID("##text");
    measure(view, text);

    Page page;
    page.cell = {shown.font->GetCharAdvance(' '), std::round(shown.font->FontSize * 1.22f)};
    const float margin = std::round(kMargin * shown.scale);
    const int digits = std::max(2, int(std::to_string(text.lines.size()).size()));
    page.gutter = float(digits + 2) * page.cell.x + margin;
    const ImRect inner = window->InnerRect;
    page.lo = {inner.Min.x + page.gutter, inner.Min.y};
    page.hi = inner.Max;
    page.origin = {inner.Min.x + page.gutter - ImGui::GetScrollX(),
                   inner.Min.y + margin - ImGui::GetScrollY()};
    page.first = std::clamp(int((page.lo.y - page.origin.y) / page.cell.y), 0, int(text.lines.size()) - 1);
    page.last = std::clamp(int((page.hi.y - page.origin.y) / page.cell.y), 0, int(text.lines.size()) - 1);

    ImGuiContext& g = *ImGui::GetCurrentContext();
    const bool shownAtAll = ImGui::ItemAdd(inner, view.id, nullptr, ImGuiItemFlags_Inputable);
    const bool asked = (g.LastItemData.StatusFlags & ImGuiItemStatusFlags_FocusedByTabbing) != 0 ||
                       g.NavActivateId == view.id || g.NavActivateInputId == view.id;
    const ImGuiIO& io = ImGui::GetIO();
    const bool covered = shown.covered && shown.covered(io.MousePos);
    const bool hovered = !covered && ImGui::ItemHoverable(inner, view.id);
    if (hovered) ImGui::SetMouseCursor(ImGuiMouseCursor_TextInput);
    // While the bars are dragged the keyboard comes back.
    const bool scrolling =
        g.ActiveId != 0 && (g.ActiveId == ImGui::GetWindowScrollbarID(window, ImGuiAxis_X) ||
                            g.ActiveId == ImGui::GetWindowScrollbarID(window, ImGuiAxis_Y));
    if (view.scrolled && !scrolling && g.ActiveId == 0) view.focus = true;
    view.scrolled = scrolling && was;
    view.follow |= view.focus || asked;
    if (view.focus || asked || (hovered && io.MouseClicked[0])) activate(view);
    if (g.ActiveId == view.id && io.MouseClicked[0] && !hovered && !covered) ImGui::ClearActiveID();

    bool active = g.ActiveId == view.id;
    if (active) {
        g.WantTextInputNextFrame = 1;
        g.ActiveIdAllowOverlap = !io.MouseDown[0];  // what lies elsewhere can be clicked at once
        followMouse(view, shown, page, hovered, heard);
        if (!view.dragging && !closed) hearKeys(view, shown, page.lines(), heard);
        active = g.ActiveId == view.id;
    }
    if (view.search.focus) searching = true;
    view.inside = active || searching || view.scrolled || view.focus || view.hold;
    heard.entered = view.inside && !was;
    heard.left = was && !view.inside;
    heard.changed = text.version != before;
    if (heard.changed || text.cursor != cursorBefore) view.follow = true, view.touched = now();
    if (heard.changed) measure(view, text);

    // The text's size, for the bars.
    ImGui::SetCursorPos({0, 0});
    ImGui::Dummy({page.gutter + float(view.widest + 4) * page.cell.x,
                  float(text.lines.size()) * page.cell.y + 2.0f * margin});
    page.last = std::min(page.last, int(text.lines.size()) - 1);
    page.first = std::min(page.first, page.last);
    if (shownAtAll) drawPage(view, shown, page);
    ImGui::RenderNavHighlight(inner, view.id);
    const bool followed = std::exchange(view.follow, false);
    if (followed) scrollToCursor(text, page);

    if (hovered && !view.dragging && page.lo.x <= io.MousePos.x) {
        const int line = int(std::floor((io.MousePos.y - page.origin.y) / page.cell.y));
        const int column = int(std::floor((io.MousePos.x - page.origin.x) / page.cell.x));
        if (line >= 0 && line < int(text.lines.size()) && column >= 0) {
            const Spot spot = spotAt(text, line, float(column));
            if (columnOf(text, spot) == column && spot.byte < int(text.lines[std::size_t(line)].size()))
                heard.hovered = spot;
        }
    }
    heard.cell = page.cell;
    heard.area[0] = page.lo, heard.area[1] = page.hi;
    heard.placeOf = [page, &text](Spot spot) {
        return ImVec2(page.x(float(columnOf(text, spot))), page.y(spot.line));
    };
    heard.cursor = {page.x(float(columnOf(text, text.cursor))), page.y(text.cursor.line + 1)};
    ImGui::EndChild();
    ImGui::EndChild();
    // Where the field itself is cut by what it stands in.
    if (followed) {
        const float bottom = std::clamp(heard.cursor.y + page.cell.y, inner.Min.y, inner.Max.y);
        const float top = std::clamp(heard.cursor.y - 2 * page.cell.y, inner.Min.y, bottom);
        const ImRect clip = ImGui::GetCurrentWindow()->InnerClipRect;
        if (bottom > clip.Max.y)
            ImGui::SetScrollY(ImGui::GetScrollY() + bottom - clip.Max.y);
        else if (top < clip.Min.y)
            ImGui::SetScrollY(ImGui::GetScrollY() + top - clip.Min.y);
    }
    return heard;
}

}  // namespace fw::editor::code
