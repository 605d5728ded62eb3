// Frozen graphs: documents of former versions, in tests/data/frozen, must keep their meaning.
//
// Every document opens without an error, is written back byte for byte, and gives the solid that is recorded
// in expected.json: the sign at every sample of the recorded grid, the number of bodies, the volume and the
// bounds. The region search must contain the recorded bounds. All measures come from the brute-force oracle.
//
// FIELDWRIGHT_LONG=1 also compares a grid that is three times finer. FIELDWRIGHT_UPDATE_FROZEN=1 records
// everything again. A change of a recorded value changes the documents of users: explain it in the commit and
// in CHANGELOG.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "graph/base/hash.h"
#include "graph/base/parallel.h"
#include "graph/check/check.h"
#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/document/timeline.h"
#include "graph/library/node_type.h"
#include "tests/support/graph/brute_force_solid.h"
#include "tests/support/graph/solid_bounds.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::frozen_graphs_test {

namespace fs = std::filesystem;
using test::BruteForceSolid;
using test::ReferenceField;
using test::SampleGrid;

const fs::path kFolder = FIELDWRIGHT_SOURCE_DIR "/tests/data/frozen";
const fs::path kExpected = kFolder / "expected.json";
/// About how many cells the grids have.
constexpr double kCoarseCells = 8e3, kFineCells = 27 * kCoarseCells;
/// Samples nearer to 0, relative to the size of the grid, could change their sign by rounding.
constexpr double kRounding = 1e-10;

bool isLong() { return std::getenv("FIELDWRIGHT_LONG") != nullptr; }

/// The names of all documents: "samples/tower".
std::vector<std::string> documentNames() {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(kFolder)) {
        const std::string name = fs::relative(entry.path(), kFolder).string();
        if (name.ends_with(kGraphEnding)) names.push_back(name.substr(0, name.size() - kGraphEnding.size()));
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::string pathOf(const std::string& name) {
    return (kFolder / (name + std::string(kGraphEnding))).string();
}

/// The document. Samples read their meshes and pictures from samples/, so that these are not stored twice.
Result<Graph> opened(const std::string& name) {
    const bool isSample = name.starts_with("samples/");
    const std::string path =
        isSample ? FIELDWRIGHT_SOURCE_DIR "/" + name + std::string(kGraphEnding) : pathOf(name);
    return parseGraph(test::readText(pathOf(name)), path, nullptr);
}

/// The times at which a document is measured: the start, and two fifths of the timeline if there is one.
std::vector<double> timesOf(const Graph& graph) {
    if (graph.timeline->is_null()) return {0.0};
    const Result<Timeline> timeline = readTimeline(graph);
    return timeline ? std::vector<double>{0.0, 0.4 * timeline->length} : std::vector<double>{0.0};
}

Result<Program> programAt(const Graph& graph, double seconds) {
    CompileOptions options;
    options.time = seconds;
    if (graph.timeline->is_null()) return compile(graph, options);
    const Result<Timeline> timeline = readTimeline(graph);
    if (!timeline) return timeline.error();
    return compile(atTime(graph, *timeline, seconds), options);
}

bool hasParticles(const Program& program) {
    return std::ranges::any_of(program.ir.volumes(),
                               [](const FieldVolumePtr& volume) { return !volume->made(); });
}

/// The kind of a document: "solid", or why it has no measurable solid.
std::string kindOf(const Program& program, const Region& region) {
    if (hasParticles(program)) return "needs the runtime";
    switch (region.extent) {
        case Extent::bounded: return "solid";
        case Extent::empty: return "empty";
        case Extent::unbounded: return "unbounded";
        case Extent::unproven: return "unproven";
    }
    return "";
}

Json jsonOf(const Point& point) { return {point[0], point[1], point[2]}; }
Point pointOf(const Json& json) { return {json[0], json[1], json[2]}; }

/// A grid of about that number of cells around the region, or around the origin if the region is not bounded.
/// Faces of solids seldom have the coordinates of its samples.
SampleGrid gridFor(const Region& region, double cells, int attempt) {
    Box box = region.extent == Extent::bounded ? region.box : cubeAround(2.0);
    const double margin = (0.06 + 0.00731 * attempt) * std::max(longestSide(box), 1e-3);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double skew = std::array{0.0137, 0.0071, 0.0193}[axis] * margin;
        box.lo[axis] -= margin - skew;
        box.hi[axis] += margin + skew;
    }
    double volume = 1.0;
    for (std::size_t axis = 0; axis < 3; ++axis) volume *= box.hi[axis] - box.lo[axis];
    return test::gridOver(box, int(std::ceil(longestSide(box) / std::cbrt(volume / cells))));
}

/// The smallest absolute value at the samples. Measured distances are stored in single precision, so no grid
/// keeps away from their rounding.
double smallestValue(const ReferenceField& field, const SampleGrid& grid) {
    std::vector<Point> points(grid.size());
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = grid.centre(i);
    std::vector<double> values(points.size());
    field(points, values);
    double least = INFINITY;
    for (const double value : values) least = std::min(least, std::abs(value));
    return least;
}

std::string hashOf(const std::vector<uint8_t>& signs) {
    uint64_t hash = 0;
    for (const uint8_t sign : signs) hash = mixed(hash, sign);
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

Json jsonOf(const BruteForceSolid& solid) {
    Json json;
    json["corner"] = jsonOf(solid.grid.corner);
    json["step"] = solid.grid.step;
    json["cells"] = solid.grid.cells;
    json["inside"] = solid.insideSamples;
    json["signs"] = hashOf(solid.inside);
    json["bodies"] = solid.bodies.size();
    json["volume"] = solid.volume;
    json["volume_error"] = solid.volumeError;
    if (solid.bounds) json["lo"] = jsonOf(solid.bounds->lo), json["hi"] = jsonOf(solid.bounds->hi);
    return json;
}

Json recordedOn(const Program& program, const Region& region, double cells) {
    const ReferenceField field(program);
    const bool isMeasured = !program.ir.volumes().empty();
    SampleGrid grid;
    bool isDecided = false;
    for (int attempt = 0; attempt < 12 && !isDecided; ++attempt) {
        grid = gridFor(region, cells, attempt);
        isDecided = !isMeasured && smallestValue(field, grid) > kRounding * longestSide(grid.box());
        if (isMeasured) break;
    }
    Json json = jsonOf(sampleByBruteForce(field, grid));
    if (!isDecided) json["signs"] = nullptr;
    return json;
}

/// The record of a document, by name; its problem if it cannot be recorded.
Json recordOf(const std::string& name) {
    const Result<Graph> graph = opened(name);
    if (!graph) return format(graph.error());
    Json record;
    for (const double time : timesOf(*graph)) {
        const Result<Program> program = programAt(*graph, time);
        if (!program) return format(program.error());
        const Region region = hasParticles(*program) ? Region{} : findRegion(*program);
        Json at;
        at["time"] = time;
        at["is"] = kindOf(*program, region);
        if (!hasParticles(*program)) {
            at["coarse"] = recordedOn(*program, region, kCoarseCells);
            at["fine"] = recordedOn(*program, region, kFineCells);
        }
        record.push_back(at);
    }
    return record;
}

/// What differs between the recorded solid and that of today; empty if nothing does.
std::string differenceOn(const Program& program, const Json& recorded) {
    const SampleGrid grid{pointOf(recorded["corner"]), recorded["step"], recorded["cells"]};
    const BruteForceSolid solid = sampleByBruteForce(ReferenceField(program), grid);
    const Json now = jsonOf(solid);
    std::string difference;
    const auto differs = [&](const char* key) {
        difference += std::string(key) + " is " + now.value(key, Json()).dump() + ", was " +
                      recorded.value(key, Json()).dump() + "; ";
    };
    if (!recorded["signs"].is_null() && now["signs"] != recorded["signs"]) differs("signs");
    const double inside = recorded["inside"];
    const bool isRoughlyInside = std::abs(double(solid.insideSamples) - inside) <= 2.0 + 0.0005 * inside;
    if (recorded["signs"].is_null() ? !isRoughlyInside : now["inside"] != recorded["inside"])
        differs("inside");
    if (now["bodies"] != recorded["bodies"]) differs("bodies");
    const double volume = recorded["volume"], volumeError = recorded["volume_error"];
    if (std::abs(solid.volume - volume) > std::max(0.001 * volume, volumeError)) differs("volume");
    if (now.contains("lo") != recorded.contains("lo")) {
        differs("lo");
    } else if (solid.bounds) {
        for (const char* key : {"lo", "hi"}) {
            const Point a = pointOf(now[key]), b = pointOf(recorded[key]);
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (std::abs(a[axis] - b[axis]) > grid.step) {
                    differs(key);
                    break;
                }
        }
    }
    return difference;
}

/// The differences between the program and its record, as text; empty if they agree.
std::string problemOf(const Program& program, const Json& recorded) {
    const Region region = hasParticles(program) ? Region{} : findRegion(program);
    if (const std::string kind = kindOf(program, region); kind != recorded["is"])
        return "it is \"" + kind + "\", was " + recorded["is"].dump();
    std::string problem;
    std::vector<const char*> grids;
    if (recorded.contains("coarse")) grids.push_back("coarse");
    if (recorded.contains("fine") && isLong()) grids.push_back("fine");
    for (const char* grid : grids)
        if (const std::string difference = differenceOn(program, recorded[grid]); !difference.empty())
            problem += std::string("on the ") + grid + " grid: " + difference;
    for (const char* grid : {"coarse", "fine"}) {
        if (region.extent != Extent::bounded || !recorded.contains(grid) || !recorded[grid].contains("lo"))
            continue;
        const double slack = 1e-9 * std::max(1.0, longestSide(region.box));
        for (const char* key : {"lo", "hi"})
            if (test::distanceOutside(region.box, pointOf(recorded[grid][key])) > slack)
                problem +=
                    std::string("its region does not contain the recorded bounds of the ") + grid + " grid; ";
    }
    return problem;
}

std::string problemOf(const std::string& name, const Json& recorded) {
    const Result<Graph> graph = opened(name);
    if (!graph) return format(graph.error());
    if (timesOf(*graph).size() != recorded.size()) return "it is recorded at other times";
    // Volumes that were baked for a program are found again while it exists.
    std::vector<Program> programs;
    for (const Json& at : recorded) {
        Result<Program> program = programAt(*graph, at["time"]);
        if (!program) return format(program.error());
        programs.push_back(std::move(*program));
    }
    for (const Error& finding : check(*graph))
        if (finding.severity == Error::Severity::error) return format(finding);
    std::string problem;
    for (std::size_t i = 0; i < programs.size(); ++i)
        if (const std::string found = problemOf(programs[i], recorded[i]); !found.empty())
            problem += "at " + recorded[i]["time"].dump() + " s: " + found + "\n";
    return problem;
}

/// A document a line, so that a change is a small difference.
void writeExpected(const std::map<std::string, Json>& records) {
    std::string text = "{\n";
    for (auto record = records.begin(); record != records.end(); ++record)
        text += "\"" + record->first + "\": " + record->second.dump() +
                (std::next(record) == records.end() ? "\n" : ",\n");
    test::writeText(kExpected.string(), text + "}\n");
}

TEST(FrozenGraphs, KeepTheirMeaning) {
    const std::vector<std::string> names = documentNames();
    const bool isUpdate = std::getenv("FIELDWRIGHT_UPDATE_FROZEN") != nullptr;
    Json expected;
    if (!isUpdate) expected = Json::parse(test::readText(kExpected.string()));
    std::vector<std::string> problems(names.size());
    std::vector<Json> records(names.size());
    forBlocks(names.size(), 1, [&](std::size_t, std::size_t i, std::size_t) {
        if (isUpdate)
            records[i] = recordOf(names[i]);
        else
            problems[i] = expected.contains(names[i]) ? problemOf(names[i], expected[names[i]])
                                                      : "it is not recorded in expected.json";
    });
    if (isUpdate) {
        std::map<std::string, Json> all;
        for (std::size_t i = 0; i < names.size(); ++i) {
            EXPECT_TRUE(records[i].is_array()) << names[i] << ": " << records[i];
            all[names[i]] = records[i];
        }
        return writeExpected(all);
    }
    for (std::size_t i = 0; i < names.size(); ++i)
        EXPECT_TRUE(problems[i].empty()) << "frozen graph '" << names[i] << "': " << problems[i];
    for (const auto& [name, record] : expected.items())
        EXPECT_TRUE(std::ranges::binary_search(names, name)) << name << " is recorded, but missing";
}

TEST(FrozenGraphs, AreWrittenBackUnchanged) {
    for (const std::string& name : documentNames()) {
        const Result<Graph> graph = opened(name);
        ASSERT_TRUE(graph) << format(graph.error());
        // Documents with former names are brought up to date.
        const bool isFormer = name.starts_with("former/");
        const std::string path = isFormer ? (kFolder / (name + ".written.json")).string() : pathOf(name);
        EXPECT_EQ(writeGraph(*graph), test::readText(path)) << name;
    }
}

/// Adds the types of the nodes, as the file spells them.
void collectTypes(const Json& nodes, std::set<std::string>& types) {
    for (const Json& node : nodes) types.insert(node["type"].get<std::string>());
}

TEST(FrozenGraphs, HaveEveryNodeTypeAndFormerName) {
    std::set<std::string> types;
    for (const std::string& name : documentNames()) {
        const Json document = Json::parse(test::readText(pathOf(name)));
        collectTypes(document["nodes"], types);
        for (const Json& group : document.value("groups", Json::array())) collectTypes(group["nodes"], types);
    }
    for (const NodeType& type : nodeTypes()) {
        EXPECT_TRUE(types.contains(type.id)) << "add a frozen graph with a node of type " << type.id;
        for (const std::string& alias : type.aliases)
            EXPECT_TRUE(types.contains(alias)) << "add the former name " << alias << " to former/";
    }
}

}  // namespace fw::frozen_graphs_test
