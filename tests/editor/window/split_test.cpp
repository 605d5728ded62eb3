// The picture split in several: where they are, who has the hand, and what becomes of each eye.
#include "editor/viewport/split.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "editor/files/arrangement.h"
#include "editor/viewport/projection.h"
#include "tests/support/editor/driven_editor.h"
#include "tests/support/editor/graphs.h"

namespace fw::editor::split_test {

using test::DrivenEditor;

bool apart(const Area& a, const Area& b) {
    return a.hi.x < b.lo.x || b.hi.x < a.lo.x || a.hi.y < b.lo.y || b.hi.y < a.lo.y;
}

TEST(Split, PicturesLieApartInWholePixelsAndFillTheRoom) {
    for (const Area& room : {Area{{820.4f, 90.7f}, {1276.2f, 440.1f}}, Area{{10, 20}, {200, 700}}})
        for (std::size_t count = 2; count <= kMostPictures; ++count) {
            const auto places = placesOf(room, count, 2.0f);
            float covered = 0.0f;
            for (std::size_t i = 0; i < count; ++i) {
                const Area& place = places[i];
                EXPECT_EQ(place.width(), std::floor(place.width()));
                EXPECT_EQ(place.height(), std::floor(place.height()));
                EXPECT_GE(place.lo.x, room.lo.x - 1.0f);
                EXPECT_GE(place.lo.y, room.lo.y - 1.0f);
                EXPECT_LE(place.hi.x, room.hi.x);
                EXPECT_LE(place.hi.y, room.hi.y);
                covered += place.width() * place.height();
                for (std::size_t k = 0; k < i; ++k) EXPECT_TRUE(apart(place, places[k])) << i << " " << k;
            }
            EXPECT_GT(covered, 0.96f * room.width() * room.height()) << count;
        }
    const Area room{{0, 0}, {402, 302}};
    EXPECT_EQ(placesOf(room, 1, 2.0f)[0].hi.x, 402.0f);
    // The third angle: the right view right of the front one, the top view above it.
    const auto places = placesOf(room, 4, 2.0f);
    const Area &front = places[1], &right = places[2], &top = places[3];
    EXPECT_EQ(front.lo.y, right.lo.y);
    EXPECT_LT(front.hi.x, right.lo.x);
    EXPECT_EQ(front.lo.x, top.lo.x);
    EXPECT_LT(top.hi.y, front.lo.y);
    for (std::size_t i = 1; i < 4; ++i) {
        EXPECT_EQ(places[i].width(), places[0].width()) << "of one size: images are made once";
        EXPECT_EQ(places[i].height(), places[0].height());
    }
}

TEST(Split, TheHandTakesItsEyeAlong) {
    Viewport view;
    view.ownCamera = true, view.orbit.distance = 3.0;
    view.place = {{0, 0}, {10, 10}};
    view.shown.seen.fov = 21.0;
    takeHand(view, 2);
    EXPECT_FALSE(view.ownCamera);
    EXPECT_EQ(view.awaits, Side::right);
    view.takeCamera();
    EXPECT_FALSE(view.awaits) << "it looks from where it is put";
    view.orbit.distance = 5.0;
    {
        const Borrowed borrowed(view, 0);
        EXPECT_EQ(view.orbit.distance, 3.0);
        EXPECT_EQ(view.place.hi.x, 10.0f);
        EXPECT_EQ(view.shown.seen.fov, 21.0);
        view.orbit.distance = 4.0;
    }
    EXPECT_EQ(view.split.hand, 2u);
    EXPECT_EQ(view.orbit.distance, 5.0);
    takeHand(view, 0);
    EXPECT_EQ(view.orbit.distance, 4.0);
}

TEST(Split, EyesWaitForASolidAndThenLookAtAllOfIt) {
    Viewport view;
    view.split.count = 4;
    const auto places = placesOf({{0, 0}, {402, 302}}, 4, 2.0f);
    for (std::size_t i = 0; i < 4; ++i) {
        const Borrowed borrowed(view, i);
        view.place = places[i];
    }
    PreviewWish wish;
    wishPictures(view, wish);
    EXPECT_EQ(wish.width, 200);
    ASSERT_EQ(wish.others.size(), 3u);
    for (const PreviewEye& eye : wish.others) EXPECT_EQ(eye.width, 0) << "nothing is known of the solid";

    view.shown.picture = {1, 1, {0, 0, 0, 0}};
    view.shown.region = {{1, 2, 3}, {3, 4, 9}};
    takeHand(view, 3);
    wish = {};
    wishPictures(view, wish);
    EXPECT_EQ(wish.first, 3u);
    EXPECT_FALSE(wish.camera) << "the first is seen as before";
    constexpr Side kSides[] = {Side::front, Side::right, Side::top};
    for (std::size_t i = 0; i < 3; ++i) {
        ASSERT_TRUE(wish.others[i].camera);
        EXPECT_EQ(wish.others[i].width, 200);
        EXPECT_EQ(wish.others[i].camera->fov, kParallelFov);
        const Borrowed borrowed(view, i + 1);
        EXPECT_EQ(sideOf(view.orbit), kSides[i]);
        EXPECT_EQ(view.orbit.target, (Vector{2, 3, 6}));
        view.orbit.distance = 1.0;
    }
    wish = {};
    wishPictures(view, wish);
    takeHand(view, 0);
    for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(view.eyes[i].orbit.distance, 1.0) << "once only";
    resetEyes(view);
    for (std::size_t i = 1; i < 4; ++i) EXPECT_TRUE(view.eyes[i].awaits);
}

constexpr const char* kBall = R"({"id": "ball", "type": "sphere", "at": [0, 0]},
    {"id": "out", "type": "output", "at": [260, 0], "inputs": {"surface": {"from": "ball"}, "resolution": 16}})";

/// Frames until that is so; pictures need not rest.
void until(DrivenEditor& editor, const std::function<bool()>& is) {
    for (int i = 0; i < 3000 && !is(); ++i) {
        const bool fresh = exchange(*editor);
        if (editor->shell.waitEvents(0.0) || fresh) editor->shell.frame([&] { showEditor(*editor); });
        fw::test::rest(0.01);
    }
    EXPECT_TRUE(is());
    editor.settle();
}

TEST(Split, IsOfTheWindowItsEyesOfTheDocument) {
    DrivenEditor editor(test::graphOf(kBall));
    NEEDS_EDITOR(editor);
    Viewport& view = editor->viewport;
    until(editor, [&] { return view.texture != nullptr; });
    const Camera before = view.shown.seen;
    editor.keys("ctrl+alt+q");
    EXPECT_EQ(view.split.count, 4u);
    const auto sees = [&](std::size_t i) {
        const Borrowed borrowed(view, i);
        return view.texture ? wordsOf(view, editor->document.graph()) : std::string("nothing");
    };
    until(editor, [&] { return sees(3) != "nothing"; });
    EXPECT_EQ(sees(0), "Whole solid");
    EXPECT_EQ(sees(1), "Front · orthographic");
    EXPECT_EQ(sees(2), "Right · orthographic");
    EXPECT_EQ(sees(3), "Top · orthographic");

    // The mouse brings the hand along, and keys count there; so does V.
    const auto middle = [&](std::size_t i) {
        const Borrowed borrowed(view, i);
        return view.place.centre();
    };
    editor.moveTo(middle(2));
    EXPECT_EQ(view.split.hand, 2u);
    editor.keys("7");
    EXPECT_EQ(sees(2), "Top · orthographic");
    EXPECT_EQ(sees(1), "Front · orthographic");
    editor.keys("v");
    EXPECT_EQ(view.split.hand, 3u);
    editor.keys("ctrl+1");
    EXPECT_EQ(sees(3), "Back · orthographic");
    editor.moveTo(middle(1));
    editor.send("click --delay 0 4");
    EXPECT_TRUE(view.ownCamera && view.split.hand == 1);
    EXPECT_FALSE(editor->document.canUndo()) << "cameras are no step";

    // Another document has eyes of its own.
    fw::test::writeText(editor.path("other.field.json"), writeGraph(test::graphOf(kBall)));
    openTab(*editor);
    replaceDocument(*editor, Document(test::graphOf(kBall)));
    editor.settle();
    EXPECT_EQ(view.split.count, 4u);
    until(editor, [&] { return sees(2) != "nothing" && sees(3) != "nothing"; });
    EXPECT_EQ(sees(2), "Right · orthographic");
    showTab(*editor, 0);
    until(editor, [&] { return sees(2) != "nothing" && sees(3) != "nothing"; });
    EXPECT_EQ(sees(2), "Top · orthographic");
    EXPECT_EQ(sees(3), "Back · orthographic");

    // It is kept with the window, and one picture is the first as it was.
    const Json kept = arrangementOf(*editor);
    editor.keys("ctrl+alt+q");
    EXPECT_EQ(view.split.count, 1u);
    EXPECT_EQ(view.split.hand, 0u);
    EXPECT_EQ(sees(0), "Whole solid");
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(view.shown.seen.target[i], before.target[i], 0.01);
    EXPECT_GT(view.place.width(), 1.9f * float(view.split.panes[0].place.width()));
    arrange(*editor, kept);
    EXPECT_EQ(view.split.count, 4u);
    for (const int wrong : {-3, 0, 99}) {
        Json other = kept;
        other["pictures"] = wrong;
        arrange(*editor, other);
        EXPECT_EQ(view.split.count, wrong > 1 ? 4u : 1u) << wrong;
    }
}

}  // namespace fw::editor::split_test
