#include "runtime/jobs/task_script.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "runtime/system/output_file.h"

namespace fw {

namespace {

// A task that is ended (143) is handed out again by whoever ended it, and has not failed.
constexpr char kRunTask[] = R"(*) echo "$0: there is no task '$1 $2'" >&2; exit 2 ;;
esac
"$fieldwright" "$@" 2>"$log"
status=$?
cat "$log" >&2
if [ $status -ne 0 ]; then
    echo "$what: exit status $status" >&2
    [ $status -eq 143 ] || { echo "$what: exit status $status"; cat "$log"; } >>failed
fi
exit $status
)";

}  // namespace

const char kSubmitBegin[] = R"(set -eu
case $0 in */*) cd -- "${0%/*}" ;; esac
mkdir -p log
rm -f failed
)";

std::string shellWord(std::string_view word) {
    const bool plain = !word.empty() && std::ranges::all_of(word, [](unsigned char letter) {
        return (letter < 0x80 && std::isalnum(letter)) ||
               std::string_view("-_./=,:+@%").find(char(letter)) != std::string_view::npos;
    });
    if (plain) return std::string(word);
    std::string text = "'";
    for (const char letter : word) text += letter == '\'' ? "'\\''" : std::string(1, letter);
    return text + "'";
}

Done writeScript(const std::string& path, std::string_view text) {
    Result<OutputFile> file = OutputFile::open(path, nullptr);
    if (!file) return file.error();
    file->write(text);
    if (Done written = file->commit(); !written) return written;
    using std::filesystem::perms;
    std::error_code failure;
    std::filesystem::permissions(path, perms::owner_exec | perms::group_exec | perms::others_exec,
                                 std::filesystem::perm_options::add, failure);
    if (failure)
        return Error{.message = "cannot make it a file that can be run: " + failure.message(), .file = path};
    return done();
}

Done writeTaskScript(const Job& job, const std::string& folder) {
    std::string text =
        "#!/bin/sh\n"
        "# Runs a task of this job: ./task STEP NUMBER\n"
        "case $0 in */*) cd -- \"${0%/*}\" || exit ;; esac\n"
        "fieldwright=" +
        shellWord(job.program) +
        "\n"
        "log=log/$1.$2\n"
        "case \"$1 $2\" in\n";
    for (const JobStep& step : job.steps)
        for (std::size_t i = 0; i < step.tasks.size(); ++i) {
            text += "'" + step.name + " " + std::to_string(i) + "') what=" + shellWord(step.tasks[i].name) +
                    "; set --";
            for (const std::string& word : step.tasks[i].words) text += " " + shellWord(word);
            text += " ;;\n";
        }
    return writeScript(folder + "/task", text + kRunTask);
}

}  // namespace fw
