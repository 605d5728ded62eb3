#include "runtime/cli/progress_lines.h"

#include <unistd.h>

#include <cstdio>

namespace fw::cli {

namespace {

bool toOpenJd = false;

void sayToOpenJd(double percent, const std::string& doing) {
    static double most = -1.0;
    static std::string last;
    if (percent > most) std::printf("openjd_progress: %.1f\n", most = percent);
    if (doing != last) std::printf("openjd_status: %s\n", (last = doing).c_str());
    std::fflush(stdout);
}

}  // namespace

void showProgressToOpenJd() { toOpenJd = true; }

bool progressIsShown() { return toOpenJd || isatty(STDERR_FILENO); }

void showProgress(double percent, const std::string& doing, const std::string& rest) {
    if (toOpenJd) return sayToOpenJd(percent, doing);
    std::fprintf(stderr, "\r\033[K%3d %%  %s%s", int(percent), doing.c_str(), rest.c_str());
    std::fflush(stderr);
}

void hideProgress() {
    if (!toOpenJd) std::fprintf(stderr, "\r\033[K");
}

}  // namespace fw::cli
