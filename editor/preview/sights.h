// The pictures that a preview makes of one graph, each through an eye of its own, and which of them is next.
//
// One renderer draws them all, one frame at a time, and what it knew of a picture is lost when it turns to
// another: a picture that is turned back to is refined from its beginning. So each is drawn once, the one
// that has the hand first; then they are refined one after the other, each to its end, in the same order.
//
// While a hand moves, wishes come faster than a slow device can draw. The picture under the hand is made for
// each of them; the others are sketched, the mesh alone by a renderer of their own, when there is time, and
// after a while in any case, one at a time: they have a small part of it at most.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/render/renderer.h"
#include "runtime/system/clock.h"

namespace fw::editor {

struct PreviewEye {
    std::optional<Camera> camera = {};  ///< none: the scene's, or the whole solid framed
    int width = 0, height = 0;          ///< pixels; 0: no picture is wanted
    bool operator==(const PreviewEye&) const = default;
};

inline constexpr auto kLongestStale = std::chrono::milliseconds(250);

/// What a picture is drawn of: of the same it would be the same.
struct SightOf {
    uint64_t content = 0;  ///< of the player
    Scene scene = {};      ///< with the camera
    EnvironmentMapPtr environment = {};
    uint32_t view = 0;
    Slice slice = {};
    float leastWidth = 0.0f;
    int width = 0, height = 0;
    bool operator==(const SightOf&) const = default;
};

/// How far one of the pictures is.
struct Sight {
    PreviewEye eye = {};
    Picture picture = {};                      ///< as it was drawn last
    SightOf of = {};                           ///< what that was drawn of
    std::shared_ptr<const Picture> told = {};  ///< the best of what there is now; null: none yet
    Camera seen = {};                          ///< by which it was drawn
    bool due = false;                          ///< something has changed since it was drawn
    bool rough = false;                        ///< what is told is a sketch
    bool rests = false;                        ///< it does not get better
    int refined = 0;                           ///< pictures since the renderer turned to it, or it changed
    int best = 0;                              ///< of those, which was told
    Clock::time_point changed = {};            ///< when it came to be due

    bool wanted() const { return eye.width > 0 && eye.height > 0; }
    /// It has to be drawn anew.
    void outdate(Clock::time_point now);
    /// And what was told is not to be shown any more: it is of another document.
    void forget(Clock::time_point now);
};

/// These eyes in place of those before; what sees otherwise than it did is due. Whether any does.
bool aimSights(std::vector<Sight>& sights, const std::vector<PreviewEye>& eyes, Clock::time_point now);

/// Which one to draw next: `first` has the hand, `turned` was drawn last. None: all is done, which without
/// `refines` is said once nothing is due. Until it is `settled` that no newer wish follows soon, the renderer
/// stays with the first one as long as that gets better.
std::optional<std::size_t> nextSight(const std::vector<Sight>& sights, std::size_t first, std::size_t turned,
                                     bool refines, bool settled = true);
/// One besides the first that has waited for longer than kLongestStale; none if none has.
std::optional<std::size_t> staleSight(const std::vector<Sight>& sights, std::size_t first,
                                      Clock::time_point now);

/// It is to be drawn of this: whether what is told is that already, and only goes on to be refined.
bool isDrawnOf(Sight& sight, const SightOf& of);
/// A picture was drawn. Whether it is to be told: the first one is, and of those that refine it each that is
/// the mean of twice as many, once it is better than what was told.
bool takeDrawn(Sight& sight);
/// A sketch was drawn, which is told.
void takeSketch(Sight& sight);
/// The renderer has nothing to add to what it drew of this last, for this eye or for another that sees the
/// same. Whether that is to be told.
bool takeSame(Sight& sight, const std::vector<Sight>& sights, const SightOf& of);
/// It will not go on for now: whether its last picture is better than what was told.
bool takeRest(Sight& sight);

}  // namespace fw::editor
