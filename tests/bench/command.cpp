#include "tests/bench/command.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "graph/base/own_files.h"
#include "graph/base/result.h"
#include "runtime/gpu/device.h"
#include "runtime/system/clock.h"

extern char** environ;

namespace fw::bench {

Outcome runCommand(std::vector<std::string> arguments, const std::string& cache) {
    arguments.insert(arguments.begin(), programFolder() / "fieldwright");
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);

    std::vector<std::string> variables = {"XDG_CACHE_HOME=" + cache, "MESA_SHADER_CACHE_DIR=" + cache};
    std::vector<char*> environment;
    for (std::string& variable : variables) environment.push_back(variable.data());
    for (char** inherited = environ; *inherited; inherited++) {
        const std::string_view name(*inherited);
        if (!name.starts_with("XDG_CACHE_HOME=") && !name.starts_with("MESA_SHADER_CACHE_DIR="))
            environment.push_back(*inherited);
    }
    environment.push_back(nullptr);

    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    const auto start = Clock::now();
    const int error = posix_spawn(&child, argv[0], &files, nullptr, argv.data(), environment.data());
    posix_spawn_file_actions_destroy(&files);
    if (error) throw SystemError("starting " + arguments[0] + " failed");
    int status = 0;
    struct rusage usage;
    if (wait4(child, &status, 0, &usage) != child) throw SystemError("waiting for a process failed");
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, millisecondsSince(start),
            uint64_t(usage.ru_maxrss) * 1024};
}

TemporaryFolder::TemporaryFolder() {
    std::string name = std::filesystem::temp_directory_path() / "fieldwright-bench-XXXXXX";
    if (!mkdtemp(name.data())) throw SystemError("making a temporary folder failed");
    path = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
}

}  // namespace fw::bench
