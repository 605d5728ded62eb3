#include "runtime/cli/play_window.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "graph/document/json.h"
#include "graph/document/named_parameters.h"
#include "runtime/cli/mesh_graph.h"
#include "runtime/system/clock.h"
#include "runtime/system/file_watch.h"
#include "runtime/window/overlay.h"
#include "runtime/window/window.h"

namespace fw::cli {

namespace {

constexpr double kSlow = 0.12, kFast = 0.03;  // seconds of a picture, beyond which its size is changed
constexpr double kRest = 0.15;                // seconds without a change, after which the picture is refined
constexpr double kSides[] = {1.0, 0.7, 0.5, 0.35,
                             0.25};  // of the window's, of a picture while something moves
constexpr double kWatch = 0.1;       // seconds between two looks at the file
constexpr double kLongStep = 0.25;   // seconds; time does not jump farther after a stall

/// Everything that plays: the player, its window and what they show.
class Stage {
  public:
    Stage(const PlayOptions& options_, Player& player_, Window& window_, Viewer& viewer_)
        : options(options_), player(player_), window(window_), viewer(viewer_) {
        describe();
    }

    void run() {
        Clock::time_point before = Clock::now(), looked = before, changed = before;
        for (int shown = 0; !viewer.closed && shown < options.frames.value_or(shown + 1);) {
            window.poll(viewer.dirty || !refined ? 0.0 : 0.02);
            const double elapsed = secondsSince(before);
            before = Clock::now();
            viewer.pass(std::min(elapsed, kLongStep));
            if (secondsSince(looked) > kWatch) {
                looked = before;
                bool touched = false;
                for (auto& [file, watch] : watches) touched |= watch.changed();
                if (touched) reload();
            }
            if (viewer.width == 0 || viewer.height == 0) {  // minimised
                window.poll(kWatch);
                continue;
            }
            if (viewer.dirty) {
                viewer.dirty = false;
                refined = false;
                overlaid = false;
                changed = before;
                shown += drawOnceMoreIfLost(kSides[level]);
            } else if (!refined && secondsSince(changed) > kRest) {
                shown += drawOnceMoreIfLost(1.0);
            }
        }
    }

  private:
    /// What the viewer has to know of the graph.
    void describe() {
        const Timeline& timeline = player.timeline();
        viewer.length = timeline.length;
        viewer.loop = timeline.loop;
        viewer.framesPerSecond = timeline.framesPerSecond;
        viewer.moves = player.moves();
        const std::vector<std::string> files = player.files();
        std::erase_if(watches, [&](const auto& each) { return !std::ranges::count(files, each.first); });
        for (const std::string& file : files) watches.try_emplace(file, file);
        window.setTitle(options.mesh.graph.path + " - Fieldwright");
    }

    void complain(const std::string& text) {
        if (text != message) std::fprintf(stderr, "%s\n", text.c_str());
        message = text;
    }

    Done readAgain() {
        Result<Graph> graph = readGraph(options.mesh.graph.path, nullptr);
        if (!graph) return graph.error();
        if (Done applied = applyOptions(*graph, options.mesh.graph); !applied) return applied;
        return player.reload(std::move(*graph));
    }

    void reload() {
        const Done done = onceMoreIfLost([&] { return readAgain(); }, [&] { renew(); });
        if (done) {
            message.clear();
            describe();
        } else {
            complain(format(done.error()));
        }
        viewer.dirty = true;
    }

    /// After the device was lost: another, in the same window.
    void renew() {
        window.leaveDevice();
        renewDevice(player, "going on");
        window.useDevice(player.device());
    }

    bool drawOnceMoreIfLost(double side) {
        return onceMoreIfLost([&] { return draw(side); }, [&] { renew(); });
    }

    /// Makes the next picture, of that share of the window's width and height, and shows it; whether it did.
    /// One that rests is refined until nothing is left to refine.
    bool draw(double side) {
        RenderOptions render;
        render.width = std::clamp(static_cast<int>(viewer.width * side), kLeastPictureSide, kMostPictureSide);
        render.height =
            std::clamp(static_cast<int>(viewer.height * side), kLeastPictureSide, kMostPictureSide);
        while (int64_t(render.width) * render.height > kMostPicturePixels)
            render.width /= 2, render.height /= 2;
        render.primary = Primary::measured;
        if (viewer.ownCamera) render.scene.camera = viewer.orbit.camera();

        const Clock::time_point start = Clock::now();
        player.seek(viewer.seconds);
        const double aspect = double(render.width) / render.height;
        const Result<bool> made = player.show(render);
        if (made) {
            if (!failed.empty() && message == failed) message.clear();
            failed.clear();
            sayIfCoarser();
            see(static_cast<float>(aspect));
        } else {
            complain(failed = format(made.error()));
        }
        refined = !made || !*made;
        if (refined && made && std::exchange(overlaid, true)) return false;
        if (side < 1.0 || level == 0) adapt(secondsSince(start));
        if (!player.picture()) return false;
        Picture overlay{viewer.width, viewer.height, {}};
        overlay.pixels.resize(4 * std::size_t(viewer.width) * std::size_t(viewer.height));
        drawOverlay(overlay, viewer, message);
        return window.show(*player.picture(), overlay);
    }

    void sayIfCoarser() {
        const std::optional<Error> now = player.coarser();
        const std::string before = std::exchange(coarser, now ? format(*now) : "");
        if (coarser == before) return;
        if (message == before) message.clear();
        if (!coarser.empty()) complain(coarser);
    }

    /// Notes by what camera the picture was seen, where an orbit would start.
    void see(float aspect) {
        if (viewer.ownCamera) return;
        if (const auto camera = player.camera(aspect); camera && *camera) viewer.seen = **camera;
    }

    /// Makes the next pictures larger or smaller, if this one was very quick or slow. Rarely: the renderer
    /// starts anew with every other size.
    void adapt(double took) {
        slow = took > kSlow ? slow + 1 : 0;
        quick = took < kFast ? quick + 1 : 0;
        if (slow > 2 && level + 1 < std::size(kSides)) ++level, slow = 0;
        if (quick > 20 && level > 0) --level, quick = 0;
    }

    const PlayOptions& options;
    Player& player;
    Window& window;
    Viewer& viewer;
    std::map<std::string, FileWatch> watches;  ///< of what the graph shown was read from
    std::string message;                       ///< shown over the picture
    std::string failed;                        ///< why there is no picture of this time
    std::string coarser;                       ///< why the mesh is coarser than it should be
    std::size_t level = 1;                     ///< of kSides
    int slow = 0, quick = 0;                   ///< pictures in a row
    bool refined = false;                      ///< nothing is left to refine
    bool overlaid = false;                     ///< what lies over the picture is as it should be
};

}  // namespace

int playInWindow(const PlayOptions& options, std::pair<int, int> size) {
    const Desktop desktop;
    std::optional<Player> player;
    {
        Progress progress;
        int status = kDone;
        PlayerOptions wishes;
        wishes.deviceOptions = desktop.deviceOptions();
        wishes.fieldBy = options.quality;
        player = openPlayer(options.mesh, progress, wishes, status);
        if (!player) return status;
    }
    Viewer viewer;
    viewer.seconds = options.mesh.graph.time;
    {
        Window window(player->device(), "Fieldwright", size.first, size.second, viewer);
        Stage(options, *player, window, viewer).run();
    }
    return kDone;
}

}  // namespace fw::cli
