// Files that are made to take long or to take much: each is refused by name and with a remedy, in a process
// that has no more than 500 MB for it.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <random>

#include "graph/implicit3mf/import.h"
#include "graph/outlines/drawing.h"
#include "graph/outlines/letters.h"
#include "tests/support/graph/implicit_model.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::bad_files_test {

constexpr rlim_t kRoom = 500'000'000;  // bytes

/// What `work` says, run in a child of this process whose memory grows by kRoom at most.
std::string inItsRoom(const std::function<std::string()>& work) {
    int ends[2];
    if (pipe(ends) != 0) return "no pipe";
    const pid_t child = fork();
    if (child == 0) {
        close(ends[0]);
#if !defined(__SANITIZE_ADDRESS__)  // which has memory of its own
        rlim_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        const rlim_t most = pages * rlim_t(sysconf(_SC_PAGESIZE)) + kRoom;
        const rlimit limit{most, most};
        setrlimit(RLIMIT_AS, &limit);
#endif
        std::string said;
        try {
            said = work();
        } catch (const std::bad_alloc&) { said = "it takes more memory than it has"; }
        const bool written = write(ends[1], said.data(), said.size()) == ssize_t(said.size());
        _exit(written ? 0 : 1);
    }
    close(ends[1]);
    std::string said;
    char part[4096];
    for (ssize_t count; (count = read(ends[0], part, sizeof part)) > 0;)
        said.append(part, std::size_t(count));
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? said : "the process died";
}

void expectRefused(const std::string& words, const std::function<std::string()>& work) {
    const std::string said = inItsRoom(work);
    EXPECT_NE(said.find(words), std::string::npos) << "wanted: " << words << "\nsaid: " << said;
}

std::string whyNoOutline(const Result<Drawing>& drawing) {
    if (!drawing) return drawing.error().message;
    const Result<OutlinePtr> outline = outlineOf(drawing->painting, "the drawing", "simplify it");
    return outline ? "it was read" : outline.error().message;
}
std::string svg(const std::string& elements) {
    return "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>" + elements + "</svg>";
}
void expectSvgRefused(const std::string& words, const std::string& file) {
    SCOPED_TRACE(file.substr(0, 200));
    expectRefused(words, [&] { return whyNoOutline(readSvg(file, "")); });
}
std::string times(int count, const std::string& text) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
}
/// So many lines across the page, from place to place.
std::string scribble(int lines) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> along(0, 100);
    std::string path = "<path d='M0 0";
    for (int i = 0; i < lines; ++i)
        path += "L" + std::to_string(along(random)) + " " + std::to_string(along(random));
    return path + "z'/>";
}

TEST(BadFiles, SvgBombs) {
    std::string uses = "<rect id='a0' width='1' height='1'/>";
    for (int i = 1; i <= 30; ++i) {
        const std::string use = "<use href='#a" + std::to_string(i - 1) + "'/>";
        uses += "<g id='a" + std::to_string(i) + "'>" + use + use + "</g>";
    }
    expectSvgRefused("draws more than 50000 elements", svg(uses));
    expectSvgRefused("draws more than 400000 arcs",
                     svg("<path d='M0 0" + times(500'000, "l1 1l1-1") + "'/>"));
    expectSvgRefused("more than 64 deep",
                     "<svg>" + times(500'000, "<g>") + times(500'000, "</g>") + "</svg>");
    expectSvgRefused("draws more than 50000 elements", svg(times(3'000'000, "<b/>")));
    expectSvgRefused("crosses itself or lies upon itself", svg(scribble(10'000)));
    expectSvgRefused("crosses itself or lies upon itself", svg(scribble(300'000)));
    expectSvgRefused("crosses itself or lies upon itself",
                     svg(times(49'000, "<circle cx='50' cy='50' r='40'/>")));
    const std::string clip =
        "<clipPath id='c'><rect width='50' height='50'/></clipPath><g clip-path='url(#c)'>";
    expectSvgRefused("crosses itself or lies upon itself",
                     svg(clip + times(20'000, "<rect clip-path='url(#c)' width='9' height='9'/>") + "</g>"));
    expectSvgRefused(
        "draws more than 400000 arcs",
        svg("<g fill='none' stroke='red' stroke-linejoin='round'>" + scribble(300'000) + "</g>"));
    expectSvgRefused("bring it onto its page",
                     svg("<path stroke='red' stroke-width='1e20' d='M0 0L1 1C1e9 1e9 -1e9 4 5 5'/>"));
    std::string styles;
    for (int i = 0; i < 50'000; ++i) styles += ".c" + std::to_string(i) + "{fill:red}";
    expectSvgRefused("too many styles", svg("<style>" + styles + "</style>" +
                                            times(20'000, "<rect class='c1 c2' width='1' height='1'/>")));
}

TEST(BadFiles, SvgOpensNothing) {
    const test::TempDir folder;
    const std::string secret = folder.path("secret.svg");
    test::writeText(secret, svg("<rect id='a' width='50' height='50'/>"));
    for (const std::string& elements : std::vector<std::string>{
             "<image href='file://" + secret + "'/>", "<use href='file://" + secret + "#a'/>",
             "<style>@import url(file://" + secret + ");</style>", "<text>&x;</text>&x;", "<path d='&x;'/>"})
        expectSvgRefused("paints nothing",
                         "<?xml-stylesheet href='file://" + secret + "'?><!DOCTYPE svg SYSTEM 'file://" +
                             secret + "' [<!ENTITY x SYSTEM 'file://" + secret + "'>]>" + svg(elements));
    std::string grows = "<!DOCTYPE svg [<!ENTITY a0 'M0 0L9 9L0 9'>";
    for (int i = 1; i < 12; ++i)
        grows +=
            "<!ENTITY a" + std::to_string(i) + " '" + times(10, "&a" + std::to_string(i - 1) + ";") + "'>";
    expectSvgRefused("paints nothing", grows + "]>" + svg("<path d='&a11;'/>"));
}

TEST(BadFiles, DxfBombs) {
    const auto file = [](const std::string& entities, const std::string& blocks = "") {
        return "0\nSECTION\n2\nBLOCKS\n" + blocks + "0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" + entities +
               "0\nENDSEC\n0\nEOF\n";
    };
    const auto expectDxfRefused = [](const std::string& words, const std::string& bytes) {
        SCOPED_TRACE(bytes.substr(0, 200));
        expectRefused(words, [&] { return whyNoOutline(readDxf(bytes, "")); });
    };
    expectDxfRefused("has more than 2000000 values", file(times(10'000'000, "0\n1\n")));
    std::string spline = "0\nSPLINE\n70\n8\n71\n3\n";
    constexpr int kControls = 100'000;
    for (int i = 0; i < kControls + 4; ++i) spline += "40\n" + std::to_string(i) + "\n";
    for (int i = 0; i < kControls; ++i)
        spline += "10\n" + std::to_string(i % 1000) + "\n20\n" + std::to_string(7 * i % 1000) + "\n";
    expectDxfRefused("draws more than 400000 arcs", file(spline));
    std::string blocks;
    for (int i = 0; i < 15; ++i) {
        const std::string insert = "0\nINSERT\n2\nB" + std::to_string(i - 1) + "\n10\n1\n20\n0\n";
        blocks +=
            "0\nBLOCK\n2\nB" + std::to_string(i) + "\n10\n0\n20\n0\n" + times(4, insert) + "0\nENDBLK\n";
    }
    expectDxfRefused("inserts more than 20000 blocks", file("0\nINSERT\n2\nB14\n10\n0\n20\n0\n", blocks));
    expectDxfRefused("is cut off",
                     file(times(100'000, "0\nLINE\n10\n0\n20\n0\n11\n5\n21\n5\n")).substr(0, 1'000'003));
    expectDxfRefused("is damaged in line 1", std::string(30'000'000, '\0'));
}

TEST(BadFiles, FontsThatAreNone) {
    const test::TempDir folder;
    const std::string whole = test::readText("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf");
    const std::string graph = folder.path("a.field.json");
    const auto expectFontRefused = [&](const std::string& words, const std::string& bytes,
                                       const std::string& text = "Ag&@8") {
        test::writeText(folder.path("bad.ttf"), bytes);
        expectRefused(words, [&] {
            const Result<OutlinePtr> outline = outlineOfText(graph, text, {.fontFile = "bad.ttf"});
            return outline ? "it was read" : outline.error().message;
        });
    };
    expectFontRefused("is none, or is damaged", "");
    expectFontRefused("is none, or is damaged", std::string(60'000'000, '\0'));
    for (const std::size_t length : {100u, 1000u, 10'000u, 300'000u})
        expectFontRefused("'bad.ttf'", whole.substr(0, length));
    expectFontRefused("has no letter for '\u6F22' (U+6F22)", whole, "\u6F22");
    expectFontRefused("has no letter for 'A' (U+0041)",  // the letters' numbers are gone
                      [&] {
                          std::string without = whole;
                          const std::size_t entry = without.find("cmap");
                          without.replace(entry, 4, "none");
                          return without;
                      }());
}

TEST(BadFiles, ThreeMfBombs) {
    const auto expect3mfRefused = [](const std::string& words, const std::string& bytes) {
        SCOPED_TRACE(words);
        expectRefused(words, [&] {
            const Result<Imported> imported = import3mf(bytes, "part.3mf", "part_3mf");
            return imported ? "it was read" : imported.error().message;
        });
    };
    using test::modelPackage;
    using test::modelText;
    expect3mfRefused("unpacks to more than 64 MB", modelPackage(std::string(100'000'000, ' ')));
    expect3mfRefused("elements: at most as many are read",
                     modelPackage("<model>" + times(15'000'000, "<b/>")));
    const std::string ring =
        "<object id='8'><components><component objectid='9'/></components></object>"
        "<object id='9'><components><component objectid='8'/></components></object>";
    EXPECT_EQ("", inItsRoom([&] {
                  const Result<Imported> imported = import3mf(
                      modelPackage(modelText(ring, "<item objectid='9'/>")), "part.3mf", "part_3mf");
                  return imported ? "it was read" : imported.error().message.empty() ? "no reason" : "";
              }));
}

}  // namespace fw::bad_files_test
