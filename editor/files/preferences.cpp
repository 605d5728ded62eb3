#include "editor/files/preferences.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "graph/library/node_type.h"
#include "runtime/system/output_file.h"
#include "runtime/system/user_folder.h"

namespace fw::editor {

namespace {

/// Takes the key out of the object if its value is as it should be; what is not stays and is complained of.
template <class Is, class Use>
void take(Json& all, const char* key, Is is, Use use, std::string& problem) {
    const auto found = all.find(key);
    if (found == all.end()) return;
    if (is(*found))
        use(*found);
    else if (problem.empty())
        problem = std::string("'") + key + "' is not what it should be";
    all.erase(found);
}

bool isScale(const Json& value) {
    return value.is_number() &&
           (value.get<double>() == 0.0 || (value.get<double>() >= 0.5 && value.get<double>() <= 4.0));
}

}  // namespace

std::string preferencesPath() {
    const std::string folder = userFolder("XDG_CONFIG_HOME", "/.config");
    return folder.empty() ? folder : folder + "/editor.json";
}

Preferences readPreferences(const std::string& path, std::string& problem) {
    Preferences preferences;
    problem.clear();
    std::ifstream file(path, std::ios::binary);
    if (path.empty() || !file) return preferences;
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    Json all = Json::parse(text, nullptr, false);
    if (!all.is_object()) {
        std::error_code error;
        std::filesystem::rename(path, path + ".broken", error);
        problem = path + " cannot be read: the editor starts with its defaults" +
                  (error ? "" : ", and the file is now " + path + ".broken");
        return preferences;
    }
    const auto takeTexts = [&](const char* key, std::vector<std::string>& texts, std::size_t most) {
        take(
            all, key, [](const Json& value) { return value.is_array(); },
            [&](const Json& value) {
                for (const Json& each : value)
                    if (each.is_string() && texts.size() < most) texts.push_back(each.get<std::string>());
            },
            problem);
    };
    takeTexts("recent", preferences.recent, kMostRecent);
    takeTexts("taken", preferences.taken, kMostTaken);
    takeTexts("favourites", preferences.favourites, nodeTypes().size());
    take(
        all, "scale", isScale, [&](const Json& value) { preferences.scale = value.get<float>(); }, problem);
    take(
        all, "library", [](const Json& value) { return value.is_string(); },
        [&](const Json& value) { preferences.library = value.get<std::string>(); }, problem);
    take(
        all, "navigation", [](const Json& value) { return value.is_string(); },
        [&](const Json& value) { preferences.navigation = value.get<std::string>(); }, problem);
    take(
        all, "scrolling", [](const Json& value) { return value.is_string(); },
        [&](const Json& value) { preferences.scrolling = value.get<std::string>(); }, problem);
    take(
        all, "views", [](const Json& value) { return value.is_object(); },
        [&](const Json& value) { preferences.views = value; }, problem);
    take(
        all, "theme", [](const Json& value) { return value.is_string(); },
        [&](const Json& value) { preferences.theme = value.get<std::string>(); }, problem);
    take(
        all, "shortcuts", [](const Json& value) { return value.is_object(); },
        [&](const Json& value) {
            for (const auto& [id, keys] : value.items())
                if (keys.is_string()) preferences.shortcuts[id] = keys.get<std::string>();
        },
        problem);
    take(
        all, "panels", [](const Json& value) { return value.is_object(); },
        [&](const Json& value) { preferences.panels = value; }, problem);
    if (!all.empty()) preferences.extra = std::move(all);
    if (!problem.empty()) problem = path + ": " + problem + ": its default is taken";
    return preferences;
}

Done savePreferences(const Preferences& preferences, const std::string& path) {
    if (path.empty()) return done();
    Json all = Json::object();
    all["recent"] = preferences.recent;
    if (!preferences.taken.empty()) all["taken"] = preferences.taken;
    if (!preferences.favourites.empty()) all["favourites"] = preferences.favourites;
    if (!preferences.library.empty()) all["library"] = preferences.library;
    if (!preferences.navigation.empty()) all["navigation"] = preferences.navigation;
    if (!preferences.scrolling.empty()) all["scrolling"] = preferences.scrolling;
    if (preferences.views->is_object() && !preferences.views->empty()) all["views"] = preferences.views;
    if (!preferences.theme.empty()) all["theme"] = preferences.theme;
    all["scale"] = preferences.scale;
    all["shortcuts"] = preferences.shortcuts;
    if (!preferences.panels->is_null()) all["panels"] = preferences.panels;
    if (preferences.extra->is_object())
        for (const auto& [key, value] : preferences.extra->items()) all[key] = value;
    std::error_code error;  // shows as the Error of the file
    std::filesystem::create_directories(std::filesystem::path(path).parent_path(), error);
    Result<OutputFile> file = OutputFile::open(path, nullptr);
    if (!file) return file.error();
    // Paths may hold bytes that are no UTF-8.
    file->write(all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    return file->commit();
}

void toFront(std::vector<std::string>& texts, const std::string& text, std::size_t most) {
    std::erase(texts, text);
    texts.insert(texts.begin(), text);
    if (texts.size() > most) texts.resize(most);
}

void addRecent(Preferences& preferences, const std::string& path) {
    std::error_code error;
    const std::filesystem::path full = std::filesystem::absolute(path, error);
    const std::string name = error ? path : full.lexically_normal().string();
    toFront(preferences.recent, name, kMostRecent);
}

}  // namespace fw::editor
