#include "tests/support/virtual_display.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

namespace fw::test {

void rest(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

VirtualDisplay::VirtualDisplay(int width, int height) : wide(width), high(height) {
    const std::string screen = std::to_string(width) + "x" + std::to_string(height) + "x24";
    int ends[2];
    if (pipe(ends) != 0) return;
    process = fork();
    if (process == 0) {
        prctl(PR_SET_PDEATHSIG, SIGTERM);  // no server outlives a test that crashed
        close(ends[0]);
        const std::string pipeEnd = std::to_string(ends[1]);
        // A reset would turn away who comes while the last one leaves; a cursor would stand in the pictures;
        // a key that is held until a busy machine lets it go would repeat.
        execlp("Xvfb", "Xvfb", "-noreset", "-nocursor", "-r", "-displayfd", pipeEnd.c_str(), "-screen", "0",
               screen.c_str(), "-fbdir", folder.folder.c_str(), nullptr);
        _exit(127);
    }
    close(ends[1]);
    char text[16] = {};
    for (ssize_t got = 0, n = 0; got < 15 && (n = read(ends[0], text + got, 1)) > 0 && text[got] != '\n';)
        got += n;
    close(ends[0]);
    number = text[0] ? std::atoi(text) : -1;
    if (number < 0) return;
    setenv("DISPLAY", (":" + std::to_string(number)).c_str(), 1);
    // XWD: a header and a colour map, then rows of blue, green, red, nothing.
    const int file = open(folder.path("Xvfb_screen0").c_str(), O_RDONLY);
    struct stat status {};
    if (file < 0 || fstat(file, &status) != 0) std::abort();
    bytes = std::size_t(status.st_size);
    void* mapped = mmap(nullptr, bytes, PROT_READ, MAP_SHARED, file, 0);
    close(file);
    if (mapped == MAP_FAILED) std::abort();
    memory = static_cast<const unsigned char*>(mapped);
    const auto word = [&](std::size_t i) {
        std::size_t value = 0;
        for (std::size_t k = 0; k < 4; ++k) value = value << 8 | memory[4 * i + k];
        return value;
    };
    first = word(0) + 12 * word(19), stride = word(12);
}

VirtualDisplay::~VirtualDisplay() {
    if (memory) munmap(const_cast<unsigned char*>(memory), bytes);
    if (process > 0) kill(process, SIGTERM), waitpid(process, nullptr, 0);
    unsetenv("DISPLAY");
}

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
    if (!memory) return;
    uint8_t* to = into.pixels.data();
    for (int y = y0; y < y1; ++y) {
        const unsigned char* from = memory + first + std::size_t(y) * stride + 4 * std::size_t(x0);
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
