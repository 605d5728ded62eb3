#include "editor/shell/desktop_theme.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "graph/base/words.h"

namespace fw::editor {

namespace {

/// The value of the key in the section of an INI file; nothing if there is none.
std::optional<std::string> valueOf(std::string_view text, std::string_view section, std::string_view key) {
    const auto trimmed = [](std::string_view words) {
        const auto first = words.find_first_not_of(" \t\r");
        if (first == std::string_view::npos) return std::string_view();
        return words.substr(first, words.find_last_not_of(" \t\r") - first + 1);
    };
    bool inside = false;
    while (!text.empty()) {
        const std::string_view line = trimmed(text.substr(0, text.find('\n')));
        text =
            text.find('\n') == std::string_view::npos ? std::string_view() : text.substr(text.find('\n') + 1);
        if (line.starts_with('[')) inside = line == "[" + std::string(section) + "]";
        const auto equals = line.find('=');
        if (inside && equals != std::string_view::npos && trimmed(line.substr(0, equals)) == key)
            return std::string(trimmed(line.substr(equals + 1)));
    }
    return std::nullopt;
}

std::string configuration(const char* file) {
    const char* folder = std::getenv("XDG_CONFIG_HOME");
    const char* home = std::getenv("HOME");
    if (!(folder && *folder) && !home) return {};
    const std::string path =
        (folder && *folder ? std::string(folder) : std::string(home) + "/.config") + "/" + file;
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

ThemeChoice themeChoice(std::string_view name) {
    for (std::size_t i = 0; i < std::size(kThemeNames); ++i)
        if (name == kThemeNames[i]) return ThemeChoice(i);
    return ThemeChoice::dark;
}

Theme themeOf(ThemeChoice choice) {
    return choice == ThemeChoice::system  ? desktopTheme()
           : choice == ThemeChoice::light ? Theme::light
                                          : Theme::dark;
}

std::optional<Theme> themeOfGtkName(std::string_view name) {
    if (name.empty()) return std::nullopt;
    const std::string low = lowered(std::string(name));
    return low.ends_with(":dark") || low.ends_with("-dark") ? Theme::dark : Theme::light;
}

std::optional<Theme> themeOfGtkSettings(std::string_view text) {
    if (const auto dark = valueOf(text, "Settings", "gtk-application-prefer-dark-theme"))
        if (*dark == "1" || *dark == "true") return Theme::dark;
    if (const auto name = valueOf(text, "Settings", "gtk-theme-name")) return themeOfGtkName(*name);
    return std::nullopt;
}

std::optional<Theme> themeOfKdeGlobals(std::string_view text) {
    const auto color = valueOf(text, "Colors:Window", "BackgroundNormal");
    int red = 0, green = 0, blue = 0;
    if (!color || std::sscanf(color->c_str(), "%d,%d,%d", &red, &green, &blue) != 3) return std::nullopt;
    return 2 * red + 5 * green + blue > 8 * 128 ? Theme::light : Theme::dark;
}

Theme desktopTheme() {
    const char* name = std::getenv("GTK_THEME");
    if (const auto found = themeOfGtkName(name ? name : "")) return *found;
    for (const char* file : {"gtk-4.0/settings.ini", "gtk-3.0/settings.ini"})
        if (const auto found = themeOfGtkSettings(configuration(file))) return *found;
    return themeOfKdeGlobals(configuration("kdeglobals")).value_or(Theme::dark);
}

}  // namespace fw::editor
