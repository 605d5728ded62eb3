// What the editor keeps beside documents: preferences, copies against crashes, and the list of files.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "editor/files/browser.h"
#include "editor/files/preferences.h"
#include "editor/files/recovery.h"
#include "graph/document/json.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::editor::files_test {

using fw::test::readText;
using fw::test::TempDir;
using fw::test::writeText;

Graph ball(double radius) {
    const std::string text = R"({"fieldwright": 1, "nodes": [{"id": "ball", "type": "sphere",
        "inputs": {"radius": )" +
                             std::to_string(radius) + R"(}}], "from_later": [1, 2]})";
    Result<Graph> graph = parseGraph(text, "", nullptr);
    EXPECT_TRUE(graph);
    return *graph;
}

TEST(Preferences, ComeBackAsTheyWere) {
    const TempDir folder;
    const std::string path = folder.path("new/folder/editor.json");
    std::string problem;
    Preferences wanted = readPreferences(path, problem);
    EXPECT_EQ(wanted, Preferences{});
    EXPECT_EQ(problem, "");
    addRecent(wanted, "/a/../b.field.json");
    addRecent(wanted, "/c.field.json");
    addRecent(wanted, "/b.field.json");
    EXPECT_EQ(wanted.recent, (std::vector<std::string>{"/b.field.json", "/c.field.json"}));
    for (int i = 0; i < 30; ++i) addRecent(wanted, "/" + std::to_string(i));
    EXPECT_EQ(wanted.recent.size(), kMostRecent);
    EXPECT_EQ(wanted.recent.front(), "/29");
    wanted.scale = 1.5f;
    wanted.shortcuts["edit.undo"] = "Ctrl+Shift+Y";
    wanted.scrolling = "pans";
    wanted.views = Json{{"/29", Json::array()}};
    wanted.panels = Json{{"side", 0.25}};
    wanted.extra = Json{{"later", Json::array({1, 2})}};
    ASSERT_TRUE(savePreferences(wanted, path));
    EXPECT_EQ(readPreferences(path, problem), wanted);
    EXPECT_EQ(problem, "");
    EXPECT_TRUE(savePreferences(wanted, ""));
    EXPECT_FALSE(savePreferences(wanted, "/proc/nowhere/editor.json"));
}

TEST(Preferences, BrokenFilesAreSurvivedAndSetAside) {
    const TempDir folder;
    const std::string path = folder.path("editor.json");
    std::string problem;
    for (const char* text : {"", "{\"scale\": 1.5", "[1]", "\xff\xfe", "null"}) {
        writeText(path, text);
        EXPECT_EQ(readPreferences(path, problem), Preferences{}) << text;
        EXPECT_NE(problem.find("editor.json.broken"), std::string::npos);
        EXPECT_EQ(readText(path + ".broken"), text);
        EXPECT_EQ(folder.names(), std::vector<std::string>{"editor.json.broken"});
    }
    writeText(path,
              R"({"scale": 100, "recent": [7, "/a"], "panels": null, "shortcuts": {"x": 3, "y": "F5"}})");
    const Preferences read = readPreferences(path, problem);
    EXPECT_EQ(read.scale, 0.0f);
    EXPECT_EQ(read.recent, std::vector<std::string>{"/a"});
    EXPECT_EQ(read.shortcuts, (std::map<std::string, std::string>{{"y", "F5"}}));
    EXPECT_NE(problem.find("'scale'"), std::string::npos) << problem;
}

TEST(Recovery, CopiesAfterSoManySecondsOfChange) {
    const TempDir folder;
    const auto start = Recovery::Clock::now();
    const auto after = [&](double seconds) {
        return start +
               std::chrono::duration_cast<Recovery::Clock::duration>(std::chrono::duration<double>(seconds));
    };
    const auto copies = [&] {
        const std::vector<std::string> names = folder.names();
        return std::ranges::count_if(names, [](const auto& name) { return name.ends_with(".field.json"); });
    };
    const auto first = std::make_shared<const Graph>(ball(1)),
               second = std::make_shared<const Graph>(ball(2));
    {
        Recovery recovery(folder.folder.string());
        EXPECT_TRUE(recovery.keep(first, 1, false, after(0)));
        EXPECT_TRUE(recovery.keep(second, 2, true, after(100)));
        // It goes on changing; then it rests.
        uint64_t revision = 2;
        for (double time = 0; time < 0.9 * kRecoverySeconds; time += 0.9 * kRecoveryRest)
            EXPECT_TRUE(recovery.keep(second, revision++, true, after(100 + time)));
        EXPECT_EQ(copies(), 0);
        EXPECT_TRUE(recovery.keep(second, revision, true, after(101 + kRecoverySeconds)));
        EXPECT_TRUE(recovery.keepNow(*second));  // waits for the one before
        EXPECT_EQ(copies(), 1);
        EXPECT_TRUE(leftCopies(folder.folder.string()).empty());  // its editor lives
        EXPECT_TRUE(recovery.keep(first, 90, false, after(130)));
        EXPECT_EQ(copies(), 0);
        EXPECT_TRUE(recovery.keep(second, 91, true, after(140)));
        EXPECT_TRUE(recovery.keep(second, 91, true, after(140 + 0.9 * kRecoveryRest)));
        EXPECT_EQ(copies(), 0);
        EXPECT_TRUE(recovery.keep(second, 91, true, after(140 + 1.1 * kRecoveryRest)));
        EXPECT_TRUE(recovery.keepNow(*second));
        EXPECT_EQ(copies(), 1) << "a change that is followed by nothing is kept soon";
        EXPECT_TRUE(recovery.keep(first, 92, false, after(150)));
        EXPECT_TRUE(recovery.keepNow(*first));
        recovery.discard();
    }
    EXPECT_TRUE(folder.names().empty());
    Recovery nowhere("/proc/nowhere");
    EXPECT_EQ(nowhere.path(), "");
    EXPECT_TRUE(nowhere.keep(first, 9, true));
    EXPECT_FALSE(nowhere.keepNow(*first));
}

TEST(Recovery, WhatAKilledProcessLeftIsOffered) {
    const TempDir folder;
    const std::string place = folder.folder.string();
    Graph graph = ball(2.5);
    graph.path = folder.path("tower.field.json.original");
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
        Recovery recovery(place);
        const bool fine = bool(recovery.keepNow(graph));
        if (write(ends[1], fine ? "y" : "n", 1) != 1) _exit(1);
        pause();
        _exit(0);
    }
    char answer = 0;
    ASSERT_EQ(read(ends[0], &answer, 1), 1);
    EXPECT_EQ(answer, 'y');
    EXPECT_TRUE(leftCopies(place).empty());  // it lives
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    close(ends[0]), close(ends[1]);

    const std::vector<LeftCopy> left = leftCopies(place);
    ASSERT_EQ(left.size(), 1u);
    EXPECT_EQ(left[0].original, graph.path);
    EXPECT_EQ(left[0].when.size(), 16u) << left[0].when;
    const Result<Graph> read = readCopy(left[0]);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->path, graph.path);
    EXPECT_EQ(writeGraph(*read), writeGraph(graph));
    removeCopy(left[0]);
    EXPECT_TRUE(folder.names().empty());
}

TEST(Recovery, ABrokenCopyIsOfferedAndExplained) {
    const TempDir folder;
    writeText(folder.path("7-0.field.json"), "{\"fieldwright\": 1, \"nod");
    const std::vector<LeftCopy> left = leftCopies(folder.folder.string());
    ASSERT_EQ(left.size(), 1u);
    EXPECT_EQ(left[0].original, "");
    EXPECT_FALSE(readCopy(left[0]));
    EXPECT_TRUE(leftCopies(folder.path("none")).empty());
}

TEST(FileBrowser, ListsFoldersAndGraphs) {
    const TempDir folder;
    std::filesystem::create_directory(folder.path("zebra"));
    std::filesystem::create_directory(folder.path(".hidden"));
    for (const char* name : {"b.field.json", "A.field.json", "c.json", ".d.field.json", "E.FIELD.JSON"})
        writeText(folder.path(name), "");
    std::string problem;
    EXPECT_EQ(
        listFolder(folder.folder.string(), {{".field.json"}}, problem),
        (std::vector<FolderEntry>{
            {"zebra", true}, {"A.field.json", false}, {"b.field.json", false}, {"E.FIELD.JSON", false}}));
    EXPECT_EQ(problem, "");
    EXPECT_TRUE(listFolder(folder.path("none"), {{".field.json"}}, problem).empty());
    EXPECT_NE(problem, "");
}

TEST(FileBrowser, OpensAndSaves) {
    const TempDir folder;
    std::filesystem::create_directory(folder.path("inner"));
    const std::string a = folder.path("a.field.json"), place = folder.folder.string();
    writeText(a, "");
    FileBrowser browser;
    open(browser, FileBrowser::Kind::open, a);
    EXPECT_EQ(browser.folder, place);
    EXPECT_EQ(browser.name, "a.field.json");
    EXPECT_EQ(choose(browser), a);
    browser.name = "a";
    EXPECT_EQ(choose(browser), a);
    browser.name = "b";
    EXPECT_EQ(choose(browser), std::nullopt);
    EXPECT_NE(browser.problem, "");
    browser.name = "inner";
    EXPECT_EQ(choose(browser), std::nullopt);
    EXPECT_EQ(browser.folder, place + "/inner");
    enter(browser, "..");
    EXPECT_EQ(browser.folder, place);
    // The beginning of a name is enough, of a file or a folder, where no other begins so.
    writeText(folder.path("Tower.field.json"), "");
    writeText(folder.path("tree.field.json"), "");
    enter(browser, place);
    browser.name = "to";
    EXPECT_EQ(choose(browser), folder.path("Tower.field.json"));
    browser.name = "t";
    EXPECT_EQ(choose(browser), std::nullopt);
    EXPECT_EQ(onlyBegunSo(browser), nullptr);
    browser.name = "in";
    EXPECT_EQ(choose(browser), std::nullopt);
    EXPECT_EQ(browser.folder, place + "/inner");
    enter(browser, "..");

    open(browser, FileBrowser::Kind::save, place);
    EXPECT_EQ(choose(browser), std::nullopt);  // no name yet
    browser.name = "new";
    EXPECT_EQ(choose(browser), folder.path("new.field.json"));
    browser.name = "a";
    EXPECT_EQ(choose(browser), std::nullopt);
    EXPECT_TRUE(browser.asking);
    EXPECT_EQ(choose(browser), a);  // asked and answered
    EXPECT_FALSE(browser.asking);
    browser.name = "none/b";
    EXPECT_EQ(choose(browser), std::nullopt);
    EXPECT_NE(browser.problem, "");
}

}  // namespace fw::editor::files_test
