#include "tests/support/virtual_display.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <X11/Xlib.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <list>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "tests/support/graph/temp_dir.h"

namespace fw::test {

void rest(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

struct XServer {
    XServer(int columns, int rows);  ///< check works()
    XServer(const XServer&) = delete;
    ~XServer();
    bool works() const { return memory != nullptr; }

    int width, height;  ///< in pixels
    bool isUsed = false;
    TempDir folder;
    pid_t process = -1;
    std::string address;  ///< for DISPLAY
    /// The file that the server keeps the screen in, mapped: rows of blue, green, red and padding from
    /// `first` on, `stride` bytes apart.
    const unsigned char* memory = nullptr;
    std::size_t bytes = 0, first = 0, stride = 0;
};

XServer::XServer(int columns, int rows) : width(columns), height(rows) {
    const std::string screen = std::to_string(width) + "x" + std::to_string(height) + "x24";
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return;
    process = fork();
    if (process == 0) {
        prctl(PR_SET_PDEATHSIG, SIGTERM);  // the server ends with the tests, even if they crash
        fcntl(ends[1], F_SETFD, 0);
        const std::string pipeEnd = std::to_string(ends[1]);
        // -noreset: the server does not restart, and refuse clients meanwhile, when its last client leaves.
        // -nocursor: no cursor in the pictures. -r: no key repeats, however long a busy machine holds it.
        execlp("Xvfb", "Xvfb", "-noreset", "-nocursor", "-r", "-displayfd", pipeEnd.c_str(), "-screen", "0",
               screen.c_str(), "-fbdir", folder.folder.c_str(), nullptr);
        _exit(127);
    }
    close(ends[1]);
    char text[16] = {};
    for (ssize_t got = 0, n = 0; got < 15 && (n = read(ends[0], text + got, 1)) > 0 && text[got] != '\n';)
        got += n;
    close(ends[0]);
    if (!text[0]) return;
    address = ":" + std::to_string(std::atoi(text));
    const int file = open(folder.path("Xvfb_screen0").c_str(), O_RDONLY | O_CLOEXEC);
    struct stat status {};
    if (file < 0 || fstat(file, &status) != 0) std::abort();
    bytes = std::size_t(status.st_size);
    void* mapped = mmap(nullptr, bytes, PROT_READ, MAP_SHARED, file, 0);
    close(file);
    if (mapped == MAP_FAILED) std::abort();
    memory = static_cast<const unsigned char*>(mapped);
    // An XWD file: a header of big-endian words and a colour map, then the rows.
    const auto word = [&](std::size_t i) {
        std::size_t value = 0;
        for (std::size_t k = 0; k < 4; ++k) value = value << 8 | memory[4 * i + k];
        return value;
    };
    first = word(0) + 12 * word(19), stride = word(12);
}

XServer::~XServer() {
    if (memory) munmap(const_cast<unsigned char*>(memory), bytes);
    if (process > 0) kill(process, SIGTERM), waitpid(process, nullptr, 0);
}

namespace {

/// All servers of the process. They end with it.
std::list<XServer> servers;

void end(const XServer* server) {
    servers.remove_if([&](const XServer& other) { return &other == server; });
}

/// Whether any window is mapped. A window may vanish between the two queries.
bool hasVisibleWindow(Display* display, Window root) {
    Window parent = None, *children = nullptr;
    unsigned count = 0;
    if (!XQueryTree(display, root, &root, &parent, &children, &count)) return false;
    const bool any = std::any_of(children, children + count, [&](Window window) {
        XWindowAttributes attributes{};
        return XGetWindowAttributes(display, window, &attributes) && attributes.map_state != IsUnmapped;
    });
    if (children) XFree(children);
    return any;
}

bool hasPressedInput(Display* display, Window root) {
    char keys[32] = {};
    XQueryKeymap(display, keys);
    Window ignored = None;
    int x = 0, y = 0;
    unsigned mask = 0;
    XQueryPointer(display, root, &ignored, &ignored, &x, &y, &x, &y, &mask);
    const unsigned buttons = Button1Mask | Button2Mask | Button3Mask | Button4Mask | Button5Mask;
    return (mask & buttons) != 0 || std::ranges::any_of(keys, [](char byte) { return byte != 0; });
}

/// Removes what the last test left on the server; false if something stays.
bool clean(const XServer& server) {
    const std::unique_ptr<Display, int (*)(Display*)> display(XOpenDisplay(server.address.c_str()),
                                                              XCloseDisplay);
    if (!display) return false;
    const auto handler = XSetErrorHandler([](Display*, XErrorEvent*) { return 0; });  // of windows that went
    const Window root = DefaultRootWindow(display.get());
    // The server notices a moment later that a program has ended.
    const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(2);
    bool isClean = false;
    while (!(isClean = !hasVisibleWindow(display.get(), root)) && std::chrono::steady_clock::now() < limit)
        rest(0.01);
    isClean = isClean && !hasPressedInput(display.get(), root);
    for (const char* selection : {"PRIMARY", "SECONDARY", "CLIPBOARD"})
        XSetSelectionOwner(display.get(), XInternAtom(display.get(), selection, False), None, CurrentTime);
    XSetInputFocus(display.get(), PointerRoot, RevertToPointerRoot, CurrentTime);
    XWarpPointer(display.get(), None, root, 0, 0, 0, 0, server.width / 2, server.height / 2);
    XClearWindow(display.get(), root);
    XSync(display.get(), True);
    XSetErrorHandler(handler);
    return isClean;
}

/// A clean server of this size that no other display uses; null if there is no Xvfb.
XServer* serverOf(int width, int height) {
    const auto found = std::ranges::find_if(servers, [&](const XServer& server) {
        return !server.isUsed && server.width == width && server.height == height;
    });
    if (found != servers.end()) {
        if (clean(*found)) return &*found;
        servers.erase(found);
    }
    XServer& server = servers.emplace_back(width, height);
    if (server.works()) return &server;
    end(&server);
    return nullptr;
}

}  // namespace

VirtualDisplay::VirtualDisplay(int width, int height)
    : server(serverOf(width, height)), wide(width), high(height) {
    if (!server) return;
    server->isUsed = true;
    setenv("DISPLAY", server->address.c_str(), 1);
}

VirtualDisplay::~VirtualDisplay() {
    unsetenv("DISPLAY");
    if (!server) return;
    server->isUsed = false;
    if (testing::Test::HasFailure()) end(server);
}

void VirtualDisplay::endServer() { end(std::exchange(server, nullptr)); }

Picture VirtualDisplay::screen() const {
    Picture picture;
    look(picture, 0, 0, wide, high);
    return picture;
}

void VirtualDisplay::look(Picture& into, int x0, int y0, int x1, int y1) const {
    x0 = std::clamp(x0, 0, wide), x1 = std::clamp(x1, x0, wide);
    y0 = std::clamp(y0, 0, high), y1 = std::clamp(y1, y0, high);
    into.width = x1 - x0, into.height = y1 - y0;
    into.pixels.resize(4 * std::size_t(into.width) * std::size_t(into.height));
    if (!server) return;
    uint8_t* to = into.pixels.data();
    for (int y = y0; y < y1; ++y) {
        const unsigned char* from =
            server->memory + server->first + std::size_t(y) * server->stride + 4 * std::size_t(x0);
        for (int x = x0; x < x1; ++x, from += 4, to += 4)
            to[0] = from[2], to[1] = from[1], to[2] = from[0], to[3] = 255;
    }
}

glm::ivec3 VirtualDisplay::pixel(int x, int y) const {
    Picture picture;
    look(picture, x, y, x + 1, y + 1);
    return {picture.pixels.at(0), picture.pixels.at(1), picture.pixels.at(2)};
}

}  // namespace fw::test
