// The pages for each kind of reader, docs/for-*.md, do what they say: what they have the reader save is
// saved, and each command run as it stands, one behind the other. What takes more than some seconds is run
// with FIELDWRIGHT_LONG, and then the pictures of the page are held against those that come of it; with
// FIELDWRIGHT_PAGES=FOLDER they are saved there (docs/pictures/make).
#include <gtest/gtest.h>

#include <cstdlib>
#include <regex>
#include <sstream>

#include "graph/assets/image.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::reader_pages_test {

namespace fs = std::filesystem;
using test::TempDir;

const std::string kDocs = FIELDWRIGHT_SOURCE_DIR "/docs/";

struct Page {
    std::string graph, text;            ///< the file that is to be saved
    std::vector<std::string> commands;  ///< as they are typed
    std::vector<std::string> pictures;  ///< names, of those that it shows
};

Page readPage(const std::string& name) {
    Page page;
    std::istringstream lines(test::readText(kDocs + name));
    const std::regex saved("## 1\\. Save this as `(.*)`"), picture("!\\[.*\\]\\(pictures/(.*)\\)");
    std::smatch match;
    for (std::string line; std::getline(lines, line);) {
        if (std::regex_match(line, match, saved)) page.graph = match[1];
        if (std::regex_match(line, match, picture)) page.pictures.push_back(match[1]);
        if (!line.starts_with("    ")) continue;
        if (line.starts_with("    fieldwright "))
            page.commands.push_back(line.substr(4));
        else
            page.text += line.substr(4) + "\n";
    }
    return page;
}

/// Mean difference of all channels, of 255; 255 if their sizes differ.
double difference(const std::string& a, const std::string& b) {
    const Result<FieldImagePtr> first = readImage(a, fs::path(a).filename()),
                                second = readImage(b, fs::path(b).filename());
    if (!first || !second || (*first)->texels.size() != (*second)->texels.size()) return 255.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < (*first)->texels.size(); ++i)
        for (unsigned shift = 0; shift < 24; shift += 8)
            sum += std::abs(int((*first)->texels[i] >> shift & 255u) -
                            int((*second)->texels[i] >> shift & 255u));
    return sum / double(3 * (*first)->texels.size());
}

class ReaderPages : public testing::TestWithParam<const char*> {};

TEST_P(ReaderPages, DoesWhatItSays) {
    const bool all = std::getenv("FIELDWRIGHT_LONG") || std::getenv("FIELDWRIGHT_PAGES");
    const Page page = readPage(GetParam());
    ASSERT_TRUE(!page.graph.empty() && page.commands.size() >= 3 && !page.pictures.empty());
    const TempDir folder;
    test::writeText(folder.path(page.graph), page.text);
    const std::string there =
        "cd '" + folder.folder.string() + "' && PATH='" FIELDWRIGHT_BINARY_DIR "':$PATH ";
    const std::regex output(" -o ([^ ]+)");
    for (const std::string& command : page.commands) {
        const bool window =
            command.starts_with("fieldwright play") && command.find("--headless") == std::string::npos;
        const bool takesLong = command.starts_with("fieldwright render") ||
                               command.find("--textures") != std::string::npos ||
                               command.find("--sweep") != std::string::npos;
        if (window || (takesLong && !all)) continue;
        const test::ProgramResult result = test::runProgram(there + command);
        EXPECT_EQ(result.status, 0) << command << "\n" << result.output;
        std::smatch match;
        EXPECT_TRUE(!std::regex_search(command, match, output) || fs::exists(folder.path(match[1])))
            << command;
    }
    EXPECT_EQ(test::runProgram(there + "fieldwright check " + page.graph).output, "");
    for (const std::string& picture : page.pictures) {
        EXPECT_TRUE(fs::exists(kDocs + "pictures/" + picture)) << picture;
        if (const char* keep = std::getenv("FIELDWRIGHT_PAGES")) {
            fs::copy_file(folder.path(picture), fs::path(keep) / picture,
                          fs::copy_options::overwrite_existing);
        } else if (all) {
            EXPECT_LT(difference(kDocs + "pictures/" + picture, folder.path(picture)), 4.0) << picture;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Docs, ReaderPages,
                         testing::Values("for-makers.md", "for-game-artists.md", "for-demo-coders.md",
                                         "for-engineers.md"));

}  // namespace fw::reader_pages_test
