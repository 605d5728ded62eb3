// Keys: those of the command table, changed by preferences, and what is found by name.
#include "editor/keymap.h"

#include <gtest/gtest.h>

#include <set>

#include "editor/commands.h"

namespace fw::editor::keymap_test {

Shortcut key(std::string_view text) {
    const auto read = shortcutOf(text);
    EXPECT_TRUE(read) << text;
    return read.value_or(Shortcut{});
}

/// What a key runs, elsewhere than over the picture and on the timeline.
std::string userOf(const Preferences& preferences, std::string_view text) {
    for (const auto& [each, user] : keymapOf(preferences))
        if (each == key(text) && user->heard != Heard::picture && user->heard != Heard::timeline)
            return user->id;
    return "";
}

TEST(Keymap, TheTablesKeysAreWellFormedAndUsedOnce) {
    std::set<std::string> ids;
    for (const Command& each : commands()) {
        EXPECT_TRUE(ids.insert(each.id).second) << each.id;
        EXPECT_EQ(textOf(shortcutsOf(each.keys)), each.keys) << each.id;
        for (const Shortcut& used : shortcutsOf(each.keys))
            EXPECT_EQ(userOf(used, each, {}), nullptr) << each.id << " " << textOf(used);
    }
}

TEST(Keymap, PreferencesStandInPlaceOfTheTable) {
    Preferences preferences;
    EXPECT_EQ(userOf(preferences, "Ctrl+D"), "edit.duplicate");
    preferences.shortcuts["edit.duplicate"] = "F9 nonsense Ctrl+F9";
    EXPECT_EQ(userOf(preferences, "Ctrl+D"), "");
    EXPECT_EQ(userOf(preferences, "F9"), "edit.duplicate");
    EXPECT_EQ(userOf(preferences, "Ctrl+F9"), "edit.duplicate");
    preferences.shortcuts["edit.duplicate"] = "";
    EXPECT_EQ(userOf(preferences, "F9"), "");
}

TEST(Keymap, AKeyThatIsGivenIsTakenFromOthers) {
    Preferences preferences;
    const Command &mute = command("node.mute"), &redo = command("edit.redo");
    ASSERT_NE(userOf(key("Ctrl+Y"), mute, preferences), nullptr);
    EXPECT_EQ(std::string(userOf(key("Ctrl+Y"), mute, preferences)->id), "edit.redo");
    setKeys(preferences, mute, {key("M"), key("Ctrl+Y")});
    EXPECT_EQ(keysOf(mute, preferences), "M Ctrl+Y");
    EXPECT_EQ(keysOf(redo, preferences), "Ctrl+Shift+Z");
    EXPECT_EQ(userOf(key("Ctrl+Y"), mute, preferences), nullptr);

    resetKeys(preferences, redo);
    EXPECT_EQ(keysOf(redo, preferences), redo.keys);
    EXPECT_EQ(keysOf(mute, preferences), "M");
    EXPECT_TRUE(preferences.shortcuts.empty()) << "as the table has them, they are not written";
}

TEST(Keymap, OverThePictureAKeyMayDoAnotherThing) {
    Preferences preferences;
    const Command &mute = command("node.mute"), &front = command("picture.front");
    setKeys(preferences, mute, {key("1")});
    EXPECT_EQ(keysOf(front, preferences), front.keys);
    EXPECT_EQ(userOf(key("1"), mute, preferences), nullptr);
}

TEST(Choices, AreFoundByEveryWordAndBeginningsComeFirst) {
    const Choice choices[] = {{"Node: Frame"}, {"Frame all"}, {"Rename"}, {"frame selection"}};
    EXPECT_EQ(findChoices("FRAME", choices), (std::vector<std::size_t>{1, 3, 0}));
    EXPECT_EQ(findChoices("all fr", choices), (std::vector<std::size_t>{1}));
    EXPECT_EQ(findChoices("", choices).size(), 4u);
    EXPECT_TRUE(findChoices("nothing", choices).empty());
}

}  // namespace fw::editor::keymap_test
