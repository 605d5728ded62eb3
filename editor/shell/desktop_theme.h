// Whether the desktop is dark or light, as far as it says so where every program can read it.
//
// Asked for when the theme is to be the system's: at the start, and when that is chosen. In this order: the
// variable GTK_THEME ("Adwaita:dark"), GTK's settings.ini, KDE's kdeglobals (by how light its windows are).
// What says nothing counts as dark.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "editor/shell/theme.h"

namespace fw::editor {

/// As preferences have them, and for a person.
enum class ThemeChoice : unsigned char { dark, light, system };
inline constexpr const char* kThemeNames[] = {"dark", "light", "system"};
inline constexpr const char* kThemeWords[] = {"Dark", "Light", "The system's"};
/// Of a name; dark if it is none of these.
ThemeChoice themeChoice(std::string_view name);
Theme themeOf(ThemeChoice choice);

/// Nothing where the text says nothing.
std::optional<Theme> themeOfGtkName(std::string_view name);      ///< of GTK_THEME
std::optional<Theme> themeOfGtkSettings(std::string_view text);  ///< settings.ini
std::optional<Theme> themeOfKdeGlobals(std::string_view text);   ///< kdeglobals
Theme desktopTheme();

}  // namespace fw::editor
