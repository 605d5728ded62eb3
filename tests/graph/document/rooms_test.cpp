// The rooms of the sources and the arrows between them. A room knows those that stand behind it here, and no
// other; each of them stands above it, so that every arrow runs one way.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace fw::rooms_test {

const std::vector<std::pair<std::string, std::string>> kRooms = {
    {"graph/base", ""},
    {"graph/assets", "base"},
    {"graph/outlines", "base"},
    {"graph/library", "base"},
    {"graph/document", "base library"},
    {"graph/rules", "base library document"},
    {"graph/curves", "base outlines"},
    {"graph/ir", "base assets outlines curves"},
    {"graph/evaluate", "base ir"},
    {"graph/bounds", "base ir evaluate"},
    {"graph/language", "base outlines curves library ir"},
    {"graph/compile", "base assets curves library document rules ir evaluate bounds language"},
    {"graph/emit", "compile"},
    {"graph/implicit3mf", "base assets document ir compile"},
    {"graph/check", "base assets library document rules language compile"},
    {"graph/nodes", "assets library compile"},

    {"runtime/system", "graph"},
    {"runtime/gpu", "graph system"},
    {"runtime/mesh", "graph"},
    {"runtime/measure", "graph system mesh"},
    {"runtime/bake", "graph system gpu"},
    {"runtime/mesher", "graph system gpu mesh"},
    {"runtime/stages", "graph system gpu mesh measure mesher"},
    {"runtime/particles", "graph system gpu bake"},
    {"runtime/render", "graph system gpu mesh mesher particles"},
    {"runtime/textures", "graph mesh"},
    {"runtime/export", "graph system mesh measure mesher"},
    {"runtime/play", "graph system gpu mesh measure bake mesher stages particles render export"},
    {"runtime/files", "graph system mesh export textures"},
    {"runtime/pictures", "graph system render export play"},
    {"runtime/window", "graph gpu render"},
    {"runtime/jobs", "graph system"},
    {"runtime/serve", "graph system gpu mesh measure bake textures render export files play pictures"},
    {"runtime/python", "graph render serve"},
    {"runtime/cli",
     "graph system gpu measure bake textures render export files play pictures window jobs serve"},

    {"editor", "graph runtime"},
};

/// "graph/ir" of "graph/ir/ops.h"; "editor" of anything in the editor, whose rooms are not parted yet.
std::string roomOf(const std::string& path) {
    const std::size_t part = path.find('/');
    if (path.substr(0, part) == "editor") return "editor";
    return path.substr(0, path.find('/', part + 1));
}

/// The room's own name, its part's neighbours by their short names, and whole parts below.
bool allows(const std::string& room, const std::string& known, const std::string& other) {
    if (room == other) return true;
    const std::string part = room.substr(0, room.find('/')), otherPart = other.substr(0, other.find('/'));
    const std::string wanted = part == otherPart ? other.substr(other.find('/') + 1) : otherPart;
    std::istringstream words(known);
    for (std::string word; words >> word;)
        if (word == wanted) return true;
    return false;
}

std::vector<std::filesystem::path> sources() {
    std::vector<std::filesystem::path> files;
    const std::filesystem::path root = FIELDWRIGHT_SOURCE_DIR;
    for (const char* part : {"graph", "runtime", "editor"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(root / part))
            if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp")
                files.push_back(std::filesystem::relative(entry.path(), root));
    return files;
}

TEST(Rooms, AreKnown) {
    std::set<std::string> rooms;
    for (const auto& [room, known] : kRooms) rooms.insert(room);
    for (const auto& file : sources())
        EXPECT_TRUE(rooms.contains(roomOf(file)))
            << file << " is in no room that is listed in tests/graph/document/rooms_test.cpp";
}

TEST(Rooms, KnowOnlyThoseAboveThem) {
    std::set<std::string> above;
    for (const auto& [room, known] : kRooms) {
        std::istringstream words(known);
        for (std::string word; words >> word;) {
            const std::string own = room.substr(0, room.find('/') + 1) + word;
            EXPECT_TRUE(above.contains(own) || above.contains(word)) << room << " -> " << word;
        }
        above.insert(room);
        above.insert(room.substr(0, room.find('/')));
    }
}

TEST(Rooms, IncludeOnlyWhatTheyMay) {
    const std::map<std::string, std::string> rooms(kRooms.begin(), kRooms.end());
    const std::regex include(R"re(^\s*#include "((?:graph|runtime|editor)/[^"]+)")re");
    std::size_t seen = 0;
    for (const auto& file : sources()) {
        const auto own = rooms.find(roomOf(file));
        if (own == rooms.end()) continue;
        std::ifstream in(std::filesystem::path(FIELDWRIGHT_SOURCE_DIR) / file);
        int number = 0;
        for (std::string line; std::getline(in, line);) {
            ++number;
            std::smatch match;
            if (!std::regex_search(line, match, include)) continue;
            ++seen;
            EXPECT_TRUE(allows(own->first, own->second, roomOf(match[1])))
                << file.string() << ":" << number << ": " << own->first << " may not know "
                << roomOf(match[1]);
        }
    }
    EXPECT_GT(seen, 500u);
}

}  // namespace fw::rooms_test
