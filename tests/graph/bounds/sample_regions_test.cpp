// The regions that the samples have: found as close to their solids as they were.
#include <gtest/gtest.h>

#include "graph/bounds/region.h"
#include "graph/compile/compile.h"
#include "graph/document/json.h"

namespace fw::sample_regions_test {

struct SampleRegion {
    const char* name;
    Box box;
};

const SampleRegion kRegions[] = {
    {"blobs", {{-2.02001, -0.42001, -2.02001}, {2.02001, 2.62001, 2.02001}}},
    {"brick_block", {{-1.00001, -0.75001, -0.75001}, {1.00001, 0.75001, 0.75001}}},
    {"camera_flight", {{-8.00001, -2.30001, -8.00001}, {8.00001, 2.10001, 8.00001}}},
    {"csg_part", {{-0.75001, -0.75001, -0.75001}, {0.75001, 0.75001, 0.75001}}},
    {"cube_morph", {{-0.70001, -0.70001, -0.70001}, {0.70001, 0.70001, 0.70001}}},
    {"cut_duck", {{-0.83939, -0.61267, -1.2908}, {0.18001, 1.4616, 1.38}}},
    {"dam_break", {{-2.10001, -0.11563, -0.60704}, {2.10001, 2.11564, 0.60704}}},
    {"drop_in_bowl", {{-0.99554, -1.04001, -0.99554}, {0.99554, 1.19001, 0.99554}}},
    {"dusk_city", {{-24.00001, -6.11174, -24.00001}, {24.00001, 14.90001, 24.00001}}},
    {"eroded_duck", {{-0.69944, -0.4849, -1.18635}, {0.69944, 1.35478, 1.27555}}},
    {"figure", {{-1.17001, -1.46001, -0.40117}, {1.17001, 1.70001, 0.40117}}},
    {"fountain", {{-1.60001, -0.60001, -1.10001}, {1.60001, 1.60001, 1.10001}}},
    {"goblet", {{-0.43501, -0.01501, -0.43501}, {0.43501, 1.51501, 0.43501}}},
    {"gyroid_sphere", {{-1.00001, -1.00001, -1.00001}, {1.00001, 1.00001, 1.00001}}},
    {"island", {{-2.00001, -0.15001, -2.00001}, {2.00001, 0.98432, 2.00001}}},
    {"landscape", {{-4.00001, -1.20001, -4.00001}, {4.00001, 1.20001, 4.00001}}},
    {"menger", {{-1.00001, -1.00001, -1.00001}, {1.00001, 1.00001, 1.00001}}},
    {"mesh_morph", {{-0.75001, -0.75001, -0.75001}, {0.75001, 0.75001, 0.75001}}},
    {"moving_booleans", {{-1.00001, -1.50001, -1.00001}, {1.00001, 1.50001, 1.00001}}},
    {"mushroom", {{-1.00001, -0.70001, -1.00001}, {1.00001, 1.35001, 1.00001}}},
    {"table_and_stool", {{-0.81251, -0.04001, -0.81251}, {1.60001, 1.14001, 0.81251}}},
    {"talk_1_box", {{-1.00001, -2.00001, -1.00001}, {1.00001, 2.00001, 1.00001}}},
    {"talk_2_cut", {{-1.00001, -2.00001, -1.00001}, {1.00001, 2.00001, 1.00001}}},
    {"talk_3_more_cuts", {{-1.00001, -2.00001, -1.00001}, {1.00001, 2.00001, 1.00001}}},
    {"talk_4_rooms", {{-1.00001, -2.00001, -1.00001}, {1.00001, 2.00001, 1.00001}}},
    {"talk_5_holes", {{-1.00001, -2.00001, -1.00001}, {1.00001, 2.00001, 1.00001}}},
    {"talk_6_combined", {{-1.00001, -2.00001, -1.00001}, {1.00001, 2.00001, 1.00001}}},
    {"talk_7_repeat_y", {{-1.00001, -5.00001, -1.00001}, {1.00001, 5.00001, 1.00001}}},
    {"talk_8_repeat_xy", {{-7.00001, -5.00001, -1.00001}, {7.00001, 5.00001, 1.00001}}},
    {"tidal_wave", {{-4.08002, -0.19001, -2.08342}, {4.08002, 2.20001, 2.08342}}},
    {"tower", {{-1.00001, -2.00001, -1.00001}, {1.00001, 2.00001, 1.00001}}},
    {"tower_expression", {{-1.00001, -2.00001, -1.00001}, {1.00001, 2.00001, 1.00001}}},
    {"worn_steps", {{-1.20001, -0.25001, -1.20001}, {1.20001, 1.55001, 1.20001}}},
};

TEST(Region, OfSamples) {
    for (const auto& [name, box] : kRegions) {
        SCOPED_TRACE(name);
        const Result<Graph> graph =
            readGraph(std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples/" + name + ".field.json", nullptr);
        ASSERT_TRUE(graph) << format(graph.error());
        const Result<Program> program = compile(*graph, {.bake = draftInPlace});
        ASSERT_TRUE(program) << format(program.error());
        const Region region = findRegion(*program);
        ASSERT_EQ(region.extent, Extent::bounded);
        constexpr double kRounding = 1e-5;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_GE(region.box.lo[axis], box.lo[axis] - kRounding) << axis;
            EXPECT_LE(region.box.hi[axis], box.hi[axis] + kRounding) << axis;
        }
    }
}

}  // namespace fw::sample_regions_test
