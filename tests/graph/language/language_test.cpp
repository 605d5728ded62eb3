// The field language: what code means, and what is said of code that means nothing.
#include <gtest/gtest.h>
#include <pthread.h>

#include <chrono>
#include <cmath>

#include "graph/evaluate/evaluate.h"
#include "graph/language/lower.h"
#include "graph/language/resolve.h"

namespace fw::language_test {

using language::Value;

struct Outcome {
    Ir ir;
    IrId root = 0;
    Type type = Type::scalar;
    std::string error;

    double at(double x, double y, double z) const { return evaluate(ir, root, {}, Point{x, y, z}); }
};

Outcome run(const std::string& code) {
    Outcome outcome;
    language::Lowering state;
    state.time = state.ir.constant(2.0);
    const Result<Value> value = language::lowerText(state, code);
    if (!value) {
        outcome.error = format(value.error());
        return outcome;
    }
    outcome.root = value->ids[0];
    outcome.type = value->type;
    outcome.ir = std::move(state.ir);
    return outcome;
}

void expectValue(const std::string& code, double expected, Point p = {0.3, -0.4, 0.5}) {
    const Outcome outcome = run(code);
    ASSERT_EQ(outcome.error, "") << code;
    EXPECT_NEAR(outcome.at(p[0], p[1], p[2]), expected, 1e-12) << code;
}

void expectError(const std::string& code, const std::string& part) {
    const Outcome outcome = run(code);
    EXPECT_NE(outcome.error.find(part), std::string::npos)
        << code.substr(0, 200) << "\n said: " << outcome.error;
}

TEST(Language, Expressions) {
    expectValue("return 1 + 2 * 3 - 4 / 8;", 6.5);
    expectValue("return -2 * -3;", 6.0);
    expectValue("return (1 + 2) * 3 % 5;", 4.0);
    expectValue("return 7 / 2;", 3.5);
    expectValue("int a = 7 / 2; return a;", 3.0);
    expectValue("return p.x + pos.y * 10;", 0.3 - 4.0);
    expectValue("return p.zyx.x;", 0.5);
    expectValue("return vec3(p.xy, 9).z;", 9.0);
    expectValue("return vec3(p.z).y;", 0.5);
    expectValue("return dot(vec3(1, 2, 3), p);", 0.3 - 0.8 + 1.5);
    expectValue("return length(vec2(3, 4));", 5.0);
    expectValue("return p.x > 0.0 && !(p.y > 0.0) ? 1.0 : 2.0;", 1.0);
    expectValue("return 1e-1 + .5 + 2.f;", 2.6);
    expectValue("return cross(vec3(1, 0, 0), vec3(0, 1, 0)).z;", 1.0);
    expectValue("return time;", 2.0);
    expectValue("return 3 // a comment\n + /* another */ 4;", 7.0);
    expectValue("return pow(-2.0, 3);", -8.0);
    expectValue("return pow(p.y, 2.0);", 0.16);
}

TEST(Language, NamesOfOtherLanguages) {
    expectValue("return frac(1.75);", 0.75);
    expectValue("return lerp(1, 3, 0.25);", 1.5);
    expectValue("return saturate(1.5);", 1.0);
    expectValue("return fmod(-0.75, 0.5);", -0.25);  // truncates, as HLSL's
    expectValue("return mod(-0.75, 0.5);", 0.25);    // floors, as GLSL's
    expectValue("float3 a = float3(1, 2, 3); return a.y;", 2.0);
}

TEST(Language, Statements) {
    expectValue("a = 1; a += 2; a *= 3; a -= 1; a /= 4; return a;", 2.0);
    expectValue("d = 1; d = d + 1;", 2.0);  // the last assignment is the result
    expectValue("vec3 q = p; q.xz = vec2(7, 8); q.y += 1.0; return q.x + q.y * 10 + q.z * 100;", 7 + 6 + 800);
    expectValue("pos.y = frac(pos.y); return pos.y;", 0.6);
    expectValue("float a = 1, b = 2; return a + b;", 3.0);
    expectValue("float s = 0.0; for (int i = 0; i < 5; i++) s += float(i); return s;", 10.0);
    expectValue(
        "s = 0; for (int i = 0; i < 10; i++) { if (i == 2) continue; if (i == 5) break; s += i; } return s;",
        8.0);
    expectValue("float s = 0; for (int i = 3; i > 0; i--) for (int j = 0; j < i; j++) s += 1; return s;",
                6.0);
    expectValue("if (p.x > 0.0) { return 5; } return 6;", 5.0);
    expectValue("a = 1; if (p.x < 0.0) a = 2; else if (p.y < 0.0) a = 3; else a = 4; return a;", 3.0);
    expectValue(
        "float twice(float x) { return 2.0 * x; } float four(float x) { return twice(twice(x)); } return "
        "four(p.x);",
        1.2);
    expectValue("float f(vec2 q) { if (q.x < q.y) return q.x; return q.y; } return f(p.xy) + f(p.yx);", -0.8);
}

TEST(Language, AssignmentsInBlocksLast) {
    expectValue("for (int i = 0; i < 3; i++) { p = abs(p) - 0.1; } return p.x + 10 * p.y + 100 * p.z;", 21.0);
    expectValue("if (p.x > 0.0) { p.y = 7.0; } return p.y;", 7.0);
    expectValue("if (p.x > 9.0) pos.y = 7.0; return p.y;", -0.4);
    expectValue("float f(vec3 p) { if (p.x > 0.0) p = -p; return p.x; } return f(p) + p.x;", 0.0);
    expectValue("float f(float x) { p.x += x; return p.x; } return f(1.0) + f(1.0);", 2.6);
    expectValue("float a = 1; { float a = 2; a = 3; } { a += 5; } return a;", 6.0);
    expectValue("{ vec3 p = vec3(9); p.x = 8.0; } return p.x;", 0.3);
}

TEST(Language, IntegersTruncateWhereverTheyAreStored) {
    expectValue("int i = 7; i /= 2; return i;", 3.0);
    expectValue("int i = 0; i = -2.7; return i;", -2.0);
    expectValue("float f(int n) { return n; } return f(2.9);", 2.0);
    expectValue("int f() { return 2.9; } return f();", 2.0);
    expectValue("int i = 0; for (; i < 4;) { i += 2; } return i;", 4.0);
}

TEST(Language, LeavingALoopWherePositionDecides) {
    const std::string code =
        "float d = 0; for (int i = 0; i < 8; i++) { d += 1; if (d > p.x) break; d += 0.5; } return d;";
    const Outcome outcome = run(code);
    ASSERT_EQ(outcome.error, "");
    for (double x = -1.0; x < 14.0; x += 0.37) {
        double d = 0;
        for (int i = 0; i < 8; i++) {
            d += 1;
            if (d > x) break;
            d += 0.5;
        }
        EXPECT_NEAR(outcome.at(x, 0, 0), d, 1e-12) << x;
    }
    const Outcome skipped =
        run("float d = 0; for (int i = 0; i < 6; i++) { if (float(i) > p.x && float(i) < p.y) continue; d += "
            "float(i); } return d;");
    ASSERT_EQ(skipped.error, "");
    for (double x = -1.0; x < 6.0; x += 0.7)
        for (double y = -1.0; y < 7.0; y += 0.6) {
            double d = 0;
            for (int i = 0; i < 6; i++)
                if (!(i > x && i < y)) d += i;
            EXPECT_NEAR(skipped.at(x, y, 0), d, 1e-12) << x << ' ' << y;
        }
}

TEST(Language, ReturnsInsideLoopsAndBranches) {
    const Outcome outcome =
        run("for (int i = 0; i < 4; i++) { if (p.x < float(i)) return float(i) * 10.0; } return -1.0;");
    ASSERT_EQ(outcome.error, "");
    EXPECT_NEAR(outcome.at(-0.5, 0, 0), 0, 1e-12);
    EXPECT_NEAR(outcome.at(0.5, 0, 0), 10, 1e-12);
    EXPECT_NEAR(outcome.at(2.5, 0, 0), 30, 1e-12);
    EXPECT_NEAR(outcome.at(3.5, 0, 0), -1, 1e-12);
}

TEST(Language, NodesAreFunctions) {
    expectValue("return sphere(p, 1.0);", std::sqrt(0.5) - 1.0);
    expectValue("d = Box(pos, vec3(1, 2, 1)); return d;", -0.5);
    expectValue("d = union(sphere(p, 0.1), sphere(p, 0.2)); return d.distance;", std::sqrt(0.5) - 0.2);
    // A field of a node at another position.
    expectValue("a = sphere(p, 1.0); return a(p + vec3(1, 0, 0));", std::sqrt(1.69 + 0.16 + 0.25) - 1.0);
    expectValue("return translate(sphere(p, 1.0), vec3(-1, 0, 0));", std::sqrt(1.69 + 0.16 + 0.25) - 1.0);
}

TEST(Language, SurfacesKeepTheirMaterial) {
    const std::string red =
        "a = with_material(sphere(p, 1.0), vec3(1, 0, 0), 0.1, 1.0, vec3(0)); b = sphere(p - vec3(3, 0, 0), "
        "1.0); ";
    expectValue(red + "return min(a, b).base_color.y;", 0.0);
    expectValue(red + "return min(a, b).base_color.y;", 0.8, {3, 0, 0});
    expectValue(red + "a = max(a, -box(p, vec3(0.1))); return a.base_color.x;", 1.0);
    expectValue(red + "a = a - 0.1; return a.metallic;", 1.0);
    expectValue(red + "return mix(a, b, 0.5).roughness;", 0.3);
}

TEST(Language, TheTalksTower) {
    // "Combined Result", word for word but for the names that the listing leaves open.
    const Outcome outcome = run(R"(
        float cylinderHole(vec3 c) { return length(c.xz - 0.25) - 0.1; }
        float holes() { return length(pos.xz) - 0.3; }
        A = 1.0; B = 0.5; N = 0.25; M = 1.0;
        d = Box(pos, vec3(1, 2, 1))
        ;c = fmod(pos * A, B);
        subD = max(c.y, min(c.y, c.z));
        subD = min(subD, cylinderHole(c));
        subD = max(subD, box(pos, vec3(2)));
        e = fmod(pos + N, M);
        floorD = Box(e, vec3(0.45, 0.1, 0.45));
        floorD = min(floorD, holes());
        d = max(d, -subD);
        d = max(d, -floorD);)");
    ASSERT_EQ(outcome.error, "");
    const auto box = [](double x, double y, double z, double a, double b, double c) {
        const double qx = std::abs(x) - a, qy = std::abs(y) - b, qz = std::abs(z) - c;
        const double outside = std::hypot(std::max(qx, 0.0), std::max(qy, 0.0), std::max(qz, 0.0));
        return outside + std::min(std::max({qx, qy, qz}), 0.0);
    };
    for (double x : {-1.3, -0.4, 0.2, 0.9})
        for (double y : {-2.1, -0.6, 0.1, 1.7})
            for (double z : {-0.9, 0.05, 0.6}) {
                double d = box(x, y, z, 1, 2, 1);
                const double cx = std::fmod(x, 0.5), cy = std::fmod(y, 0.5), cz = std::fmod(z, 0.5);
                double subD = std::max(cy, std::min(cy, cz));
                subD = std::min(subD, std::hypot(cx - 0.25, cz - 0.25) - 0.1);
                subD = std::max(subD, box(x, y, z, 2, 2, 2));
                double floorD = box(std::fmod(x + 0.25, 1), std::fmod(y + 0.25, 1), std::fmod(z + 0.25, 1),
                                    0.45, 0.1, 0.45);
                floorD = std::min(floorD, std::hypot(x, z) - 0.3);
                d = std::max(std::max(d, -subD), -floorD);
                EXPECT_NEAR(outcome.at(x, y, z), d, 1e-12);
            }
}

TEST(Language, Diagnostics) {
    expectError("return spere(p, 1);", "code 1:8: unknown function 'spere': did you mean 'sphere'?");
    expectError("a = 1;\nreturn lenght(p);", "code 2:8: unknown function 'lenght': did you mean 'length'?");
    expectError("radius = 1; return radios;", "did you mean 'radius'?");
    expectError("x = 3 +", "code 1:8: expected a value, found the end of the code");
    expectError("return 1/0;", "code 1:9: division by zero");
    expectError("return p / vec3(1, 0, 1);", "division by zero");
    expectError("return p % 0;", "code 1:10: division by zero");
    expectError("return mod(p, 0);", "division by zero");
    expectError("p /= 0;", "division by zero");
    expectError("float f(float x) { return f(x); } return f(1);", "calls itself");
    expectError("for (;;) {}", "code 1:1: the loop has no condition");
    EXPECT_EQ(language::resolve("for (;;) { } return 1;", {}).errors.size(), 1u);
    expectError("return p[0.5];", "code 1:9: an index is a whole number, not 0.5");
    expectError("return prism(p, 3.5);", "the value 3.5 must be a whole number");
    expectError("d = 0; for (int i = 0; i < 1; ) d = p.x;", "steps");
    expectError("d = 0; for (int i = 0; i < 1; i = i) d = p.x;", "steps");
    expectError("d = 0; for (int i = 0; i < p.x; i++) d = 1.;", "must be known");
    expectError("const float k = 1; k = 2;", "'k' is const");
    expectError("return output(p);", "is a node and no function");
    expectError("p.", "expected a component");
    expectError("++p.;", "expected a component");
    expectError(std::string("return 1 \0;", 11), "the character '?' has no meaning");
    expectError("return é;", "the character 'é' has no meaning");
    expectError("float f(float x, float x) { return x; } return f(1, 2);",
                "code 1:24: the parameter 'x' is there twice");
    expectError("p[0] = 1; return 1;", "code 1:6: only a variable, or components of one");
    expectError("i = 1; return i++;", "code 1:16: only a variable");
    expectError("vec4 v; return 1;",
                "code 1:1: expected a type (float, int, bool, vec2 or vec3), found 'vec4'");
    expectError("while (true) {}", "'while' is not part of the language");
    expectError("return vec3(1) + vec2(1);", "vec2 and vec3 do not mix");
    expectError("return \"a\";", "string");
    expectError("if (p.x > 0.) { return 1.; }", "does not return on every path");
    expectError("", "no result");
    expectError("return 1; }", "expected a value, found '}'");
    expectError("return 1e999;", "out of range");
    expectError("return @;", "the character '@'");
    expectError("return p.w;", "no component 'w'");
    expectError("return sphere(p, 1, 2);", "at most 2 arguments");
    expectError("float if = 1;", "is a word of the language");
    expectError("return min(1);", "takes 2 to 8 arguments");
    expectError("return pow(1, 2, 3);", "takes 2 arguments");
    expectError("return p[3];", "index 3 is outside 0 to 2");
    expectError("return p[5128 * 1e21];", "index 5.128e+24 is outside 0 to 2");
    expectError("return p[-1];", "index -1 is outside 0 to 2");
    expectError("break; return 1;", "inside a loop");
    expectError("return /* open", "no end");
}

TEST(Language, HostileCodeIsRefusedSoon) {
    const auto start = std::chrono::steady_clock::now();
    std::string sum = "return p.x", parens = "return ", minus = "return ", blocks, dots = "return p";
    for (int i = 0; i < 1'000'000; ++i) sum += "+p.x";
    for (int i = 0; i < 100'000; ++i) parens += '(', minus += "- ", blocks += '{', dots += ".x";
    expectError(sum + ";", "longer than");
    expectError(parens, "nested deeper");
    expectError(minus, "nested deeper");
    expectError(blocks, "nested deeper");
    expectError(dots + ";", "");
    expectError("d = p.x; for (int i = 0; i < 1000000000; i++) d = sphere(p + d, 1);", "more than");
    expectError("a = p.x; for (int i = 0; i < 100000; i++) { a = sin(a) + cos(a + i); } return a;",
                "operations");
    std::string calls = "float f0(float x) { return x + p.x; }";
    for (int i = 1; i < 40; ++i)
        calls += "float f" + std::to_string(i) + "(float x) { return f" + std::to_string(i - 1) + "(x) + f" +
                 std::to_string(i - 1) + "(x * 1.1); }";
    expectError(calls + " return f39(1);", "");
    EXPECT_LT(std::chrono::steady_clock::now() - start,
              std::chrono::seconds(60));  // ends at all; time is no criterion here
}

TEST(Language, BooleansAndTextsAreNoNumbers) {
    expectError("return length(p) - 1 - 0.5*(p.x > 0.0);",
                "code 1:33: expected a number or a vector, found a bool");
    expectError("return any(p) ? 1. : length(p)-1.;",
                "code 1:12: argument 1 of 'any': expected a comparison, found a vec3");
    expectError("return 1.0 == p ? 1 : 2;", "expected a float to compare with, found a vec3");
    expectError("return p == 1.0 ? 1 : 2;", "expected a vec3 to compare with, found a float");
    expectError("return time == \"abc\" ? 1 : 2;", "expected a float to compare with, found a string");
    expectError("return perlin(\"abc\", 1);", "expected a position (vec3), found a string");
    expectError("return with_distance(sphere(p), \"abc\");",
                "expected a number, the distance, found a string");
    expectError("return perlin(p, \"abc\");", "expected a number, the seed, found a string");
    expectError("return (p.x > 0.) == (p.y > 0.) ? 1 : 2;", "comparisons cannot be compared");
    expectError("return -(p.x > 0.);", "found a bool");
    expectError("float a = p.x > 0.; return a;", "expected a float for 'a', found a bool");
    expectError("a = 1; a = p.x > 0.; return a;", "expected a float, which 'a' is, found a bool");
    expectError("a = p.x > 0.; a = 1.; return a ? 1 : 2;", "expected a bool, which 'a' is, found a float");
    expectError("if (p.x) return 1; return 2;",
                "code 1:7: expected a condition, which is a comparison, found a float");
    expectError("return p ? 1 : 2;", "expected a condition");
    expectError("return !p.x ? 1 : 2;", "expected a comparison behind '!', found a float");
    expectError("return p.x > 0. && p.y ? 1 : 2;", "expected a comparison beside '&&', found a float");
    expectError("return p < 1. ? 1 : 2;", "expected a number beside '<', found a vec3");
    expectError("return vec3(p.x > 0., 1, 2);", "found a bool");
    expectError("float f(float x) { return x; } return f(p);",
                "argument 1 of 'f': expected a float, found a vec3");
    expectError("float f() { return p; } return f();", "expected a float to return, found a vec3");
    expectError("return sphere(1.0 > p.x);",
                "argument 1 of 'sphere' is its p: expected a vec3, found a bool");
    expectError("return p.x > 0. ? p : p.xy;",
                "the two sides are of different types: expected a vec3, found a vec2");
    expectError("if (p.x > 0.) return p; return p.xy;", "as is returned in line 1, found a vec2");
    expectError("vec3 q = p; q.xy = p; return q;", "expected a vec2, found a vec3");
    expectError("return p.x[0];", "expected points or a vector before '[', found a float");
    expectError("return p[p];", "expected an index, a whole number, found a vec3");
    expectValue("return float(p.x > 0.0) * 3;", 3.0);
    expectValue("return bool(p.x) ? 1 : 2;", 1.0);
    expectValue("return p == p && \"a\" != \"b\" ? 1 : 2;", 1.0);
    expectValue("vec2 a = 2; return a.x + a.y;", 4.0);
}

TEST(Language, SeveralMistakesAreToldAtOnce) {
    const language::Resolved resolved =
        language::resolve("a = lenght(p);\nb = p + vec2(1);\nc = 3 +;\nd = 1 == p;\nreturn a + q;", {});
    std::vector<int> lines;
    for (const Error& error : resolved.errors) lines.push_back(error.codeLine);
    EXPECT_EQ(lines, (std::vector{2, 3, 4}));  // what is unknown may be what could not be read
    EXPECT_FALSE(resolved.code);
    const language::Resolved read = language::resolve("a = lenght(p);\nb = p + vec2(1);\nreturn a + q;", {});
    lines.clear();
    for (const Error& error : read.errors) lines.push_back(error.codeLine);
    EXPECT_EQ(lines, (std::vector{1, 2, 3}));
}

TEST(Language, ALoopIsLeftByThosePlacesAlone) {
    // The step runs for those who stay.
    for (const double x : {0.1, 0.6, 1.3, 2.5})
        expectValue("float t = 0; for (t = 0; t < 2; t += .25) if (length(p) < t) break; return t - 1;",
                    std::min(std::floor(x / 0.25) * 0.25 + 0.25, 2.0) - 1.0, {x, 0, 0});
    // A loop in a loop, left by each in its own iteration.
    const Outcome outcome = run(R"(
        float n = 0;
        for (int i = 0; i < 4; i++) {
            float t = 0;
            for (int j = 0; j < 5; j++) {
                if (p.y < float(j)) break;
                if (p.z > float(j)) continue;
                t += 1;
                if (t > 2.) { n += 10; break; }
            }
            if (p.x < float(i)) break;
            n += t;
        }
        return n;)");
    ASSERT_EQ(outcome.error, "");
    for (double x = -0.5; x < 5; x += 0.9)
        for (double y = -0.5; y < 6; y += 0.7)
            for (double z = -0.5; z < 6; z += 0.8) {
                double n = 0;
                for (int i = 0; i < 4; i++) {
                    double t = 0;
                    for (int j = 0; j < 5; j++) {
                        if (y < j) break;
                        if (z > j) continue;
                        t += 1;
                        if (t > 2.) {
                            n += 10;
                            break;
                        }
                    }
                    if (x < i) break;
                    n += t;
                }
                EXPECT_EQ(outcome.at(x, y, z), n) << x << ' ' << y << ' ' << z;
            }
}

TEST(Language, AnIfMergesWhatItsSidesAssign) {
    expectValue("k = \"a\"; d = length(p); if (p.x > 0.) d -= 1.; return d;", std::sqrt(0.5) - 1.0);
    expectValue("if (p.x > 0.) 1.; else 2.;", 1.0);
    expectValue("if (p.x > 0.) 1.; else 2.;", 2.0, {-1, 0, 0});
    expectValue("d = 1; if (p.x > 9.) d = 2;", 1.0);
    expectValue("d = 1; for (int i = 0; i < 3; i++) d += 1;", 4.0);
    expectError("if (p.x > 0.) 1.;", "does not");
    expectError("a = 1; b = 2; if (p.x > 0.) a = 3; else b = 4;", "one name on every path");
    expectError("k = \"a\"; if (p.x > 0.) k = \"b\"; return k == \"a\" ? 1 : 2;", "can only be chosen");
    expectValue("k = \"b\"; if (p.x > 0.) k = \"b\"; return k == \"a\" ? 1 : 2;", 2.0);
    expectValue("a = 1; if (p.x > 0.) { a = 2; if (p.y > 0.) a = 3; } else a = 4; return a;", 2.0);
}

TEST(Language, ANameIsASurfacesWhereverItComesToBeOne) {
    const std::string red = "s = with_material(sphere(p, 1.0), vec3(1, 0, 0), 0.1, 1.0, vec3(0)); ";
    expectValue(
        red + "d = 5; e = d; for (int i = 0; i < 2; i++) { e = d; d = min(d, s); } return e.base_color.y;",
        0.0);
    expectValue(red + "float d = s; d = min(d, s); return d.metallic;", 1.0);
    expectError("d = 5; return d.base_color.y;", "a float has no '.base_color'");
}

TEST(Language, DeepAndLongCodeNeedsNoStack) {
    std::string sum = "float f(float x) { return f0(x)";
    for (int i = 0; i < 1000; ++i) sum += " + 1";
    sum += "; } float f0(float x) { return x; } return f(1);";
    expectValue(sum, 1001.0);
    std::string chain = "return p.x";
    for (int i = 0; i < 49'000; ++i) chain += "+p.x";
    const auto stackless = [&](const std::string& code) {
#ifdef __SANITIZE_ADDRESS__
        constexpr std::size_t kStack = 8 << 20;  // its frames are many times as large
#else
        constexpr std::size_t kStack = 512 << 10;
#endif
        pthread_attr_t attributes;
        pthread_attr_init(&attributes);
        pthread_attr_setstacksize(&attributes, kStack);
        pthread_t thread;
        std::string copy = code;
        pthread_create(
            &thread, &attributes,
            [](void* text) -> void* {
                run(*static_cast<std::string*>(text));
                return nullptr;
            },
            &copy);
        pthread_join(thread, nullptr);
        pthread_attr_destroy(&attributes);
    };
    stackless(chain + ";");
    std::string deep, braces, unary = "return ", calls = "return ", ifs, choices = "return ";
    for (int i = 0; i < 250; ++i) {
        braces += "{", unary += "-", calls += "abs(", deep += "(", ifs += "if (p.x > 0.) ";
        choices += "p.x > 0. ? ";
    }
    stackless(braces + "a = 1;" + std::string(250, '}') + "return 1;");
    stackless(unary + "p.x;");
    stackless(calls + "p.x" + std::string(250, ')') + ";");
    stackless("return " + deep + "p.x" + std::string(250, ')') + ";");
    stackless(ifs + "return 1; return 2;");
    stackless(choices);
    std::string nested = "float f0(float x){return x+1;}";
    for (int i = 1; i < 60; ++i) {
        nested += "float f" + std::to_string(i) + "(float x){return f" + std::to_string(i - 1) + "(x)";
        for (int k = 0; k < 900; ++k) nested += "+1";
        nested += ";}";
    }
    stackless(nested + "return f59(1);");
    stackless("float f(float x){return f(x)+1" + chain.substr(10, 4000) + ";} return f(1);");
}

TEST(Language, RangesHoldForArguments) {
    expectError("return prism(p, 0);", "argument 2 of 'prism' is its sides: the value 0 is out of range");
    expectError("return scale(sphere(p), 0);", "out of range");
    expectError("return union(sphere(p), sphere(p), 0.2, \"round-ish\");", "is not one of its choices");
}

TEST(Language, AKnownChoiceIsAsWideAsItsOtherSide) {
    expectValue("c = true ? 0 : p; return c.y;", 0.0);
    expectValue("return (true ? 5 : p).y;", 5.0);
    expectValue("return length(true ? 1 : p);", std::sqrt(3.0));
    expectValue("return (true ? 5 : p) == vec3(5, 1, 1) ? 1 : 2;", 2.0);
    expectValue("c = false ? p : 5; return c[2];", 5.0);
    expectValue("return image_grey(\"\", true ? 0 : p.xy) * 0;", 0.0);
}

TEST(Language, LoneExpressionsAreNumbersOfAnyKind) {
    expectValue("if (p.x > 0.) 1; else 0.5;", 0.5, {-1, 0, 0});
    expectValue("1; 0.5", 0.5);
    expectValue("p; p.x", 0.3);
    expectError("for (int i = 0; i < 3; i++) { if (p.x > 0.) break; 5.; }", "before it gives a result");
}

TEST(Language, AFieldElsewhereIsASurfaceIfItsNameComesToBeOne) {
    const std::string red = "s = with_material(sphere(p, 1.0), vec3(1, 0, 0), 0.1, 1.0, vec3(0)); ";
    expectValue(red + "d = 1; e = 2; if (p.x > 0.) d = s; e = d(p + 1.); return e.metallic;", 1.0);
}

TEST(Language, OddAssignmentsAreRefused) {
    expectError("int i = 0; i.x = 1.5; return i;", "an int has no '.x'");
    expectError("vec3 q = p; q.xx = vec2(1, 2); return q;", "names a component twice");
    expectError("const x = 1; return x;", "expected a type behind 'const'");
    expectError("true = 1; return 1;", "is a word of the language");
    expectError("if (p.x > 0.) { d = 2.; } else { d = 1.; }", "lives in a block that has ended");
    std::string chain = "if (p.x > 0.) return 1;";
    for (int i = 0; i < 300; ++i) chain += " else if (p.x > 0.) return 1;";
    EXPECT_EQ(language::resolve(chain, {}).errors.size(), 1u);
}

TEST(Language, WorkIsBoundedByWhatItCosts) {
    std::string names, declarations = "float f(float x){ return x; ";
    for (int i = 0; i < 20'000; ++i) {
        names += "a" + std::to_string(i) + "=1;zz" + std::to_string(i) + ";";
        declarations += "float a" + std::to_string(i) + ";";
    }
    expectError(names, "unknown name");
    expectError(declarations + "} d = 0; for (int i = 0; i < 500000; i++) d += f(1); return d;", "steps");
    expectError(
        "k = \"" + std::string(1 << 20, 'x') + "\"; for (int i = 0; i < 500000; i++) k == k; return 1.;",
        "steps");
}

}  // namespace fw::language_test
