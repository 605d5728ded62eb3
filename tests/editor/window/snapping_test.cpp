// Places that a drag snaps to: which is found near the mouse, and vertices of meshes from files.
#include "editor/viewport/snapping.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "editor/viewport/projection.h"
#include "graph/document/named_parameters.h"
#include "tests/support/editor/driven_editor.h"
#include "tests/support/editor/graphs.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::editor::snapping_test {

using test::DrivenEditor;

Lens lensFrom(const Triple& eye) {
    Camera camera;
    camera.position = eye, camera.target = {0, 0, 0}, camera.fov = 40;
    return Lens(camera, {{100, 50}, {500, 350}});
}

TEST(Snapping, FindsWhatASearchThroughAllFinds) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> at(-3.0, 3.0);
    std::vector<glm::dvec3> places;
    for (int i = 0; i < 4000; ++i) places.emplace_back(at(random), at(random), at(random));
    SnapPlaces snap(places);
    for (const Triple& eye : {Triple{0, 0, 9}, Triple{7, 3, 1}}) {
        const Lens lens = lensFrom(eye);
        for (int i = 0; i < 300; ++i) {
            const ImVec2 mouse(float(100 + random() % 400), float(50 + random() % 300));
            const float reach = float(1 + random() % 20);
            const auto away = [&](const glm::dvec3& place) {
                const auto seen = lens.project(place);
                return seen && lens.place.contains(*seen) ? std::hypot(seen->x - mouse.x, seen->y - mouse.y)
                                                          : INFINITY;
            };
            float least = INFINITY;
            for (const glm::dvec3& place : places) least = std::min(least, away(place));
            const auto found = snap.near(lens, mouse, reach);
            ASSERT_EQ(found.has_value(), least < reach) << least << " of " << reach;
            if (!found) continue;
            EXPECT_LE(away(*found), std::min(least + 4.01f, reach));
            for (const glm::dvec3& place : places) {  // none in nearly the same place lies before it
                if (away(place) > least + 3.99f || away(place) >= reach) continue;
                EXPECT_LE(glm::dot(*found - lens.eye, lens.forward),
                          glm::dot(place - lens.eye, lens.forward) + 1e-9);
            }
        }
    }
    SnapPlaces none({});
    EXPECT_FALSE(none.near(lensFrom({0, 0, 9}), {300, 200}, 20));
}

constexpr const char* kCorner = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

std::string meshAndBall(const std::string& behind) {
    return R"({"id": "file", "type": "mesh_file", "at": [0, 0], "inputs": {"path": "corner.obj"}},
        {"id": "solid", "type": "mesh_to_field", "at": [220, 0], "inputs": {"mesh": {"from": "file"}, "resolution": 24}},
        {"id": "put", "type": "translate", "at": [440, 0], "inputs": {"surface": {"from": "solid"}, "offset": [10, 0, 0]}},
        {"id": "ball", "type": "sphere", "at": [0, 300], "inputs": {"radius": 0.4}},
        {"id": "place", "type": "translate", "at": [220, 300], "inputs": {"surface": {"from": "ball"}, "offset": [12, 1, 0]}},
        {"id": "both", "type": "union", "at": [660, 0], "inputs": {"a": {"from": "put"}, "b": {"from": "place"}}},
        {"id": "out", "type": "output", "at": [880, 0], "inputs": {"surface": {"from": ")" +
           behind + R"("}, "resolution": 24}})";
}

TEST(Snapping, VerticesOfAMeshStandWhereItsFieldDoes) {
    const fw::test::TempDir folder;
    fw::test::writeText(folder.path("corner.obj"), kCorner);
    Graph graph = test::graphOf(meshAndBall("both"));
    graph.path = folder.path("a.field.json");
    const auto found = meshVertices(graph, "", {"place"}, "", 0.0);
    ASSERT_EQ(found.size(), 4u);
    for (const glm::dvec3& corner :
         {glm::dvec3(10, 0, 0), glm::dvec3(11, 0, 0), glm::dvec3(10, 2, 0), glm::dvec3(10, 0, 3)})
        EXPECT_EQ(std::ranges::count(found, corner), 1);
    EXPECT_TRUE(meshVertices(graph, "", {"put"}, "", 0.0).empty()) << "it goes along";
    EXPECT_TRUE(meshVertices(graph, "", {}, "ball", 0.0).empty()) << "it is not in the picture";
    const auto alone = meshVertices(graph, "", {}, "solid", 0.0);
    EXPECT_EQ(std::ranges::count(alone, glm::dvec3(1, 0, 0)), 1) << "shown alone it is not moved";
    std::filesystem::remove(folder.path("corner.obj"));
    graph.node("file")->set("path", [] {
        InputValue gone;
        gone.value = std::string("gone.obj");
        return gone;
    }());
    EXPECT_TRUE(meshVertices(graph, "", {}, "", 0.0).empty());
}

TEST(Snapping, AHandleIsDraggedToAVertexOfAMesh) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    fw::test::writeText(editor.path("corner.obj"), kCorner);
    fw::test::writeText(editor.path("a.field.json"), writeGraph(test::graphOf(meshAndBall("both"))));
    openFile(*editor, editor.path("a.field.json"));
    editor->canvas.select({"place"});
    Viewport& view = editor->viewport;
    for (int i = 0; i < 6000 && !view.texture; ++i) {  // it need not rest
        const bool fresh = exchange(*editor);
        if (editor->shell.waitEvents(0.0) || fresh) editor->shell.frame([&] { showEditor(*editor); });
        fw::test::rest(0.01);
    }
    ASSERT_NE(view.texture, nullptr);
    editor.settle();
    view.gizmo.snap = {.to = Snap::To::vertices, .on = true};
    const Lens lens(view.shown.seen, view.place);
    const auto ball = lens.project({12, 1, 0}), corner = lens.project({10, 2, 0});
    ASSERT_TRUE(ball && corner);
    editor.drag(*ball, {corner->x + 5, corner->y - 3});
    const auto offset = inputNumbers(*editor->document.graph().node("place"), "offset");
    ASSERT_EQ(offset.size(), 3u);
    EXPECT_NEAR(offset[0], 10.0, 1e-6);
    EXPECT_NEAR(offset[1], 2.0, 1e-6);
    EXPECT_NEAR(offset[2], 0.0, 1e-6);
    EXPECT_EQ(editor->document.undoName(), "Move Translate");
}

}  // namespace fw::editor::snapping_test
