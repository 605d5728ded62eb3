#include "tests/support/dropped_file.h"

#include <X11/Xatom.h>
#include <X11/Xlib.h>

#include <chrono>
#include <memory>
#include <thread>

namespace fw::test {

namespace {

constexpr double kDropPatience = 30.0;  // seconds

struct Source {
    Display* display;
    Window own, target;

    Atom atom(const char* name) const { return XInternAtom(display, name, False); }

    void tell(const char* what, long second, long third, long fourth, long fifth) const {
        XEvent event{};
        event.xclient.type = ClientMessage;
        event.xclient.window = target;
        event.xclient.message_type = atom(what);
        event.xclient.format = 32;
        const long words[] = {long(own), second, third, fourth, fifth};
        std::copy(std::begin(words), std::end(words), event.xclient.data.l);
        XSendEvent(display, target, False, NoEventMask, &event);
        XFlush(display);
    }

    /// The list of files, put where the window asks for it.
    void answer(const XSelectionRequestEvent& asked, const std::string& text) const {
        XChangeProperty(display, asked.requestor, asked.property, asked.target, 8, PropModeReplace,
                        reinterpret_cast<const unsigned char*>(text.data()), int(text.size()));
        XEvent event{};
        event.xselection.type = SelectionNotify;
        event.xselection.requestor = asked.requestor;
        event.xselection.selection = asked.selection;
        event.xselection.target = asked.target;
        event.xselection.property = asked.property;
        event.xselection.time = asked.time;
        XSendEvent(display, asked.requestor, False, NoEventMask, &event);
        XFlush(display);
    }
};

}  // namespace

bool dropFile(const std::string& window, const std::string& path, int x, int y) {
    const std::unique_ptr<Display, int (*)(Display*)> display(XOpenDisplay(nullptr), XCloseDisplay);
    if (!display) return false;
    Source source{display.get(), 0, Window(std::stoul(window))};
    source.own = XCreateSimpleWindow(source.display, DefaultRootWindow(source.display), 0, 0, 1, 1, 0, 0, 0);
    const Atom list = source.atom("text/uri-list"), selection = source.atom("XdndSelection"),
               copy = source.atom("XdndActionCopy");
    XSetSelectionOwner(source.display, selection, source.own, CurrentTime);
    source.tell("XdndEnter", 5L << 24, long(list), 0, 0);
    source.tell("XdndPosition", 0, long(x) << 16 | y, CurrentTime, long(copy));
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begun = Clock::now();
    while (std::chrono::duration<double>(Clock::now() - begun).count() < kDropPatience) {
        if (XPending(source.display) == 0) {
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
            continue;
        }
        XEvent event{};
        XNextEvent(source.display, &event);
        if (event.type == SelectionRequest) source.answer(event.xselectionrequest, "file://" + path + "\r\n");
        if (event.type != ClientMessage) continue;
        if (event.xclient.message_type == source.atom("XdndFinished")) return true;
        if (event.xclient.message_type != source.atom("XdndStatus")) continue;
        if ((event.xclient.data.l[1] & 1) == 0) return false;
        source.tell("XdndDrop", 0, CurrentTime, 0, 0);
    }
    return false;
}

}  // namespace fw::test
