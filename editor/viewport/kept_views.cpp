#include "editor/viewport/kept_views.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "editor/editor.h"
#include "editor/viewport/projection.h"

namespace fw::editor {

namespace {

/// As recent files are named; empty: the document has no file of its own.
std::string fileOf(const Editor& editor) {
    const std::string& path = editor.document.graph().path;
    if (path.empty() || editor.files.origin == Files::Origin::sample) return {};
    std::error_code error;
    const std::filesystem::path full = std::filesystem::absolute(path, error);
    return error ? path : full.lexically_normal().string();
}

void keepThem(Editor& editor) {
    const KeptViews& kept = editor.viewport.kept;
    if (kept.path.empty()) return;
    Preferences& preferences = editor.files.preferences;
    Json all = Json::object();
    if (preferences.views->is_object())
        for (const auto& [path, views] : preferences.views->items())
            if (path != kept.path && std::ranges::count(preferences.recent, path) > 0) all[path] = views;
    if (!kept.views.empty()) all[kept.path] = jsonOf(kept.views);
    preferences.views = std::move(all);
    keepPreferences(editor);
}

void goTo(Editor& editor, std::size_t number) {
    Viewport& view = editor.viewport;
    const KeptView& to = view.kept.views[number - 1];
    view.ownCamera = true;
    view.awaits.reset();
    view.orbit = to.orbit;
    view.orthographic = to.orthographic;
    view.kept.last = number;
}

std::string nameOfView(const std::vector<KeptView>& views, std::size_t i) {
    return std::to_string(i + 1) + "  " + wordsOf(views[i].orbit, views[i].orthographic);
}

}  // namespace

Json jsonOf(const std::vector<KeptView>& views) {
    Json all = Json::array();
    for (const KeptView& view : views)
        all.push_back({{"target", view.orbit.target},
                       {"azimuth", view.orbit.azimuth},
                       {"elevation", view.orbit.elevation},
                       {"distance", view.orbit.distance},
                       {"fov", view.orbit.fov},
                       {"orthographic", view.orthographic}});
    return all;
}

std::vector<KeptView> keptViewsIn(const Json& json) {
    std::vector<KeptView> views;
    if (!json.is_array()) return views;
    for (const Json& each : json) {
        if (!each.is_object() || views.size() == kMostKeptViews) continue;
        KeptView view;
        const auto number = [&](const Json& from, double& to) {
            if (from.is_number()) to = from.get<double>();
            return from.is_number() && std::isfinite(to);
        };
        const auto named = [&](const char* key, double& to) {
            const auto found = each.find(key);
            return found != each.end() && number(*found, to);
        };
        const auto target = each.find("target");
        bool whole = target != each.end() && target->is_array() && target->size() == 3;
        for (std::size_t i = 0; whole && i < 3; ++i) whole = number((*target)[i], view.orbit.target[i]);
        whole = whole && named("azimuth", view.orbit.azimuth) && named("elevation", view.orbit.elevation) &&
                named("distance", view.orbit.distance) && named("fov", view.orbit.fov) &&
                view.orbit.distance > 0.0 && view.orbit.fov >= kLeastFov && view.orbit.fov <= kMostFov;
        if (!whole) continue;
        const auto orthographic = each.find("orthographic");
        view.orthographic = orthographic != each.end() && *orthographic == true;
        views.push_back(view);
    }
    return views;
}

void followKeptViews(Editor& editor) {
    KeptViews& kept = editor.viewport.kept;
    const std::string path = fileOf(editor);
    const bool other = !kept.known;
    if (!other && path == kept.path) return;
    // Saved under a name: what was kept goes along.
    if (!other && !kept.views.empty()) {
        kept.path = path;
        return keepThem(editor);
    }
    kept = {.views = {}, .last = 0, .known = true, .path = path};
    const KeptJson& all = editor.files.preferences.views;
    if (path.empty() || !all->is_object()) return;
    if (const auto found = all->find(path); found != all->end()) kept.views = keptViewsIn(*found);
}

void keepView(Editor& editor) {
    Viewport& view = editor.viewport;
    if (view.kept.views.size() == kMostKeptViews)
        return say(editor, "there are 32 kept views: forget one first");
    view.takeCamera();
    view.kept.views.push_back({view.orbit, view.orthographic});
    view.kept.last = view.kept.views.size();
    keepThem(editor);
    say(editor, "kept as view " + std::to_string(view.kept.last));
}

void goToNextView(Editor& editor) {
    const KeptViews& kept = editor.viewport.kept;
    if (!kept.views.empty()) goTo(editor, kept.last % kept.views.size() + 1);
}

void showKeptViews(Editor& editor) {
    KeptViews& kept = editor.viewport.kept;
    if (!ImGui::BeginMenu("Kept views", !kept.views.empty())) return;
    for (std::size_t i = 0; i < kept.views.size(); ++i)
        if (ImGui::MenuItem(nameOfView(kept.views, i).c_str())) goTo(editor, i + 1);
    ImGui::Separator();
    if (ImGui::BeginMenu("Forget")) {
        for (std::size_t i = 0; i < kept.views.size(); ++i)
            if (ImGui::MenuItem(nameOfView(kept.views, i).c_str())) {
                kept.views.erase(kept.views.begin() + std::ptrdiff_t(i));
                kept.last = std::min(kept.last, kept.views.size());
                keepThem(editor);
            }
        ImGui::EndMenu();
    }
    ImGui::EndMenu();
}

}  // namespace fw::editor
