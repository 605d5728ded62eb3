// The menu to add nodes from: a search field and what it finds, by mouse or keyboard.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "editor/canvas/keyboard.h"
#include "editor/commands.h"
#include "editor/document/joining.h"
#include "editor/document/library.h"
#include "editor/editor.h"
#include "editor/shell/icons.h"
#include "editor/shell/letters.h"
#include "editor/shell/theme.h"

namespace fw::editor {

namespace {

constexpr const char* kPopup = "Add node";

constexpr std::size_t kUsualShown = 6;

/// One line of the menu: a type, or a group.
struct Offer {
    std::string heading;  ///< above it, where another part of the list begins
    std::string label;
    const NodeType* type = nullptr;
    const Group* group = nullptr;
    const LibraryPart* part = nullptr;
};

/// What the menu can add: all types that can be added here, or those that fit the open wire.
std::vector<const NodeType*> offered(const Editor& editor) {
    const Graph& graph = editor.document.graph();
    std::vector<const NodeType*> types;
    if (editor.add.wish.plug) {
        types = typesThatFit(graph, editor.canvas.scope, *editor.add.wish.plug, editor.add.wish.plugIsOutput);
    } else {
        for (const NodeType& type : nodeTypes()) types.push_back(&type);
    }
    std::erase_if(types, [&](const NodeType* type) {
        const bool onlyInGroups = type->role == NodeRole::groupInput || type->role == NodeRole::groupOutput;
        return type->role == NodeRole::group || type->role == NodeRole::frame ||
               (onlyInGroups && editor.canvas.scope.empty());
    });
    return types;
}

/// The menu as it stands: what matches, the best first; or, before anything is typed, the part that was kept
/// or taken last, if nothing was since, favourites, what was taken last or is taken most, and then all by
/// category.
std::vector<Offer> offersOf(const Editor& editor) {
    const AddMenu& menu = editor.add;
    const Preferences& preferences = editor.files.preferences;
    const std::vector<const NodeType*> types = offered(editor);
    const bool searches = menu.search[0] != 0;
    std::vector<Offer> offers;
    const auto add = [&](const NodeType* type, std::string heading) {
        offers.push_back({std::move(heading), type->label, type});
    };
    if (!searches) {
        const auto part = [&](std::span<const NodeType* const> some, const char* heading) {
            for (const NodeType* type : some) add(type, type == some.front() ? heading : "");
        };
        for (const LibraryPart& last : editor.library.parts)
            if (!menu.wish.plug && !preferences.taken.empty() && last.path == preferences.taken.front())
                offers.push_back({"The last", last.label + " (library)", nullptr, nullptr, &last});
        std::vector<const NodeType*> favourites;
        for (const std::string& id : preferences.favourites)
            for (const NodeType* type : types)
                if (type->id == id) favourites.push_back(type);
        part(favourites, "Favourites");
        part(usualTypes(types, preferences.taken, kUsualShown),
             preferences.taken.empty() || menu.wish.plug ? "Usual" : "Recent");
    }
    std::optional<Category> category;
    for (const NodeType* type : findTypes(menu.search, types, preferences.taken)) {
        const bool first = !searches && category != type->category;
        category = type->category;
        add(type, first ? std::string(categoryName(type->category)) : "");
    }
    if (menu.wish.plug) return offers;
    for (const Group& group : editor.document.graph().groups)
        if (group.id != editor.canvas.scope &&
            match(menu.search, {.label = group.id, .id = group.id}) < kNoMatch)
            offers.push_back({"", readable(group.id) + " (group)", findNodeType("group"), &group});
    // Of many parts those that are asked for.
    for (const LibraryPart& part : editor.library.parts)
        if (searches &&
            match(menu.search, {.label = part.label, .id = {}, .others = {}, .category = part.folder}) <
                kNoMatch)
            offers.push_back({"", part.label + " (library)", nullptr, nullptr, &part});
    return offers;
}

/// What a node that is added with Shift is wired to: the active one, else the output; empty: nothing is
/// there.
std::string wiredTo(const Editor& editor) {
    if (editor.add.wish.plug) return {};
    const std::string& active = editor.canvas.active;
    return active.empty() ? joinedByItself(editor.document.graph(), editor.canvas.scope) : active;
}

/// Adds the node wired to this one, in sight.
void addTo(Editor& editor, const Offer& offer, const std::string& to) {
    Edited edited = addJoined(editor.document.graph(), editor.canvas.scope, offer.type->id, to,
                              offer.group ? offer.group->id : std::string());
    apply(editor, "Add " + offer.type->label, std::move(edited));
    const Boxes boxes(editor.document.graph(), editor.canvas.scope);
    if (const NodeBox* box = boxes.find(editor.canvas.active)) bringIntoSight(editor.canvas.view, box->area);
}

/// Adds the node, and connects it to the open wire; or, if it is to be wired, to what is selected.
void add(Editor& editor, const Offer& offer, bool wired) {
    const AddMenu& menu = editor.add;
    const std::string to = wired ? wiredTo(editor) : std::string();
    if (!offer.part && !to.empty()) {
        if (!offer.group) toFront(editor.files.preferences.taken, offer.type->id, kMostTaken);
        addTo(editor, offer, to);
        return ImGui::CloseCurrentPopup();
    }
    if (offer.part) {
        const LibraryPart part = *offer.part;
        toFront(editor.files.preferences.taken, part.path, kMostTaken);
        addPart(editor, part, position(menu.wish.at), false, to);
        return ImGui::CloseCurrentPopup();
    }
    const NodeType& type = *offer.type;
    Edited edited = addNode(editor.document.graph(), editor.canvas.scope, type.id, position(menu.wish.at),
                            offer.group ? offer.group->id : std::string());
    if (menu.wish.plug && !edited.nodes.empty()) {
        const Plug& plug = *menu.wish.plug;
        const std::string& id = edited.nodes.front();
        const auto other = menu.wish.plugIsOutput
                               ? fittingInput(edited.graph, editor.canvas.scope, plug, id)
                               : fittingOutput(edited.graph, editor.canvas.scope, id, plug);
        if (other)
            edited.graph = menu.wish.plugIsOutput ? connect(edited.graph, editor.canvas.scope, plug, *other)
                                                  : connect(edited.graph, editor.canvas.scope, *other, plug);
    }
    if (!offer.group) toFront(editor.files.preferences.taken, type.id, kMostTaken);
    apply(editor, "Add " + type.label, std::move(edited));
    ImGui::CloseCurrentPopup();
}

/// What is typed to search for has no tabs: that key takes what is chosen.
int noTabs(ImGuiInputTextCallbackData* data) { return data->EventChar == '\t' ? 1 : 0; }

/// A star at the line's end: filled for a favourite, which a click on it makes or ends. Whether the mouse is
/// on it.
bool showStar(Editor& editor, const NodeType& type, bool seen) {
    std::vector<std::string>& favourites = editor.files.preferences.favourites;
    const bool is = std::ranges::find(favourites, type.id) != favourites.end();
    const ImVec2 lo = ImGui::GetItemRectMin(), hi = ImGui::GetItemRectMax();
    const float side = hi.y - lo.y;
    const ImVec2 corner(hi.x - side, lo.y);
    const bool over = seen && ImGui::IsMouseHoveringRect(corner, hi);
    if (!is && !seen) return false;
    std::array<ImVec2, 10> points;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const float angle = float(i) * std::numbers::pi_v<float> / 5.0f;
        const float radius = side * (i % 2 == 0 ? 0.38f : 0.16f);
        points[i] = {corner.x + 0.5f * side + radius * std::sin(angle),
                     corner.y + 0.5f * side - radius * std::cos(angle)};
    }
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImU32 color = themeColor(over || is ? ThemeColor::warning : ThemeColor::text);
    if (is)
        for (std::size_t i = 0; i < points.size(); ++i)  // a star is not convex: it has a fan of triangles
            list->AddTriangleFilled({corner.x + 0.5f * side, corner.y + 0.5f * side}, points[i],
                                    points[(i + 1) % points.size()], color);
    else
        list->AddPolyline(points.data(), int(points.size()), color, ImDrawFlags_Closed, 1.0f);
    return over;
}

void turnFavourite(Editor& editor, const std::string& id) {
    std::vector<std::string>& favourites = editor.files.preferences.favourites;
    if (std::erase(favourites, id) == 0) favourites.push_back(id);
    keepPreferences(editor);
}

}  // namespace

void showAddMenu(Editor& editor) {
    AddMenu& menu = editor.add;
    if (menu.opened) {
        menu.search[0] = 0;
        menu.chosen = 0;
        lookAtLibrary(editor);
        ImGui::OpenPopup(kPopup);
        ImGui::SetNextWindowPos(editor.canvas.view.toScreen(menu.wish.at));
    }
    const float unit = editor.shell.scale();
    const ImVec2 whole = ImGui::GetMainViewport()->Size;
    ImGui::SetNextWindowSize({std::min(300 * unit, 0.95f * whole.x), std::min(380 * unit, 0.95f * whole.y)});
    if (!ImGui::BeginPopup(kPopup)) return;
    if (menu.opened) ImGui::SetKeyboardFocusHere();
    menu.opened = false;
    ImGui::SetNextItemWidth(-1);
    const char* hint = wiredTo(editor).empty() ? "Search" : "Shift+Enter: wired; Tab: and the next one";
    if (ImGui::InputTextWithHint("##search", hint, menu.search, sizeof menu.search,
                                 ImGuiInputTextFlags_AllowTabInput | ImGuiInputTextFlags_CallbackCharFilter,
                                 noTabs))
        menu.chosen = 0;

    const std::vector<Offer> offers = offersOf(editor);
    const int count = int(offers.size());
    const bool down = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_DownArrow)),
               up = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_UpArrow));
    menu.chosen += int(down) - int(up);
    menu.chosen = count > 0 ? (menu.chosen % count + count) % count : 0;
    const bool entered = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter)) ||
                         ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_KeyPadEnter));

    // Wired, and the menu comes again for what is next.
    const bool goesOn = menu.search[0] != 0 && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Tab), false);

    ImGui::BeginChild("##found");
    if (count == 0)
        ImGui::TextDisabled(menu.wish.plug ? "Nothing of that name fits this wire" : "Nothing has that name");
    const Offer* taken = nullptr;
    const NodeType* turned = nullptr;
    for (int i = 0; i < count; ++i) {
        const Offer& offer = offers[std::size_t(i)];
        if (!offer.heading.empty()) ImGui::TextDisabled("%s", offer.heading.c_str());
        ImGui::PushID(i);
        const float em = ImGui::GetFontSize();
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        const std::string label = fitted(offer.label, ImGui::GetContentRegionAvail().x - 3.2f * em);
        const bool clicked =
            ImGui::Selectable("##offer", i == menu.chosen, ImGuiSelectableFlags_DontClosePopups);
        ImDrawList* list = ImGui::GetWindowDrawList();
        list->AddText({corner.x + 1.8f * em, corner.y}, themeColor(ThemeColor::text), label.c_str());
        drawBadge(*list, offer.type ? offer.type->category : Category::structure,
                  {corner.x + 0.9f * em, corner.y + 0.5f * em}, em);
        const bool hovered = ImGui::IsItemHovered();
        if (i == menu.chosen && (down || up)) ImGui::SetScrollHereY();
        const bool ofType = offer.type && !offer.group;
        const bool onStar = ofType && showStar(editor, *offer.type, hovered);
        if (hovered && ofType)
            ImGui::SetTooltip("%s", onStar ? "Favourites stand first" : offer.type->doc.c_str());
        ImGui::PopID();
        if (clicked && onStar)
            turned = offer.type;
        else if (clicked || ((entered || goesOn) && i == menu.chosen))
            taken = &offer;
    }
    ImGui::EndChild();
    // At once, whatever has been typed.
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) ImGui::CloseCurrentPopup();
    if (turned) turnFavourite(editor, turned->id);
    if (taken) add(editor, *taken, goesOn || ImGui::GetIO().KeyShift);
    if (taken && goesOn) editor.windows.chosen = &command("node.add");
    ImGui::EndPopup();
}

}  // namespace fw::editor
