#include "editor/preview/preview.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <mutex>
#include <thread>
#include <utility>

#include "editor/preview/detail.h"
#include "editor/preview/pinned.h"
#include "graph/check/check.h"
#include "runtime/play/player.h"
#include "runtime/system/cancel_flag.h"
#include "runtime/system/clock.h"

namespace fw::editor {

namespace {

/// Inputs that stay live after the hand has let go of them: taking hold again, or undoing, compiles nothing.
constexpr std::size_t kMostLive = 6;
/// While a hand moves: how long the others wait for a newer wish, and in how many times its own length one of
/// them is sketched once if wishes do not stop.
constexpr auto kPause = std::chrono::milliseconds(40);
constexpr int kSketchesApart = 12;
/// So long after a change, if none followed, the renderer turns to other views to refine them.
constexpr auto kSettled = std::chrono::milliseconds(200);
constexpr auto kCompilePoll = std::chrono::milliseconds(5);
/// A first mesh with few cells is followed by that with all, once nothing was asked for so long,
/// milliseconds.
constexpr double kRest = 120.0;
/// Fewer steps of particles than this are soon made: nobody is told of them.
constexpr int kToldSteps = 20;

bool sameWish(const PreviewWish& a, const PreviewWish& b) {
    return a.graph == b.graph && a.revision == b.revision && a.document == b.document &&
           a.pinned == b.pinned && a.held == b.held && a.seconds == b.seconds && a.camera == b.camera &&
           a.width == b.width && a.height == b.height && a.view == b.view && a.slice == b.slice &&
           a.leastWidth == b.leastWidth && a.resolution == b.resolution && a.others == b.others &&
           a.first == b.first;
}

std::vector<PreviewEye> eyesOf(const PreviewWish& wish) {
    std::vector<PreviewEye> eyes = {{wish.camera, wish.width, wish.height}};
    eyes.insert(eyes.end(), wish.others.begin(), wish.others.end());
    return eyes;
}

/// By what the wish under way was overtaken.
struct Overtaken {
    std::atomic<bool> byAny = false;      ///< a newer wish waits
    std::atomic<bool> byEarlier = false;  ///< one of an earlier time: particles need not go as far
    /// One of another graph that no hand is moving, so that a draft will come before this picture is done.
    CancelFlag byOther;
    void reset() {
        byAny = byEarlier = false;
        byOther.reset();
    }
};

}  // namespace

/// What the interface's thread and the preview's both touch; each holds the lock for moves alone.
struct Preview::Shared {
    DeviceOptions deviceOptions;
    std::function<void()> changed;
    std::mutex mutex;
    std::condition_variable asked;
    std::optional<PreviewWish> next, last;  ///< to be worked on; the newest that was asked for
    std::optional<PreviewResult> ready;
    PreviewResult told;  ///< the last result but for its pictures
    Overtaken overtaken;
    std::atomic<double> baked = 1.0;      ///< of a mesh that is being made a field; 1: none is
    std::atomic<double> simulated = 1.0;  ///< of the steps of particles up to the time; 1: all
    bool stop = false, working = true;
    std::optional<PreviewWish> tried;  ///< what is or was worked on last
    bool renewed = false;              ///< the device was lost since the last result
    std::thread thread;

    void publish(PreviewResult result) {
        Picture picture = std::exchange(result.picture, {});
        std::vector<PreviewSight> others = std::exchange(result.others, {});
        PreviewResult bare = result;
        bare.current = bare.draft = false;
        result.picture = std::move(picture), result.others = std::move(others);
        {
            std::lock_guard lock(mutex);
            renewed = false;
            ready = std::move(result);
            told = std::move(bare);
        }
        if (changed) changed();
    }
    void tell(std::atomic<double>& of, double share) {
        if (of.exchange(share) != share && changed) changed();
    }
    /// What the thread does: work(), and again with another device after a failure, when something is asked;
    /// at once after the first loss of the device.
    void run();
    bool beginsAgain();
    void fail(const std::string& why);
    void work();
};

namespace {

/// The preview's side: what is shown, and what is still to be done for it.
class Maker {
  public:
    Maker(Device opened, std::function<void(PreviewResult)> publish_, const Overtaken& overtaken_,
          std::function<void(double)> baking_, std::function<void(double)> simulating_)
        : device(std::move(opened)),
          publish(std::move(publish_)),
          baking(std::move(baking_)),
          simulating(std::move(simulating_)),
          overtaken(overtaken_) {}

    void take(PreviewWish newer);
    /// The next thing to do for the wish: a picture, or nothing. Whether there is more to do at once.
    bool work();
    /// Whether a newer wish will probably come before there is time for more.
    bool pauses() const { return pausing; }
    /// Whether more will have to be done when kernels are compiled.
    bool waits() {
        return player && playsOf == wish.document && (coarse || !compiled || player->compiling());
    }

  private:
    void load();
    PlayerOptions playerOptions() const;
    Done play(const Graph& graph);
    void draw(std::size_t which, bool urgent);
    bool sketches(std::size_t which) const;
    Done aim(RenderOptions& options, const Sight& sight);
    void outdateAll();
    void adapt(double took);
    bool measure();
    void coarsen();
    void tell();
    void refuse(Error error);

    std::optional<Device> device;  ///< until the player has it
    std::function<void(PreviewResult)> publish;
    std::function<void(double)> baking, simulating;
    const Overtaken& overtaken;
    std::optional<Player> player;
    PreviewWish wish;
    std::deque<std::string> live;     ///< held last first
    PreviewResult result;             ///< as it was told last
    std::vector<Error> checked;       ///< the graph's findings; a time may have one more
    std::vector<Sight> sights;        ///< of the wish's eyes
    Clock::duration sketch{};         ///< that one takes
    Clock::time_point sketched = {};  ///< when one was made last
    bool pausing = false;             ///< the picture under the hand was drawn, and the others may wait
    std::size_t turned = 0;           ///< that of the last picture
    Box solid = kUnbounded;           ///< where the last one was
    HeldDetail heldDetail;
    bool await = false;    ///< what changed is only what is held: the picture stays until kernels are there
    bool compiled = true;  ///< all kernels were there for the last picture
    bool good = false;     ///< the graph can be drawn
    bool interrupted = false;  ///< the graph was not loaded, for a newer one waits
    bool coarse = false;       ///< the mesh has few cells, that there be a picture soon
    /// What the solid was measured of.
    struct Measured {
        uint64_t revision, document;
        std::string pinned;
        double seconds;
        int cells;
        bool operator==(const Measured&) const = default;
    };
    std::optional<Measured> measured;
    std::optional<uint64_t> playsOf;  ///< the document that the player has a graph of
    Clock::time_point since;          ///< what the picture came for
    Clock::time_point rests;          ///< when the wish was taken, or a picture drawn last
    double loading = 0;
};

PlayerOptions Maker::playerOptions() const {
    PlayerOptions options;
    options.resolution = wish.resolution;
    if (!wish.held.empty() && heldDetail.cells > 0) options.resolution = heldDetail.cells;
    options.liveParameters = false;
    options.live = {live.begin(), live.end()};
    options.compileBehind = options.checked = true;
    options.baking = baking;
    options.simulating = [this](int done, int all) {
        const bool many = all >= kToldSteps;
        if (many) simulating(double(done) / all);
        return !overtaken.byOther && !(many && overtaken.byEarlier);
    };
    options.stop = [this] { return overtaken.byOther.token(); };
    options.view = wish.view;
    return options;
}

Done Maker::play(const Graph& graph) {
    const auto with = [&](const PlayerOptions& options) -> Done {
        if (player) return player->reload(graph, options);
        Result<Player> made = Player::create(graph, std::move(*device), options);
        if (!made) return made.error();
        player.emplace(std::move(*made));
        device.reset();
        return done();
    };
    PlayerOptions options = playerOptions();
    Done played = with(options);
    if (played) {
        solid = player->region();
        return played;
    }
    // A node on the way to the solid may have no bounds.
    if (wish.pinned.empty() || played.error().code == Error::Code::cancelled) return played;
    options.region = solid;
    return with(options) ? done() : std::move(played);
}

void Maker::refuse(Error error) {
    result.findings = checked;
    result.findings.push_back(std::move(error));
    result.current = false;
}

void Maker::load() {
    const auto start = Clock::now();
    for (const std::string& name : wish.held) {
        std::erase(live, name);
        live.push_front(name);
    }
    if (live.size() > std::max(kMostLive, wish.held.size()))
        live.resize(std::max(kMostLive, wish.held.size()));
    result.revision = wish.revision;
    result.document = wish.document;
    std::future<std::vector<Error>> checking =
        std::async(std::launch::async, [graph = wish.graph] { return check(*graph); });
    // What the output does not need may be broken.
    const Graph shown = showingNode(*wish.graph, wish.pinned);
    const Done played = play(shown);
    good = bool(played);
    interrupted = !played && played.error().code == Error::Code::cancelled;
    if (good && wish.held.empty()) coarsen();
    checked = checking.get();
    if (interrupted) return;
    if (!played) {
        if (!hasErrors(checked)) checked.push_back(played.error());
        result.current = false;
    } else {
        playsOf = wish.document;
        result.spoiledBy = player->program().spoiledBy;
        result.region = player->region();
        result.exactness = player->program().nodeExactness;
        result.efforts = effortByNode(player->program());
        std::ranges::stable_sort(result.efforts, std::greater(), &NodeEffort::sample);
        checked.insert(checked.end(), player->notes().begin(), player->notes().end());
    }
    result.findings = checked;
    loading = millisecondsSince(start);
}

void Maker::outdateAll() {
    for (Sight& sight : sights) sight.outdate(since);
}

/// A large field that has no kernels yet is shown with few cells first.
void Maker::coarsen() {
    player->coarsen(0);
    const int cells = player->resolution();
    const int few =
        player->meshesOnHost() ? firstCells(cells, secondsByTapes(player->program(), cells)) : cells;
    coarse = few < cells;
    if (coarse) player->coarsen(few);
}

void Maker::take(PreviewWish newer) {
    since = rests = Clock::now();
    const bool first = !wish.graph;
    const bool sameGraph =
        !first && newer.graph == wish.graph && newer.revision == wish.revision && newer.pinned == wish.pinned;
    const bool sameHeld = newer.held == wish.held, sameMesh = newer.resolution == wish.resolution;
    const bool sameLook = newer.seconds == wish.seconds && newer.view == wish.view &&
                          newer.slice == wish.slice && newer.leastWidth == wish.leastWidth;
    if (!first && newer.document != wish.document) {
        for (Sight& sight : sights) sight.forget(since);
        result = {};
    }
    if (newer.held.empty()) heldDetail.cells = 0;
    const bool letGo = !wish.held.empty() && newer.held.empty();
    wish = std::move(newer);
    if (!wish.graph) return;
    const bool samePictures = !aimSights(sights, eyesOf(wish), since) && sameLook;
    if (!sameGraph || !sameHeld || !sameMesh || first || interrupted) load();
    if (player) player->seek(wish.seconds);
    // Taking hold of an input changes the code and not the picture.
    await = sameGraph && sameMesh && samePictures && !sameHeld && !letGo && result.current;
    // What was valid last can be looked at from elsewhere.
    const bool same = sameGraph && sameHeld && sameMesh && sameLook;
    if (good ? !same && !await : !sameLook) outdateAll();
    if (!good && !interrupted) tell();
}

/// The scene, and through what camera it is seen.
Done Maker::aim(RenderOptions& options, const Sight& sight) {
    const Result<Scene> scene = player->scene();
    if (!scene) return scene.error();
    options.scene = *scene;
    if (sight.eye.camera) {
        options.scene.camera = sight.eye.camera;
    } else if (!scene->camera && !wish.held.empty() && sight.told) {
        options.scene.camera = sight.seen;  // what the hand moves, not the eye
    } else if (!scene->camera) {
        const auto points = player->outline();
        if (!points) return points.error();
        if (!points->empty())
            options.scene.camera = framingCamera(*points, float(sight.eye.width) / float(sight.eye.height));
    }
    return done();
}

void Maker::adapt(double took) {
    if (wish.held.empty() || player->compiling()) return;
    heldDetail =
        adapted(heldDetail, took, wish.resolution > 0 ? wish.resolution : player->program().resolution);
}

/// Whether it is sketched: on a software device those are that have not the hand, so that they are not in its
/// way.
bool Maker::sketches(std::size_t which) const {
    return which != wish.first && sights[which].due && player->device().software && !showsField(wish.view) &&
           wish.view != RENDER_AMBIENT;
}

/// `urgent` is what no newer wish of the same graph cancels.
void Maker::draw(std::size_t which, bool urgent) {
    Sight& sight = sights[which];
    const auto side = [&](int pixels) {
        const double scale = wish.held.empty() ? 1.0 : heldDetail.scale;
        return std::clamp(int(std::lround(scale * pixels)), kLeastPictureSide, kMostPictureSide);
    };
    RenderOptions options{.width = side(sight.eye.width),
                          .height = side(sight.eye.height),
                          .primary = Primary::measured,
                          .show = wish.view,
                          .slice = wish.slice,
                          .leastWidth = wish.leastWidth};
    // What is asked for on and on, as while a hand moves, gets its pictures nevertheless.
    if (!urgent)
        options.cancel = &overtaken.byAny;
    else if (!player->compiling())
        options.cancel = &overtaken.byOther;
    const bool asSketch = sketches(which);
    if (!asSketch && std::exchange(turned, which) != which) sight.refined = 0;
    const auto refuseAll = [&](Error error) {
        refuse(std::move(error));
        for (Sight& each : sights) each.due = false, each.rests = true;
        tell();
    };
    const auto start = Clock::now();
    const uint64_t submitted = player->device().record->submissions, awaited = player->device().record->waits;
    const Result<MesherResult> mesh = player->meshOnDevice(wish.view);
    const double meshing = millisecondsSince(start);
    if (!mesh) {
        simulating(1.0);
        if (!overtaken.byOther && !overtaken.byEarlier) refuseAll(mesh.error());
        return;
    }
    if (const Done aimed = aim(options, sight); !aimed)
        return overtaken.byOther ? void() : refuseAll(aimed.error());
    const SightOf of{player->contentNumber(), options.scene, player->environment(), wish.view, wish.slice,
                     wish.leastWidth,         options.width, options.height};
    const auto saysSo = [&] {
        result.findings = checked;
        if (std::optional<Error> note = player->coarser()) result.findings.push_back(std::move(*note));
        result.current = good;
        result.draft = player->compiling();
        result.statistics.vertices = mesh->vertices;
        result.statistics.triangles = mesh->triangles;
        result.statistics.resolution = player->resolution();
    };
    const bool fresh = sight.due;
    if (isDrawnOf(sight, of)) return saysSo(), tell();
    const auto drawing = Clock::now();
    const Result<bool> drawn =
        asSketch ? player->sketch(options, sight.picture) : player->show(options, sight.picture);
    if (!drawn) return refuseAll(drawn.error());
    if (!*drawn && options.cancel && *options.cancel) {
        if (takeRest(sight)) tell();
        return;
    }
    saysSo();
    if (options.scene.camera) sight.seen = *options.scene.camera;
    if (!asSketch && !*drawn) {  // the renderer is at the end of that
        if (takeSame(sight, sights, of) || fresh) tell();
        return;
    }
    sight.of = of;
    if (asSketch) {
        sketched = Clock::now(), sketch = sketched - drawing;
        return takeSketch(sight), tell();
    }
    const double drew = millisecondsSince(drawing);
    if (!fresh && result.particles.empty()) result.particles = player->particleVolumes();
    if (fresh && which == wish.first) {
        result.particles.clear();
        result.statistics.stages = {{"compile", loading}, {"mesh", meshing}, {"picture", drew}};
        result.statistics.milliseconds = millisecondsSince(since);
        result.statistics.submissions = player->device().record->submissions - submitted;
        result.statistics.waits = player->device().record->waits - awaited;
        adapt(loading + meshing + drew);
        loading = 0;
    }
    result.statistics.pipelines = player->pipelinesBuilt();
    result.statistics.deviceBytes = player->device().record->allocated;
    // Each picture refines the one before: not every one is worth waking the interface.
    if (takeDrawn(sight)) tell();
}

/// Measures the mesh that is seen, unless it was; whether there is something to tell.
bool Maker::measure() {
    const Measured now{wish.revision, wish.document, wish.pinned, wish.seconds, player->resolution()};
    if (!wish.measures || now == measured) return false;
    measured = now;
    result.size.reset();
    if (const Result<Mesh> mesh = player->mesh(); mesh && !mesh->indices.empty())
        result.size = sizeOf(mesh->positions, mesh->indices);
    return true;
}

void Maker::tell() {
    result.picture = sights[0].told ? *sights[0].told : Picture{};
    result.seen = sights[0].seen;
    result.others.clear();
    for (std::size_t i = 1; i < sights.size(); ++i) result.others.push_back({sights[i].told, sights[i].seen});
    publish(result);
}

bool Maker::work() {
    pausing = false;
    if (!player || playsOf != wish.document) return false;
    const bool compiling = player->compiling();
    if (!compiling && !compiled) since = Clock::now(), outdateAll();  // from the draft to the full
    compiled = !compiling;
    if (await && !compiling) await = false, outdateAll();
    const bool due = std::any_of(sights.begin(), sights.end(), [](const Sight& sight) { return sight.due; });
    if (coarse && (!player->meshesOnHost() || (!due && millisecondsSince(rests) > kRest))) {
        player->coarsen(0);
        coarse = false, await = false;
        since = Clock::now(), outdateAll();
    }
    if (await) return false;
    const bool refines = !compiling && wish.held.empty();
    const auto nextOne = [&] {
        return nextSight(sights, wish.first, turned, refines, Clock::now() - since > kSettled);
    };
    const auto next = nextOne();
    const bool stale = std::ranges::any_of(sights, &Sight::due);
    if (refines && good && !coarse && !stale && measure()) return tell(), true;
    if (!next) return false;
    const bool urgent = sights[*next].due && *next == wish.first;
    draw(*next, urgent);
    rests = Clock::now();
    pausing = urgent && !wish.held.empty();
    if (urgent && rests - sketched > kSketchesApart * sketch)
        if (const auto old = staleSight(sights, wish.first, rests)) draw(*old, true);
    return nextOne().has_value();
}

}  // namespace

void Preview::Shared::work() {
    {
        std::lock_guard lock(mutex);
        tried = next;
    }
    Result<Device> device = createDevice(deviceOptions);
    if (!device) throw SystemError(device.error().message);
    Maker maker(
        std::move(*device), [this](PreviewResult result) { publish(std::move(result)); }, overtaken,
        [this](double share) { tell(baked, share); }, [this](double share) { tell(simulated, share); });
    bool more = false;
    for (;;) {
        const bool waits = maker.waits();
        std::optional<PreviewWish> newer;
        {
            std::unique_lock lock(mutex);
            const auto woken = [&] { return stop || next; };
            if (!more && waits) {
                asked.wait_for(lock, kCompilePoll, woken);
            } else if (more && maker.pauses()) {
                asked.wait_for(lock, kPause, woken);
            } else if (!more) {
                working = next.has_value();
                asked.wait(lock, woken);
            }
            if (stop) return;
            working = true;
            newer = std::exchange(next, std::nullopt);
            if (newer) tried = newer;
            overtaken.reset();
        }
        if (newer) maker.take(std::move(*newer));
        more = maker.work();
    }
}

bool Preview::Shared::beginsAgain() {
    std::lock_guard lock(mutex);
    if (std::exchange(renewed, true)) return false;
    if (!next) next = last;
    baked = simulated = 1.0;
    return true;
}

void Preview::Shared::fail(const std::string& why) {
    {
        std::lock_guard lock(mutex);
        if (!ready) ready = told;
        ready->failure = why;
        ready->current = false;
        // Not what failed once more; a newer wish may be the remedy.
        if (next && tried && sameWish(*next, *tried)) next.reset();
        baked = simulated = 1.0;
        renewed = working = false;
    }
    if (changed) changed();
}

void Preview::Shared::run() {
    for (;;) {
        try {
            return work();
        } catch (const DeviceLost& lost) {
            if (beginsAgain()) continue;
            fail(lostAgain(lost).what());
        } catch (const std::exception& error) { fail(error.what()); }
        std::unique_lock lock(mutex);
        asked.wait(lock, [&] { return stop || next; });
        if (stop) return;
        working = true;
    }
}

Preview::Preview(DeviceOptions device, std::function<void()> changed) : shared(std::make_shared<Shared>()) {
    shared->deviceOptions = std::move(device);
    shared->changed = std::move(changed);
    shared->thread = std::thread([state = shared.get()] { state->run(); });
}

Preview::~Preview() {
    {
        std::lock_guard lock(shared->mutex);
        shared->stop = true;
        shared->overtaken.byAny = shared->overtaken.byEarlier = true;
        shared->overtaken.byOther.request();
    }
    shared->asked.notify_all();
    shared->thread.join();
}

void Preview::ask(PreviewWish wish) {
    std::lock_guard lock(shared->mutex);
    if (shared->last && sameWish(*shared->last, wish)) return;
    shared->overtaken.byAny = true;
    if (shared->last && shared->last->graph != wish.graph && wish.held.empty())
        shared->overtaken.byOther.request();
    if (shared->last && wish.seconds < shared->last->seconds) shared->overtaken.byEarlier = true;
    shared->last = wish;
    shared->next = std::move(wish);
    shared->asked.notify_all();
}

std::optional<PreviewResult> Preview::take() {
    std::lock_guard lock(shared->mutex);
    return std::exchange(shared->ready, std::nullopt);
}

std::optional<double> Preview::baking() const {
    const double share = shared->baked;
    return share < 1.0 ? std::optional(share) : std::nullopt;
}

std::optional<double> Preview::simulating() const {
    const double share = shared->simulated;
    return share < 1.0 ? std::optional(share) : std::nullopt;
}

bool Preview::busy() const {
    std::lock_guard lock(shared->mutex);
    return shared->working || shared->next.has_value();
}

}  // namespace fw::editor
