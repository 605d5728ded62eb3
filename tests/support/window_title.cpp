#include "tests/support/window_title.h"

#include <X11/Xatom.h>
#include <X11/Xlib.h>

#include <cstdlib>
#include <memory>

namespace fw::test {

std::string windowTitle(const std::string& window) {
    const std::unique_ptr<Display, int (*)(Display*)> display(XOpenDisplay(nullptr), XCloseDisplay);
    if (!display || window.empty()) return {};
    const Atom name = XInternAtom(display.get(), "_NET_WM_NAME", False),
               utf8 = XInternAtom(display.get(), "UTF8_STRING", False);
    Atom type = None;
    int bits = 0;
    unsigned long count = 0, left = 0;
    unsigned char* text = nullptr;
    constexpr long kMost = 1024;  // words of four bytes
    if (XGetWindowProperty(display.get(), std::strtoul(window.c_str(), nullptr, 10), name, 0, kMost, False,
                           utf8, &type, &bits, &count, &left, &text) != Success ||
        !text)
        return {};
    std::string title(reinterpret_cast<const char*>(text), count);
    XFree(text);
    return title;
}

}  // namespace fw::test
