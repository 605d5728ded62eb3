// Keys of the timeline, of which a document is needed that moves.
#include <gtest/gtest.h>

#include <cmath>

#include "graph/document/timeline.h"
#include "tests/editor/program/shortcut_cases.h"

namespace fw::editor::test::shortcut_cases {

/// The timeline with the keyboard, at its beginning; with all keys selected, or none.
void openTimeline(Program& program, bool all) {
    program.keys("Ctrl+T");
    const Area name = program.waitFor("ball · radius");
    program.click({16, program.waitFor("fps").centre().y});  // the first button
    program.click({300, name.centre().y});
    program.waitFor("Double click in a row to add a key.");
    if (!all) return;
    program.keys("Ctrl+A");
    program.waitFor("3 keys");
}

Timeline timelineAfter(Program& program) {
    const Result<Timeline> timeline = readTimeline(program.saved());
    return timeline ? *timeline : Timeline{};
}

/// Presses the keys on the timeline and says which times its keys have, in frames.
std::vector<int> framesAfter(Program& program, const std::vector<std::string>& presses) {
    openTimeline(program, true);
    for (const std::string& keys : presses) program.keys(keys);
    const Timeline timeline = timelineAfter(program);
    program.keys("Ctrl+T");
    std::vector<int> frames;
    for (const Track& track : timeline.tracks)
        for (const Key& key : track.keys) frames.push_back(int(std::lround(key.time * 30.0)));
    return frames;
}

/// Presses the keys on the timeline and says where a marker is added then, in frames.
int markedAfter(Program& program, const std::vector<std::string>& presses) {
    openTimeline(program, false);
    for (const std::string& keys : presses) program.keys(keys);
    program.keys("M");
    const Timeline timeline = timelineAfter(program);
    program.keys("Ctrl+T");
    return timeline.markers.size() == 3 ? int(std::lround(timeline.markers[2].time * 30.0)) : -1;
}

/// What the timeline's first line says after the keys.
void readTime(Program& program, const std::vector<std::string>& presses, const std::string& words) {
    openTimeline(program, false);
    for (const std::string& keys : presses) program.keys(keys);
    const Area line = program.waitFor("fps");
    program.waitFor(words, Area{{0, line.lo.y - 8}, {line.lo.x, line.hi.y + 8}});
    program.keys("Ctrl+T");
}

const Cases& timelineCases() {
    static const Cases all = {
        {"timeline.cut",
         [](Program& p, const std::string& keys) {
             EXPECT_EQ(framesAfter(p, {keys}), std::vector<int>());
             EXPECT_NE(p.clipboard().find("keys_of"), std::string::npos);
         }},
        {"timeline.copy",
         [](Program& p, const std::string& keys) {
             p.clipboard("nothing");
             EXPECT_EQ(framesAfter(p, {keys}), (std::vector{0, 30, 60}));
             EXPECT_NE(p.clipboard().find("keys_of"), std::string::npos);
         }},
        {"timeline.paste",
         [](Program& p, const std::string& keys) {
             EXPECT_EQ(framesAfter(p, {"Ctrl+C", "Up", keys}), (std::vector{0, 30, 60, 90}));
         }},
        {"timeline.duplicate",
         [](Program& p, const std::string& keys) {
             EXPECT_EQ(framesAfter(p, {keys}), (std::vector{0, 30, 60, 61, 91, 121}));
         }},
        {"timeline.delete",
         [](Program& p, const std::string& keys) { EXPECT_EQ(framesAfter(p, {keys}), std::vector<int>()); }},
        {"timeline.select_all",
         [](Program& p, const std::string& keys) {
             openTimeline(p, false);
             p.keys(keys);
             p.waitFor("3 keys");
             p.keys("Ctrl+T");
         }},
        {"timeline.invert",
         [](Program& p, const std::string& keys) {
             openTimeline(p, true);
             p.keys(keys);
             p.waitUntilGone("3 keys");
             p.keys(keys);
             p.waitFor("3 keys");
             p.keys("Ctrl+T");
         }},
        {"timeline.earlier",
         [](Program& p, const std::string& keys) {
             EXPECT_EQ(framesAfter(p, {"Shift+Right", keys}), (std::vector{9, 39, 69}));
         }},
        {"timeline.later",
         [](Program& p, const std::string& keys) {
             EXPECT_EQ(framesAfter(p, {keys}), (std::vector{1, 31, 61}));
         }},
        {"timeline.much_earlier",
         [](Program& p, const std::string& keys) {
             EXPECT_EQ(framesAfter(p, {"Shift+Right", "Right", keys}), (std::vector{1, 31, 61}));
         }},
        {"timeline.much_later",
         [](Program& p, const std::string& keys) {
             EXPECT_EQ(framesAfter(p, {keys}), (std::vector{10, 40, 70}));
         }},
        {"timeline.next_key",
         [](Program& p, const std::string& keys) { EXPECT_EQ(markedAfter(p, {keys}), 30); }},
        {"timeline.previous_key",
         [](Program& p, const std::string& keys) {
             EXPECT_EQ(markedAfter(p, {"Up", "Up", keys}), 30);
         }},
        {"timeline.marker",
         [](Program& p, const std::string& keys) {
             openTimeline(p, false);
             p.keys(keys);
             EXPECT_EQ(timelineAfter(p).markers.size(), 3u);
             p.keys(keys);  // on a marker it asks for its name
             p.type("start\n");
             EXPECT_EQ(timelineAfter(p).markers.back().name, "start");
             p.keys("Ctrl+T");
         }},
        {"timeline.next_marker",
         [](Program& p, const std::string& keys) {
             readTime(p, {keys, keys}, "1 s 15 f");
         }},
        {"timeline.previous_marker",
         [](Program& p, const std::string& keys) {
             readTime(p, {"Up", "Up", keys, keys}, "15 f");
         }},
        {"timeline.selection",
         [](Program& p, const std::string& keys) {
             openTimeline(p, true);
             p.waitFor("3 s");
             p.keys(keys);
             p.waitUntilGone("3 s");
             p.keys("Home");
             p.waitFor("3 s");
             p.keys("Ctrl+T");
         }},
        {"timeline.all",
         [](Program& p, const std::string& keys) {
             openTimeline(p, true);
             p.keys("F");
             p.waitUntilGone("3 s");
             p.keys(keys);
             p.waitFor("3 s");
             p.keys("Ctrl+T");
         }},
        {"timeline.curves",
         [](Program& p, const std::string& keys) {
             openTimeline(p, false);
             p.keys(keys);
             p.waitFor("Keys");
             p.keys(keys);
             p.waitFor("Curves");
             p.keys("Ctrl+T");
         }},
    };
    return all;
}

}  // namespace fw::editor::test::shortcut_cases
