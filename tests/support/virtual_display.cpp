#include "tests/support/virtual_display.h"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

namespace fw::test {

void rest(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

VirtualDisplay::VirtualDisplay(int width, int height) {
    const std::string screen = std::to_string(width) + "x" + std::to_string(height) + "x24";
    int ends[2];
    if (pipe(ends) != 0) return;
    process = fork();
    if (process == 0) {
        prctl(PR_SET_PDEATHSIG, SIGTERM);  // no server outlives a test that crashed
        close(ends[0]);
        const std::string pipeEnd = std::to_string(ends[1]);
        // A reset would turn away who comes while the last one leaves; a cursor would stand in the pictures.
        execlp("Xvfb", "Xvfb", "-noreset", "-nocursor", "-displayfd", pipeEnd.c_str(), "-screen", "0",
               screen.c_str(), "-fbdir", folder.folder.c_str(), nullptr);
        _exit(127);
    }
    close(ends[1]);
    char text[16] = {};
    for (ssize_t got = 0, n = 0; got < 15 && (n = read(ends[0], text + got, 1)) > 0 && text[got] != '\n';)
        got += n;
    close(ends[0]);
    number = text[0] ? std::atoi(text) : -1;
    if (number >= 0) setenv("DISPLAY", (":" + std::to_string(number)).c_str(), 1);
}

VirtualDisplay::~VirtualDisplay() {
    if (process > 0) kill(process, SIGTERM), waitpid(process, nullptr, 0);
    unsetenv("DISPLAY");
}

Picture VirtualDisplay::screen() const {
    // XWD: a header and a colour map, then rows of blue, green, red, nothing.
    std::ifstream file(folder.path("Xvfb_screen0"), std::ios::binary);
    std::ostringstream content;
    content << file.rdbuf();
    const std::string data = content.str();
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(data.at(i)); };
    const auto word = [&](std::size_t i) {
        std::size_t value = 0;
        for (std::size_t k = 0; k < 4; ++k) value = value << 8 | byte(4 * i + k);
        return value;
    };
    const std::size_t first = word(0) + 12 * word(19), stride = word(12), width = word(4), height = word(5);
    Picture picture{int(width), int(height), std::vector<uint8_t>(4 * width * height, 255)};
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x)
            for (std::size_t c = 0; c < 3; ++c)
                picture.pixels[4 * (y * width + x) + c] = byte(first + y * stride + 4 * x + 2 - c);
    return picture;
}

glm::ivec3 VirtualDisplay::pixel(int x, int y) const {
    const Picture picture = screen();
    const std::size_t at = 4 * (std::size_t(y) * std::size_t(picture.width) + std::size_t(x));
    return {picture.pixels.at(at), picture.pixels.at(at + 1), picture.pixels.at(at + 2)};
}

}  // namespace fw::test
