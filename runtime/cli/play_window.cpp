#include "runtime/cli/play_window.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>

#include "graph/json.h"
#include "runtime/cli/mesh_graph.h"
#include "runtime/file_watch.h"
#include "runtime/window/overlay.h"
#include "runtime/window/window.h"

namespace fw::cli {

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point then) {
    return std::chrono::duration<double>(Clock::now() - then).count();
}

constexpr double kSmooth = 0.04;    // seconds that a picture may take while something moves
constexpr double kRest = 0.15;      // seconds without a change, after which a picture is made in full
constexpr double kWatch = 0.1;      // seconds between two looks at the file
constexpr double kLongStep = 0.25;  // seconds; time does not jump farther after a stall

/// Everything that plays: the player, its window and what they show.
class Stage {
  public:
    Stage(const PlayOptions& options_, Player& player_, Window& window_, Viewer& viewer_)
        : options(options_), player(player_), window(window_), viewer(viewer_) {
        describe();
    }

    void run() {
        Clock::time_point before = Clock::now(), looked = before, changed = before;
        for (int shown = 0; !viewer.closed && !interrupted && shown < options.frames.value_or(shown + 1);) {
            window.poll(viewer.dirty ? 0.0 : 0.02);
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
                changed = before;
                shown += draw(share);
            } else if (reduced && secondsSince(changed) > kRest) {
                shown += draw(1.0);
            }
        }
    }

  private:
    /// What the viewer has to know of the graph.
    void describe() {
        const Timeline& timeline = player.timeline();
        viewer.length = timeline.length;
        viewer.loop = timeline.tracks.empty() ? Loop::repeat : timeline.loop;
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
        for (const std::string& assignment : options.mesh.graph.assignments) {
            const std::size_t equals = assignment.find('=');
            const Done set =
                setParameter(*graph, assignment.substr(0, equals), assignment.substr(equals + 1));
            if (!set) return set.error();
        }
        return player.reload(std::move(*graph));
    }

    void reload() {
        const Done done = readAgain();
        if (done) {
            message.clear();
            describe();
        } else {
            complain(format(done.error()));
        }
        viewer.dirty = true;
    }

    /// Makes a picture of the window's size, or of that share of its pixels, and shows it; whether it did.
    /// One in full is given up as soon as something changes.
    bool draw(double pixels) {
        const double side = std::sqrt(pixels);
        RenderOptions render;
        render.width = std::clamp(static_cast<int>(viewer.width * side), kLeastPictureSide, kMostPictureSide);
        render.height =
            std::clamp(static_cast<int>(viewer.height * side), kLeastPictureSide, kMostPictureSide);
        while (int64_t(render.width) * render.height > kMostPicturePixels)
            render.width /= 2, render.height /= 2;
        std::atomic<bool> giveUp = false;
        render.cancel = &giveUp;
        if (pixels >= 1.0)
            render.progress = [&](int) {
                window.poll(0.0);
                viewer.pass(0.0);
                giveUp = viewer.dirty || viewer.closed || interrupted;
            };
        if (viewer.ownCamera) render.scene.camera = viewer.orbit.camera();

        const Clock::time_point start = Clock::now();
        player.seek(viewer.seconds);
        const double aspect = double(render.width) / render.height;
        const Result<Picture> made = player.frame(render);
        if (made) {
            picture = *made;
            if (!failed.empty() && message == failed) message.clear();
            failed.clear();
            see(static_cast<float>(aspect));
        } else if (giveUp) {
            return false;
        } else {
            complain(failed = format(made.error()));
        }
        reduced = pixels < 1.0 && bool(made);
        if (pixels < 1.0 || !reduced) adapt(secondsSince(start));
        if (picture.pixels.empty()) return false;
        Picture decorated = scaled(picture, viewer.width, viewer.height);
        drawOverlay(decorated, viewer, message);
        return window.show(decorated);
    }

    /// Notes by what camera the picture was seen, where an orbit would start.
    void see(float aspect) {
        if (viewer.ownCamera) return;
        const Result<Scene> scene = player.scene();
        if (scene && scene->camera) {
            viewer.seen = *scene->camera;
        } else if (const auto points = player.outline(); points && !points->empty()) {
            viewer.seen = framingCamera(*points, aspect);
        }
    }

    /// The share of pixels with which the next picture takes about as long as it may.
    void adapt(double took) {
        share = std::clamp(share * std::clamp(kSmooth / std::max(took, 1e-4), 0.4, 1.6), 0.02, 1.0);
    }

    const PlayOptions& options;
    Player& player;
    Window& window;
    Viewer& viewer;
    std::map<std::string, FileWatch> watches;  ///< of what the graph shown was read from
    Picture picture;                           ///< the last good one
    std::string message;                       ///< shown over it
    std::string failed;                        ///< why there is no picture of this time
    double share = 0.25;
    bool reduced = false;  ///< the picture that is shown has fewer pixels than the window
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
        player = openPlayer(options.mesh, progress, wishes, status);
        if (!player) return status;
    }
    Viewer viewer;
    viewer.seconds = options.mesh.graph.time;
    {
        Window window(player->device(), "Fieldwright", size.first, size.second, viewer);
        Stage(options, *player, window, viewer).run();
    }
    return interrupted ? kInterrupted : kDone;
}

}  // namespace fw::cli
