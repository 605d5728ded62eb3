#include "runtime/cli/options/pages.h"

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace fw::cli {

namespace {

/// An option as all pages tell of it.
struct Described {
    std::vector<std::string> names;  ///< "-o", "--output"; of a positional "GRAPH"
    std::string takes;               ///< what follows it, as a word; empty of a flag
    std::vector<std::string> words;  ///< what that may be, if it is one of a few
    std::string standard;            ///< what it is if it isn't given; empty if nothing is said
    std::string text;
    bool positional = false, required = false, repeats = false;
};

/// A program, or one of its commands.
struct Page {
    const CLI::App* app;
    std::string name;  ///< of a command; empty for the program itself
    std::vector<Described> options;
};

std::vector<std::string> split(const std::string& text, char at) { return CLI::detail::split(text, at); }

Described described(const CLI::Option& option) {
    Described said{.names = {}, .takes = {}, .words = {}, .standard = {}, .text = option.get_description()};
    said.positional = option.get_positional();
    said.required = option.get_required();
    for (const std::string& name : option.get_snames()) said.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) said.names.push_back("--" + name);
    if (said.positional) said.names = {option.get_name(true, false)};
    if (option.get_items_expected_max() == 0) return said;
    // "TEXT:{a,b}", "INT:1 to 9", "LENGTH": a type, and what a validator says that is narrower.
    const std::string type = option.get_type_name();
    said.takes = type.substr(type.find(':') == std::string::npos ? 0 : type.find(':') + 1);
    if (const std::size_t open = type.find('{'); open != std::string::npos) {
        said.words = split(type.substr(open + 1, type.find('}') - open - 1), ',');
        said.takes = CLI::detail::join(said.words, "|");
    }
    if (said.takes.empty() || said.takes == "TEXT") said.takes = said.positional ? said.names[0] : "WORD";
    said.repeats = option.get_items_expected_max() > 1;
    said.standard = option.get_default_str();
    return said;
}

std::vector<Page> pagesOf(const CLI::App& program) {
    std::vector<Page> pages{{&program, "", {}}};
    for (const CLI::App* command : program.get_subcommands({}))
        pages.push_back({command, command->get_name(), {}});
    for (Page& page : pages)
        for (const CLI::Option* option : page.app->get_options()) page.options.push_back(described(*option));
    return pages;
}

/// The first clause that says enough, and no more than fits beside a name.
std::string brief(const std::string& text) {
    constexpr std::size_t kLeast = 24, kMost = 90;
    std::size_t end = text.size();
    for (const char* mark : {": ", "; ", ", ", " (", ". "}) end = std::min(end, text.find(mark, kLeast));
    std::string clause = text.substr(0, end);
    if (clause.size() > kMost) clause = clause.substr(0, clause.rfind(' ', kMost)) + " ...";
    if (clause.ends_with('.') && !clause.ends_with("...")) clause.pop_back();
    return clause;
}

std::string replaced(std::string text, std::string_view each, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(each, at)) != std::string::npos; at += by.size())
        text.replace(at, each.size(), by);
    return text;
}

// Manual pages: man(7), of groff.

std::string roff(const std::string& text) {
    std::string safe = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
    safe = replaced(replaced(safe, "\n.", "\n\\&."), "\n'", "\n\\&'");
    if (safe.starts_with('.') || safe.starts_with('\'')) safe = "\\&" + safe;
    return safe;
}

void optionsInRoff(const Page& page, std::string& out) {
    for (const Described& option : page.options) {
        out += ".TP\n";
        for (std::size_t i = 0; i < option.names.size(); ++i)
            out += (i ? ", \\fB" : "\\fB") + roff(option.names[i]) + "\\fR";
        if (!option.takes.empty() && !option.positional) out += " \\fI" + roff(option.takes) + "\\fR";
        if (option.repeats) out += " ...";
        out += "\n" + roff(option.text);
        if (!option.standard.empty()) out += " (default: " + roff(option.standard) + ")";
        if (option.required && !option.positional) out += " (must be given)";
        out += "\n";
    }
}

/// A footer's lines as they stand.
std::string asItStands(const std::string& text) { return ".nf\n" + roff(text) + "\n.fi\n"; }

std::string manual(const CLI::App& program) {
    const std::vector<Page> pages = pagesOf(program);
    const std::string name = program.get_name();
    std::string capitals = name, what = program.get_description();
    for (char& letter : capitals) letter = char(std::toupper(static_cast<unsigned char>(letter)));
    if (const std::size_t colon = what.find(": "); colon != std::string::npos) what = what.substr(colon + 2);
    if (what.ends_with('.')) what.pop_back();
    std::string out = ".TH \"" + roff(capitals) + "\" 1 \"\" \"Fieldwright\" \"User Commands\"\n.SH NAME\n" +
                      roff(name) + " \\- " + roff(what) + "\n.SH SYNOPSIS\n";
    for (const Page& page : pages) {
        if (page.name.empty() && pages.size() > 1) continue;
        out += ".B " + roff(name + (page.name.empty() ? "" : " " + page.name)) + "\n[\\fIOPTIONS\\fR]";
        for (const Described& option : page.options)
            if (option.positional)
                out += (option.required ? " \\fI" : " [\\fI") + roff(option.names[0]) + "\\fR" +
                       (option.repeats ? " ..." : "") + (option.required ? "" : "]");
        out += "\n.br\n";
    }
    out += ".SH OPTIONS\n";
    optionsInRoff(pages[0], out);
    if (pages.size() > 1) out += ".SH COMMANDS\n";
    for (std::size_t i = 1; i < pages.size(); ++i) {
        const CLI::App& command = *pages[i].app;
        out += ".SS " + roff(name + " " + pages[i].name) + "\n" + roff(command.get_description()) + ".\n";
        optionsInRoff(pages[i], out);
        if (!command.get_footer().empty() && command.get_footer() != program.get_footer())
            out += ".PP\n" + asItStands(command.get_footer());
    }
    if (!program.get_footer().empty()) out += ".SH NOTES\n" + asItStands(program.get_footer());
    return out;
}

// Completions. A graph is offered by its ending; what an option takes by its words, else as a file.

constexpr std::string_view kGraphs = "*.field.json";

/// The words of a shell in single quotes.
std::string quotedWord(const std::string& text) { return "'" + replaced(text, "'", "'\\''") + "'"; }

bool takesGraph(const Page& page) {
    for (const Described& option : page.options)
        if (option.positional && option.names[0] == "GRAPH") return true;
    return false;
}

std::string bashCompletion(const CLI::App& program) {
    const std::vector<Page> pages = pagesOf(program);
    const std::string function = "_" + replaced(program.get_name(), "-", "_");
    std::string cases, commands;
    for (const Page& page : pages) {
        if (!page.name.empty()) commands += (commands.empty() ? "" : " ") + page.name;
        std::string options, ofWords, ofOthers;
        for (const Described& option : page.options) {
            if (option.positional) continue;
            for (const std::string& name : option.names) options += (options.empty() ? "" : " ") + name;
            const std::string names = CLI::detail::join(option.names, "|");
            if (!option.words.empty())
                ofWords += "                " + names + ") words='" + CLI::detail::join(option.words, " ") +
                           "' ;;\n";
            else if (!option.takes.empty())
                ofOthers += (ofOthers.empty() ? "" : "|") + names;
        }
        cases += "        '" + page.name + "')\n            options='" + options + "'\n" +
                 (takesGraph(page) ? "            graphs=yes\n" : "");
        if (!ofWords.empty() || !ofOthers.empty())
            cases += "            case $before in\n" + ofWords +
                     (ofOthers.empty() ? "" : "                " + ofOthers + ") return ;;\n") +
                     "            esac ;;\n";
        else
            cases += "            ;;\n";
    }
    return "# Completions of " + program.get_name() + " for bash: " + program.get_name() +
           " --completion bash\n" + function + R"(() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command='' options='' words='' graphs='' i
)" + (commands.empty() ? "" : R"(    for ((i = 1; i < COMP_CWORD; ++i)); do
        case ${COMP_WORDS[i]} in -*) ;; *) command=${COMP_WORDS[i]}; break ;; esac
    done
)") + "    COMPREPLY=()\n    case $command in\n" +
           cases + R"(        *) return ;;
    esac
    if [[ -n $words ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
    elif [[ $word == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
)" +
           (commands.empty()
                ? ""
                : "    elif [[ -z $command ]]; then\n        mapfile -t COMPREPLY < <(compgen -W '" +
                      commands + "' -- \"$word\")\n") +
           R"(    elif [[ -n $graphs ]]; then
        compopt -o filenames
        mapfile -t COMPREPLY < <(compgen -f -X '!)" +
           std::string(kGraphs) + R"(' -- "$word"; compgen -d -- "$word")
    fi
}
complete -o default -F )" +
           function + " " + program.get_name() + "\n";
}

/// What `_arguments` takes of the options.
std::string zshArguments(const Page& page, const std::string& indent) {
    std::string out;
    for (const Described& option : page.options) {
        const std::string action = !option.words.empty() ? "(" + CLI::detail::join(option.words, " ") + ")"
                                   : option.names[0] == "GRAPH" ? "_files -g \"" + std::string(kGraphs) + "\""
                                                                : "_files";
        const std::string takes = replaced(option.words.empty() ? option.takes : "word", ":", "\\:");
        if (option.positional) {
            out += " \\\n" + indent + quotedWord("*:" + takes + ":" + action);
            continue;
        }
        std::string text = replaced(replaced(brief(option.text), "[", "\\["), "]", "\\]");
        for (const std::string& name : option.names)
            out += " \\\n" + indent +
                   quotedWord("*" + name + "[" + text + "]" +
                              (option.takes.empty() ? "" : ":" + takes + ":" + action));
    }
    return out;
}

std::string zshCompletion(const CLI::App& program) {
    const std::vector<Page> pages = pagesOf(program);
    const std::string function = "_" + replaced(program.get_name(), "-", "_");
    std::string out = "#compdef " + program.get_name() + "\n# Completions of " + program.get_name() +
                      " for zsh: " + program.get_name() + " --completion zsh\n" + function + "() {\n";
    if (pages.size() == 1) {
        out += "    _arguments" + zshArguments(pages[0], "        ") + "\n";
    } else {
        out += "    local -a commands=(";
        for (std::size_t i = 1; i < pages.size(); ++i)
            out += "\n        " + quotedWord(pages[i].name + ":" + brief(pages[i].app->get_description()));
        out +=
            "\n    )\n    if (( CURRENT == 2 )); then\n        _describe command commands\n        "
            "_arguments" +
            zshArguments(pages[0], "            ") +
            "\n        return\n    fi\n    shift words\n    (( CURRENT-- ))\n    case $words[1] in\n";
        for (std::size_t i = 1; i < pages.size(); ++i)
            out += "        " + pages[i].name + ")\n            _arguments" +
                   zshArguments(pages[i], "                ") + " ;;\n";
        out += "    esac\n";
    }
    return out + "}\n" + function + " \"$@\"\n";
}

std::string fishCompletion(const CLI::App& program) {
    const std::string name = program.get_name();
    std::string out = "# Completions of " + name + " for fish: " + name + " --completion fish\n";
    const std::vector<Page> pages = pagesOf(program);
    for (const Page& page : pages) {
        std::string when;
        if (!page.name.empty()) {
            out += "complete -c " + name + " -n __fish_use_subcommand -x -a " + page.name + " -d " +
                   quotedWord(brief(page.app->get_description())) + "\n";
            when = " -n '__fish_seen_subcommand_from " + page.name + "'";
        } else if (pages.size() > 1) {
            when = " -n __fish_use_subcommand";
        }
        for (const Described& option : page.options) {
            if (option.positional) {
                if (option.names[0] == "GRAPH")
                    out +=
                        "complete -c " + name + when + " -k -x -a '(__fish_complete_suffix .field.json)'\n";
                continue;
            }
            out += "complete -c " + name + when;
            for (const std::string& each : option.names)
                out += each.starts_with("--") ? " -l " + each.substr(2) : " -s " + each.substr(1);
            if (!option.words.empty())
                out += " -x -a " + quotedWord(CLI::detail::join(option.words, " "));
            else if (!option.takes.empty())
                out += " -r";
            out += " -d " + quotedWord(brief(option.text)) + "\n";
        }
    }
    return out;
}

[[noreturn]] void endWith(const std::string& page) {
    std::fwrite(page.data(), 1, page.size(), stdout);
    throw CLI::Success();
}

}  // namespace

void addPages(CLI::App& program) {
    program.add_flag_callback(
        "--manual", [&program] { endWith(manual(program)); }, "Print the manual page, for man");
    program
        .add_option_function<std::string>(
            "--completion",
            [&program](const std::string& shell) {
                endWith(shell == "bash"  ? bashCompletion(program)
                        : shell == "zsh" ? zshCompletion(program)
                                         : fishCompletion(program));
            },
            "Print completions for a shell")
        ->type_name("SHELL")
        ->check(CLI::IsMember({"bash", "zsh", "fish"}));
}

}  // namespace fw::cli
