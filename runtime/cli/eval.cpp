// `fieldwright eval`: the field at one point or over one box, and at as many as a file or a pipe has.
//
// Lines are read a few megabytes at a time, parted into blocks that all processors take, and answered in
// order: what is held does not grow with the input, and a pipe gets the answers to what it has sent.
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "graph/base/parallel.h"
#include "graph/base/result.h"
#include "graph/evaluate/evaluate.h"
#include "runtime/bake/mesh_field_baker.h"
#include "runtime/cli/commands.h"

namespace fw::cli {

namespace {

constexpr std::size_t kChunk = 4 << 20, kBlock = 128 << 10;  // bytes of input
constexpr const char* kBoxOrder = "write its least corner, then its greatest: x0 y0 z0 x1 y1 z1";

/// What the lines hold, and what is asked of them.
enum class Asked { values, gradients, bounds };

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// Reads, from `at` on, exactly `count` finite numbers parted by blanks, or by one comma each; says what is
/// wrong, or nothing. `nothing` tells of a line that is empty but for a comment.
std::string readLine(const char*& at, const char* end, double* numbers, std::size_t count, bool& nothing) {
    if (const void* comment = std::memchr(at, '#', std::size_t(end - at)))
        end = static_cast<const char*>(comment);
    const auto skip = [&] {
        while (at < end && isBlank(*at)) ++at;
    };
    skip();
    if (nothing = at == end; nothing) return {};
    const auto wanted = [&] { return "expected " + std::to_string(count) + " numbers"; };
    for (std::size_t i = 0; i < count; ++i) {
        if (i > 0) {
            const char* const before = at;
            skip();
            if (at < end && *at == ',') ++at, skip();
            if (at == end) return wanted() + ", found " + std::to_string(i);
            if (at == before) return "expected a blank or a comma before " + inQuotes({at, end});
        }
        const char* const from = at;
        if (*at == '+' && at + 1 < end && at[1] != '-') ++at;
        const auto [next, fault] = std::from_chars(at, end, numbers[i]);
        if (fault == std::errc::result_out_of_range)  // zero, if it is too near to that; or infinite
            numbers[i] = std::strtod(std::string(at, next).c_str(), nullptr);
        if (fault == std::errc::invalid_argument || !std::isfinite(numbers[i])) {
            const char* word = at = from;
            while (word < end && !isBlank(*word) && *word != ',') ++word;
            return word == from ? "expected a number before " + inQuotes({from, end})
                                : inQuotes({from, word}) + " is not a finite number";
        }
        at = next;
    }
    skip();
    if (at < end) return wanted() + " and no more: there is " + inQuotes({at, end}) + " behind them";
    return {};
}

/// Appends numbers as short as they are read back the same, with blanks between.
template <class... Numbers>
void appendLine(std::string& text, Numbers... numbers) {
    char line[32 * sizeof...(numbers)];
    char* at = line;
    const auto add = [&](double number) {
        // Neither a zero nor what is no number has a sign.
        at = std::isnan(number) ? std::copy_n("nan", 3, at)
                                : std::to_chars(at, std::end(line), number + 0.0).ptr;
        *at++ = ' ';
    };
    (add(numbers), ...);
    at[-1] = '\n';
    text.append(line, at);
}

/// One block's lines and their answers.
struct Block {
    std::string_view text;
    std::string answers = {}, fault = {};
    std::size_t lines = 0;  // up to the fault and with it, if there is one
    int column = 0;         // of the fault
};

/// Answers a block: the points of several lines at once.
void answer(const Tape& tape, Asked asked, Block& block) {
    TapeMachine<double> machine;
    const std::size_t batch = asked == Asked::gradients ? machine.kGradientPoints : machine.kPoints;
    std::size_t waiting = 0;
    const auto flush = [&] {
        if (waiting == 0) return;
        if (asked == Asked::gradients) {
            const auto [values, g] = machine.gradient(tape, waiting);
            for (std::size_t i = 0; i < waiting; ++i)
                appendLine(block.answers, values[i], g[0][i], g[1][i], g[2][i]);
        } else {
            const double* values = machine.value(tape, waiting);
            for (std::size_t i = 0; i < waiting; ++i) appendLine(block.answers, values[i]);
        }
        waiting = 0;
    };
    const char *at = block.text.data(), *const end = at + block.text.size();
    while (at < end && block.fault.empty()) {
        const void* const found = std::memchr(at, '\n', std::size_t(end - at));
        const char* const stop = found ? static_cast<const char*>(found) : end;
        double numbers[6];
        bool nothing = false;
        const char* place = at;
        block.fault = readLine(place, stop, numbers, asked == Asked::bounds ? 6 : 3, nothing);
        block.column = int(std::min<std::ptrdiff_t>(place - at, 1 << 20)) + 1;
        at = stop + 1;
        ++block.lines;
        if (nothing || !block.fault.empty()) continue;
        if (asked != Asked::bounds) {
            for (int axis = 0; axis < 3; ++axis) machine.position(axis)[waiting] = numbers[axis];
            if (++waiting == batch) flush();
            continue;
        }
        for (int axis = 0; axis < 3 && block.fault.empty(); ++axis)
            if (numbers[axis] > numbers[axis + 3])
                block.column = 1,
                block.fault = std::string("the first corner lies beyond the second along ") + "xyz"[axis] +
                              ": " + kBoxOrder;
        if (!block.fault.empty()) continue;
        const Interval range = machine.interval(
            tape, {{numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}});
        appendLine(block.answers, range.lo, range.hi);
    }
    flush();
}

/// Lines of a file or of standard input, some megabytes at a time.
class Lines {
  public:
    explicit Lines(const std::string& path)
        : own(path != "-"), file(own ? open(path.c_str(), O_RDONLY | O_CLOEXEC) : STDIN_FILENO) {}
    Lines(const Lines&) = delete;
    ~Lines() {
        if (own && file >= 0) close(file);
    }
    bool opened() const { return file >= 0; }

    /// Whole lines, as many as there are without waiting, at least one; empty at the end. They hold until the
    /// next call.
    std::string_view next() {
        std::copy(buffer.begin() + std::ptrdiff_t(given), buffer.begin() + std::ptrdiff_t(filled),
                  buffer.begin());
        filled -= given;
        std::size_t whole = 0;
        while (!ended && (whole == 0 || (filled < kChunk && more()))) {
            const ssize_t got = read(file, buffer.data() + filled, buffer.size() - filled);
            if (got < 0 && errno == EINTR) continue;
            if (got < 0) fault = errno;
            ended = got <= 0;
            if (ended) break;
            const std::size_t newline =
                std::string_view(buffer.data() + filled, std::size_t(got)).rfind('\n');
            if (newline != std::string::npos) whole = filled + newline + 1;
            filled += std::size_t(got);
            if (whole == 0 && filled >= kChunk) return tooLong = true, std::string_view();
        }
        given = ended || whole == 0 ? filled : whole;
        return {buffer.data(), given};
    }

    int fault = 0;         ///< errno, where reading failed
    bool tooLong = false;  ///< the next line is longer than kChunk

  private:
    bool more() const {
        pollfd waiting{file, POLLIN, 0};
        return poll(&waiting, 1, 0) > 0;
    }

    bool own;
    int file;
    std::vector<char> buffer = std::vector<char>(kChunk);
    std::size_t filled = 0, given = 0;  // bytes of it
    bool ended = false;
};

/// Answers every line of the file, in order, up to the first that is wrong.
int evalLines(const Program& program, const std::string& path, Asked asked) {
    const Tape tape = makeTape(program.ir, program.distance(), program.parameters());
    const std::string name = path == "-" ? "standard input" : path;
    const auto refuse = [&](const std::string& message, std::size_t line = 0, int column = 0) {
        print(Error{.message = message, .file = name, .line = int(line), .column = column});
        return kBadInput;
    };
    Lines lines(path);
    if (!lines.opened()) return refuse(std::string("cannot be read: ") + std::strerror(errno));
    std::size_t line = 0;
    for (std::string_view text; !(text = lines.next()).empty();) {
        std::vector<Block> blocks;
        while (!text.empty()) {
            const std::size_t end = text.find('\n', std::min(kBlock, text.size()) - 1);
            const std::size_t size = end == std::string_view::npos ? text.size() : end + 1;
            blocks.push_back({text.substr(0, size)});
            text.remove_prefix(size);
        }
        forBlocks(blocks.size(), 1,
                  [&](std::size_t i, std::size_t, std::size_t) { answer(tape, asked, blocks[i]); });
        for (const Block& block : blocks) {
            std::fwrite(block.answers.data(), 1, block.answers.size(), stdout);
            line += block.lines;
            if (!block.fault.empty()) return refuse(block.fault, line, block.column);
        }
        if (std::fflush(stdout) != 0) return kDone;  // which is told behind every command
    }
    if (lines.tooLong)
        return refuse(
            "a line is longer than " + std::to_string(kChunk >> 20) + " MiB: give a point or box a line",
            line + 1, 1);
    if (lines.fault) return refuse(std::string("cannot be read: ") + std::strerror(lines.fault));
    return kDone;
}

/// What is wrong with what is asked, or nothing.
std::string usageFault(const EvalOptions& options) {
    if (options.at.empty() && options.interval.empty() && options.points.empty() && options.boxes.empty())
        return "give a point (--at x y z) or a box (--interval x0 y0 z0 x1 y1 z1), or many of them (--points "
               "FILE, "
               "--boxes FILE)";
    const std::vector<double>& b = options.interval;
    for (std::size_t axis = 0; axis < b.size() / 2; ++axis)
        if (b[axis] > b[axis + 3])
            return std::string("--interval has its first corner beyond its second along ") + "xyz"[axis] +
                   ": " + kBoxOrder;
    return {};
}

}  // namespace

int runEval(const EvalOptions& options) {
    if (const std::string fault = usageFault(options); !fault.empty()) {
        std::fprintf(stderr, "fieldwright eval: %s\n", fault.c_str());
        return kBadUsage;
    }
    const std::optional<Graph> graph = openGraph(options.graph);
    if (!graph) return kBadInput;
    OpeningDevice device(std::launch::deferred, {});
    CompileOptions compileOptions;
    compileOptions.bake = meshFieldBaker([&] { return device.orNone(); });
    const std::optional<Program> program =
        openProgram(*graph, options.graph.time, std::move(compileOptions), [&] { return device.orNone(); });
    if (!program) return kBadInput;
    if (!options.points.empty())
        return evalLines(*program, options.points, options.gradient ? Asked::gradients : Asked::values);
    if (!options.boxes.empty()) return evalLines(*program, options.boxes, Asked::bounds);
    if (!options.at.empty()) {
        const Point point{options.at[0], options.at[1], options.at[2]};
        ValueGradient result;
        evaluateGradient(program->ir, program->distance(), program->parameters(), std::span(&point, 1),
                         std::span(&result, 1));
        std::printf("%.17g\n", result.value);
        if (options.gradient)
            std::printf("%.17g %.17g %.17g\n", result.gradient[0] + 0.0, result.gradient[1] + 0.0,
                        result.gradient[2] + 0.0);
    }
    if (const std::vector<double>& b = options.interval; !b.empty()) {
        const Box box{{b[0], b[1], b[2]}, {b[3], b[4], b[5]}};
        const Interval range = evaluateInterval(program->ir, program->distance(), program->parameters(), box);
        std::printf("%.17g %.17g\n", range.lo, range.hi);
    }
    return kDone;
}

}  // namespace fw::cli
