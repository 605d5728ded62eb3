#include "graph/scene.h"

#include <algorithm>
#include <cmath>

#include "graph/placed_json.h"

namespace fw {

namespace {

/// Every function returns false after it has stored the one error.
struct SceneReader {
    Scene scene;
    Error error;

    bool fail(const PlacedJson& where, std::string message) {
        error = {.message = std::move(message), .line = where.at().line, .column = where.at().column};
        return false;
    }

    bool point(const PlacedJson& value, const std::string& name, std::array<double, 3>& to) {
        const Json& json = value.value();
        const bool fits = json.is_array() && json.size() == 3 &&
                          std::all_of(json.begin(), json.end(), [](const Json& number) {
                              return number.is_number() && std::isfinite(number.get<double>());
                          });
        if (!fits) return fail(value, "the scene's " + name + " must be three finite numbers [x, y, z]");
        for (std::size_t i = 0; i < 3; ++i) to[i] = json[i].get<double>();
        return true;
    }

    bool camera(const PlacedJson& value) {
        if (!value.value().is_object())
            return fail(value,
                        "the scene's camera must be an object such as {\"position\": [4, 3, 5], "
                        "\"target\": [0, 0, 0], \"fov\": 30}");
        Camera& to = scene.camera.emplace();
        const bool sound = value.forMembers([&](const std::string& key, const PlacedJson& member) {
            if (key == "position") return point(member, "camera.position", to.position);
            if (key == "target") return point(member, "camera.target", to.target);
            if (key != "fov") return true;
            const Json& json = member.value();
            to.fov = json.is_number() ? json.get<double>() : 0.0;
            return (to.fov >= kLeastFov && to.fov <= kMostFov) ||
                   fail(member, "the scene's camera.fov must be a number of degrees from 1 to 170");
        });
        if (sound && to.position == to.target)
            return fail(value, "the scene's camera stands on its target: move one of them");
        return sound;
    }
};

}  // namespace

Result<Scene> readScene(const Json& json, const TextPlaces& places) {
    SceneReader reader;
    if (json.is_null()) return reader.scene;
    const PlacedJson root(json, places);
    if (!json.is_object()) {
        reader.fail(root, "\"scene\" must be an object");
        return std::move(reader.error);
    }
    const bool sound = root.forMembers([&](const std::string& key, const PlacedJson& value) {
        return key != "camera" || reader.camera(value);
    });
    if (!sound) return std::move(reader.error);
    return std::move(reader.scene);
}

}  // namespace fw
