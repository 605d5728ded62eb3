// The regions that the samples have: found as close to their solids as they were.
#include <gtest/gtest.h>

#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/evaluate/region.h"

namespace fw::sample_regions_test {

struct SampleRegion {
    const char* name;
    Box box;
};

const SampleRegion kRegions[] = {
    {"blobs", {{-2, -0.40281, -2}, {2, 2.6, 2}}},
    {"brick_block", {{-1, -0.75, -0.75}, {1, 0.75, 0.75}}},
    {"camera_flight", {{-8, -2.3, -8}, {8, 2.1, 8}}},
    {"csg_part", {{-0.75, -0.75, -0.75}, {0.75, 0.75, 0.75}}},
    {"cube_morph", {{-0.7, -0.7, -0.7}, {0.7, 0.7, 0.7}}},
    {"cut_duck", {{-0.8125, -0.59375, -1.28125}, {0.18018, 1.46875, 1.375}}},
    {"dam_break", {{-2.1, -0.11563, -0.60703}, {2.1, 2.11563, 0.60703}}},
    {"drop_in_bowl", {{-0.99554, -1.04, -0.99554}, {0.99554, 1.19, 0.99554}}},
    {"dusk_city", {{-24, -0.8875, -24}, {24, 14.9, 24}}},
    {"eroded_duck", {{-0.75, -0.5, -1.20312}, {0.75, 1.39062, 1.29688}}},
    {"figure", {{-1.17025, -1.46, -0.40022}, {1.17025, 1.70336, 0.40022}}},
    {"fountain", {{-1.6, -0.6, -1.1}, {1.6, 1.6, 1.1}}},
    {"goblet", {{-0.435, -0.015, -0.435}, {0.435, 1.515, 0.435}}},
    {"gyroid_sphere", {{-1, -1, -1}, {1, 1, 1}}},
    {"island", {{-2, -0.15, -2}, {2, 0.98431, 2}}},
    {"landscape", {{-4, -1.2, -4}, {4, 1.2, 4}}},
    {"menger", {{-1, -1, -1}, {1, 1, 1}}},
    {"mesh_morph", {{-0.75, -0.75, -0.75}, {0.75, 0.75, 0.75}}},
    {"moving_booleans", {{-1, -1.5, -1}, {1, 1.5, 1}}},
    {"mushroom", {{-0.97665, -0.7, -0.97665}, {0.97665, 1.35, 0.97665}}},
    {"table_and_stool", {{-0.8, -0.04, -0.8}, {1.6, 1.14, 0.8}}},
    {"talk_1_box", {{-1, -2, -1}, {1, 2, 1}}},
    {"talk_2_cut", {{-1, -2, -1}, {1, 2, 1}}},
    {"talk_3_more_cuts", {{-1, -2, -1}, {1, 2, 1}}},
    {"talk_4_rooms", {{-1, -2, -1}, {1, 2, 1}}},
    {"talk_5_holes", {{-1, -2, -1}, {1, 2, 1}}},
    {"talk_6_combined", {{-1, -2, -1}, {1, 2, 1}}},
    {"talk_7_repeat_y", {{-1, -5, -1}, {1, 5, 1}}},
    {"talk_8_repeat_xy", {{-7, -5, -1}, {7, 5, 1}}},
    {"tidal_wave", {{-4.15, -0.35938, -2.15281}, {4.15, 2.65063, 2.15281}}},
    {"tower", {{-1, -2, -1}, {1, 2, 1}}},
    {"tower_expression", {{-1, -2, -1}, {1, 2, 1}}},
    {"worn_steps", {{-1.2, -0.25, -1.2}, {1.2, 1.55, 1.2}}},
};

TEST(Region, OfSamples) {
    for (const auto& [name, box] : kRegions) {
        SCOPED_TRACE(name);
        const Result<Graph> graph =
            readGraph(std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples/" + name + ".field.json", nullptr);
        ASSERT_TRUE(graph) << format(graph.error());
        const Result<Program> program = compile(*graph, {.bake = draftInPlace});
        ASSERT_TRUE(program) << format(program.error());
        const Region region = findRegion(program->ir, program->distance(), program->parameters());
        ASSERT_EQ(region.extent, Extent::bounded);
        constexpr double kRounding = 1e-5;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_GE(region.box.lo[axis], box.lo[axis] - kRounding) << axis;
            EXPECT_LE(region.box.hi[axis], box.hi[axis] + kRounding) << axis;
        }
    }
}

}  // namespace fw::sample_regions_test
