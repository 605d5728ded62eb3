#include "graph/document/scene.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "graph/base/file_kind.h"
#include "graph/document/placed_json.h"

namespace fw {

namespace {

std::string numberText(double number) {
    std::string text = std::to_string(number);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
}

std::string range(double least, double most) {
    return "from " + numberText(least) + " to " + numberText(most);
}

/// False if this is no number in the range.
bool readNumber(const Json& json, double& to, double least, double most) {
    if (!json.is_number()) return false;
    to = json.get<double>();
    return to >= least && to <= most;
}

/// Whether the way from one to the other has a direction in single precision.
bool apart(const Triple& a, const Triple& b) {
    float square = 0.0f;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const float step = float(b[i]) - float(a[i]);
        square += step * step;
    }
    return square >= std::numeric_limits<float>::min();
}

/// Every function returns false after it has stored the one error. `name` is a value's dotted path.
struct SceneReader {
    Error error;

    bool fail(const PlacedJson& where, std::string message) {
        error = {.message = std::move(message), .line = where.at().line, .column = where.at().column};
        return false;
    }

    bool number(const PlacedJson& value, const std::string& name, double& to,
                double least = -kMostSceneNumber, double most = kMostSceneNumber) {
        if (readNumber(value.value(), to, least, most)) return true;
        return fail(value, "the scene's " + name + " must be a number " + range(least, most));
    }

    bool triple(const PlacedJson& value, const std::string& name, Triple& to,
                double least = -kMostSceneNumber) {
        const Json& json = value.value();
        bool fits = json.is_array() && json.size() == to.size();
        for (std::size_t i = 0; i < to.size() && fits; ++i)
            fits = readNumber(json[i], to[i], least, kMostSceneNumber);
        return fits || fail(value, "the scene's " + name + " must be three numbers " +
                                       range(least, kMostSceneNumber) +
                                       (least == 0.0 ? ": [red, green, blue]" : ": [x, y, z]"));
    }
    bool color(const PlacedJson& value, const std::string& name, Triple& to) {
        return triple(value, name, to, 0.0);
    }

    bool path(const PlacedJson& value, const std::string& name, std::string& to) {
        if (!value.value().is_string() || value.value().get<std::string>().empty())
            return fail(value, "the scene's " + name + " must be the path of " + anyOf(kEnvironmentFile));
        to = value.value().get<std::string>();
        return true;
    }

    /// Reads an object's members by `member`(key, value), or, where `to` may be switched off, `false`.
    template <class T, class Member>
    bool object(const PlacedJson& value, const std::string& name, std::optional<T>& to, bool mayBeOff,
                const char* example, Member member) {
        if (mayBeOff && value.value().is_boolean()) {
            to = value.value().get<bool>() ? std::optional<T>(T{}) : std::nullopt;
            return true;
        }
        if (!value.value().is_object())
            return fail(value, "the scene's " + name + " must be an object such as " + example +
                                   (mayBeOff ? ", or false" : ""));
        to.emplace();
        return value.forMembers(
            [&](const std::string& key, const PlacedJson& entry) { return member(*to, key, entry); });
    }

    bool camera(const PlacedJson& value, Scene& scene) {
        const char* example = R"({"position": [4, 3, 5], "target": [0, 0, 0], "fov": 30})";
        const auto member = [&](Camera& to, const std::string& key, const PlacedJson& entry) {
            if (key == "position") return triple(entry, "camera.position", to.position);
            if (key == "target") return triple(entry, "camera.target", to.target);
            if (key == "aperture") return number(entry, "camera.aperture", to.aperture, 0.0);
            if (key == "focus") return number(entry, "camera.focus", to.focus, 0.0);
            if (key == "shutter") return number(entry, "camera.shutter", to.shutter, 0.0, kMostShutter);
            if (key != "fov") return true;
            const Json& json = entry.value();
            to.fov = json.is_number() ? json.get<double>() : 0.0;
            return (to.fov >= kLeastFov && to.fov <= kMostFov) ||
                   fail(entry, "the scene's camera.fov must be a number of degrees from 1 to 170");
        };
        if (!object(value, "camera", scene.camera, false, example, member)) return false;
        return apart(scene.camera->position, scene.camera->target) ||
               fail(value, "the scene's camera stands on its target: move one of them");
    }

    bool sun(const PlacedJson& value, Scene& scene) {
        return object(value, "sun", scene.sun, true, R"({"azimuth": 30, "elevation": 45})",
                      [&](Sun& to, const std::string& key, const PlacedJson& entry) {
                          if (key == "azimuth") return number(entry, "sun.azimuth", to.azimuth);
                          if (key == "elevation")
                              return number(entry, "sun.elevation", to.elevation, -kMostElevation,
                                            kMostElevation);
                          if (key == "color") return color(entry, "sun.color", to.color);
                          if (key == "strength") return number(entry, "sun.strength", to.strength, 0.0);
                          if (key == "traced") return flag(entry, "sun.traced", to.traced);
                          return key != "size" || number(entry, "sun.size", to.size, 0.0, kMostSunSize);
                      });
    }

    bool sky(const PlacedJson& value, Scene& scene) {
        return object(value, "sky", scene.sky, true,
                      R"({"zenith": [0.2, 0.4, 0.9], "horizon": [0.8, 0.9, 1]})",
                      [&](Sky& to, const std::string& key, const PlacedJson& entry) {
                          if (key == "zenith") return color(entry, "sky.zenith", to.zenith);
                          if (key == "horizon") return color(entry, "sky.horizon", to.horizon);
                          if (key == "ground") return color(entry, "sky.ground", to.ground);
                          if (key == "image") return path(entry, "sky.image", to.image);
                          if (key == "rotation") return number(entry, "sky.rotation", to.rotation);
                          return key != "strength" || number(entry, "sky.strength", to.strength, 0.0);
                      });
    }

    bool ambient(const PlacedJson& value, Scene& scene) {
        return object(value, "ao", scene.ao, true, R"({"radius": 0.5, "strength": 1})",
                      [&](AmbientOcclusion& to, const std::string& key, const PlacedJson& entry) {
                          if (key == "radius") return number(entry, "ao.radius", to.radius, 0.0);
                          return key != "strength" || number(entry, "ao.strength", to.strength, 0.0, 1.0);
                      });
    }

    bool ground(const PlacedJson& value, Scene& scene) {
        return object(value, "ground", scene.ground, true, R"({"height": 0})",
                      [&](Ground& to, const std::string& key, const PlacedJson& entry) {
                          return key != "height" || number(entry, "ground.height", to.height.emplace());
                      });
    }

    bool fog(const PlacedJson& value, Scene& scene) {
        return object(value, "fog", scene.fog, true, R"({"density": 0.05, "height": 2})",
                      [&](Fog& to, const std::string& key, const PlacedJson& entry) {
                          if (key == "density") return number(entry, "fog.density", to.density, 0.0);
                          if (key == "height") return number(entry, "fog.height", to.height, 0.0);
                          return key != "color" || color(entry, "fog.color", to.color);
                      });
    }

    bool bloom(const PlacedJson& value, Scene& scene) {
        return object(value, "bloom", scene.bloom, true, R"({"strength": 0.15, "radius": 0.1})",
                      [&](Bloom& to, const std::string& key, const PlacedJson& entry) {
                          if (key == "radius") return number(entry, "bloom.radius", to.radius, 0.0, 1.0);
                          return key != "strength" || number(entry, "bloom.strength", to.strength, 0.0, 1.0);
                      });
    }

    bool lamp(const PlacedJson& value, const std::string& name, Lamp& to) {
        const auto type = [&](const PlacedJson& entry) {
            const Json& json = entry.value();
            if (json == "point") return to.type = Lamp::Type::point, true;
            if (json == "spot") return to.type = Lamp::Type::spot, true;
            if (json == "directional") return to.type = Lamp::Type::directional, true;
            return fail(entry, "the scene's " + name + R"(.type must be "point", "spot" or "directional")");
        };
        std::optional<Lamp> read;
        const bool sound =
            object(value, name, read, false,
                   R"({"type": "point", "position": [0, 3, 0], "color": [1, 1, 1], "strength": 10})",
                   [&](Lamp&, const std::string& key, const PlacedJson& entry) {
                       const std::string at = name + "." + key;
                       if (key == "type") return type(entry);
                       if (key == "position") return triple(entry, at, to.position);
                       if (key == "target") return triple(entry, at, to.target);
                       if (key == "color") return color(entry, at, to.color);
                       if (key == "strength") return number(entry, at, to.strength, 0.0);
                       if (key == "angle")
                           return number(entry, at, to.angle, kLeastLampAngle, kMostLampAngle);
                       if (key == "blend") return number(entry, at, to.blend, 0.0, 1.0);
                       return key != "size" || number(entry, at, to.size, 0.0);
                   });
        if (!sound) return false;
        return to.type == Lamp::Type::point || apart(to.position, to.target) ||
               fail(value, "the scene's " + name + " stands on its target: move one of them");
    }

    bool tone(const PlacedJson& value, Scene& scene) {
        for (std::size_t i = 0; i < kToneNames.size(); ++i)
            if (value.value() == kToneNames[i]) return scene.tone = Tone(i), true;
        return fail(value, R"(the scene's tone must be "aces" or "neutral")");
    }

    bool flag(const PlacedJson& value, const std::string& key, bool& to) {
        if (!value.value().is_boolean()) return fail(value, "the scene's " + key + " must be true or false");
        to = value.value().get<bool>();
        return true;
    }

    bool lights(const PlacedJson& value, Scene& scene) {
        if (!value.value().is_array() || value.value().size() > kMostLights)
            return fail(value, "the scene's lights must be a list of at most " + std::to_string(kMostLights) +
                                   " objects");
        return value.forEntries([&](const PlacedJson& entry) {
            const std::string name = "lights." + std::to_string(scene.lights.size());
            return lamp(entry, name, scene.lights.emplace_back());
        });
    }
};

}  // namespace

Result<Scene> readScene(const Json& json, const TextPlaces& places) {
    Scene scene;
    SceneReader reader;
    if (json.is_null()) return scene;
    const PlacedJson root(json, places);
    if (!json.is_object()) {
        reader.fail(root, "\"scene\" must be an object");
        return std::move(reader.error);
    }
    const bool sound = root.forMembers([&](const std::string& key, const PlacedJson& value) {
        if (key == "camera") return reader.camera(value, scene);
        if (key == "sun") return reader.sun(value, scene);
        if (key == "sky") return reader.sky(value, scene);
        if (key == "ao") return reader.ambient(value, scene);
        if (key == "ground") return reader.ground(value, scene);
        if (key == "fog") return reader.fog(value, scene);
        if (key == "bloom") return reader.bloom(value, scene);
        if (key == "lights") return reader.lights(value, scene);
        if (key == "bounce") return reader.flag(value, key, scene.bounce);
        if (key == "reflections") return reader.flag(value, key, scene.reflections);
        if (key == "tone") return reader.tone(value, scene);
        return key != "exposure" ||
               reader.number(value, "exposure", scene.exposure, -kMostExposure, kMostExposure);
    });
    if (!sound) return std::move(reader.error);
    return scene;
}

TextPosition skyPlace(const Json& json, const TextPlaces& places) {
    TextPosition place;
    PlacedJson(json, places).forMembers([&](const std::string& key, const PlacedJson& value) {
        if (key == "sky") place = value.at();
        return key != "sky";
    });
    return place;
}

}  // namespace fw
