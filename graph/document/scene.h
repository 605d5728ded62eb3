// The `scene` of a document: how what the graph makes is looked at and lit.
//
//     "scene": {
//       "camera": {"position": [4, 3, 5], "target": [0, 0, 0], "fov": 30},
//       "sun": {"azimuth": 250, "elevation": 9, "color": [1, 0.55, 0.3], "strength": 5, "size": 1},
//       "sky": {"zenith": [0.1, 0.15, 0.35], "horizon": [0.9, 0.45, 0.3]},
//       "lights": [{"type": "spot", "position": [2, 4, 0], "target": [0, 0, 0], "color": [1, 0.8, 0.6],
//       "strength": 40}], "ao": {"radius": 0.5}, "fog": {"density": 0.1}, "ground": false, "exposure": 0.5,
//       "tone": "neutral"
//     }
//
// Every key may be absent. Without a camera the whole solid is framed from three quarters; without a sky it
// stands before a studio's wall. `sun`, `ao`, `ground`, `fog` and `bloom` may be false, which switches them
// off. Keys that are not known here are kept in the document (graph.h) and have no effect. A Scene is a
// value, read anew for every time that tracks of the timeline give the document's scene (timeline.h,
// sceneAt).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "graph/base/result.h"
#include "graph/document/graph.h"

namespace fw {

inline constexpr double kLeastFov = 1.0, kMostFov = 170.0, kMostShutter = 360.0;
inline constexpr double kMostElevation = 90.0, kMostSunSize = 45.0;
inline constexpr double kLeastLampAngle = 1.0, kMostLampAngle = 179.0;
inline constexpr double kMostExposure = 20.0;
/// Of numbers without a range of their own, on either side of 0: pictures are made in single precision, in
/// which lengths are squared and strengths multiplied.
inline constexpr double kMostSceneNumber = 1e9;
inline constexpr std::size_t kMostLights = 16;

using Triple = std::array<double, 3>;

struct Camera {
    Triple position{4.0, 3.0, 5.0};  ///< metres
    Triple target{0.0, 0.0, 0.0};    ///< what is in the middle of the picture
    double fov = 30.0;               ///< degrees, from the bottom of the picture to its top
    double aperture = 0.0;  ///< metres across the lens: what is not in focus is blurred; 0: nothing is
    double focus = 0.0;     ///< metres to the plane that is in focus; 0: to the target
    double shutter = 0.0;   ///< degrees of a frame's 360 that it is open for: what moves is blurred
    bool operator==(const Camera&) const = default;
};

struct Sun {
    double azimuth = -32.0;         ///< degrees from +z towards +x
    double elevation = 48.0;        ///< degrees above the horizon
    Triple color{1.0, 0.9, 0.776};  ///< linear
    double strength = 2.9;  ///< irradiance of a surface that faces it; a white one then shows 1 / pi of it
    double size = 4.0;      ///< degrees across: the larger, the softer its shadows
    bool traced = false;    ///< its shadows, through the field; by a map of the solid otherwise
    bool operator==(const Sun&) const = default;
};

struct Sky {
    Triple zenith{0.50, 0.66, 0.95}, horizon{0.95, 0.93, 0.90}, ground{0.56, 0.54, 0.51};
    double strength = 1.0;
    std::string image =
        {};  ///< path of an environment map (graph/assets/environment.h) in place of the colours
    double rotation = 0.0;  ///< of it, degrees about y, from +z towards +x
    bool isPicture() const { return !image.empty(); }
    bool operator==(const Sky&) const = default;
};

struct Lamp {
    enum class Type : unsigned char { point, spot, directional };
    Type type = Type::point;
    Triple position{0.0, 3.0, 0.0};  ///< metres; not of a directional one
    Triple target{0.0, 0.0, 0.0};    ///< what a spot or a directional light points at
    Triple color{1.0, 1.0, 1.0};
    double strength = 10.0;  ///< radiant intensity; of a directional light its irradiance
    double angle = 40.0;     ///< degrees, across a spot's cone
    double blend = 0.3;      ///< share of the cone over which its edge fades
    double size = 0.1;       ///< metres across: the larger, the softer its shadows
    bool operator==(const Lamp&) const = default;
};

struct AmbientOcclusion {
    double radius = 0.0;    ///< metres that its rays see; 0: as suits the solid's size
    double strength = 1.0;  ///< 0 to 1
    bool operator==(const AmbientOcclusion&) const = default;
};

struct Fog {
    double density = 0.05;  ///< at the height of the ground, 1 / metre
    double height = 0.0;    ///< metres in which it thins to 1 / e; 0: it does not
    Triple color{1.0, 1.0, 1.0};
    bool operator==(const Fog&) const = default;
};

/// Light that spills from bright places.
struct Bloom {
    double strength = 0.15;  ///< share of all light that does
    double radius = 0.1;     ///< how far, in heights of the picture
    bool operator==(const Bloom&) const = default;
};

struct Ground {
    std::optional<double> height;  ///< metres; none: the solid's foot
    bool operator==(const Ground&) const = default;
};

/// How light is mapped to what a screen can show.
enum class Tone : unsigned char {
    aces,     ///< a filmic curve for each colour by itself: bright colours bleach early, and shift towards
              ///< yellow
    neutral,  ///< Khronos' PBR Neutral: colours stay what they are until they are very bright, then bleach
};
inline constexpr std::array<const char*, 2> kToneNames = {"aces", "neutral"};

struct Scene {
    std::optional<Camera> camera;
    std::optional<Sun> sun = Sun{};
    std::optional<Sky> sky;  ///< none: the studio
    std::optional<AmbientOcclusion> ao = AmbientOcclusion{};
    std::optional<Ground> ground = Ground{};
    std::optional<Fog> fog;
    std::optional<Bloom> bloom;
    std::vector<Lamp> lights;
    bool bounce = false;       ///< light that surfaces throw on each other
    bool reflections = false;  ///< surfaces mirror each other, rather than the sky alone
    double exposure = 0.0;     ///< stops
    Tone tone = Tone::aces;
    bool operator==(const Scene&) const = default;
};

/// The scene in this JSON, which is null or an object; `places` are those of its values, for the places of
/// errors (empty if unknown). Errors name the key: what has the wrong form, is not finite or out of range, a
/// camera or light that stands on its target, too many lights.
Result<Scene> readScene(const Json& json, const TextPlaces& places = {});

/// Where the sky stands in the text of that JSON; 0 if that is not known.
TextPosition skyPlace(const Json& json, const TextPlaces& places);

}  // namespace fw
