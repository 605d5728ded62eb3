// The document's unit and density, and its scene: camera, sun, sky, lamps, ambient occlusion, ground, fog,
// bloom, exposure and tone.
//
// What is shown is the scene as readScene() has it, defaults included; what is changed is one value of the
// JSON, so that everything else in it stays as it was written. A value that the scene would refuse is not
// taken: the hand's last good one stays.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "editor/document/scene_edits.h"
#include "editor/panels/properties.h"
#include "editor/panels/unit.h"
#include "editor/shell/letters.h"
#include "editor/shell/theme.h"
#include "editor/viewport/marks.h"
#include "graph/base/file_kind.h"

namespace fw::editor {

namespace {

constexpr NumberRange kPlaceRange{
    .min = -kMostSceneNumber, .max = kMostSceneNumber, .speed = 0.02, .unit = "m"};
constexpr NumberRange kLengthRange{.min = 0.0, .max = kMostSceneNumber, .speed = 0.02, .unit = "m"};
constexpr NumberRange kStrengthRange{.min = 0.0, .max = kMostSceneNumber, .speed = 0.02};

/// The document with the value, if its scene is one; as it is otherwise.
Graph sound(const Graph& graph, Graph next) { return readScene(next.scene) ? std::move(next) : graph; }

void set(Editor& editor, const std::string& name, Graph next) {
    const Graph& graph = editor.document.graph();
    editor.document.apply("Set " + name, sound(graph, std::move(next)));
}

Json jsonOf(std::span<const double> numbers) {
    Json json;
    setNumbers(json, {numbers.begin(), numbers.end()});
    return json;
}

/// A row for the numbers at a path, with the button for a key. `color` shows them as a colour too.
void numbersRow(Editor& editor, const std::string& path, const char* label, const char* tip,
                std::span<const double> now, const NumberRange& range, bool color = false) {
    std::vector<double> value(now.begin(), now.end());
    const Timeline* timeline = timelineOf(editor);
    const Moved moved{Track::Target::scene, "", path};
    const Track* track = nullptr;
    if (timeline)
        if (const auto index = trackOf(*timeline, moved)) track = &timeline->tracks[*index];
    const float side = ImGui::GetFrameHeight(), gap = ImGui::GetStyle().ItemSpacing.x;
    const float room = timeline ? 0.8f * side + gap : 0.0f;
    ImGui::PushID(path.c_str());
    propertyRow(label, tip, room);
    const auto with = [path](const Graph& graph, std::span<const double> numbers) {
        return sound(graph, setSceneValue(graph, path, jsonOf(numbers)));
    };
    if (track) {
        editAnimated(editor, "##animated", *track, range, label);
    } else {
        const std::string name = std::string("Set ") + label;
        if (color) {
            follow(editor, "##color", pickColor("##color", value), name,
                   [&] { return with(editor.document.graph(), value); });
            ImGui::SameLine();
            ImGui::SetNextItemWidth(-std::max(room, FLT_MIN));
        }
        editNumbers(editor, "##numbers", value, range, name, with);
    }
    if (timeline) {
        ImGui::SameLine();
        const bool here = track && keyAt(*track, editor.viewport.seconds);
        if (keyButton("##key", here, track != nullptr,
                      here ? "Remove the key at the time shown" : "Add a key at the time shown"))
            toggleKey(editor, *timeline, moved, value);
    }
    ImGui::PopID();
}

void number(Editor& editor, const std::string& path, const char* label, const char* tip, double now,
            const NumberRange& range) {
    numbersRow(editor, path, label, tip, std::span(&now, 1), range);
}
void place(Editor& editor, const std::string& path, const char* label, const char* tip, const Triple& now) {
    numbersRow(editor, path, label, tip, now, kPlaceRange);
}
void color(Editor& editor, const std::string& path, const char* label, const Triple& now) {
    numbersRow(editor, path, label, "Linear: red, green, blue; 1 is as bright as white.", now, kStrengthRange,
               true);
}

/// A row for what is on or off.
void flag(Editor& editor, const char* path, const char* label, const char* doc, bool on) {
    propertyRow(label, doc);
    ImGui::PushID(path);
    if (ImGui::Checkbox("##on", &on)) set(editor, label, setSceneValue(editor.document.graph(), path, on));
    ImGui::PopID();
}

/// The head of a part of the scene, with a switch where it can be off. Whether its rows are to follow.
bool part(Editor& editor, const char* path, const char* label, std::optional<bool> on) {
    ImGui::PushID(path);
    bool is = on.value_or(true);
    if (on) {
        if (ImGui::Checkbox("##on", &is)) {
            ImGui::SetNextItemOpen(is);
            set(editor, label, switchScene(editor.document.graph(), path, is));
        }
        ImGui::SameLine();
    }
    const bool open = ImGui::CollapsingHeader(label, is ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    ImGui::PopID();
    return open && is;
}

void showCamera(Editor& editor, const Scene& scene) {
    if (!part(editor, "camera", "Camera", std::nullopt)) return;
    Viewport& viewport = editor.viewport;
    Document& document = editor.document;
    if (ImGui::Button("From the viewport")) keepAsSceneCamera(editor);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Make what the viewport shows the scene's camera");
    besideIfFits("Look through it");
    ImGui::BeginDisabled(!viewport.ownCamera);
    if (ImGui::Button("Look through it")) viewport.ownCamera = false;
    ImGui::EndDisabled();
    besideIfFits("Remove");
    ImGui::BeginDisabled(!scene.camera);
    if (ImGui::Button("Remove")) set(editor, "Camera", setSceneCamera(document.graph(), std::nullopt));
    ImGui::EndDisabled();
    if (!scene.camera)
        return ImGui::TextDisabled("No camera: the whole solid is framed from three quarters.");
    if (!beginProperties("camera")) return;
    place(editor, "camera.position", "Position", "Where the camera stands.", scene.camera->position);
    place(editor, "camera.target", "Target", "What is in the middle of the picture.", scene.camera->target);
    number(editor, "camera.fov", "Field of view", "From the bottom of the picture to its top.",
           scene.camera->fov, {.min = kLeastFov, .max = kMostFov, .speed = 0.2, .unit = "degrees"});
    number(editor, "camera.aperture", "Aperture",
           "Across the lens: what is out of focus is blurred; 0: nothing.", scene.camera->aperture,
           {.min = 0.0, .max = kMostSceneNumber, .speed = 0.002, .unit = "m"});
    number(editor, "camera.focus", "Focus", "How far what is sharp is; 0: as far as the target.",
           scene.camera->focus, kLengthRange);
    number(editor, "camera.shutter", "Shutter",
           "Of a frame's 360° those that it is open for: stills are blurred where they move.",
           scene.camera->shutter, {.min = 0.0, .max = kMostShutter, .speed = 1.0, .unit = "degrees"});
    endProperties();
}

void showSun(Editor& editor, const Scene& scene) {
    if (!part(editor, "sun", "Sun", scene.sun.has_value()) || !scene.sun || !beginProperties("sun")) return;
    number(editor, "sun.azimuth", "Azimuth", "From +z towards +x.", scene.sun->azimuth,
           {.min = -kMostSceneNumber, .max = kMostSceneNumber, .speed = 0.5, .unit = "degrees"});
    number(editor, "sun.elevation", "Elevation", "Above the horizon.", scene.sun->elevation,
           {.min = -kMostElevation, .max = kMostElevation, .speed = 0.25, .unit = "degrees"});
    color(editor, "sun.color", "Colour", scene.sun->color);
    number(editor, "sun.strength", "Strength", "Irradiance of a surface that faces it.", scene.sun->strength,
           kStrengthRange);
    number(editor, "sun.size", "Size", "Across: the larger, the softer its shadows.", scene.sun->size,
           {.min = 0.0, .max = kMostSunSize, .speed = 0.05, .unit = "degrees"});
    flag(editor, "sun.traced", "Traced", "Shadows through the field: sharp near and far.", scene.sun->traced);
    endProperties();
}

void showSky(Editor& editor, const Scene& scene) {
    if (!part(editor, "sky", "Sky", scene.sky.has_value()) || !scene.sky || !beginProperties("sky")) return;
    color(editor, "sky.zenith", "Zenith", scene.sky->zenith);
    color(editor, "sky.horizon", "Horizon", scene.sky->horizon);
    color(editor, "sky.ground", "Ground", scene.sky->ground);
    number(editor, "sky.strength", "Strength", "A factor on all of it.", scene.sky->strength, kStrengthRange);
    propertyRow("Picture", "An environment map, in the folder of the graph's file or in one below it.");
    editFile(
        editor, "##image", scene.sky->image, kEnvironmentFile, 0.0f, [](Editor& in, const std::string& text) {
            const Graph& graph = in.document.graph();
            set(in, "Sky's Picture",
                text.empty() ? clearSceneValue(graph, "sky.image") : setSceneValue(graph, "sky.image", text));
        });
    if (scene.sky->isPicture())
        number(editor, "sky.rotation", "Rotation", "How far the map is turned, from +z towards +x.",
               scene.sky->rotation,
               {.min = -kMostSceneNumber, .max = kMostSceneNumber, .speed = 0.5, .unit = "degrees"});
    endProperties();
}

void showAmbient(Editor& editor, const Scene& scene) {
    if (!part(editor, "ao", "Ambient occlusion", scene.ao.has_value()) || !scene.ao || !beginProperties("ao"))
        return;
    number(editor, "ao.radius", "Radius", "How far its rays see; 0: as suits the solid's size.",
           scene.ao->radius, kLengthRange);
    number(editor, "ao.strength", "Strength", "0 to 1.", scene.ao->strength,
           {.min = 0.0, .max = 1.0, .speed = 0.005});
    endProperties();
}

void showGround(Editor& editor, const Scene& scene) {
    if (!part(editor, "ground", "Ground", scene.ground.has_value()) || !scene.ground) return;
    bool foot = !scene.ground->height;
    if (ImGui::Checkbox("At the solid's foot", &foot)) {
        const Graph& graph = editor.document.graph();
        set(editor, "Ground",
            foot ? clearSceneValue(graph, "ground.height") : setSceneValue(graph, "ground.height", 0.0));
        return;
    }
    if (foot || !beginProperties("ground")) return;
    number(editor, "ground.height", "Height", "Of the ground.", *scene.ground->height, kPlaceRange);
    endProperties();
}

void showFog(Editor& editor, const Scene& scene) {
    if (!part(editor, "fog", "Fog", scene.fog.has_value()) || !scene.fog || !beginProperties("fog")) return;
    number(editor, "fog.density", "Density", "At the height of the ground.", scene.fog->density,
           {.min = 0.0, .max = kMostSceneNumber, .speed = 0.001, .unit = "1/m"});
    number(editor, "fog.height", "Height", "In which it thins to 1 / e; 0: it does not.", scene.fog->height,
           kLengthRange);
    color(editor, "fog.color", "Colour", scene.fog->color);
    endProperties();
}

void showBloom(Editor& editor, const Scene& scene) {
    if (!part(editor, "bloom", "Bloom", scene.bloom.has_value()) || !scene.bloom || !beginProperties("bloom"))
        return;
    number(editor, "bloom.strength", "Strength", "Share of all light that spills.", scene.bloom->strength,
           {.min = 0.0, .max = 1.0, .speed = 0.005});
    number(editor, "bloom.radius", "Radius", "How far, in heights of the picture.", scene.bloom->radius,
           {.min = 0.0, .max = 1.0, .speed = 0.002});
    endProperties();
}

void showLamp(Editor& editor, const Lamp& lamp, std::size_t index) {
    const std::string path = "lights." + std::to_string(index) + ".";
    if (!beginProperties("lamp")) return;
    propertyRow("Type");
    auto chosen = std::size_t(lamp.type);
    if (chooseName("##type", lampTypes(), chosen))
        set(editor, "Lamp's Type",
            setSceneValue(editor.document.graph(), path + "type", lampTypes()[chosen]));
    const bool directional = lamp.type == Lamp::Type::directional;
    place(editor, path + "position", "Position",
          directional ? "It shines along the way from here to the target." : "Where it stands.",
          lamp.position);
    if (lamp.type != Lamp::Type::point)
        place(editor, path + "target", "Target", "What it points at.", lamp.target);
    color(editor, path + "color", "Colour", lamp.color);
    number(editor, path + "strength", "Strength",
           directional ? "Irradiance of a surface that faces it." : "Radiant intensity.", lamp.strength,
           {.min = 0.0, .max = kMostSceneNumber, .speed = 0.1});
    if (lamp.type == Lamp::Type::spot) {
        number(editor, path + "angle", "Angle", "Across the cone.", lamp.angle,
               {.min = kLeastLampAngle, .max = kMostLampAngle, .speed = 0.2, .unit = "degrees"});
        number(editor, path + "blend", "Blend", "Share of the cone over which its edge fades.", lamp.blend,
               {.min = 0.0, .max = 1.0, .speed = 0.005});
    }
    number(editor, path + "size", "Size", "Across: the larger, the softer its shadows.", lamp.size,
           {.min = 0.0, .max = kMostSceneNumber, .speed = 0.005, .unit = "m"});
    endProperties();
}

void showLamps(Editor& editor, const Scene& scene) {
    if (!part(editor, "lights", "Lamps", std::nullopt)) return;
    std::optional<std::size_t> removed;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const Lamp& lamp = scene.lights[i];
        ImGui::PushID(int(i));
        const std::string title =
            "Lamp " + std::to_string(i + 1) + " (" + lampTypes()[std::size_t(lamp.type)] + ")###lamp";
        const bool open = ImGui::TreeNodeEx(
            title.c_str(), ImGuiTreeNodeFlags_DefaultOpen | ImGuiTreeNodeFlags_AllowItemOverlap);
        ImGui::SameLine(ImGui::GetContentRegionMax().x - 1.5f * ImGui::GetFrameHeight());
        if (ImGui::SmallButton("×")) removed = i;
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("Remove the lamp");
        if (open) {
            showLamp(editor, lamp, i);
            ImGui::TreePop();
        }
        ImGui::PopID();
    }
    if (removed) return set(editor, "Lamps", removeLamp(editor.document.graph(), *removed));
    ImGui::BeginDisabled(scene.lights.size() >= kMostLights);
    if (ImGui::Button("Add a lamp")) ImGui::OpenPopup("lamps");
    ImGui::EndDisabled();
    if (!ImGui::BeginPopup("lamps")) return;
    for (std::size_t i = 0; i < lampTypes().size(); ++i)
        if (ImGui::MenuItem(readable(lampTypes()[i]).c_str())) {
            Lamp lamp;
            lamp.type = Lamp::Type(i);
            if (lamp.type != Lamp::Type::point) lamp.position = {2.0, 4.0, 2.0};
            if (lamp.type == Lamp::Type::directional) lamp.strength = 1.0;
            editor.document.apply("Add Lamp", addLamp(editor.document.graph(), lamp));
        }
    ImGui::EndPopup();
}

}  // namespace

void showScene(Editor& editor) {
    const Result<Scene> scene = readScene(editor.document.graph().scene);
    if (!scene) {
        wrapped(themeColor(ThemeColor::error), "The scene cannot be read: " + scene.error().message + ".");
        if (!ImGui::Button("Begin a new scene")) return;
        Graph fresh = editor.document.graph();
        fresh.scene = nullptr;
        fresh.scenePlaces.list.clear();
        return editor.document.apply("New Scene", std::move(fresh));
    }
    showUnit(editor);
    if (beginProperties("exposure")) {
        number(editor, "exposure", "Exposure", "Stops: one more is twice as bright.", scene->exposure,
               {.min = -kMostExposure, .max = kMostExposure, .speed = 0.01});
        propertyRow(
            "Tone",
            "How light is mapped to the screen: a filmic curve, or one that keeps colours as they are.");
        static const std::vector<std::string> tones(kToneNames.begin(), kToneNames.end());
        auto chosen = std::size_t(scene->tone);
        if (chooseName("##tone", tones, chosen))
            set(editor, "Tone", setSceneValue(editor.document.graph(), "tone", tones[chosen]));
        flag(editor, "bounce", "Bounce", "Light that surfaces throw on each other.", scene->bounce);
        flag(editor, "reflections", "Reflections", "Surfaces mirror each other, rather than the sky alone.",
             scene->reflections);
        endProperties();
    }
    showCamera(editor, *scene);
    showSun(editor, *scene);
    showSky(editor, *scene);
    showAmbient(editor, *scene);
    showGround(editor, *scene);
    showFog(editor, *scene);
    showBloom(editor, *scene);
    showLamps(editor, *scene);
}

}  // namespace fw::editor
