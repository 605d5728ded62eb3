#include "tests/support/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "tests/support/graph/temp_dir.h"

namespace fw::test {

namespace {

constexpr double kWidth = 640, kHeight = 400, kLeft = 56, kRight = 16, kTop = 16, kBottom = 48;

/// The range of one coordinate and where it lies in the picture.
struct Axis {
    double least = std::numeric_limits<double>::infinity(), most = -least, from = 0.0, to = 1.0;
    double at(double value) const { return from + (to - from) * (value - least) / (most - least); }
    /// 1, 2 or 5 times a power of ten, about a sixth of the range.
    double step() const {
        const double rough = (most - least) / 6.0, power = std::pow(10.0, std::floor(std::log10(rough)));
        return power * (rough < 2.0 * power ? 2.0 : rough < 5.0 * power ? 5.0 : 10.0);
    }
};

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.5g", std::abs(value) < 1e-12 ? 0.0 : value);
    return text;
}
std::string line(double x0, double y0, double x1, double y1, const char* color) {
    return "<line x1=\"" + number(x0) + "\" y1=\"" + number(y0) + "\" x2=\"" + number(x1) + "\" y2=\"" +
           number(y1) + "\" stroke=\"" + color + "\"/>\n";
}
std::string words(double x, double y, const char* anchor, const std::string& what) {
    return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\">" + what +
           "</text>\n";
}

}  // namespace

void plot(const std::string& name, const std::string& x, const std::string& y,
          const std::vector<Curve>& curves) {
    const char* folder = std::getenv("FIELDWRIGHT_PLOTS");
    if (!folder) return;
    Axis across{.from = kLeft, .to = kWidth - kRight}, up{.from = kHeight - kBottom, .to = kTop};
    for (const Curve& curve : curves)
        for (const auto& [u, v] : curve.points) {
            across.least = std::min(across.least, u), across.most = std::max(across.most, u);
            up.least = std::min(up.least, v), up.most = std::max(up.most, v);
        }
    up.most += 0.05 * (up.most - up.least), up.least -= 0.05 * (up.most - up.least);
    std::string svg =
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 640 400\" font-family=\"sans-serif\" "
        "font-size=\"13\">\n<rect width=\"640\" height=\"400\" fill=\"white\"/>\n";
    for (double at = std::ceil(across.least / across.step()) * across.step(); at <= across.most;
         at += across.step())
        svg += line(across.at(at), up.from, across.at(at), up.to, "#ddd") +
               words(across.at(at), up.from + 18, "middle", number(at));
    for (double at = std::ceil(up.least / up.step()) * up.step(); at <= up.most; at += up.step())
        svg += line(across.from, up.at(at), across.to, up.at(at), "#ddd") +
               words(across.from - 6, up.at(at) + 4, "end", number(at));
    double row = kTop + 18;
    for (const Curve& curve : curves) {
        std::string path;
        for (const auto& [u, v] : curve.points) {
            const std::string px = number(across.at(u)), py = number(up.at(v));
            if (curve.dots)
                svg += "<circle cx=\"" + px + "\" cy=\"" + py + "\" r=\"4\" fill=\"" + curve.color + "\"/>\n";
            else
                path += (path.empty() ? "M" : " L") + px + " " + py;
        }
        if (!curve.dots)
            svg += "<path d=\"" + path + "\" fill=\"none\" stroke-width=\"2\" stroke=\"" + curve.color +
                   "\"/>\n";
        svg += "<circle cx=\"" + number(kLeft + 16) + "\" cy=\"" + number(row - 4) + "\" r=\"4\" fill=\"" +
               curve.color + "\"/>\n" + words(kLeft + 28, row, "start", curve.name);
        row += 18;
    }
    svg += words(0.5 * (across.from + across.to), kHeight - 10, "middle", x) +
           "<g transform=\"rotate(-90 16 " + number(0.5 * kHeight) + ")\">" +
           words(16, 0.5 * kHeight, "middle", y) + "</g>\n</svg>\n";
    writeText(std::string(folder) + "/" + name + ".svg", svg);
}

}  // namespace fw::test
