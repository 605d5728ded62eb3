#include "tests/support/editor/program.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "editor/canvas/canvas.h"
#include "editor/shell/theme.h"
#include "graph/document/json.h"
#include "tests/support/dropped_file.h"
#include "tests/support/window_title.h"

namespace fw::editor::test {

using fw::test::readText;
using fw::test::runProgram;
using fw::test::writeText;

namespace {

constexpr double kPatience = 120.0;            // seconds; only what fails takes so long
constexpr const char* kDelay = " --delay 5 ";  // ms: GLFW takes presses of a key within one for a single one
constexpr double kLook = 0.02;                 // seconds between two looks

std::string inQuotes(const std::string& text) {
    std::string quoted = "'";
    for (char each : text) quoted += each == '\'' ? std::string("'\\''") : std::string(1, each);
    return quoted + "'";
}

std::string trimmed(std::string text) {
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text;
}

/// "Ctrl+Shift+PageUp" as xdotool has it.
std::string keysym(const std::string& shortcut) {
    static const std::pair<const char*, const char*> kNames[] = {
        {"Enter", "Return"},         {"Backspace", "BackSpace"}, {"PageUp", "Prior"},
        {"PageDown", "Next"},        {"Minus", "minus"},         {"Equal", "equal"},
        {"Comma", "comma"},          {"Period", "period"},       {"Slash", "slash"},
        {"Space", "space"},          {"PadEnter", "KP_Enter"},   {"PadPlus", "KP_Add"},
        {"PadMinus", "KP_Subtract"}, {"PadSlash", "KP_Divide"}};
    static const char* const kPad[] = {"KP_Insert", "KP_End",   "KP_Down", "KP_Next", "KP_Left",
                                       "KP_Begin",  "KP_Right", "KP_Home", "KP_Up",   "KP_Prior"};
    std::string words, word;
    std::istringstream parts(shortcut);
    while (std::getline(parts, word, '+')) {
        if (word == "Ctrl" || word == "Shift" || word == "Alt" || word.size() == 1)
            std::ranges::transform(word, word.begin(), [](unsigned char c) { return std::tolower(c); });
        // As it is without Num Lock: xdotool would press Shift for the digit.
        if (word.starts_with("Pad") && word.size() == 4) word = kPad[std::size_t(word.at(3) - '0')];
        for (const auto& [ours, theirs] : kNames)
            if (word == ours) word = theirs;
        words += (words.empty() ? "" : "+") + word;
    }
    return words;
}

std::string at(ImVec2 p) {
    return "mousemove " + std::to_string(int(std::lround(p.x))) + " " +
           std::to_string(int(std::lround(p.y))) + " ";
}

/// Another one whenever the file is written anew.
std::array<long long, 3> identity(const std::string& path) {
    struct stat status {};
    if (stat(path.c_str(), &status) != 0) return {};
    return {(long long)status.st_ino, (long long)status.st_mtim.tv_sec, (long long)status.st_mtim.tv_nsec};
}

}  // namespace

bool eventually(const std::function<bool()>& condition) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point end =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(kPatience));
    while (!condition()) {
        if (Clock::now() > end) return false;
        fw::test::rest(kLook);
    }
    return true;
}

Program::Program(const std::string& text, float picture, float side)
    : document(folder.path("document.field.json")), share(picture) {
    usable = display.works() && runProgram("xdotool version").status == 0;
    if (!usable) return;
    writeText(document, text);
    if (share != kUsual || side != kUsualSide) {
        std::filesystem::create_directories(folder.path("config/fieldwright"));
        writeText(
            folder.path("config/fieldwright/editor.json"),
            "{\"panels\": {\"top\": " + std::to_string(share) + ", \"side\": " + std::to_string(side) + "}}");
    }
    read();
    start({document});
    usable = process > 0;
}

Program::~Program() {
    if (!usable) return;
    if (testing::Test::HasFailure()) keepScreen();
    kill();
}

void Program::keepScreen() {
    if (std::exchange(kept, true)) return;
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = test ? std::string(test->test_suite_name()) + "." + test->name() : "editor";
    std::ranges::replace(name, '/', '.');
    const std::string path = FIELDWRIGHT_BINARY_DIR "/" + name + ".png";
    if (savePicture(screen(), path)) std::fprintf(stderr, "the screen as it was: %s\n", path.c_str());
}

bool Program::waitUntil(const std::function<bool()>& condition) {
    if (eventually(condition)) return true;
    keepScreen();
    return false;
}

void Program::start(const std::vector<std::string>& arguments) {
    static const fw::test::TempDir caches;  // what one start has compiled the next one need not
    process = fork();
    if (process == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        setenv("XDG_CONFIG_HOME", folder.path("config").c_str(), 1);
        setenv("XDG_STATE_HOME", folder.path("state").c_str(), 1);
        setenv("XDG_DATA_HOME", folder.path("data").c_str(), 1);
        setenv("XDG_CACHE_HOME", caches.folder.c_str(), 1);
        if (chdir(folder.folder.c_str()) != 0) _exit(125);
        std::vector<std::string> words = {FIELDWRIGHT_BINARY_DIR "/fieldwright-editor", "--scale", "1"};
        words.insert(words.end(), arguments.begin(), arguments.end());
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        execv(argv[0], argv.data());
        _exit(126);
    }
    ASSERT_GT(process, 0);
    // To ask for the window again and again would cost more than to look.
    waitFor("File");
    // The title is set by the first frame.
    ASSERT_TRUE(waitUntil([&] {
        window = trimmed(runProgram("xdotool search --onlyvisible --name ' - Fieldwright$'").output);
        return !window.empty() && window.find_first_not_of("0123456789") == std::string::npos;
    })) << "no window: "
        << window;
    // Without a window manager nobody else gives it the keyboard.
    send("windowfocus --sync " + window + " mousemove 640 790");
}

void Program::kill() {
    if (process <= 0) return;
    ::kill(process, SIGKILL);
    waitpid(std::exchange(process, -1), nullptr, 0);
}

int Program::waitForEnd() {
    int status = 0;
    if (!waitUntil([&] { return waitpid(process, &status, WNOHANG) != 0; })) return -1;
    process = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void Program::send(const std::string& words) {
    const auto sent = runProgram("xdotool " + words);
    ASSERT_EQ(sent.status, 0) << "xdotool " << words << "\n" << sent.output;
}

void Program::keys(const std::string& shortcut, int times) {
    effort.keys += times;
    std::string words = "key" + std::string(kDelay);
    for (int i = 0; i < times; ++i) words += " " + keysym(shortcut);
    send(words);
}

void Program::type(const std::string& text) {
    // Characters of several bytes are one.
    effort.keys += int(std::ranges::count_if(text, [](char each) { return (each & 0xC0) != 0x80; }));
    std::string words, line;
    for (char each : text + '\0') {
        if (each != '\n' && each != '\0') {
            line += each;
            continue;
        }
        if (!line.empty()) words += "type" + std::string(kDelay) + "--args 1 -- " + inQuotes(line) + " ";
        if (each == '\n') words += "key Return ";
        line.clear();
    }
    send(words);
}

void Program::moveTo(ImVec2 to) { send(at(to)); }

void Program::click(ImVec2 p, int button, const std::string& held) {
    ++effort.clicks;
    send(at(p) + (held.empty() ? "" : "keydown " + held + " ") + "click --delay 0 " + std::to_string(button) +
         (held.empty() ? "" : " keyup " + held));
}

void Program::doubleClick(ImVec2 p) {
    effort.clicks += 2;
    send(at(p) + "click --repeat 2 --delay 0 1");
}

void Program::drop(const std::string& path, ImVec2 p) {
    ++effort.drags;
    EXPECT_TRUE(fw::test::dropFile(window, path, int(std::lround(p.x)), int(std::lround(p.y))))
        << path << " cannot be dropped";
}

void Program::release(int button) { send("mouseup " + std::to_string(button)); }

void Program::drag(const std::vector<ImVec2>& through, int button, const std::string& held, bool watched,
                   bool ends) {
    ++effort.drags;
    const std::string number = std::to_string(button);
    std::string words =
        at(through.front()) + (held.empty() ? "" : "keydown " + held + " ") + "mousedown " + number;
    for (std::size_t i = 1; i < through.size(); ++i) {
        words += " " + at(through[i]);
        if (!watched) continue;
        const Picture before = screen();
        send(words);
        words.clear();
        waitForChange(before, Area{through[i], through[i]}.grown(6));
    }
    if (ends) words += " mouseup " + number;
    if (!held.empty()) words += " keyup " + held;
    if (!words.empty()) send(words);
}

void Program::wheel(ImVec2 p, int notches) {
    send(at(p) + "click --delay 0 --repeat " + std::to_string(std::abs(notches)) +
         (notches > 0 ? " 4" : " 5"));
}

void Program::look(Picture& into, const std::optional<Area>& part) const {
    const Area all = part.value_or(Area{{0, 0}, {float(display.width()), float(display.height())}});
    display.look(into, int(all.lo.x), int(all.lo.y), int(all.hi.x), int(all.hi.y));
}

Picture Program::screen(const Area& part) const {
    Picture picture;
    look(picture, part);
    return picture;
}

bool Program::sees(const std::string& words, const std::optional<Area>& within) {
    Picture now;
    look(now, within);
    return reader.find(now, words).has_value();
}

Area Program::waitForWords(const std::string& words, const std::optional<Area>& within, Reader::Face face) {
    std::optional<Area> found;
    Picture now, last;
    const bool came = waitUntil([&] {
        look(now, within);
        if (now.pixels == last.pixels) return false;  // read already
        found = reader.find(now, words, kFontSize, std::nullopt, face);
        std::swap(now, last);
        return found.has_value();
    });
    EXPECT_TRUE(came) << "\"" << words << "\" is not on the screen"
                      << (face == Reader::Face::code ? " as code" : "");
    if (!found) return {};
    const ImVec2 corner =
        within ? ImVec2(std::max(std::floor(within->lo.x), 0.0f), std::max(std::floor(within->lo.y), 0.0f))
               : ImVec2();
    return {{found->lo.x + corner.x, found->lo.y + corner.y},
            {found->hi.x + corner.x, found->hi.y + corner.y}};
}

Area Program::waitFor(const std::string& words, const std::optional<Area>& within) {
    return waitForWords(words, within, Reader::Face::text);
}

Area Program::waitForCode(const std::string& word, const std::optional<Area>& within) {
    return waitForWords(word, within, Reader::Face::code);
}

void Program::waitUntilGone(const std::string& words) {
    EXPECT_TRUE(waitUntil([&] { return !sees(words); })) << "\"" << words << "\" stays on the screen";
}

void Program::clickOn(const std::string& words, const std::optional<Area>& within) {
    const Area found = waitFor(words, within);
    if (found.width() > 0) click(found.centre());
}

std::string Program::title() const { return fw::test::windowTitle(window); }

void Program::waitForTitle(const std::string& wanted) {
    EXPECT_TRUE(waitUntil([&] { return title() == wanted; })) << "it is " << title() << ", not " << wanted;
}

void Program::expectGolden(const std::string& name, const Area& part) {
    constexpr fw::test::Tolerance kInterface{.mean = 0.1, .mostStrong = 0.001};
    const std::string path = "editor/" + name;
    if (fw::test::remakesGolden())
        fw::test::rest(3.0);  // there is nothing to wait for
    else
        waitUntil([&] { return fw::test::isGolden(screen(part), path, kInterface); });
    fw::test::expectGolden(screen(part), path, kInterface);
}

void Program::waitForChange(const Picture& before, const Area& part) {
    const auto same = [&](const Picture& now) {
        const std::size_t row = 4 * std::size_t(now.width);
        const auto x = std::size_t(std::clamp(int(part.lo.x), 0, before.width)),
                   y = std::size_t(std::clamp(int(part.lo.y), 0, before.height));
        for (std::size_t i = 0; i < std::size_t(now.height); ++i)
            if (!std::equal(&now.pixels[i * row], &now.pixels[i * row] + row,
                            &before.pixels[4 * ((y + i) * std::size_t(before.width) + x)]))
                return false;
        return true;
    };
    EXPECT_TRUE(waitUntil([&] { return !same(screen(part)); })) << "nothing changes on the screen";
}

std::string Program::save() {
    const auto before = identity(document);
    const Effort done = effort;
    keys("Ctrl+S");
    effort = done;
    EXPECT_TRUE(waitUntil([&] { return identity(document) != before; })) << "Ctrl+S does not write the file";
    read();
    return readText(document);
}

const Graph& Program::saved() {
    save();
    return known;
}

void Program::open(const std::string& path, const std::string& typed) {
    keys("Ctrl+O");
    waitFor("Cancel");
    type((typed.empty() ? path : typed) + "\n");
    const std::size_t slash = path.find_last_of('/');
    document = slash == std::string::npos ? folder.path(path) : path;
    waitForTitle(document.substr(document.find_last_of('/') + 1) + " - Fieldwright");
    read();
}

void Program::read() {
    Result<Graph> graph = readGraph(document, nullptr);
    ASSERT_TRUE(graph) << format(graph.error());
    known = std::move(*graph);
}

void Program::clipboard(const std::string& text) {
    writeText(folder.path("clipboard"), text);
    // Its streams closed: it stays behind to answer for the text.
    const auto put = runProgram("xclip -selection clipboard -i " + inQuotes(folder.path("clipboard")) +
                                " >/dev/null 2>&1 </dev/null");
    ASSERT_EQ(put.status, 0) << put.output;
}

std::string Program::clipboard() const { return runProgram("xclip -selection clipboard -o").output; }

void Program::findPanel() {
    // The canvas is where its grid is: lines from one side to the other.
    constexpr int kLine = 20;
    const ImU32 grid = themeColor(ThemeColor::grid);
    const std::array<uint8_t, 3> ink = {uint8_t(grid), uint8_t(grid >> 8), uint8_t(grid >> 16)};
    const Picture seen = screen();
    float left = 1e9f, top = 1e9f, right = 0, bottom = 0;
    std::vector<int> down(std::size_t(seen.width), 0);  // how long the line is that ends here, in each column
    const uint8_t* pixel = seen.pixels.data();
    for (int y = 0; y < seen.height; ++y)
        for (int x = 0, across = 0; x < seen.width; ++x, pixel += 4) {
            int& run = down[std::size_t(x)];
            if (!std::equal(ink.begin(), ink.end(), pixel)) {
                across = run = 0;
                continue;
            }
            if (++across >= kLine)
                left = std::min(left, float(x - across + 1)), right = std::max(right, float(x + 1));
            if (++run >= kLine)
                top = std::min(top, float(y - run + 1)), bottom = std::max(bottom, float(y + 1));
        }
    view.panel = {{left, top}, {right, bottom}};
}

void Program::frameAll() {
    const Effort done = effort;
    keys("Home");
    effort = done;
    ASSERT_TRUE(waitUntil([&] {
        // Twice the same: it may be seen while it is drawn.
        const Area before = view.panel;
        findPanel();
        const ImVec2 lo = view.panel.lo, hi = view.panel.hi;
        return lo.x == before.lo.x && lo.y == before.lo.y && hi.x == before.hi.x && hi.y == before.hi.y &&
               hi.x > lo.x + 200 && hi.y > lo.y + 200;
    })) << "there is no canvas on the screen";
    view.frame(Boxes(known, scope).around());
}

void Program::zoom(int notches) {
    const ImVec2 middle(std::round(view.panel.centre().x), std::round(view.panel.centre().y));
    wheel(middle, notches);
    view.zoomTo(view.zoom * std::pow(kWheel, float(notches)), middle);
}

void Program::pan(ImVec2 pixels) {
    const ImVec2 whole(std::round(pixels.x), std::round(pixels.y)), middle = view.panel.centre();
    drag({middle, {middle.x + whole.x, middle.y + whole.y}}, 2);
    view.pan(whole);
}

ImVec2 Program::title(const std::string& node) const {
    const Boxes boxes(known, scope);
    const NodeBox* box = boxes.find(node);
    EXPECT_NE(box, nullptr) << node;
    if (!box) return {};
    if (box->reroute) return view.toScreen(box->area.centre());
    return view.toScreen(
        ImVec2(box->area.lo.x + 0.35f * box->area.width(), box->area.lo.y + 0.5f * kTitleHeight));
}

ImVec2 Program::input(const std::string& node, const std::string& name) const {
    const Boxes boxes(known, scope);
    const Row* row = boxes.row({node, name}, false);
    EXPECT_NE(row, nullptr) << node << '.' << name;
    return row ? view.toScreen(boxes.find(node)->socket(*row)) : ImVec2();
}

ImVec2 Program::output(const std::string& node) const {
    const Boxes boxes(known, scope);
    const Row* row = boxes.row({node, ""}, true);
    EXPECT_NE(row, nullptr) << node;
    return row ? view.toScreen(boxes.find(node)->socket(*row)) : ImVec2();
}

ImVec2 Program::field(const std::string& node, const std::string& name, int component) const {
    const Boxes boxes(known, scope);
    const Row* row = boxes.row({node, name}, false);
    EXPECT_TRUE(row && component < row->fields) << node << '.' << name << ' ' << component;
    return row ? view.toScreen(boxes.find(node)->field(*row, component).centre()) : ImVec2();
}

ImVec2 Program::nowhere() const {
    constexpr float kStep = 20, kOff = 40;
    const Boxes boxes(known, scope);
    const Area inner = view.panel.grown(-kOff), map = minimapArea(view).grown(kOff);
    for (float y = inner.lo.y; y < inner.hi.y; y += kStep)
        for (float x = inner.lo.x; x < inner.hi.x; x += kStep) {
            const ImVec2 p(x, y);
            if (map.contains(p)) continue;
            if (hitTest(boxes, view.toCanvas(p), kOff / view.unit()).what == Hit::What::nothing) return p;
        }
    ADD_FAILURE() << "the canvas is full";
    return {};
}

std::string Program::add(const std::string& search, ImVec2 p) {
    std::set<std::string> before;
    for (const Node& node : nodesOf(known, scope)) before.insert(node.id);
    moveTo(p);
    keys("Shift+A");
    type(search + "\n");
    save();
    for (const Node& node : nodesOf(known, scope))
        if (!before.contains(node.id)) return node.id;
    ADD_FAILURE() << "the menu adds nothing for " << search;
    return {};
}

void Program::set(const std::string& node, const std::string& name, int component, const std::string& text) {
    click(field(node, name, component));
    type(text + "\n");
}

}  // namespace fw::editor::test
