// Images: reading them, what is refused, sampling, and graphs that use them.
#include "graph/assets/image.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <random>

#include "graph/assets/environment.h"
#include "graph/bounds/region.h"
#include "graph/check/check.h"
#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "tests/support/graph/picture_file.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::image_test {

using test::TempDir;
using test::writePictureFile;
using test::writeText;

/// Three by two pixels: red, green, blue over black, middle grey, white.
const std::vector<uint8_t> kSix = {255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 128, 128, 128, 255, 255, 255};
constexpr double kMiddle = 0.21586050011389926;  // 128 / 255 of sRGB as linear light

FieldImagePtr six() {
    std::vector<uint32_t> texels;
    for (int y : {1, 0})
        for (int x = 0; x < 3; ++x) {
            const uint8_t* pixel = &kSix[std::size_t(3 * (3 * y + x))];
            texels.push_back(uint32_t(pixel[0] | pixel[1] << 8 | pixel[2] << 16));
        }
    return std::make_shared<const FieldImage>(3, 2, std::move(texels));
}

FieldImagePtr noisy(int width, int height) {
    std::mt19937 random(5);
    std::vector<uint32_t> texels(std::size_t(width) * std::size_t(height));
    for (uint32_t& texel : texels) texel = uint32_t(random());
    return std::make_shared<const FieldImage>(width, height, std::move(texels));
}

TEST(Image, ReadsEveryFormat) {
    const TempDir folder;
    for (const char* name : {"six.png", "six.bmp", "six.tga"}) {
        writePictureFile(folder.path(name), 3, 2, kSix);
        const Result<FieldImagePtr> image = readImage(folder.path("a.field.json"), name);
        ASSERT_TRUE(image) << format(image.error());
        EXPECT_EQ((*image)->width, 3);
        EXPECT_EQ((*image)->height, 2);
        EXPECT_EQ((*image)->texels, six()->texels) << name;
        EXPECT_EQ((*image)->hash, six()->hash);
    }
}

TEST(Image, AnUnchangedFileIsReadOnce) {
    const TempDir folder;
    std::filesystem::create_directory(folder.path("in"));
    writePictureFile(folder.path("in/a.png"), 3, 2, kSix);
    const std::string graph = folder.path("a.field.json");
    const Result<FieldImagePtr> first = readImage(graph, "in/a.png");
    const Result<FieldImagePtr> again = readImage(graph, "./in/../in/a.png");
    ASSERT_TRUE(first && again);
    EXPECT_EQ(*first, *again);
    std::vector<uint8_t> other = kSix;
    other[0] = 200;
    writePictureFile(folder.path("in/a.png"), 3, 2, other);
    std::filesystem::last_write_time(folder.path("in/a.png"),
                                     std::filesystem::file_time_type::clock::now() + std::chrono::seconds(2));
    const Result<FieldImagePtr> changed = readImage(graph, "in/a.png");
    ASSERT_TRUE(changed);
    EXPECT_NE((*first)->hash, (*changed)->hash);
}

TEST(Image, TexelCentresHaveTheTexelsLight) {
    const FieldImagePtr image = six();
    const auto at = [&](int channel, double u, double v) {
        return sampleImage(image->layers[std::size_t(channel)], u, v).value;
    };
    const double left = 0.5 / 3, middle = 1.5 / 3, right = 2.5 / 3, top = 0.75, bottom = 0.25;
    EXPECT_NEAR(at(0, left, top), 1.0, 1e-12);
    EXPECT_NEAR(at(1, left, top), 0.0, 1e-12);
    EXPECT_NEAR(at(1, middle, top), 1.0, 1e-12);
    EXPECT_NEAR(at(2, right, top), 1.0, 1e-12);
    EXPECT_NEAR(at(0, left, bottom), 0.0, 1e-12);
    EXPECT_NEAR(at(1, middle, bottom), kMiddle, 1e-12);
    EXPECT_NEAR(at(kGreyLayer, middle, bottom), 128 / 255.0, 1e-12);  // as stored
    EXPECT_NEAR(at(kGreyLayer, left, top), 85 / 255.0, 1e-12);        // the mean of 255, 0, 0
    EXPECT_NEAR(at(2, right, bottom), 1.0, 1e-12);
    EXPECT_NEAR(linearOfByte(128), kMiddle, 1e-12);
}

TEST(Image, BetweenCentresValuesAreBilinearAndTheImageRepeats) {
    const FieldImagePtr image = six();
    const ImageLayer& red = image->layers[0];
    const double bottom = 0.25;
    EXPECT_NEAR(sampleImage(red, 1.0 / 3, bottom).value, 0.5 * kMiddle, 1e-12);
    EXPECT_NEAR(sampleImage(red, 1.0, bottom).value, 0.5, 1e-12);  // white and, wrapped, black
    EXPECT_NEAR(sampleImage(red, 0.5 / 3, 0.5).value, 0.5, 1e-12);
    EXPECT_NEAR(sampleImage(red, 0.5 / 3, 0.0).value, 0.5, 1e-12);  // over the edge
    EXPECT_NEAR(sampleImage(red, 1.0 / 3, 0.5).value, 0.25 * (1.0 + kMiddle), 1e-12);
    for (double u : {0.0, 0.1, 0.37, 0.5, 0.9})
        for (double v : {0.0, 0.2, 0.55, 0.8})
            for (int whole : {-7, -1, 1, 40}) {
                EXPECT_NEAR(sampleImage(red, u + whole, v).value, sampleImage(red, u, v).value, 1e-12);
                EXPECT_NEAR(sampleImage(red, u, v + whole).value, sampleImage(red, u, v).value, 1e-12);
            }
    EXPECT_TRUE(std::isfinite(sampleImage(red, 1e300, -std::numeric_limits<double>::infinity()).value));
    EXPECT_TRUE(std::isfinite(sampleImage(red, std::nan(""), 0.0).value));
}

TEST(Image, SlopesAndIntervalsHoldTheValues) {
    for (const FieldImagePtr& image : {noisy(16, 9), noisy(1, 1), plainImage()})
        for (const ImageLayer& layer : image->layers) {
            std::mt19937 random(9);
            std::uniform_real_distribution<double> unit(0.0, 1.0);
            bool narrower = false;
            for (int i = 0; i < 3000; ++i) {
                const double u = 6 * unit(random) - 3, v = 6 * unit(random) - 3;
                const double du = 0.02 * unit(random), dv = 0.02 * unit(random);
                const Interval range = sampleImage(layer, Interval{u, u + du}, Interval{v, v + dv});
                const ImageSample sample = sampleImage(layer, u + du * unit(random), v + dv * unit(random));
                ASSERT_TRUE(range.contains(sample.value));
                EXPECT_LE(std::abs(sample.du), layer.slopeU * (1 + 1e-12));
                EXPECT_LE(std::abs(sample.dv), layer.slopeV * (1 + 1e-12));
                narrower |= range.hi - range.lo < 0.9 * (layer.most - layer.least);
            }
            EXPECT_TRUE(narrower || layer.most == layer.least);
        }
}

// ---- graphs
// ---------------------------------------------------------------------------------------------------

std::string graphText(const std::string& path) {
    return R"({
  "fieldwright": 1,
  "nodes": [
    {"id": "solid", "type": "box"},
    {"id": "paint", "type": "triplanar",
     "inputs": {"image": ")" +
           path + R"(", "surface": {"from": "solid"}}},
    {"id": "made", "type": "material", "inputs": {"surface": {"from": "solid"}, "base_color": {"from": "paint"}}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "made"}}}
  ]
}
)";
}

Graph graphIn(const TempDir& folder, const std::string& path) {
    const Result<Graph> graph = parseGraph(graphText(path), folder.path("g.field.json"), nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    return *graph;
}

/// The only error of check(), which compile() gives too; without the file's name.
std::string refusal(const TempDir& folder, const std::string& path) {
    const Graph graph = graphIn(folder, path);
    std::vector<Error> errors;
    for (const Error& error : check(graph))
        if (error.severity == Error::Severity::error) errors.push_back(error);
    const Result<Program> program = compile(graph);
    EXPECT_FALSE(program);
    EXPECT_EQ(errors.size(), 1u) << path;
    if (errors.size() != 1 || program) return "";
    EXPECT_EQ(format(program.error()), format(errors[0]));
    const std::string text = format(errors[0]), start = folder.path("g.field.json") + ":6:26: error: ";
    EXPECT_TRUE(text.starts_with(start)) << text;
    return text.substr(std::min(start.size(), text.size()));
}

TEST(ImageRefused, NamesTheInputAndTheReason) {
    const TempDir folder;
    const std::string who = "node 'paint', input 'image': the picture ";
    EXPECT_EQ(refusal(folder, "none.png"), who + "'none.png' does not exist: check the path");
    EXPECT_EQ(refusal(folder, "a/none.png"), who + "'a/none.png' does not exist: check the path");
    std::filesystem::create_directory(folder.path("sub"));
    EXPECT_EQ(refusal(folder, "sub"), who + "'sub' is a folder: name a picture in it");
    EXPECT_EQ(refusal(folder, "."), who + "'.' is a folder: name a picture in it");
    writeText(folder.path("text.png"), "{\"fieldwright\": 1}\n");
    EXPECT_EQ(refusal(folder, "text.png"),
              who + "'text.png' is none: use a .png, .jpg, .jpeg, .bmp or .tga file");
    writeText(folder.path("empty.png"), "");
    EXPECT_EQ(refusal(folder, "empty.png"), who + "'empty.png' is an empty file");
    ASSERT_EQ(mkfifo(folder.path("pipe.png").c_str(), 0600), 0);
    EXPECT_EQ(refusal(folder, "pipe.png"), who + "'pipe.png' is no ordinary file: name a picture");

    std::vector<uint8_t> rgb(3 * 64 * 64);
    std::mt19937 random(1);
    for (uint8_t& c : rgb) c = uint8_t(random());
    writePictureFile(folder.path("whole.png"), 64, 64, rgb);
    EXPECT_TRUE(compile(graphIn(folder, "whole.png")));
    const std::string whole = test::readText(folder.path("whole.png"));
    for (std::size_t length : {whole.size() / 2, whole.size() - 2000, std::size_t(40), std::size_t(12)}) {
        writeText(folder.path("cut.png"), whole.substr(0, length));
        EXPECT_TRUE(refusal(folder, "cut.png").starts_with(who + "'cut.png' is damaged")) << length;
    }
    writeText(folder.path("noise.tga"), std::string(100, '\x7F'));
    EXPECT_TRUE(refusal(folder, "noise.tga").starts_with(who + "'noise.tga' is damaged"));
}

/// A sky of 16 by 4 texels in Radiance's format, each row a run a channel.
std::string skyOfRuns() {
    std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 16\n";
    for (int row = 0; row < 4; ++row) {
        bytes += {2, 2, 0, 16};
        for (int channel = 0; channel < 4; ++channel) bytes += {char(128 + 16), char(128)};
    }
    return bytes;
}

TEST(ImageRefused, ASkyWhoseRunsAreCutOff) {
    // Its decoder would wait for the rest for ever.
    const std::string whole = skyOfRuns();
    const Result<EnvironmentMap> sky = parseEnvironment(whole, "sky.hdr", 64);
    ASSERT_TRUE(sky) << format(sky.error());
    for (const Radiance& texel : sky->texels) EXPECT_EQ(texel, (Radiance{0.5f, 0.5f, 0.5f}));
    for (std::size_t size = whole.size() - 4 * 12; size < whole.size(); ++size) {
        const Result<EnvironmentMap> cut = parseEnvironment(whole.substr(0, size), "sky.hdr", 64);
        ASSERT_FALSE(cut) << size;
        EXPECT_NE(cut.error().message.find("'sky.hdr' is damaged or cut off"), std::string::npos)
            << format(cut.error());
    }
    for (const int code : {0, 17, 128 + 17}) {  // of nothing, and of more than the row has
        std::string other = whole;
        other[whole.size() - 2] = char(code);
        EXPECT_FALSE(parseEnvironment(other, "sky.hdr", 64)) << code;
    }
    // A line that begins with nothing ends the header, too; what looks like its end behind that does not.
    std::string hidden = whole.substr(0, whole.size() - 1) + "\n\n-Y 4 +X 16\n" + std::string(99, '\1');
    hidden.replace(hidden.find("\n\n"), 2, std::string("\n\0\n", 3));
    hidden.replace(hidden.find("\n\n") - 4, 4, 4, '\0');  // a run of nothing
    EXPECT_FALSE(parseEnvironment(hidden, "sky.hdr", 64));
    const TempDir folder;
    writeText(folder.path("sky.tga"), whole.substr(0, whole.size() - 1));
    const Result<FieldImagePtr> picture = readImage(folder.path("graph.field.json"), "sky.tga");
    ASSERT_FALSE(picture);
    EXPECT_NE(picture.error().message.find("is none"), std::string::npos) << format(picture.error());
}

TEST(ImageRefused, OutsideTheFolder) {
    const TempDir folder;
    std::filesystem::create_directories(folder.path("in/deeper"));
    writePictureFile(folder.path("six.png"), 3, 2, kSix);
    writePictureFile(folder.path("in/six.png"), 3, 2, kSix);
    const std::string graph = folder.path("in/g.field.json");
    EXPECT_TRUE(readImage(graph, "six.png"));
    EXPECT_TRUE(readImage(graph, "deeper/../six.png"));
    std::filesystem::create_symlink(folder.path("in/six.png"), folder.path("in/deeper/inside.png"));
    EXPECT_TRUE(readImage(graph, "deeper/inside.png"));
    std::filesystem::create_symlink(folder.path("six.png"), folder.path("in/outside.png"));
    for (const std::string& path :
         {std::string("../six.png"), std::string("deeper/../../six.png"), folder.path("in/six.png"),
          std::string("outside.png"), std::string("/dev/zero"), std::string("..")}) {
        const Result<FieldImagePtr> image = readImage(graph, path);
        ASSERT_FALSE(image) << path;
        EXPECT_NE(image.error().message.find("lies outside the folder of the file that names it"),
                  std::string::npos)
            << image.error().message;
    }
    EXPECT_FALSE(readImage(graph, std::string("six.png\0.png", 12)));
    EXPECT_FALSE(readImage(graph, std::string(100'000, 'a')));
}

TEST(ImageRefused, LargerThanTheLimits) {
    const TempDir folder;
    writePictureFile(folder.path("wide.png"), 4097, 1, std::vector<uint8_t>(3 * 4097));
    EXPECT_EQ(refusal(folder, "wide.png"),
              "node 'paint', input 'image': the picture 'wide.png' has 4097 x 1 pixels: at most 4096 along a "
              "side can be used, so scale it down");
    // Of a picture that says it is larger than memory nothing but its head is read.
    std::string head = test::readText(folder.path("wide.png")).substr(0, 64);
    head[16] = head[20] = 0;
    head[17] = head[21] = char(0xFF);
    writeText(folder.path("vast.png"), head);
    EXPECT_FALSE(readImage(folder.path("g.field.json"), "vast.png"));

    const std::vector<uint8_t> flat(3 * 4096 * 4096, 100);
    std::string nodes, shown;
    for (const char* name : {"a", "b", "c"}) {
        writePictureFile(folder.path(std::string(name) + ".bmp"), 4096, 4096, flat);
        nodes += R"({"id": ")" + std::string(name) + R"(", "type": "triplanar", "inputs": {"image": ")" +
                 name + R"(.bmp"}},)";
    }
    const Result<Graph> graph =
        parseGraph(R"({"fieldwright": 1, "nodes": [)" + nodes +
                       R"({"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}}},
                        {"id": "ball", "type": "sphere"}]})",
                   folder.path("g.field.json"), nullptr);
    ASSERT_TRUE(graph) << format(graph.error());
    int errors = 0;
    for (const Error& error : check(*graph))
        if (error.severity == Error::Severity::error) {
            ++errors;
            EXPECT_NE(error.message.find("take 128 MiB or more"), std::string::npos) << error.message;
        }
    EXPECT_EQ(errors, 2);
    EXPECT_TRUE(compile(*graph));  // which needs none of them
}

TEST(ImageGraph, RoundTripAndHash) {
    const TempDir folder;
    writePictureFile(folder.path("six.png"), 3, 2, kSix);
    std::vector<uint8_t> other = kSix;
    other[0] = 200;
    writePictureFile(folder.path("other.png"), 3, 2, other);
    std::filesystem::create_directory(folder.path("in"));
    std::filesystem::copy(folder.path("six.png"), folder.path("in/copy.png"));

    const Graph graph = graphIn(folder, "six.png");
    const Result<Graph> again = parseGraph(writeGraph(graph), graph.path, nullptr);
    ASSERT_TRUE(again);
    EXPECT_EQ(*again, graph);
    EXPECT_EQ(writeGraph(*again), writeGraph(graph));

    const Result<Program> program = compile(graph), same = compile(graphIn(folder, "in/copy.png")),
                          changed = compile(graphIn(folder, "other.png"));
    ASSERT_TRUE(program && same && changed);
    ASSERT_EQ(program->ir.images().size(), 1u);
    EXPECT_EQ(program->ir.images()[0]->texels, six()->texels);
    EXPECT_EQ(program->structureHash, same->structureHash);
    EXPECT_NE(program->structureHash, changed->structureHash);
    EXPECT_EQ(imageWords(program->ir.images()).size(), 6u);
    EXPECT_TRUE(program->hasMaterial());
}

/// The paint's colour at a point.
Point colorAt(const Program& program, const Point& point) {
    Point color;
    for (int i = 0; i < 3; ++i)
        color[std::size_t(i)] =
            evaluate(program.ir, program.surface[std::size_t(baseColorComponent + i)], {}, point);
    return color;
}

TEST(ImageGraph, EachSideShowsThePictureUpright) {
    const TempDir folder;
    writePictureFile(folder.path("six.png"), 3, 2, kSix);
    const Result<Program> program = compile(graphIn(folder, "six.png"));
    ASSERT_TRUE(program) << format(program.error());
    // The picture is 1 m wide and 2/3 m high; (0, 0) is a lower left corner.
    const double red = 0.5 / 3, upper = 0.75 * 2 / 3;
    const double toBlue = 2.0 / 3;
    const auto isRed = [&](const Point& p) {
        const Point color = colorAt(*program, p);
        return std::abs(color[0] - 1) < 1e-9 && std::abs(color[1]) < 1e-9 && std::abs(color[2]) < 1e-9;
    };
    const auto isBlue = [&](const Point& p) {
        const Point color = colorAt(*program, p);
        return std::abs(color[2] - 1) < 1e-9 && std::abs(color[0]) < 1e-9 && std::abs(color[1]) < 1e-9;
    };
    EXPECT_TRUE(isRed({red, upper, 1}));  // seen from +z, x goes to the right
    EXPECT_TRUE(isBlue({red + toBlue, upper, 1}));
    EXPECT_TRUE(isRed({-red, upper, -1}));
    EXPECT_TRUE(isBlue({-red - toBlue, upper, -1}));
    EXPECT_TRUE(isRed({1, upper, -red}));  // from +x, -z does
    EXPECT_TRUE(isBlue({1, upper, -red - toBlue}));
    EXPECT_TRUE(isRed({-1, upper, red}));
    EXPECT_TRUE(isRed({red, 1, -upper}));  // from above, x does, and -z is up
    EXPECT_TRUE(isBlue({red + toBlue, 1, -upper}));
    EXPECT_TRUE(isRed({red, -1, upper}));
}

TEST(ImageGraph, WithoutASurfaceAllSidesCountAlike) {
    const TempDir folder;
    writePictureFile(folder.path("six.png"), 3, 2, kSix);
    Graph graph = graphIn(folder, "six.png");
    std::erase_if(graph.node("paint")->inputs, [](const auto& input) { return input.first == "surface"; });
    const Result<Program> program = compile(graph);
    ASSERT_TRUE(program) << format(program.error());
    const ImageLayer& green = program->ir.images()[0]->layers[1];
    const Point p{0.31, -0.42, 0.77};
    const double wanted =
        (sampleImage(green, -p[2], p[1] * 1.5).value + sampleImage(green, p[0], -p[2] * 1.5).value +
         sampleImage(green, p[0], p[1] * 1.5).value) /
        3;
    EXPECT_NEAR(colorAt(*program, p)[1], wanted, 1e-12);
}

TEST(ImageGraph, WithoutAnImageThereIsAChecker) {
    const TempDir folder;
    const Result<Program> program = compile(graphIn(folder, ""));
    ASSERT_TRUE(program) << format(program.error());
    const double light = linearOfByte(0xE0), dark = linearOfByte(0xB0);
    EXPECT_NEAR(colorAt(*program, {0.25, 0.25, 1})[0], light, 1e-12);
    EXPECT_NEAR(colorAt(*program, {0.75, 0.25, 1})[1], dark, 1e-12);
    EXPECT_NEAR(colorAt(*program, {0.25, 0.75, 1})[2], dark, 1e-12);
    EXPECT_NEAR(colorAt(*program, {-0.25, -0.25, 1})[2], light, 1e-12);
}

TEST(ImageGraph, AHeightfieldIsAsHighAsThePictureIsLight) {
    const TempDir folder;
    std::mt19937 random(11);
    std::vector<uint8_t> rgb;
    for (int i = 0; i < 12 * 8; ++i) {
        const auto grey = uint8_t(40 + random() % 100);
        rgb.insert(rgb.end(), {grey, grey, grey});
    }
    rgb[0] = rgb[1] = rgb[2] = 255;  // the upper left corner
    writePictureFile(folder.path("rough.png"), 12, 8, rgb);
    const Result<Graph> graph = parseGraph(
        R"({"fieldwright": 1, "nodes": [{"id": "h", "type": "heightfield", "inputs": {"image": "rough.png", "size": [3, 0.6, 2],
            "base": 0.2}}, {"id": "out", "type": "output", "inputs": {"surface": {"from": "h"}}}]})",
        folder.path("g.field.json"), nullptr);
    ASSERT_TRUE(graph) << format(graph.error());
    const Result<Program> program = compile(*graph);
    ASSERT_TRUE(program) << format(program.error());
    EXPECT_TRUE(program->exactness.bound());
    const auto at = [&](double x, double y, double z) {
        return evaluate(program->ir, program->distance(), {}, Point{x, y, z});
    };
    for (int row = 0; row < 8; ++row)
        for (int column = 0; column < 12; ++column) {
            const double x = 3 * ((column + 0.5) / 12 - 0.5), z = 2 * ((row + 0.5) / 8 - 0.5);
            const double height = 0.6 * rgb[std::size_t(3 * (12 * row + column))] / 255.0;
            EXPECT_LT(at(x, height - 1e-6, z), 0);
            EXPECT_GT(at(x, height + 1e-6, z), 0);
        }
    EXPECT_NEAR(at(-1.5 + 1e-9, 0.6, -1 + 1e-9), 0, 1e-6);  // the corner, not mixed with what lies across
    EXPECT_LT(at(0, -0.19, 0), 0);
    EXPECT_GT(at(0, -0.21, 0), 0);
    EXPECT_GT(at(1.51, 0, 0), 0);
    EXPECT_GT(at(0, 0, -1.01), 0);
    EXPECT_NEAR(at(0, 40.6, 0), 40, 1e-9);  // far above, the relief slows nothing down

    const Region region = findRegion(program->ir, program->distance(), {});
    ASSERT_EQ(region.extent, Extent::bounded);
    EXPECT_NEAR(region.box.hi[1], 0.6, 0.05);
    EXPECT_NEAR(region.box.lo[1], -0.2, 0.05);

    // The declared constant: no two points differ by more than their distance.
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int i = 0; i < 20'000; ++i) {
        const Point a{1.6 * unit(random), 0.8 * unit(random), 1.1 * unit(random)};
        Point b = a;
        double squared = 0;
        for (int axis = 0; axis < 3; ++axis) {
            b[std::size_t(axis)] += 0.05 * unit(random);
            squared += std::pow(b[std::size_t(axis)] - a[std::size_t(axis)], 2);
        }
        ASSERT_LE(std::abs(at(a[0], a[1], a[2]) - at(b[0], b[1], b[2])), std::sqrt(squared) + 1e-12);
    }
}

TEST(ImageGraph, ExpressionsAndGroupsTakeImages) {
    const TempDir folder;
    writePictureFile(folder.path("six.png"), 3, 2, kSix);
    const auto valueOf = [&](const std::string& nodes, const Point& at) -> double {
        const Result<Graph> graph = parseGraph(
            R"({"fieldwright": 1, "groups": [{"id": "sampler", "inputs": [{"name": "picture", "type": "image"}],
                "outputs": [{"name": "color", "type": "vec3"}], "nodes": [{"id": "in", "type": "group_input"},
                {"id": "paint", "type": "triplanar", "inputs": {"image": {"from": "in", "output": "picture"}}},
                {"id": "end", "type": "group_output", "inputs": {"color": {"from": "paint"}}}]}], "nodes": [)" +
                nodes + R"(, {"id": "out", "type": "output", "inputs": {"surface": {"from": "e"}}}]})",
            folder.path("g.field.json"), nullptr);
        EXPECT_TRUE(graph) << format(graph.error());
        const Result<Program> program = compile(*graph);
        EXPECT_TRUE(program) << format(program.error());
        return program ? evaluate(program->ir, program->distance(), {}, at) : 0.0;
    };
    const auto expression = [](const std::string& code, const std::string& inputs = {}) {
        return R"({"id": "e", "type": "expression", "inputs": {)" + inputs + R"(}, "code": ")" + code + "\"}";
    };
    const Point at{0.5, 0.25, 0};
    EXPECT_NEAR(valueOf(expression(R"(return image_color(\"six.png\", p.x, p.y).y;)"), at), kMiddle, 1e-12);
    EXPECT_NEAR(valueOf(expression(R"(return image_grey(\"six.png\", p.xy);)"), at), 128 / 255.0, 1e-12);
    EXPECT_EQ(valueOf(expression(R"(return image_size(\"six.png\").x;)"), at), 3.0);
    EXPECT_NEAR(
        valueOf(expression(R"(return triplanar(p, \"six.png\", 1.0, 4.0, plane(p, vec3(0, 0, 1), 0)).y;)"),
                {0.5, 0.25 * 2 / 3, 0}),
        kMiddle, 1e-9);
    EXPECT_NEAR(
        valueOf(R"({"id": "g", "type": "group", "group": "sampler", "inputs": {"picture": "six.png"}}, )" +
                    expression("return c.y;", R"("c": {"from": "g"})"),
                {0.5, 0.25 * 2 / 3, -0.25 * 2 / 3}),
        (2 * kMiddle + sampleImage(six()->layers[1], 0.25 * 2 / 3, 0.25).value) / 3, 1e-12);

    const auto refused = [&](const std::string& code) {
        const Result<Graph> graph =
            parseGraph(R"({"fieldwright": 1, "nodes": [)" + expression(code) +
                           R"(, {"id": "out", "type": "output", "inputs": {"surface": {"from": "e"}}}]})",
                       folder.path("g.field.json"), nullptr);
        EXPECT_TRUE(graph) << format(graph.error());
        const Result<Program> program = compile(*graph);
        return program ? std::string() : format(program.error());
    };
    EXPECT_NE(refused(R"(return image_grey(\"none.png\", p.xy);)")
                  .find("code 1:8: the picture 'none.png' does not"),
              std::string::npos)
        << refused(R"(return image_grey(\"none.png\", p.xy);)");
    EXPECT_NE(refused("return image_grey(p, p.xy);").find("a vec3 cannot stand for an image"),
              std::string::npos);
    EXPECT_NE(refused(R"(return image_grey(\"six.png\", p);)").find("behind an image stand"),
              std::string::npos);
}

}  // namespace fw::image_test
