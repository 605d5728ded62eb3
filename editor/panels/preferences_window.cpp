// Preferences: how large the interface is and how it looks, and which keys do what.
#include <cmath>

#include "editor/commands.h"
#include "editor/shell/desktop_theme.h"
#include "editor/shell/letters.h"
#include "editor/shell/theme.h"

namespace fw::editor {

namespace {

constexpr const char* kPreferencesTitle = "Preferences";
constexpr float kScales[] = {0.0f, 0.75f, 1.0f, 1.25f, 1.5f, 1.75f, 2.0f, 2.5f, 3.0f, 4.0f};

void keep(Editor& editor) {
    editor.keymap = keymapOf(editor.files.preferences);
    keepPreferences(editor);
}

std::string percent(float scale) { return std::to_string(int(std::lround(100.0f * scale))) + " %"; }

/// The label of a choice that stands in a column beside the others.
void label(const char* words) {
    const float em = ImGui::GetFontSize();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(words);
    ImGui::SameLine(12.0f * em);
    ImGui::SetNextItemWidth(std::min(18.0f * em, ImGui::GetContentRegionAvail().x));
}

/// One of a few, kept by its name; what was chosen, if another was.
template <class Choice, std::size_t count>
std::optional<Choice> choose(Editor& editor, const char* words, const char* id, Choice now,
                             const char* const (&choices)[count], const char* const (&names)[count],
                             std::string& kept) {
    std::optional<Choice> chosen;
    label(words);
    if (!ImGui::BeginCombo(id, choices[std::size_t(now)])) return chosen;
    for (std::size_t i = 0; i < count; ++i)
        if (ImGui::Selectable(choices[i], Choice(i) == now))
            chosen = Choice(i), kept = names[i], keep(editor);
    ImGui::EndCombo();
    return chosen;
}

void showTheme(Editor& editor) {
    std::string& name = editor.files.preferences.theme;
    if (const auto chosen =
            choose(editor, "Theme", "##theme", themeChoice(name), kThemeWords, kThemeNames, name))
        setTheme(themeOf(*chosen));
}

void showScale(Editor& editor) {
    float& scale = editor.files.preferences.scale;
    label("Interface scale");
    const std::string now = scale > 0.0f ? percent(scale) : "The display's";
    if (!ImGui::BeginCombo("##scale", now.c_str())) return;
    for (const float each : kScales)
        if (ImGui::Selectable(each > 0.0f ? percent(each).c_str() : "The display's", each == scale)) {
            editor.shell.setScale(scale = each);
            keep(editor);
        }
    ImGui::EndCombo();
}

void stopWaiting(PreferencesWindow& window) {
    window.command = nullptr;
    window.taken.reset();
}

/// The keys of the command with one of them replaced, or one more.
void give(Editor& editor, const Command& command, const Shortcut& key) {
    PreferencesWindow& window = editor.windows.preferences;
    std::vector<Shortcut> keys = shortcutsOf(keysOf(command, editor.files.preferences));
    std::erase(keys, key);
    if (window.key < keys.size())
        keys[window.key] = key;
    else
        keys.push_back(key);
    setKeys(editor.files.preferences, command, keys);
    stopWaiting(window);
    keep(editor);
}

/// What is pressed while a key is waited for.
void hearKey(Editor& editor) {
    PreferencesWindow& window = editor.windows.preferences;
    if (!window.command || window.taken) return;
    const std::optional<Shortcut> key = pressedNow();
    if (!key) return;
    if (*key == shortcutOf("Escape")) return stopWaiting(window);
    if (userOf(*key, *window.command, editor.files.preferences))
        window.taken = key;
    else
        give(editor, *window.command, *key);
}

/// A key that another command has: whose is it to be?
void showConflict(Editor& editor) {
    PreferencesWindow& window = editor.windows.preferences;
    if (!window.taken) return;
    const Command* user = userOf(*window.taken, *window.command, editor.files.preferences);
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(themeColor(ThemeColor::warning)),
                       "%s is the key of \"%s\".", textOf(*window.taken).c_str(), user ? user->label : "");
    const auto pressed = [](ImGuiKey key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key), false); };
    if (ImGui::Button("Take it from there (Enter)") || pressed(ImGuiKey_Enter))
        return give(editor, *window.command, *window.taken);
    ImGui::SameLine();
    if (ImGui::Button("Leave it there (Escape)") || pressed(ImGuiKey_Escape)) stopWaiting(window);
}

/// The command's keys as buttons: each waits for another one in its place.
void showKeys(Editor& editor, const Command& command) {
    PreferencesWindow& window = editor.windows.preferences;
    const std::vector<Shortcut> keys = shortcutsOf(keysOf(command, editor.files.preferences));
    for (std::size_t i = 0; i <= keys.size(); ++i) {
        ImGui::PushID(int(i));
        const bool waits = window.command == &command && window.key == i;
        const std::string label = waits             ? "Press a key …"
                                  : i < keys.size() ? textOf(keys[i])
                                                    : std::string("+");
        if (ImGui::SmallButton((label + "###key").c_str())) {
            window.taken.reset();
            window.command = waits ? nullptr : &command;
            window.key = i;
        }
        if (i == keys.size() && !waits && ImGui::IsItemHovered()) ImGui::SetTooltip("One more key");
        const std::string after = waits                 ? "No key"
                                  : i + 1 < keys.size() ? textOf(keys[i + 1])
                                                        : std::string("+");
        if (waits || i < keys.size()) besideIfFits(after.c_str());
        bool removed = false;
        if (waits && i < keys.size()) {
            removed = ImGui::SmallButton("No key");
            ImGui::SameLine();
        }
        ImGui::PopID();
        if (!removed) continue;
        std::vector<Shortcut> left = keys;
        left.erase(left.begin() + std::ptrdiff_t(i));
        setKeys(editor.files.preferences, command, left);
        stopWaiting(window);
        return keep(editor);
    }
}

void showCommands(Editor& editor) {
    PreferencesWindow& window = editor.windows.preferences;
    Preferences& preferences = editor.files.preferences;
    std::vector<Choice> choices;
    for (const Command& command : commands())
        choices.push_back(
            {std::string(command.menu) + "  " + command.label + "  " + keysOf(command, preferences)});
    if (!ImGui::BeginTable("##keys", 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY,
                           {0, -ImGui::GetFrameHeightWithSpacing()}))
        return;
    const float em = ImGui::GetFontSize();
    ImGui::TableSetupColumn("Command", ImGuiTableColumnFlags_WidthStretch, 1.3f);
    ImGui::TableSetupColumn("Keys", ImGuiTableColumnFlags_WidthStretch, 1.0f);
    ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, 4.0f * em);
    for (const std::size_t i : findChoices(window.search, choices)) {
        const Command& command = commands()[i];
        ImGui::PushID(command.id);
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextDisabled("%s", command.menu);
        ImGui::SameLine(4.8f * em);
        ImGui::TextWrapped("%s", command.label);
        ImGui::TableNextColumn();
        showKeys(editor, command);
        ImGui::TableNextColumn();
        if (preferences.shortcuts.contains(command.id) && ImGui::SmallButton("Reset")) {
            resetKeys(preferences, command);
            stopWaiting(window);
            keep(editor);
        }
        ImGui::PopID();
    }
    ImGui::EndTable();
}

void showMouse(Editor& editor) {
    Viewport& view = editor.viewport;
    Preferences& kept = editor.files.preferences;
    if (const auto chosen = choose(editor, "The picture by mouse", "##navigation", view.navigation,
                                   kNavigationWords, kNavigationNames, kept.navigation))
        view.navigation = *chosen;
    if (const auto chosen = choose(editor, "Wheel, two fingers", "##scrolling", view.scrolling,
                                   kScrollingWords, kScrollingNames, kept.scrolling))
        view.scrolling = *chosen;
}

}  // namespace

void showPreferences(Editor& editor) {
    PreferencesWindow& window = editor.windows.preferences;
    const bool opens = std::exchange(window.opened, false);
    if (opens) {
        window = {};
        ImGui::OpenPopup(kPreferencesTitle);
    }
    const ImVec2 whole = ImGui::GetMainViewport()->Size;
    const float unit = editor.shell.scale();
    ImGui::SetNextWindowSize(
        {std::min(720.0f * unit, whole.x * 0.95f), std::min(560.0f * unit, whole.y * 0.9f)});
    ImGui::SetNextWindowPos({0.5f * whole.x, 0.5f * whole.y}, ImGuiCond_Always, {0.5f, 0.5f});
    bool stays = true;
    // While a key is waited for, none moves about in the window.
    const bool waited = window.command != nullptr;
    if (!ImGui::BeginPopupModal(kPreferencesTitle, &stays,
                                ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoResize |
                                    ImGuiWindowFlags_NoMove |
                                    (waited ? ImGuiWindowFlags_NoNavInputs : ImGuiWindowFlags_None)))
        return stopWaiting(window);
    showTheme(editor);
    showScale(editor);
    showMouse(editor);
    ImGui::Separator();
    if (opens) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-1);
    ImGui::InputTextWithHint("##search", "Search commands and keys", window.search, sizeof window.search);
    showConflict(editor);
    hearKey(editor);
    showCommands(editor);
    Preferences& preferences = editor.files.preferences;
    ImGui::BeginDisabled(preferences.shortcuts.empty());
    if (ImGui::Button("Reset all keys")) {
        preferences.shortcuts.clear();
        stopWaiting(window);
        keep(editor);
    }
    ImGui::EndDisabled();
    ImGui::SameLine();
    const bool leaves = !waited && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    if (ImGui::Button("Close") || leaves) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

}  // namespace fw::editor
