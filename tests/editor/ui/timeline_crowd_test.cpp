// What is drawn of many keys: nothing that is there is left out, and little is drawn twice.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "editor/timeline/columns.h"
#include "editor/timeline/signs.h"

namespace fw::editor::timeline_crowd_test {

const ImVec2 kLo{160, 300}, kHi{1276, 780};

Track randomTrack(std::mt19937& random, int count, std::size_t components) {
    Track track;
    track.name = "offset", track.node = "ball";
    double time = 0.0;
    for (int i = 0; i < count; ++i) {
        Key key;
        key.time = time, key.interpolation = Interpolation(random() % 3);
        for (std::size_t c = 0; c < components; ++c)
            key.value.push_back(double(random() % 2001) * 1e-3 - 1.0);
        track.keys.push_back(std::move(key));
        time += 1e-3 * double(1 + random() % 400);
    }
    return track;
}

/// The curves of the pieces that hold this place, drawn in their order.
std::vector<uint16_t> under(const std::vector<ColumnPiece>& pieces, ImVec2 at) {
    std::vector<uint16_t> curves;
    for (const ColumnPiece& piece : pieces)
        if (at.x >= piece.lo.x && at.x < piece.hi.x && at.y >= piece.lo.y && at.y < piece.hi.y)
            curves.push_back(piece.curve);
    return curves;
}

TEST(Columns, ShowEveryKeyAndBothExtremes) {
    std::mt19937 random(7);
    for (const float side : {1.0f, 2.0f, 3.0f})
        for (const int count : {1, 2, 40, 3000}) {
            const Track track = randomTrack(random, count, 1);
            const double end = track.keys.back().time + 1e-3;
            const TimeView times{.from = -0.1 * end, .to = 1.1 * end, .left = kLo.x, .right = kHi.x};
            const ValueView values{.lo = -1.2, .hi = 1.2, .top = kLo.y, .bottom = kHi.y};
            Columns columns = emptyColumns(kLo, kHi, side);
            paintCurves(columns, track, times, values, 1);
            const std::vector<ColumnPiece> pieces = piecesOf(columns);
            std::size_t most = 0;
            for (const ColumnPiece& piece : pieces)
                EXPECT_LT(piece.lo.x, piece.hi.x), most += piece.curve != 1;
            EXPECT_EQ(most, 0u);
            EXPECT_LE(pieces.size(), std::size_t(columns.count)) << "a stretch in each column";
            for (std::size_t i = 0; i < track.keys.size(); i += 1 + track.keys.size() / 500) {
                const Key& key = track.keys[i];
                EXPECT_EQ(under(pieces, {times.x(key.time), values.y(key.value[0])}).size(), 1u)
                    << side << " " << count << " key " << i;
            }
            // Between keys too, and beyond the first and the last: within a pixel where columns are sampled.
            for (float x = kLo.x; count <= 40 && x < kHi.x; x += 7.0f * side) {
                const float y = values.y(evaluate(track, times.time(x))[0]);
                if (y < kLo.y || y >= kHi.y) continue;
                EXPECT_FALSE(under(pieces, {x + 0.25f, y}).empty()) << side << " " << count << " at " << x;
            }
        }
}

TEST(Columns, AreNotFullerThanTheCurve) {
    // Flat but for one key: the columns away from it are a line.
    Track track;
    for (int i = 0; i < 1000; ++i)
        track.keys.push_back(
            {.time = 0.01 * i, .value = {i == 500 ? 1.0 : 0.0}, .interpolation = Interpolation::linear});
    const TimeView times{.from = 0, .to = 10, .left = 0, .right = 500};
    const ValueView values{.lo = -1, .hi = 1, .top = 0, .bottom = 400};
    Columns columns = emptyColumns({0, 0}, {500, 400}, 1.0f);
    paintCurves(columns, track, times, values, 1);
    const std::vector<ColumnPiece> pieces = piecesOf(columns);
    EXPECT_LE(pieces.size(), 6u) << "what goes on in the next column is one piece";
    float highest = 1e9f;
    for (const ColumnPiece& piece : pieces) {
        highest = std::min(highest, piece.lo.y);
        if (std::abs(piece.lo.x - 250.0f) > 3.0f) { EXPECT_LE(piece.hi.y - piece.lo.y, 2.0f); }
    }
    EXPECT_EQ(highest, 0.0f);
}

TEST(Columns, HaveTheUppermostAlone) {
    std::mt19937 random(11);
    const TimeView times{.from = 0, .to = 100, .left = kLo.x, .right = kHi.x};
    const ValueView values{.lo = -1, .hi = 1, .top = kLo.y, .bottom = kHi.y};
    Columns columns = emptyColumns(kLo, kHi, 2.0f);
    std::vector<Columns> alone;
    for (int i = 0; i < 10; ++i) {
        const Track track = randomTrack(random, 500, 3);
        paintCurves(columns, track, times, values, uint16_t(1 + 3 * i));
        paintCurves(alone.emplace_back(emptyColumns(kLo, kHi, 2.0f)), track, times, values,
                    uint16_t(1 + 3 * i));
    }
    const std::vector<ColumnPiece> pieces = piecesOf(columns);
    double painted = 0;
    for (const ColumnPiece& piece : pieces)
        painted += double((piece.hi.x - piece.lo.x) * (piece.hi.y - piece.lo.y));
    EXPECT_LE(painted, double(columns.count) * columns.high * 4.0) << "no pixel twice";
    for (std::size_t i = 0; i < columns.cells.size(); ++i) {
        uint16_t top = 0;
        for (const Columns& each : alone)
            if (each.cells[i] != 0) top = each.cells[i];
        ASSERT_EQ(columns.cells[i], top);
    }
    for (int i = 0; i < 2000; ++i) {
        const ImVec2 at{kLo.x + float(random() % 1116), kLo.y + float(random() % 480)};
        const std::size_t cell =
            std::size_t((at.x - kLo.x) / 2) * std::size_t(columns.high) + std::size_t((at.y - kLo.y) / 2);
        const std::vector<uint16_t> curves = under(pieces, at);
        ASSERT_EQ(curves.size(), columns.cells[cell] == 0 ? 0u : 1u);
        if (!curves.empty()) { EXPECT_EQ(curves[0], columns.cells[cell]); }
    }
}

TEST(Columns, OfNoRoomAreEmpty) {
    Columns columns = emptyColumns({10, 10}, {10, 5}, 1.0f);
    std::mt19937 random(1);
    paintCurves(columns, randomTrack(random, 5, 2), {.from = 0, .to = 1, .left = 10, .right = 10},
                {.lo = 0, .hi = 1, .top = 10, .bottom = 5}, 1);
    EXPECT_TRUE(piecesOf(columns).empty());
}

TEST(KeySigns, StandForEveryKey) {
    std::mt19937 random(5);
    constexpr float kApart = 4.5f;
    for (int run = 0; run < 200; ++run) {
        std::vector<KeyMark> marks;
        float x = 100.0f;
        for (int i = 0; i < 300; ++i) {
            marks.push_back({x, random() % 3 == 0});
            x += 0.1f * float(random() % (run % 2 ? 20u : 120u));
        }
        const std::vector<KeySign> signs = signsOf(marks, kApart);
        EXPECT_LE(signs.size(), std::size_t((x - 100.0f) / (0.25f * kApart)) + 2) << "few, however many keys";
        for (const KeyMark& mark : marks) {
            bool shown = false, chosen = false;
            for (const KeySign& sign : signs)
                if (mark.x >= sign.first - 0.5f * kApart && mark.x <= sign.last + 0.5f * kApart) {
                    shown = true;
                    chosen = chosen || (sign.chosen && mark.x >= sign.first && mark.x <= sign.last);
                }
            EXPECT_TRUE(shown) << mark.x;
            if (mark.chosen) { EXPECT_TRUE(chosen) << "a selected key is seen as selected: " << mark.x; }
        }
        for (const KeySign& sign : signs) {
            bool begins = false, ends = false;
            for (const KeyMark& mark : marks) {
                begins = begins || (mark.x == sign.first && mark.chosen == sign.chosen);
                ends = ends || (mark.x == sign.last && mark.chosen == sign.chosen);
            }
            EXPECT_TRUE(begins && ends) << "a sign goes from key to key";
        }
    }
    const KeyMark apart[] = {{10, false}, {15, false}, {20, true}, {24, true}, {25, false}, {30, false}};
    const std::vector<KeySign> expected = {{10, 10, false}, {15, 15, false}, {20, 24, true}, {30, 30, false}};
    EXPECT_EQ(signsOf(apart, kApart), expected);
}

TEST(ThinnedPoints, HaveOneInEachSquare) {
    std::mt19937 random(9);
    std::vector<PointMark> marks;
    for (int i = 0; i < 5000; ++i)
        marks.push_back({{float(random() % 1200), float(random() % 500)}, random() % 50 == 0});
    constexpr float kSide = 12.0f;
    const ImVec2 lo{100, 50}, hi{1100, 450};
    const std::vector<std::size_t> kept = thinned(marks, lo, hi, kSide);
    EXPECT_TRUE(std::ranges::is_sorted(kept));
    const auto square = [&](const PointMark& mark) {
        return std::pair(std::floor((mark.at.x - lo.x) / kSide), std::floor((mark.at.y - lo.y) / kSide));
    };
    std::map<std::pair<float, float>, bool> shown;
    for (const std::size_t i : kept)
        EXPECT_TRUE(shown.emplace(square(marks[i]), marks[i].chosen).second) << "one of a square";
    for (const PointMark& mark : marks) {
        if (mark.at.x < lo.x || mark.at.x >= hi.x || mark.at.y < lo.y || mark.at.y >= hi.y) continue;
        const auto found = shown.find(square(mark));
        ASSERT_NE(found, shown.end());
        EXPECT_TRUE(found->second || !mark.chosen) << "a selected one is the one";
    }
    const PointMark two[] = {{{200, 100}, false}, {{201, 101}, false}};
    EXPECT_EQ(thinned(two, lo, hi, kSide), std::vector<std::size_t>{1}) << "the upper one";
}

}  // namespace fw::editor::timeline_crowd_test
