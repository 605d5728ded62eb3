// Random code of solids in moved, turned, mirrored and repeated coordinates.
#pragma once

#include <cmath>
#include <random>
#include <string>

namespace fw::test {

struct Source {
    std::mt19937_64 random;
    double unit() { return double(random() >> 11) * 0x1p-53; }
    double between(double lo, double hi) { return std::lerp(lo, hi, unit()); }
    bool chance(double share) { return unit() < share; }
    /// Mostly near the origin, sometimes as far as 60,000.
    double coordinate() {
        if (chance(0.6)) return between(-6.0, 6.0);
        return (chance(0.5) ? 1.0 : -1.0) * std::pow(10.0, between(-3.0, 4.77));
    }
};

/// Random solids in moved, turned, twisted, mirrored and repeated coordinates, and combinations of them.
struct SolidWriter {
    Source& source;
    std::string code = {};
    int count = 0;

    std::string number(double lo, double hi) {
        return "(" + std::to_string(std::round(source.between(lo, hi) * 100.0) / 100.0) + ")";
    }
    std::string named(const std::string& type, const std::string& value) {
        const std::string name = "v" + std::to_string(count++);
        code += type + " " + name + " = " + value + ";\n";
        return name;
    }
    std::string coordinates(std::string q) {
        for (int n = int(source.random() % 4); n > 0; --n) {
            const std::string x = q + ".x", y = q + ".y", z = q + ".z";
            std::string next;
            switch (source.random() % 9) {
                case 0: next = q + " - vec3(" + number(-5, 5) + ", " + number(-5, 5) + ", 1)"; break;
                case 1: next = q + " - vec3(time, " + number(-2, 2) + " * time, 0)"; break;
                case 2:
                case 3: {
                    const std::string angles[] = {number(-3, 3), "time", number(-1, 1) + " * " + y,
                                                  "time * " + y, "atan(" + y + ", 2.0)"};
                    const std::string a = named("float", angles[source.random() % 5]);
                    const std::string c = "cos(" + a + ")", s = "sin(" + a + ")";
                    next = "vec3(" + x + " * " + c + " + " + z + " * " + s + ", " + y + ", " + z + " * " + c +
                           " - " + x + " * " + s + ")";
                    break;
                }
                case 4: next = "vec3(abs(" + x + "), " + y + ", abs(" + z + "))"; break;
                case 5:
                    next = "vec3(" + x + " - 3 * clamp(round(" + x + " / 3), -2, 2), " + z + ", " + y + ")";
                    break;
                case 6:
                    next = "vec3(" + x + " > " + y + " ? " + x + " - time : " + x + " + 1, " + z + ", " + y +
                           ")";
                    break;
                case 7:
                    next = "vec3(" + x + " / 2, " + y + " / (time + 3), " + z + " + 0.3 * " + x + ")";
                    break;
                default:
                    next = "vec3(max(" + x + ", " + number(-2, 2) + "), " + y + " + 0.4 * sin(" + x +
                           "), min(" + z + ", time))";
            }
            q = named("vec3", next);
        }
        return q;
    }
    std::string shape(const std::string& q) {
        const std::string r = source.chance(0.2) ? "(time + 2.5)" : number(0.2, 2);
        switch (source.random() % 9) {
            case 0: return "length(" + q + ") - " + r;
            case 1:
                return "max(abs(" + q + ".x) - " + r + ", max(abs(" + q + ".y) - 1, abs(" + q + ".z) - 0.5))";
            case 2: return "length(max(abs(" + q + ") - vec3(1, 0.5, " + r + "), 0)) - 0.2";
            case 3: return "length(vec2(length(vec2(" + q + ".x, " + q + ".z)) - 2, " + q + ".y)) - " + r;
            case 4: return "abs(" + q + ".x) + abs(" + q + ".y) + abs(" + q + ".z) - " + r;
            case 5: return "dot(" + q + ", " + q + ") + " + q + ".x * " + q + ".y - " + r;
            case 6: return "max(length(vec2(" + q + ".x, " + q + ".z)) - " + r + ", abs(" + q + ".y) - 1)";
            case 7: return q + ".x + 0.5 * " + q + ".y";
            default: return "0.3 - 1 / (1 + dot(" + q + ", " + q + "))";
        }
    }
    std::string solid(int depth) {
        if (depth == 0 || source.chance(0.2)) return named("float", shape(coordinates("p")));
        const std::string a = solid(depth - 1), b = solid(depth - 1);
        switch (source.random() % 10) {
            case 0:
            case 1: return named("float", "min(" + a + ", " + b + ")");
            case 2: return named("float", "max(" + a + ", " + b + ")");
            case 3: return named("float", "max(" + a + ", -" + b + ")");
            case 4: return named("float", "smooth_min(" + a + ", " + b + ", " + number(0.1, 2) + ")");
            case 5: return named("float", "abs(" + a + ") - 0.1");
            case 6: return named("float", a + " / (time + 3) + 0.2 * sin(p.x)");
            case 7: return named("float", "mix(" + a + ", " + b + ", 0.3)");
            case 8: return named("float", "p.x + p.y > time ? " + a + " : " + b);
            default: return named("float", "max(" + a + ", time * p.y)");
        }
    }
};

}  // namespace fw::test
