// The tower built from nothing by hand, in the real program: what is saved makes the same mesh as the sample.
#include <gtest/gtest.h>

#include "editor/canvas/fields.h"
#include "graph/document/json.h"
#include "tests/support/command.h"
#include "tests/support/editor/program.h"

namespace fw::editor::test::end_to_end_tower_test {

using fw::test::readText;
using fw::test::runCommand;

const std::string kSample = FIELDWRIGHT_SOURCE_DIR "/samples/tower.field.json";

/// Places nodes, and says what each of the sample's is called here.
struct Builder {
    Program& program;
    const Graph sample;
    std::map<std::string, std::string> ids = {};
    std::vector<std::string> added = {};

    const Node& original(const std::string& id) const { return *findNode(sample.nodes, id); }

    /// At the sample's place, which is given by the upper left corner.
    void add(const std::string& id, const std::string& search) {
        program.moveTo(program.view.toScreen(vec(*original(id).at)));
        program.keys("Shift+A");
        program.type(search + "\n");
        added.push_back(id);
    }
    /// What was added, in its order, which is that of the file.
    void look() {
        const std::vector<Node>& nodes = program.saved().nodes;
        ASSERT_EQ(nodes.size(), added.size());
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            ids[added[i]] = nodes[i].id;
            EXPECT_EQ(nodes[i].type, original(added[i]).type);
        }
    }
    /// A wire of a surface changes the place of nothing: all of them are looked at together.
    void wire(const std::string& from, const std::string& to, const std::string& input) {
        program.drag({program.output(ids.at(from)), program.input(ids.at(to), input)});
    }
    /// Each number of the input, as the sample has it.
    void set(const std::string& id, const std::string& input) {
        const InputValue& value = *original(id).input(input);
        std::vector<double> numbers;
        if (const auto* number = std::get_if<double>(&value.value)) numbers = {*number};
        if (const auto* list = std::get_if<std::vector<double>>(&value.value)) numbers = *list;
        for (std::size_t i = 0; i < numbers.size(); ++i)
            program.set(ids.at(id), input, int(i), numberText(numbers[i]));
    }
};

std::string meshOf(Program& program, const std::string& graph, const std::string& name) {
    const std::string mesh = program.path(name + ".ply");
    const auto made = runCommand({"export", graph, "-o", mesh, "--resolution", "96"});
    EXPECT_EQ(made.status, 0) << made.errors;
    return readText(mesh);
}

TEST(EndToEnd, BuildsTheTowerFromNothing) {
    Program program(R"({"fieldwright": 1, "nodes": []})", Program::kLittle);
    ASSERT_TRUE(program.works()) << "Xvfb or xdotool is not installed: run ./.install test";
    Result<Graph> sample = readGraph(kSample, nullptr);
    ASSERT_TRUE(sample);
    const std::string empty = program.save();

    program.frameAll();
    program.zoom(-3);
    const ImVec2 all = Boxes(*sample, "").around().centre();
    program.pan({-all.x * program.view.unit(), -all.y * program.view.unit()});

    Builder builder{program, *sample};
    for (const auto& [id, search] : {std::pair{"tower", "box max"},
                                     {"tubes", "expression"},
                                     {"room", "box max"},
                                     {"rooms", "repeat"},
                                     {"floors", "translate"},
                                     {"pierced", "subtract"},
                                     {"hollow", "subtract"},
                                     {"out", "output"}})
        builder.add(id, search);
    ASSERT_NO_FATAL_FAILURE(builder.look());

    // The code and the inputs of the expression, in the inspector.
    program.click(program.title(builder.ids["tubes"]));
    // Reading all of the screen takes as long as ten clicks.
    const Area side{{program.view.panel.hi.x, 0.4f * 800}, {1280, 800}};
    const Area code = program.waitFor("Ctrl+Enter applies it", side);
    program.click({code.lo.x, code.hi.y + 30});
    program.keys("Ctrl+A");
    program.type(builder.original("tubes").code);
    for (const char* input : {"period", "half_width"}) {
        program.clickOn("new input's name", side);
        program.type(std::string(input) + "\n");
    }
    program.save();
    EXPECT_EQ(findNode(program.graph().nodes, builder.ids["tubes"])->code, builder.original("tubes").code);

    for (const auto& [id, input] : {std::pair{"tower", "half_extents"},
                                    {"tubes", "period"},
                                    {"tubes", "half_width"},
                                    {"room", "half_extents"},
                                    {"rooms", "period"},
                                    {"floors", "offset"},
                                    {"out", "resolution"}})
        builder.set(id, input);
    program.click(program.field(builder.ids["rooms"], "neighbours"));

    for (const auto& [from, to, input] : {std::tuple{"room", "rooms", "surface"},
                                          {"rooms", "floors", "surface"},
                                          {"tower", "pierced", "a"},
                                          {"tubes", "pierced", "b"},
                                          {"pierced", "hollow", "a"},
                                          {"floors", "hollow", "b"},
                                          {"hollow", "out", "surface"}})
        builder.wire(from, to, input);

    const std::string built = program.save();
    // Not EXPECT_EQ: it would print them.
    EXPECT_TRUE(meshOf(program, program.file(), "built") == meshOf(program, kSample, "sample"))
        << "another mesh than that of the sample:\n"
        << built;

    program.keys("Ctrl+Z", 40);
    EXPECT_EQ(program.save(), empty);
    program.keys("Ctrl+Shift+Z", 40);
    EXPECT_EQ(program.save(), built);
}

}  // namespace fw::editor::test::end_to_end_tower_test
