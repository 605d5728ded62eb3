// Sweeps of parameters: ranges, tables, their combinations, and what their files are called.
#include "graph/document/sweep.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/graph/temp_dir.h"

namespace fw::sweep_test {

std::vector<std::string> stems(const std::vector<std::string>& texts) {
    const Result<std::vector<Variant>> variants = readSweep(texts);
    if (!variants) return {format(variants.error())};
    std::vector<std::string> names;
    for (const Variant& variant : *variants) names.push_back(variant.stem);
    return names;
}

std::string refusal(const std::vector<std::string>& texts) {
    const Result<std::vector<Variant>> variants = readSweep(texts);
    return variants ? "" : format(variants.error());
}

using Names = std::vector<std::string>;

TEST(Sweep, ARangeHasBothEndsAndRoundNumbersBetween) {
    EXPECT_EQ(stems({"hole=0.1:0.9:9"}), (Names{"hole=0.1", "hole=0.2", "hole=0.3", "hole=0.4", "hole=0.5",
                                                "hole=0.6", "hole=0.7", "hole=0.8", "hole=0.9"}));
    EXPECT_EQ(stems({"x=2:-2:3"}), (Names{"x=2", "x=0", "x=-2"}));
    EXPECT_EQ(stems({"x=1:2:4"}), (Names{"x=1", "x=1.33333333333", "x=1.66666666667", "x=2"}));
    EXPECT_EQ(stems({"x=3:3:1"}), (Names{"x=3"}));
    EXPECT_EQ(stems({"x=1e-9:1e9:2"}), (Names{"x=1e-09", "x=1000000000"}));
}

TEST(Sweep, SeveralAreEveryCombination) {
    const auto variants = readSweep(Names{"a=0:1:2", "b=5:7:3"});
    ASSERT_TRUE(variants);
    ASSERT_EQ(variants->size(), 6u);
    EXPECT_EQ((*variants)[1].values, (std::vector<NamedValue>{{"a", "0"}, {"b", "6"}}));
    EXPECT_EQ((*variants)[3].stem, "a=1,b=5");
}

TEST(Sweep, WhatIsNoRangeIsToldWithTheRemedy) {
    for (const auto& [text, why] :
         std::vector<std::pair<std::string, std::string>>{{"hole", "names no parameter"},
                                                          {"=1:2:3", "names no parameter"},
                                                          {"hole=0.5", "is no range"},
                                                          {"hole=1:2:3:4", "is no range"},
                                                          {"hole=a:2:3", "'a' is not a number"},
                                                          {"hole=1:2mmm:3", "'2mmm' is not a number"},
                                                          {"hole=1:2mm:3", "different units"},
                                                          {"hole=1mm:2mm:3mm", "the count is a whole number"},
                                                          {"hole=1:inf:3", "'inf' is not a number"},
                                                          {"hole=1:2:", "'' is not a number"},
                                                          {"hole=1:2:0", "a whole number from 1"},
                                                          {"hole=1:2:2.5", "a whole number from 1"},
                                                          {"hole=1:2:1", "one value has no way to go"},
                                                          {"hole=1:1:5", "all of its values are the same"},
                                                          {"hole=1:2:1e9", "more than 1000000 values"}}) {
        EXPECT_NE(refusal({text}).find(why), std::string::npos) << text << ": " << refusal({text});
        EXPECT_NE(refusal({text}).find("hole=0.1:0.9:9"), std::string::npos) << text;
    }
    EXPECT_NE(refusal({"a=0:1:2", "a=0:1:3"}).find("'a' is swept twice"), std::string::npos);
    EXPECT_NE(refusal({"a=0:1:1001", "b=0:1:1000"}).find("at most 1000000 variants"), std::string::npos);
}

TEST(Sweep, ATableHasAVariantALine) {
    test::TempDir folder;
    const std::string path = folder.path("values.csv");
    test::writeText(path, "\xEF\xBB\xBFhole, \"a \"\"b\"\", c\"\r\n0.1 ,\"1,2,3\"\r\n\r\n0.2,\" x\ny\"\r\n");
    const auto variants = readSweep(Names{path});
    ASSERT_TRUE(variants) << format(variants.error());
    ASSERT_EQ(variants->size(), 2u);
    EXPECT_EQ((*variants)[0].values, (std::vector<NamedValue>{{"hole", "0.1"}, {"a \"b\", c", "1,2,3"}}));
    EXPECT_EQ((*variants)[1].values, (std::vector<NamedValue>{{"hole", "0.2"}, {"a \"b\", c", " x\ny"}}));
    EXPECT_EQ((*variants)[0].stem, "hole=0.1,a _b_, c=1,2,3");
    EXPECT_EQ((*variants)[1].stem, "hole=0.2,a _b_, c= x_y");
}

TEST(Sweep, WhatIsWrongInATableIsToldWithItsLine) {
    test::TempDir folder;
    const std::string path = folder.path("values.csv");
    for (const auto& [text, why] : std::vector<std::pair<std::string, std::string>>{
             {"", "values.csv:1:1: error: has no values"},
             {"hole\n", "has no values"},
             {"hole,\n1,2\n", "values.csv:1:1: error: '' names no parameter"},
             {"a=b\n1\n", "'a=b' names no parameter"},
             {"a,b\n1,2\n\n1\n", "values.csv:4:1: error: has 1 values for 2 names"},
             {"a,b\n1,\n", "values.csv:2:1: error: no value for 'b'"},
             {"a\n\"1\n2\n", "values.csv:2:1: error: a quote is not closed"},
             {"a\n\"1\"2\n", "behind its closing quote"},
             {"a,a\n1,2\n", "'a' is swept twice"}}) {
        test::writeText(path, text);
        EXPECT_NE(refusal({path}).find(why), std::string::npos) << text << ": " << refusal({path});
    }
    EXPECT_NE(refusal({folder.path("none.csv")}).find("none.csv: error: cannot read"), std::string::npos);
    std::filesystem::create_directory(folder.path("folder.csv"));
    EXPECT_NE(refusal({folder.path("folder.csv")}).find("cannot read"), std::string::npos);
}

TEST(Sweep, FilesOfVariantsThatLookAlikeAreNumbered) {
    test::TempDir folder;
    const std::string path = folder.path("v.CSV");
    test::writeText(path, "a\n1/2\n1:2\n3\n");
    EXPECT_EQ(stems({path}), (Names{"000000", "000001", "000002"}));
    test::writeText(path, "a\n" + std::string(300, '1') + "\n2\n");
    EXPECT_EQ(stems({path}), (Names{"000000", "000001"}));
    const auto many = readSweep(Names{"a=1:100:100", "b=1:100:100"});
    ASSERT_TRUE(many);
    EXPECT_EQ(many->size(), 10'000u);
    EXPECT_EQ((*many)[9'999].stem, "a=100,b=100");
}

}  // namespace fw::sweep_test
