// Keys of the picture.
#include <gtest/gtest.h>

#include <cmath>

#include "graph/document/scene.h"
#include "tests/editor/program/shortcut_cases.h"

namespace fw::editor::test::shortcut_cases {

using fw::test::readText;

/// The mouse over the picture, once there is one, and it is looked at as after these keys.
void lookFirst(Program& program, const std::string& keys, const std::string& words) {
    program.moveTo(picturePart(program).centre());
    lookUntil(program, keys, words);
}

void showNormals(Program& program) {
    lookFirst(program, "1", "Front · perspective");
    program.keys("Z", 2);
    program.waitFor("Normals");
    program.keys("0");
    waitForLook(program, "Whole solid");
}

/// From one side, which the picture says, to another, which it says then.
Case lookFrom(const std::string& first, const std::string& firstWords, const std::string& words) {
    return [=](Program& program, const std::string& keys) {
        lookFirst(program, first, firstWords);
        program.keys(keys);
        waitForLook(program, words);
        program.keys("0");
        waitForLook(program, "Whole solid");
        program.moveTo(program.nowhere());
    };
}

/// The camera that is seen by, as it is saved when it becomes the scene's.
Camera cameraSeen(Program& program) {
    program.keys("Ctrl+Alt+0");
    const Result<Scene> scene = readScene(program.saved().scene);
    if (!scene || !scene->camera) throw std::runtime_error("the scene has no camera");
    return *scene->camera;
}

/// What becomes of the camera in front of the solid: where it is by its target then, and where its target is
/// by what it was.
struct Looked {
    double right, up, back;           ///< of the eye, in distances
    double panRight, panUp, panBack;  ///< of the target
};

Looked lookAfter(Program& program, const std::string& keys) {
    lookFirst(program, "1", "Front · perspective");
    const Camera before = cameraSeen(program);
    program.keys(keys);
    const Camera after = cameraSeen(program);
    program.keys("Ctrl+Z", 2);
    program.keys("0");
    program.moveTo(program.nowhere());
    const double distance = before.position[2] - before.target[2];
    const auto& [x, y, z] = after.target;
    return {(after.position[0] - x) / distance, (after.position[1] - y) / distance,
            (after.position[2] - z) / distance, (x - before.target[0]) / distance,
            (y - before.target[1]) / distance,  (z - before.target[2]) / distance};
}

/// Turned by a tenth of a height, about the target.
Case turned(double right, double up) {
    return [=](Program& program, const std::string& keys) {
        const Looked looked = lookAfter(program, keys);
        EXPECT_NEAR(looked.right, right * std::sin(0.3), 1e-3);
        EXPECT_NEAR(looked.up, up * std::sin(0.3), 1e-3);
        EXPECT_NEAR(looked.back, std::cos(0.3), 1e-3);
        EXPECT_NEAR(std::hypot(looked.panRight, looked.panUp, looked.panBack), 0.0, 1e-6);
    };
}

/// The solid goes this way in the picture, the camera the other.
Case panned(int right, int up) {
    return [=](Program& program, const std::string& keys) {
        const Looked looked = lookAfter(program, keys);
        const auto sign = [](double by) { return (by > 1e-3) - (by < -1e-3); };
        EXPECT_EQ(sign(looked.panRight), -right);
        EXPECT_EQ(sign(looked.panUp), -up);
        EXPECT_NEAR(looked.panBack, 0.0, 1e-6);
        EXPECT_NEAR(looked.back, 1.0, 1e-6);
    };
}

Case zoomed(double distance) {
    return [=](Program& program, const std::string& keys) {
        const Looked looked = lookAfter(program, keys);
        EXPECT_NEAR(looked.back, distance, 1e-3);
        EXPECT_NEAR(std::hypot(looked.panRight, looked.panUp, looked.panBack), 0.0, 1e-6);
    };
}

/// Which of the buttons over the picture is lit: unlike the two others, which are alike; "": none.
std::string toolInUse(Program& program) {
    constexpr const char* kTools[] = {"Move", "Rotate", "Scale"};
    const float left = program.view.panel.hi.x;
    const Picture seen = program.screen();
    std::array<uint8_t, 3> colors[3];
    for (std::size_t i = 0; i < 3; ++i) {
        const Area word = program.waitFor(
            kTools[i], Area{{left, program.pictureEnd() - 140}, {left + 100, program.pictureEnd() + 30}});
        const auto beside =
            4 * (std::size_t(word.centre().y) * std::size_t(seen.width) + std::size_t(word.lo.x) - 5);
        std::copy_n(&seen.pixels[beside], 3, colors[i].begin());
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const auto &one = colors[(i + 1) % 3], &other = colors[(i + 2) % 3];
        if (one == other && colors[i] != one) return kTools[i];
    }
    return "";
}

/// Another tool is taken up, for the node that is selected.
Case takeUp(const std::string& first, const std::string& firstTool, const std::string& tool) {
    return [=](Program& program, const std::string& keys) {
        pick(program, {"box"});
        program.moveTo(picturePart(program).centre());
        EXPECT_TRUE(eventually([&] {  // once the mouse is known to be over the picture
            program.keys(first);
            return toolInUse(program) == firstTool;
        }));
        program.keys(keys);
        EXPECT_TRUE(eventually([&] { return toolInUse(program) == tool; })) << tool;
        program.moveTo(program.nowhere());
    };
}

/// The tool that measures says what it waits for, until the same keys put it down.
void takeUpMeasure(Program& program, const std::string& keys, const std::string& hint) {
    lookFirst(program, "1", "Front · perspective");
    program.keys(keys);
    program.waitFor(hint);
    program.keys(keys);
    program.waitUntilGone(hint);
}

const Cases& pictureCases() {
    static const Cases all = {
        {"picture.frame",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "1", "Front · perspective");
             p.wheel(picturePart(p).centre(), -8);
             const Camera far = cameraSeen(p);
             p.keys(keys);
             waitForLook(p, "Front · perspective");
             const Camera near = cameraSeen(p);
             const auto away = [](const Camera& camera) { return camera.position[2] - camera.target[2]; };
             EXPECT_LT(away(near), 0.7 * away(far));
             EXPECT_GT(away(near), 1.0);
             for (const double middle : near.target) EXPECT_NEAR(middle, 0.0, 0.5);
         }},
        {"view.split",
         [](Program& p, const std::string& keys) {
             p.keys(keys);
             p.waitFor("Front · orthographic");
             p.waitFor("Right · orthographic");
             p.waitFor("Top · orthographic");
             p.keys(keys);
             p.waitUntilGone("Front · orthographic");
         }},
        {"picture.next_picture",
         [](Program& p, const std::string& keys) {
             p.keys("Ctrl+Alt+Q");
             p.waitFor("Front · orthographic");
             p.keys("Alt+2");
             p.keys(keys);
             p.keys("Ctrl+1");  // in the second of them
             p.waitFor("Back · orthographic");
             p.keys("1");
             p.waitUntilGone("Back · orthographic");
             p.keys("Ctrl+Alt+Q");
             p.waitUntilGone("Front · orthographic");
             p.keys("Alt+1");
         }},
        {"picture.measure",
         [](Program& p, const std::string& keys) { takeUpMeasure(p, keys, "Length: click two points"); }},
        {"picture.angle",
         [](Program& p, const std::string& keys) {
             takeUpMeasure(p, keys, "Angle: click a point of one side");
         }},
        {"picture.radius",
         [](Program& p, const std::string& keys) { takeUpMeasure(p, keys, "Radius: click the solid"); }},
        {"picture.wall",
         [](Program& p, const std::string& keys) { takeUpMeasure(p, keys, "Wall: click the solid"); }},
        {"picture.line",
         [](Program& p, const std::string& keys) {
             takeUpMeasure(p, keys, "Plot: click two points");
             p.keys("Alt+P");  // its panel
         }},
        {"picture.clear",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "1", "Front · perspective");
             p.keys("Shift+M");
             p.waitFor("Length: click two points");
             p.keys(keys);
             p.waitUntilGone("Length: click two points");
         }},
        {"picture.shading",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "1", "Front · perspective");
             p.waitFor("Normals");
             p.keys(keys);
             p.clickOn("Colours");
             p.clickOn("Normals");  // as all others look at it
             p.waitUntilGone("Wireframe");
             p.waitFor("Normals");
             lookFirst(p, "0", "Whole solid");
         }},
        {"picture.move", takeUp("R", "Scale", "Move")},
        {"picture.rotate", takeUp("R", "Scale", "Rotate")},
        {"picture.scale", takeUp("W", "Move", "Scale")},
        {"picture.snap",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "1", "Front · perspective");
             p.keys(keys);
             p.waitFor("Snap: drags in the picture");
             p.keys(keys);
             p.waitFor("Snap is off");
         }},
        {"picture.axes",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "1", "Front · perspective");
             p.keys(keys, 2);
             p.waitFor("Axes: the node's own");
             p.keys(keys);
             p.waitFor("Axes: those of the numbers");
         }},
        {"picture.reset",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "7", "Top · perspective");
             p.keys(keys);
             waitForLook(p, "Whole solid");
         }},
        {"picture.front", lookFrom("7", "Top · perspective", "Front · perspective")},
        {"picture.back", lookFrom("7", "Top · perspective", "Back · perspective")},
        {"picture.right", lookFrom("7", "Top · perspective", "Right · perspective")},
        {"picture.left", lookFrom("7", "Top · perspective", "Left · perspective")},
        {"picture.top", lookFrom("1", "Front · perspective", "Top · perspective")},
        {"picture.bottom", lookFrom("1", "Front · perspective", "Bottom · perspective")},
        {"picture.turn_left", turned(1, 0)},
        {"picture.turn_right", turned(-1, 0)},
        {"picture.turn_up", turned(0, -1)},
        {"picture.turn_down", turned(0, 1)},
        {"picture.pan_left", panned(-1, 0)},
        {"picture.pan_right", panned(1, 0)},
        {"picture.pan_up", panned(0, 1)},
        {"picture.pan_down", panned(0, -1)},
        {"picture.nearer", zoomed(0.88)},
        {"picture.farther", zoomed(1.0 / 0.88)},
        {"picture.to_scene",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "3", "Right · perspective");
             p.keys(keys);
             waitForLook(p, "Scene camera");
             const Result<Scene> scene = readScene(p.saved().scene);
             ASSERT_TRUE(scene && scene->camera);
             const auto &eye = scene->camera->position, &target = scene->camera->target;
             EXPECT_GT(eye[0] - target[0], 1.0);
             EXPECT_NEAR(eye[2], target[2], 1e-6);
         }},
        {"picture.projection",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "1", "Front · perspective");
             const Camera before = cameraSeen(p);
             p.keys(keys);
             waitForLook(p, "Front · orthographic");
             const Camera after = cameraSeen(p);
             EXPECT_EQ(after.fov, kLeastFov);
             EXPECT_GT(after.position[2] - after.target[2], 10.0 * (before.position[2] - before.target[2]));
             // The sides keep it, and so does who goes on from such a camera.
             p.keys("3");
             waitForLook(p, "Right · orthographic");
             p.keys(keys);
             waitForLook(p, "Right · perspective");
             p.keys("Ctrl+Z", 2);
             p.keys("0");
         }},
        {"picture.grid",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "1", "Front · perspective");
             p.keys("5");
             waitForLook(p, "Front · orthographic");
             // The target is at the height of the origin: the line of x goes through the middle, from side
             // to side, beside the solid too.
             const Area part = picturePart(p);
             const auto reddest = [&] {
                 const Picture seen =
                     p.screen(Area{{part.hi.x - 60, part.lo.y}, {part.hi.x - 20, part.hi.y}});
                 int most = 0;
                 for (std::size_t i = 0; i + 3 < seen.pixels.size(); i += 4)
                     most = std::max(most, seen.pixels[i] - std::max(seen.pixels[i + 1], seen.pixels[i + 2]));
                 return most;
             };
             EXPECT_TRUE(eventually([&] { return reddest() < 30; }));
             p.keys(keys);
             EXPECT_TRUE(eventually([&] { return reddest() > 60; }));
             p.keys(keys);
             EXPECT_TRUE(eventually([&] { return reddest() < 30; }));
             p.keys("0");
         }},
        {"picture.keep_view",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "7", "Top · perspective");
             p.keys(keys);
             p.waitFor("kept as view 1");
             EXPECT_NE(readText(p.path("config/fieldwright/editor.json")).find("\"views\""),
                       std::string::npos);
         }},
        {"picture.next_view",
         [](Program& p, const std::string& keys) {
             lookFirst(p, "3", "Right · perspective");
             p.keys("Ctrl+B");
             p.waitFor("kept as view");
             p.keys("5");
             p.keys("7");
             waitForLook(p, "Top · orthographic");
             p.keys("Ctrl+B");
             waitForLook(p, "Top · orthographic");
             p.keys("1");
             waitForLook(p, "Front · orthographic");
             lookUntil(p, keys, "Right · perspective");  // round all that are kept
             lookUntil(p, keys, "Top · orthographic");
             p.keys("0");
         }},
    };
    return all;
}

}  // namespace fw::editor::test::shortcut_cases
