#include "editor/keymap.h"

#include <algorithm>
#include <sstream>

#include "editor/commands.h"

namespace fw::editor {

namespace {

/// Whether one key cannot be of both: over the picture, and on the timeline, it may do other things than
/// elsewhere.
bool shareKeys(const Command& a, const Command& b) {
    const auto where = [](Heard heard) { return heard == Heard::canvas ? Heard::everywhere : heard; };
    return where(a.heard) == where(b.heard);
}

}  // namespace

Keymap keymapOf(const Preferences& preferences) {
    Keymap keymap;
    for (const Command& command : commands())
        for (const Shortcut& key : shortcutsOf(keysOf(command, preferences)))
            keymap.emplace_back(key, &command);
    return keymap;
}

std::string keysOf(const Command& command, const Preferences& preferences) {
    const auto changed = preferences.shortcuts.find(command.id);
    return changed == preferences.shortcuts.end() ? command.keys : changed->second;
}

std::vector<Shortcut> shortcutsOf(const std::string& keys) {
    std::vector<Shortcut> all;
    std::istringstream words(keys);
    for (std::string word; words >> word;)
        if (const auto key = shortcutOf(word)) all.push_back(*key);
    return all;
}

std::string textOf(const std::vector<Shortcut>& keys) {
    std::string text;
    for (const Shortcut& key : keys) text += (text.empty() ? "" : " ") + textOf(key);
    return text;
}

const Command* userOf(const Shortcut& key, const Command& besides, const Preferences& preferences) {
    for (const auto& [each, command] : keymapOf(preferences))
        if (each == key && command != &besides && shareKeys(*command, besides)) return command;
    return nullptr;
}

void setKeys(Preferences& preferences, const Command& command, const std::vector<Shortcut>& keys) {
    const auto give = [&](const Command& to, const std::vector<Shortcut>& given) {
        const std::string text = textOf(given);
        if (text == to.keys)
            preferences.shortcuts.erase(to.id);
        else
            preferences.shortcuts[to.id] = text;
    };
    for (const Command& other : commands()) {
        if (&other == &command || !shareKeys(other, command)) continue;
        std::vector<Shortcut> left = shortcutsOf(keysOf(other, preferences));
        if (std::erase_if(left, [&](const Shortcut& key) { return std::ranges::count(keys, key) > 0; }) > 0)
            give(other, left);
    }
    give(command, keys);
}

void resetKeys(Preferences& preferences, const Command& command) {
    setKeys(preferences, command, shortcutsOf(command.keys));
}

}  // namespace fw::editor
