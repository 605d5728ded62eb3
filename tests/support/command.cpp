#include "tests/support/command.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <thread>

#include "tests/support/graph/temp_dir.h"

namespace fw::test {

namespace {

std::vector<char*> pointers(std::vector<std::string>& words) {
    std::vector<char*> list;
    for (std::string& word : words) list.push_back(word.data());
    list.push_back(nullptr);
    return list;
}

/// This process's own memory now: a child starts with as much, and its peak counts it.
double residentMegabytes() {
    long total = 0, resident = 0;
    FILE* file = std::fopen("/proc/self/statm", "r");
    if (!file || std::fscanf(file, "%ld %ld", &total, &resident) != 2) resident = 0;
    if (file) std::fclose(file);
    return static_cast<double>(resident * sysconf(_SC_PAGESIZE)) / 1e6;
}

/// All that is written to the terminal until nobody holds it; `seen` is called once `text` was read.
std::string readTerminal(int terminal, const std::string& text, const std::function<void()>& seen) {
    std::string all;
    char piece[4096];
    bool found = false;
    for (ssize_t got; (got = read(terminal, piece, sizeof piece)) > 0 || (got < 0 && errno == EINTR);) {
        all.append(piece, std::size_t(std::max<ssize_t>(got, 0)));
        if (!found && all.find(text) != std::string::npos) found = true, seen();
    }
    return all;
}

double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

CommandResult runCommand(const std::vector<std::string>& arguments, const CommandOptions& options) {
    static const TempDir caches;
    const TempDir streams;
    const std::string output = streams.path("output"), errors = streams.path("errors");

    std::vector<std::string> words = options.wrapper;
    words.push_back(FIELDWRIGHT_BINARY_DIR "/fieldwright");
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<std::string> environment = {"XDG_CACHE_HOME=" + caches.folder.string()};
    for (char** entry = environ; *entry; ++entry)
        if (!std::string(*entry).starts_with("XDG_CACHE_HOME=")) environment.emplace_back(*entry);
    for (const std::string& entry : options.environment) {
        const std::string name = entry.substr(0, entry.find('=') + 1);
        std::erase_if(environment, [&](const std::string& known) { return known.starts_with(name); });
        environment.push_back(entry);
    }
    const std::vector<char*> argv = pointers(words), envp = pointers(environment);

    for (const std::string& stream : {output, errors}) writeText(stream, "");
    int terminal = -1, screen = -1;
    if (!options.interruptAt.empty() && openpty(&terminal, &screen, nullptr, nullptr, nullptr) != 0)
        return {};
    const double own = residentMegabytes();
    const pid_t child = fork();
    if (child == 0) {
        const int in = open("/dev/null", O_RDONLY);
        const int out = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        const int err = screen >= 0 ? screen : open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        if (dup2(in, 0) < 0 || dup2(out, 1) < 0 || dup2(err, 2) < 0) _exit(125);
        if (options.maxFileBytes >= 0) {
            const rlimit limit{static_cast<rlim_t>(options.maxFileBytes),
                               static_cast<rlim_t>(options.maxFileBytes)};
            setrlimit(RLIMIT_FSIZE, &limit);
        }
        ::signal(SIGINT, SIG_DFL);  // which a shell has its background ignore
        execvpe(argv[0], argv.data(), envp.data());
        _exit(126);
    }
    CommandResult result;
    if (child < 0) return result;
    if (options.interruptAfterMs >= 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(options.interruptAfterMs));
        kill(child, options.signal);
    }
    if (options.meanwhile) options.meanwhile(), kill(child, options.signal);
    if (terminal >= 0) {
        close(screen);
        writeText(errors, readTerminal(terminal, options.interruptAt, [&] { kill(child, options.signal); }));
        close(terminal);
    }
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    result.killed = WIFSIGNALED(status);
    result.status = result.killed ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    result.cpuSeconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    const double peak = static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6;
    result.peakMegabytes = peak > own * 1.05 ? peak : std::min(peak, 300.0);
    result.output = readText(output);
    result.errors = readText(errors);
    EXPECT_EQ(result.errors.find("validation layer:"), std::string::npos) << result.errors.substr(0, 2000);
    return result;
}

void expectRefusal(const CommandResult& result, int status, const std::vector<std::string>& parts,
                   double maxSeconds) {
    EXPECT_FALSE(result.killed) << "by signal " << result.status - 128;
    EXPECT_EQ(result.status, status) << result.errors;
    for (const std::string& part : parts)
        EXPECT_NE(result.errors.find(part), std::string::npos)
            << "standard error does not say \"" << part << "\" but:\n"
            << result.errors.substr(0, 2000);
    EXPECT_EQ(result.output, "");
    const auto lines = std::count(result.errors.begin(), result.errors.end(), '\n');
    EXPECT_GE(lines, 1);
    EXPECT_LE(lines, 5) << result.errors.substr(0, 2000);
    EXPECT_LT(result.cpuSeconds, maxSeconds);
    EXPECT_LT(result.peakMegabytes, kMostMegabytes);
}

}  // namespace fw::test
