// Which keys run which command: those of the command table, or what the preferences have in their place.
#pragma once

#include <utility>
#include <vector>

#include "editor/files/preferences.h"
#include "editor/shortcuts.h"

namespace fw::editor {

struct Command;

/// What each key runs; of two of one key the first that can be done.
using Keymap = std::vector<std::pair<Shortcut, const Command*>>;
Keymap keymapOf(const Preferences& preferences);

/// The command's keys, parted by blanks: the preferences', else the table's.
std::string keysOf(const Command& command, const Preferences& preferences);
/// The keys one by one; words that name no key are left out.
std::vector<Shortcut> shortcutsOf(const std::string& keys);
std::string textOf(const std::vector<Shortcut>& keys);

/// Another command that this key runs in the same place; nullptr if there is none. Over the picture a key may
/// do other things than elsewhere.
const Command* userOf(const Shortcut& key, const Command& besides, const Preferences& preferences);
/// Gives the command these keys, and takes them from every other of the same place.
void setKeys(Preferences& preferences, const Command& command, const std::vector<Shortcut>& keys);
/// As the table has it; keys that other commands got meanwhile come back.
void resetKeys(Preferences& preferences, const Command& command);

}  // namespace fw::editor
