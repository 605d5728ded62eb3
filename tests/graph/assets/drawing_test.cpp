// Drawings: what SVG and DXF files paint, by areas that are known, against other people's pictures, and what
// is refused.
#include "graph/outlines/drawing.h"

#include <gtest/gtest.h>
#include <stb/stb_image.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <regex>
#include <set>
#include <sstream>

#include "tests/support/graph/temp_dir.h"

namespace fw::drawing_test {

namespace fs = std::filesystem;
using glm::dvec2;
constexpr double kPi = std::numbers::pi;

double areaOf(const Painting& painting) {
    double twice = 0;
    const std::vector<Arc> arcs = Painted(painting).boundary().value();
    for (const Arc& arc : arcs) twice += twiceAreaBeside(arc);
    return 0.5 * twice;
}

/// What elements paint on a page of 100 by 100, in units of the page.
double areaOf(const std::string& elements) {
    const Result<Drawing> drawing = readSvg(
        R"(<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 100 100">)" +
            elements + "</svg>",
        "");
    EXPECT_TRUE(drawing) << drawing.error().message << " " << elements;
    return drawing ? 1e4 * areaOf(drawing->painting) : 0;
}
std::string whyNot(const std::string& file, const std::string& part = "") {
    const Result<Drawing> drawing = readSvg(file, part);
    return drawing ? "" : drawing.error().message;
}

TEST(Svg, ShapesHaveTheirAreas) {
    EXPECT_NEAR(areaOf("<rect x='10' y='20' width='30' height='40'/>"), 1200, 1e-6);
    EXPECT_NEAR(areaOf("<rect width='30' height='40' rx='5'/>"), 1200 - (4 - kPi) * 25, 1e-3);
    EXPECT_NEAR(areaOf("<rect width='30' height='40' rx='5' ry='10'/>"), 1200 - (4 - kPi) * 50, 1e-3);
    EXPECT_NEAR(areaOf("<circle cx='50' cy='50' r='10'/>"), 100 * kPi, 1e-6);
    EXPECT_NEAR(areaOf("<ellipse cx='50' cy='50' rx='20' ry='10'/>"), 200 * kPi, 1e-2);
    EXPECT_NEAR(areaOf("<polygon points='0,0 10,0 10,10'/>"), 50, 1e-6);
    EXPECT_NEAR(areaOf("<polyline points='0 0 10 0 10 10'/>"), 50, 1e-6) << "it is filled though it is open";
    EXPECT_NEAR(areaOf("<line x1='0' y1='5' x2='10' y2='5' stroke='black' stroke-width='2'/>"), 20, 1e-6);
    EXPECT_NEAR(areaOf("<rect width='50%' height='10%'/>"), 500, 1e-6);
    EXPECT_NEAR(areaOf("<rect width='1in' height='1pt'/>"), 96 * 96 / 72.0, 1e-6);
}

TEST(Svg, PathsKnowEveryCommand) {
    EXPECT_NEAR(areaOf("<path d='M10 10H30V30H10Z'/>"), 400, 1e-6);
    EXPECT_NEAR(areaOf("<path d='m10,10 20,0 0,20-20,0z'/>"), 400, 1e-6);
    EXPECT_NEAR(areaOf("<path d='M10 10h20v20h-20z m50 50 l10 0 0 10 z'/>"), 450, 1e-6);
    EXPECT_NEAR(areaOf("<path d='M0 0Q50 100 100 0Z'/>"), 2 / 3.0 * 0.5 * 100 * 100, 1e-2);
    EXPECT_NEAR(areaOf("<path d='M0 0q25 50 50 0t50 0z'/>"), 2 / 3.0 * 0.5 * 50 * 50 * 2, 1e-2)
        << "one to each side";
    EXPECT_NEAR(areaOf("<path d='M0 50C0 80 40 80 40 50S80 20 80 50'/>"), 1440, 1e-2);
    EXPECT_NEAR(areaOf("<path d='M40 50a10 10 0 1 0 20 0a10 10 0 1 0-20 0z'/>"), 100 * kPi, 1e-6);
    EXPECT_NEAR(areaOf("<path d='M40 50a10,10 0 1020 0 10,10 0 10-20 0z'/>"), 100 * kPi, 1e-6)
        << "flags without space";
    EXPECT_NEAR(areaOf("<path d='M40 50A20 10 90 0 1 60 50Z'/>"),
                areaOf("<path d='M60 50A20 10 90 0 0 40 50Z'/>"), 1e-3);
    EXPECT_NEAR(areaOf("<path d='M0 0 1e1 0 1.0e+1.5e1 0 5'/>"), 50, 1e-6) << "1.0e+1 and .5e1";
    EXPECT_NEAR(areaOf("<path d='M10 10h20v20h-20z M15 15h10v10h-10z'/>"), 400, 1e-6);
    EXPECT_NEAR(areaOf("<path fill-rule='evenodd' d='M10 10h20v20h-20z M15 15h10v10h-10z'/>"), 300, 1e-6);
    EXPECT_NEAR(areaOf("<path d='M10 10h20v20h-20z M15 15v10h10v-10z'/>"), 300, 1e-6);
}

TEST(Svg, StylesComeFromEverywhere) {
    const std::string box = "width='10' height='10'/>";
    EXPECT_NEAR(areaOf("<rect style='fill:none;stroke:#000;stroke-width:2' " + box), 144 - 64, 1e-5);
    EXPECT_NEAR(
        areaOf("<style>.a{fill:none} rect.a{stroke:red} #b{stroke-width:4}</style><rect class='x a' id='b' " +
               box),
        196 - 36, 1e-5);
    EXPECT_NEAR(areaOf("<g fill='none' stroke='red'><rect stroke-linejoin='round' " + box + "</g>"),
                100 + 20 + kPi / 4 - 81, 1e-4);
    EXPECT_NEAR(areaOf("<rect " + box + "<rect x='50' display='none' " + box), 100, 1e-6);
    EXPECT_NEAR(areaOf("<rect " + box + "<g opacity='.4'><rect x='50' " + box + "</g>"), 100, 1e-6)
        << "hardly seen";
    EXPECT_NEAR(
        areaOf("<g visibility='hidden'><rect " + box + "<rect visibility='visible' x='20' " + box + "</g>"),
        100, 1e-6);
    EXPECT_NEAR(
        areaOf("<linearGradient id='g'><stop offset='0'/><stop offset='1' stop-opacity='0'/></linearGradient>"
               "<linearGradient id='h'><stop offset='0'/></linearGradient>"
               "<rect fill='url(#g)' " +
               box + "<rect x='50' fill='url(#h)' " + box),
        100, 1e-6)
        << "what fades is a shadow";
    EXPECT_NEAR(areaOf("<rect fill='url(#no)' " + box + "<rect x='50' fill='url(#no) red' " + box), 100,
                1e-6);
}

TEST(Svg, TransformsUsesPagesAndClips) {
    const std::string box = "<rect width='10' height='10'/>";
    EXPECT_NEAR(areaOf("<g transform='translate(20 20) rotate(30) scale(2)'>" + box + "</g>"), 400, 1e-5);
    EXPECT_NEAR(areaOf("<g transform='matrix(1 0 .5 2 0 0),skewX(20)'>" + box + "</g>"), 200, 1e-5);
    EXPECT_NEAR(areaOf("<circle r='10' transform='translate(50,50)scale(2 .5)'/>"), 100 * kPi, 1e-2);
    EXPECT_NEAR(areaOf("<circle r='10' fill='none' stroke='red' stroke-width='2' "
                       "transform='translate(50,50)scale(2 .5)'/>"),
                40 * kPi, 1e-2);
    EXPECT_NEAR(
        areaOf("<defs><g id='a'>" + box + "</g></defs><use href='#a'/><use xlink:href='#a' x='50' y='3'/>"),
        200, 1e-5);
    EXPECT_NEAR(areaOf("<symbol id='a' viewBox='0 0 10 10'>" + box +
                       "</symbol><use href='#a' width='40' height='20'/>"),
                400, 1e-5);
    EXPECT_NEAR(
        areaOf("<svg x='10' y='10' width='20' height='20' viewBox='0 0 10 10'><circle r='10'/></svg>"),
        400 * kPi / 4, 1e-4)
        << "a page cuts off what is beyond it";
    EXPECT_NEAR(areaOf("<clipPath id='c'><rect width='5' height='100'/><circle cx='9' cy='5' "
                       "r='1'/></clipPath><g clip-path='url(#c)'>" +
                       box + "</g>"),
                50 + kPi, 1e-4);
    EXPECT_NEAR(areaOf("<switch><foreignObject/><g>" + box + "</g><circle r='50'/></switch>"), 100, 1e-5);
}

TEST(Svg, UnitsSayHowLargeItIs) {
    const auto scale = [](const std::string& attributes) {
        const Result<Drawing> drawing =
            readSvg("<svg " + attributes + "><rect width='1' height='1'/></svg>", "");
        EXPECT_TRUE(drawing);
        return drawing ? drawing->scale : 0;
    };
    EXPECT_NEAR(scale("width='100mm' height='50mm' viewBox='0 0 200 100'"), 0.1, 1e-9);
    EXPECT_NEAR(scale("width='3in' height='1in'"), 3 * 0.0254, 1e-9);
    EXPECT_NEAR(scale("viewBox='0 0 96 48'"), 0.0254, 1e-9);
    EXPECT_NEAR(scale("width='100%' height='100%' viewBox='0 0 96 48'"), 0.0254, 1e-9);
    EXPECT_NEAR(scale("width='48' height='96'"), 0.0254, 1e-9);
}

TEST(Svg, APartIsTakenByItsIdOrLabel) {
    const std::string file = R"svg(<svg xmlns:inkscape="x" viewBox="0 0 100 100"><g transform="scale(2)">
        <g inkscape:label="Cut" id="layer1" style="display:none"><rect width="10" height="10"/></g>
        <g inkscape:label="Engrave"><rect id="r" width="5" height="5"/><rect x="20" width="5" height="5"/></g></g></svg>)svg";
    const auto area = [&](const std::string& part) {
        const Result<Drawing> drawing = readSvg(file, part);
        EXPECT_TRUE(drawing) << drawing.error().message;
        return drawing ? 1e4 * areaOf(drawing->painting) : 0;
    };
    EXPECT_NEAR(area(""), 200, 1e-5);
    EXPECT_NEAR(area("Cut"), 400, 1e-5) << "a hidden layer that is asked for";
    EXPECT_NEAR(area("layer1"), 400, 1e-5);
    EXPECT_NEAR(area("Engrave"), 200, 1e-5);
    EXPECT_NEAR(area("r"), 100, 1e-5);
    EXPECT_NE(whyNot(file, "Drill").find("Cut, Engrave"), std::string::npos) << whyNot(file, "Drill");
}

TEST(Svg, WhatIsLeftAwayIsNamed) {
    const auto remarks = [](const std::string& elements) {
        const Result<Drawing> drawing =
            readSvg("<svg viewBox='0 0 9 9'><rect width='1' height='1'/>" + elements + "</svg>", "");
        EXPECT_TRUE(drawing);
        std::string all;
        for (const std::string& remark : drawing->remarks) all += remark + ";";
        return all;
    };
    EXPECT_EQ(remarks(""), "");
    EXPECT_NE(remarks("<text>hello</text>").find("text"), std::string::npos);
    EXPECT_NE(remarks("<image href='/etc/passwd'/>").find("pictures"), std::string::npos);
    EXPECT_NE(remarks("<rect mask='url(#m)' width='1' height='1'/>").find("masks"), std::string::npos);
    EXPECT_NE(remarks("<path d='M0 0 1 x'/>").find("mistake"), std::string::npos);
    EXPECT_NE(remarks("<use href='other.svg#a'/>").find("not in the file"), std::string::npos);
}

TEST(Svg, BadFilesAreRefused) {
    EXPECT_NE(whyNot("").find("damaged"), std::string::npos);
    EXPECT_NE(whyNot("<html/>").find("no SVG"), std::string::npos);
    EXPECT_NE(whyNot("<svg>\n<g></svg>").find("line 2"), std::string::npos) << whyNot("<svg>\n<g></svg>");
    EXPECT_NE(whyNot("<svg/>").find("paints nothing"), std::string::npos);
    // Uses of uses: 2^20 of one rectangle, and a ring.
    std::string bomb = "<svg viewBox='0 0 9 9'><rect id='a0' width='1' height='1'/>";
    for (int i = 1; i <= 20; ++i) {
        const std::string before = "'#a" + std::to_string(i - 1) + "'";
        bomb += "<g id='a" + std::to_string(i) + "'><use href=" + before + "/><use href=" + before + "/></g>";
    }
    EXPECT_NE(whyNot(bomb + "</svg>").find("elements"), std::string::npos);
    EXPECT_NE(whyNot("<svg><g id='a'><use href='#a'/></g></svg>").find("deep"), std::string::npos);
    EXPECT_NE(whyNot("<svg><clipPath id='c'><rect clip-path='url(#c)' width='1' height='1'/></clipPath>"
                     "<rect clip-path='url(#c)' width='1' height='1'/></svg>")
                  .find("deep"),
              std::string::npos);
    // A million segments.
    std::string many = "<svg viewBox='0 0 1000 1000'><path d='M0 0";
    for (int i = 0; i < 1'000'000; ++i) many += i % 2 != 0 ? "l1 1" : "l1-1";
    EXPECT_NE(whyNot(many + "'/></svg>").find("simplify"), std::string::npos);
    // No entity is opened: neither a file's nor one of its own, which would grow.
    const std::string outside =
        whyNot("<!DOCTYPE svg [<!ENTITY x SYSTEM 'file:///etc/passwd'>]><svg><text>&x;</text></svg>");
    EXPECT_NE(outside.find("paints nothing"), std::string::npos) << outside;
    EXPECT_EQ(outside.find("root"), std::string::npos);
    std::string deep = "<svg>";
    for (int i = 0; i < 100'000; ++i) deep += "<g>";
    for (int i = 0; i < 100'000; ++i) deep += "</g>";
    EXPECT_NE(whyNot(deep + "</svg>").find("deep"), std::string::npos);
}

/// Icons that others drew, against the pictures that librsvg makes of them. All of it is made opaque first:
/// what is half seen is another question.
void expectWhatLibrsvgPaints(const fs::path& icons, const std::string& ending, std::size_t wanted) {
    if (!fs::exists(icons) || std::system("command -v rsvg-convert >/dev/null") != 0)
        GTEST_SKIP() << "needs " << icons << " and rsvg-convert: run ./.install test";
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(icons))
        if (entry.path().filename().string().ends_with(ending) && !entry.is_symlink())
            files.push_back(entry.path());
    std::ranges::sort(files);
    ASSERT_GT(files.size(), wanted);
    const int side = std::getenv("FIELDWRIGHT_LONG") ? 2048 : 256;
    const test::TempDir folder;
    const std::string copy = folder.path("icon.svg"), picture = folder.path("icon.png");
    // About turns that are much tighter than a stroke is wide librsvg paints polygons; its picture of them at
    // many times the scale has the round that ours has.
    const std::set<std::string> polygonal = {"mail-reply-sender", "user-trash-full"};
    const std::regex seenThrough(R"re((fill-|stroke-|stop-|\b)opacity(:[^;"]*;?|="[^"]*")|filter:[^;"]*)re");
    for (std::size_t i = 0; i < wanted; ++i) {
        std::size_t number = i * files.size() / wanted;
        std::string text;
        do {
            std::stringstream read;
            read << std::ifstream(files[number]).rdbuf();
            text = std::regex_replace(read.str(), seenThrough, "");
        } while (
            (text.find("<text") != std::string::npos || polygonal.contains(files[number].stem().string())) &&
            ++number < files.size());
        SCOPED_TRACE(files[number]);
        test::writeText(copy, text);
        const Result<Drawing> drawing = readSvg(text, "");
        ASSERT_TRUE(drawing) << drawing.error().message;
        EXPECT_TRUE(drawing->remarks.empty()) << drawing->remarks.front();
        const Result<OutlinePtr> outline = outlineOf(drawing->painting, "", "");
        ASSERT_TRUE(outline && *outline);
        ASSERT_EQ(std::system(
                      ("rsvg-convert -w " + std::to_string(side) + " '" + copy + "' -o " + picture).c_str()),
                  0);
        int width = 0, height = 0, channels = 0;
        stbi_uc* const pixels = stbi_load(picture.c_str(), &width, &height, &channels, 4);
        ASSERT_TRUE(pixels);
        const double longer = std::max(width, height);
        const auto inPixels = [&](double x, double y) {
            return longer *
                   sampleOutline(**outline, (x - 0.5 * width) / longer, (0.5 * height - y) / longer).value;
        };
        constexpr int kBlock = 8;  // pixels on a side, all on one side of an outline that is far
        int wrong = 0;
        for (int top = 0; top < height; top += kBlock)
            for (int left = 0; left < width; left += kBlock) {
                const double middle = inPixels(left + 0.5 * kBlock, top + 0.5 * kBlock);
                for (int y = top; y < std::min(top + kBlock, height); ++y)
                    for (int x = left; x < std::min(left + kBlock, width); ++x) {
                        const double value = std::abs(middle) > kBlock ? middle : inPixels(x + 0.5, y + 0.5);
                        const bool painted = pixels[4 * (y * width + x) + 3] > 127;
                        wrong += painted != (value < 0) && std::abs(value) > 0.5;
                    }
            }
        stbi_image_free(pixels);
        EXPECT_EQ(wrong, 0);
    }
}

TEST(Svg, IconsAreWhatLibrsvgPaints) {
    expectWhatLibrsvgPaints("/usr/share/icons/Adwaita/scalable", "-symbolic.svg", 20);
}

// These have strokes, gradients, clips and a hundred layers.
TEST(Svg, DrawingsOfManyLayersAreWhatLibrsvgPaints) {
    expectWhatLibrsvgPaints("/usr/share/icons/Tango/scalable", ".svg", 20);
}

// ---- DXF

std::string dxf(const std::string& entities, const std::string& header = "", const std::string& blocks = "") {
    std::string text = "0\nSECTION\n2\nHEADER\n" + header + "0\nENDSEC\n0\nSECTION\n2\nBLOCKS\n" + blocks +
                       "0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" + entities + "0\nENDSEC\n0\nEOF\n";
    return text;
}
std::string line(double ax, double ay, double bx, double by) {
    std::ostringstream text;
    text << "0\nLINE\n8\nA\n10\n" << ax << "\n20\n" << ay << "\n11\n" << bx << "\n21\n" << by << "\n";
    return text.str();
}
/// The area in the file's own units.
double dxfArea(const std::string& file, const std::string& part = "") {
    const Result<Drawing> drawing = readDxf(file, part);
    EXPECT_TRUE(drawing) << drawing.error().message;
    return drawing ? areaOf(drawing->painting) * std::pow(drawing->scale * 1e3, 2) : 0;
}
std::string whyNotDxf(const std::string& file, const std::string& part = "") {
    const Result<Drawing> drawing = readDxf(file, part);
    return drawing ? "" : drawing.error().message;
}

const std::string kCircle = "0\nCIRCLE\n8\nB\n10\n5\n20\n5\n40\n2\n";
const std::string kSquare = line(0, 0, 10, 0) + line(10, 10, 10, 0) + line(10, 10, 0, 10) + line(0, 0, 0, 10);

TEST(Dxf, LinesThatMeetAreOutlinesAndThoseWithinThemHoles) {
    EXPECT_NEAR(dxfArea(dxf(kSquare)), 100, 1e-6);
    EXPECT_NEAR(dxfArea(dxf(kSquare + kCircle)), 100 - 4 * kPi, 1e-6);
    EXPECT_NEAR(dxfArea(dxf(kSquare + kCircle), "B"), 4 * kPi, 1e-6);
    EXPECT_NEAR(dxfArea(dxf(kSquare + "0\nPOINT\n10\n3\n20\n4\n" + line(20, 20, 30, 30))), 100, 1e-6);
    const Result<Drawing> open = readDxf(dxf(kSquare + line(20, 20, 30, 30) + "0\nTEXT\n1\nhello\n"), "");
    ASSERT_TRUE(open);
    EXPECT_EQ(open->remarks.size(), 2u);
}

TEST(Dxf, CurvesHaveTheirAreas) {
    // Half a disc: an arc and a line.
    EXPECT_NEAR(dxfArea(dxf("0\nARC\n10\n0\n20\n0\n40\n3\n50\n0\n51\n180\n" + line(-3, 0, 3, 0))), 4.5 * kPi,
                1e-5);
    EXPECT_NEAR(
        dxfArea(dxf("0\nELLIPSE\n10\n1\n20\n2\n11\n3\n21\n0\n40\n0.5\n41\n0\n42\n6.283185307179586\n")),
        4.5 * kPi, 1e-4);
    // A square of which two sides bulge to half circles, one of them inwards.
    EXPECT_NEAR(dxfArea(dxf("0\nLWPOLYLINE\n90\n4\n70\n1\n10\n0\n20\n0\n42\n1\n10\n4\n20\n0\n10\n4\n20\n4\n42"
                            "\n-1\n10\n0\n20\n4\n")),
                16, 1e-5);
    EXPECT_NEAR(dxfArea(dxf("0\nLWPOLYLINE\n70\n1\n10\n0\n20\n0\n42\n2.414213562373095\n10\n2\n20\n0\n")),
                1.5 * kPi + 1, 1e-5)
        << "more than half a circle";
    EXPECT_NEAR(dxfArea(dxf("0\nPOLYLINE\n70\n1\n0\nVERTEX\n10\n0\n20\n0\n0\nVERTEX\n10\n2\n20\n0\n0\nVERTEX"
                            "\n10\n0\n20\n2\n0\nSEQEND\n")),
                2, 1e-6);
    // A quarter of a circle as a rational spline, and its two radii.
    const std::string quarter =
        "0\nSPLINE\n70\n4\n71\n2\n40\n0\n40\n0\n40\n0\n40\n1\n40\n1\n40\n1\n41\n1\n41\n0."
        "7071067811865476\n41\n1\n"
        "10\n2\n20\n0\n10\n2\n20\n2\n10\n0\n20\n2\n";
    EXPECT_NEAR(dxfArea(dxf(quarter + line(0, 0, 2, 0) + line(0, 0, 0, 2))), kPi, 1e-5);
    EXPECT_NEAR(dxfArea(dxf("0\nSOLID\n10\n0\n20\n0\n11\n2\n21\n0\n12\n0\n22\n2\n13\n2\n23\n2\n")), 4, 1e-6);
}

TEST(Dxf, BlocksAreInsertedAndUnitsKnown) {
    const std::string block = "0\nBLOCK\n2\nHOLE\n10\n5\n20\n5\n" + kCircle + "0\nENDBLK\n";
    const std::string insert = "0\nINSERT\n8\nC\n2\nHOLE\n10\n20\n20\n0\n41\n2\n42\n2\n";
    EXPECT_NEAR(dxfArea(dxf(insert, "", block)), 16 * kPi, 1e-5);
    EXPECT_NEAR(dxfArea(dxf(insert + "70\n3\n71\n2\n44\n10\n45\n10\n", "", block)), 6 * 16 * kPi, 1e-4);
    EXPECT_NEAR(dxfArea(dxf(kSquare, "9\n$INSUNITS\n70\n1\n")), 100 * 25.4 * 25.4, 1e-3);
    const std::string ring = "0\nBLOCK\n2\nHOLE\n10\n0\n20\n0\n0\nINSERT\n2\nHOLE\n10\n1\n20\n0\n0\nENDBLK\n";
    EXPECT_NE(whyNotDxf(dxf(insert, "", ring)).find("deep"), std::string::npos);
}

TEST(Dxf, BadFilesAreRefused) {
    const std::string file = dxf(kSquare);
    EXPECT_NE(whyNotDxf("").find("no DXF"), std::string::npos);
    EXPECT_NE(whyNotDxf("hello").find("line 1"), std::string::npos);
    EXPECT_NE(whyNotDxf("AutoCAD Binary DXF\r\n\x1a").find("ASCII"), std::string::npos);
    for (std::size_t length = 20; length + 8 < file.size(); length += 7)
        EXPECT_FALSE(whyNotDxf(file.substr(0, length)).empty()) << length;
    EXPECT_NE(whyNotDxf(dxf(kSquare), "X").find("it has A"), std::string::npos);
    EXPECT_NE(whyNotDxf(dxf(line(0, 0, 1, 1))).find("join their ends"), std::string::npos);
    // Angles of many turns end as soon as others.
    EXPECT_NEAR(dxfArea(dxf("0\nARC\n10\n0\n20\n0\n40\n3\n50\n-36000000000\n51\n180\n" + line(-3, 0, 3, 0))),
                4.5 * kPi, 1e-3);
}

}  // namespace fw::drawing_test
